# SPDX-License-Identifier: Apache-2.0
"""Gradients of runs."""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple, Optional, Sequence, Union, overload

from . import _native
from ._errors import fault
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


def tangents(model: Model, channels: "Sequence[str]", times: Any, wrt: "Sequence[str]", overrides: Overrides) -> Any:
    """Derivatives of channels at times, step ends, by parameters: an array (times, channels, parameters)."""
    import numpy as np

    text, name = _text_of(model)
    of = [f"{channel}@{time!r}" for time in np.asarray(times).tolist() for channel in channels]
    _, found = _native.gradient(text, name, overrides_list(overrides), of, list(wrt), True, False, True)
    return np.array([outcome[4] for outcome in found]).reshape(len(times), len(channels), len(wrt))


def _text_of(model: Model) -> "tuple[str, str]":
    """Text and name of a model without callables."""
    for call in model._calls()[1]:
        raise fault(f"loads.{call.load}", f"{call.function!r} has no known derivative",
                    "Write an expression of t instead")
    text, name, _ = model._source()
    return text, name


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
    """Runs a model and differentiates the run: exact for its steps, whose lengths are kept.

    of:         an outcome, or several: "bodies.rod.position.x@end", "probes.tip.vx@max", "joints.A.rz@mean",
                "bodies.rod.velocity.z@0.25" at a time [s] at which a step ends. Without @ the end.
    wrt:        parameters by path, as overrides: "bodies.rod.mass", "variables.L", "joints.A.at.0".
    forward:    tangents of all parameters instead of the adjoint of each outcome: the same numbers. None: if there
                are more outcomes than parameters.
    error_bars: also run with half the step.

    Returns a Gradient, or a list of them for a list of outcomes. Derivatives are per unit of the number in the model,
    in SI if it has a unit there. Doubts, as in chaotic motions, are warnings. Raises ModelError for models, parameters
    and outcomes that have no gradient, such as those with contacts, and for models with callables.
    """
    outcomes = [of] if isinstance(of, str) else list(of)
    paths = [wrt] if isinstance(wrt, str) else list(wrt)
    text, name = _text_of(model)
    by_tangents = len(outcomes) > len(paths) if forward is None else forward
    listed = overrides_list(overrides)
    parameters, found = _native.gradient(text, name, listed, outcomes, paths, by_tangents, error_bars)
    results = []
    for outcome, value, unit, time, by, bars, growth, check, doubts in found:
        for doubt in doubts:
            warnings.warn(doubt, stacklevel=2)
        slopes = {path: slope for (path, _, _), slope in zip(parameters, by)}
        elasticity = {path: size / value * slopes[path] for path, size, _ in parameters if size and value}
        results.append(Gradient(outcome, value, unit, time, slopes, dict(zip(slopes, bars)), elasticity, growth, check))
    return results[0] if isinstance(of, str) else results
