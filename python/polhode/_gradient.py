# SPDX-License-Identifier: Apache-2.0
"""Gradients of runs."""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple, Optional, Sequence, Union, overload

from . import _native
from ._errors import ModelError, NotConverged, fault
from ._model import Model, Overrides, overrides_list


class Gradient(NamedTuple):
    """Derivatives of one outcome by parameters of a model, each by the parameter's path.

    error: how far they are from those of the motion itself, from a run with half the step; empty without error_bars.
    elasticity: relative change of the outcome by that of the parameter, for those that are not zero. growth: by how
    much perturbations grow, backwards over the run. check: difference of tangent and adjoint in one direction [-].
    """

    outcome: str
    value: float
    unit: str
    time: float
    by: "dict[str, float]"
    error: "dict[str, float]"
    elasticity: "dict[str, float]"
    growth: float
    check: float

    def __repr__(self) -> str:
        lines = [f"{self.outcome} = {self.value:.10g} {self.unit} at {self.time:.6g} s"]
        for path, slope in self.by.items():
            bar = f" +- {self.error[path]:.1e}" if path in self.error else ""
            lines.append(f"  by {path}: {slope:.10g}{bar}")
        return "\n".join(lines)


class Source(NamedTuple):
    """What a run was computed from."""

    text: str  #: Of the model file.
    name: str  #: Of the model file.
    overrides: "list[str]"  #: As the command line takes them.
    called: "tuple[str, str]" = ("", "")  #: Load with a callable, and that; derivatives are refused.

    def known(self) -> "Source":
        """Itself, if no load is a callable. Raises ModelError otherwise."""
        load, function = self.called
        if load:
            raise fault(f"loads.{load}", f"{function} has no known derivative", "Write an expression of t instead")
        return self


def source_of(model: Model, overrides: Overrides) -> Source:
    """The source of runs of a model as it is now."""
    text, name, in_file = model._source()
    calls = [] if in_file else model._calls()[1]
    called = (calls[0].load, repr(calls[0].function)) if calls else ("", "")
    return Source(text, name, overrides_list(overrides), called)


def _differentiate(source: Source, *request: Any) -> "tuple[list[Any], list[Any]]":
    """Parameters and outcomes of the engine's gradients. Raises NotConverged for a run that does not end."""
    text, name, overrides, _ = source.known()
    try:
        parameters, found = _native.gradient(text, name, overrides, *request)
    except ModelError:
        raise
    except RuntimeError as error:
        raise NotConverged(str(error)) from None
    return parameters, found


def gradients(source: Source, of: "list[str]", wrt: "list[str]", forward: Optional[bool],
              error_bars: bool) -> "list[Gradient]":
    """Gradients of outcomes of a run."""
    by_tangents = len(of) > len(wrt) if forward is None else forward
    parameters, found = _differentiate(source, of, wrt, by_tangents, error_bars)
    results = []
    for outcome, value, unit, time, by, bars, growth, check, doubts in found:
        for doubt in doubts:
            warnings.warn(doubt, stacklevel=3)
        slopes = {path: slope for (path, _, _), slope in zip(parameters, by)}
        elasticity = {path: size / value * slopes[path] for path, size, _ in parameters if size and value}
        results.append(Gradient(outcome, value, unit, time, slopes, dict(zip(slopes, bars)), elasticity, growth, check))
    return results


#: Part of the largest derivative below which one is zero but for round-off.
_NEGLIGIBLE = 1e-9


def _at_times(channels: "Sequence[str]", times: Any) -> "list[str]":
    """Outcomes of channels at times, those of one time together."""
    import numpy as np

    return [f"{channel}@{time!r}" for time in np.asarray(times, dtype=float).tolist() for channel in channels]


def tangents(source: Source, channels: "Sequence[str]", times: Any, wrt: "Sequence[str]") -> "tuple[Any, Any]":
    """Values of channels at times, step ends: (times, channels), and their derivatives by parameters: (times,
    channels, parameters)."""
    import numpy as np

    of = _at_times(channels, times)
    _, found = _differentiate(source, of, list(wrt), True, False, True)
    shape = (len(times), len(channels))
    values = np.array([outcome[1] for outcome in found]).reshape(shape)
    by = np.array([outcome[4] for outcome in found])
    # Only the last outcome has an adjoint to compare with. Digits of a derivative that is zero mean nothing.
    if np.max(np.abs(by[-1])) > _NEGLIGIBLE * np.max(np.abs(by)):
        _warn(found[-1][8])
    return values, by.reshape(*shape, len(wrt))


def pulled_back(source: Source, channels: "Sequence[str]", times: Any, weights: Any, wrt: "Sequence[str]") -> Any:
    """Derivative of the sum of channels at times, step ends, with weights (times, channels), by parameters
    (parameters,): one adjoint."""
    import numpy as np

    of = _at_times(channels, times)
    factors = np.asarray(weights, dtype=float).ravel().tolist()
    if not np.all(np.isfinite(factors)):
        raise ValueError("the weights are not finite numbers")
    _, found = _differentiate(source, of, list(wrt), False, False, False, factors)
    _warn(found[0][8])
    return np.array(found[0][4])


def _warn(doubts: "list[str]") -> None:
    """Doubts about derivatives as warnings in the caller of a public function."""
    for doubt in doubts:
        warnings.warn(doubt, stacklevel=4)


@overload
def gradient(model: Model, of: str, wrt: "Union[str, Sequence[str]]", *, overrides: Overrides = ...,
             forward: Optional[bool] = ..., error_bars: bool = ...) -> Gradient: ...
@overload
def gradient(model: Model, of: "list[str]", wrt: "Union[str, Sequence[str]]", *, overrides: Overrides = ...,
             forward: Optional[bool] = ..., error_bars: bool = ...) -> "list[Gradient]": ...


def gradient(
    model: Model,
    of: "Union[str, list[str]]",
    wrt: "Union[str, Sequence[str]]",
    *,
    overrides: Overrides = None,
    forward: Optional[bool] = None,
    error_bars: bool = True,
) -> "Union[Gradient, list[Gradient]]":
    """Runs a model and differentiates the run: exact for its steps, whose lengths are kept. Automatic steps, with
    their lengths and orders, are those of this run: the sequence is frozen.

    of:         an outcome, or several: "bodies.rod.position.x@end", "probes.tip.vx@max", "joints.A.rz@mean",
                "bodies.rod.velocity.z@0.25" at a time [s] at which a fixed step ends; automatic ones end there.
                Also "@min", "@integral"; without @ the end. "misfit:table.csv": the sum of the squares of the
                differences from measured values, in a table with the columns "t [s]" and channels.
    wrt:        parameters by path, as overrides: "bodies.rod.mass", "variables.L", "joints.A.at.0".
    forward:    tangents of all parameters instead of the adjoint of each outcome: the same numbers. None: if there
                are more outcomes than parameters.
    error_bars: also run with half the step, or with each automatic step as two of half its length.

    Returns a Gradient, or a list of them for a list of outcomes. Derivatives are per unit of the number in the model,
    in SI if it has a unit there. Doubts, as in chaotic motions, are warnings. Raises ModelError for models, parameters
    and outcomes that have no gradient, such as those with contacts, and for models with callables; NotConverged for a
    run that does not end.
    """
    outcomes = [of] if isinstance(of, str) else list(of)
    paths = [wrt] if isinstance(wrt, str) else list(wrt)
    results = gradients(source_of(model, overrides), outcomes, paths, forward, error_bars)
    return results[0] if isinstance(of, str) else results
