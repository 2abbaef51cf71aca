# SPDX-License-Identifier: Apache-2.0
"""Design: parameters for which an outcome of a run is smallest."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np

from ._errors import ModelError, NotConverged
from ._fit import ranges_of
from ._gradient import gradients, source_of
from ._model import Model, Overrides
from ._result import Result
from ._run import whole_run

#: Value of a design that does not run, in units of the largest cost seen; its slope is zero.
_WORSE = 10.0
#: Size of a parameter, in units of its guess, beyond which designs are not run: a search that gets there has no end.
_FARTHEST = 1e4

Cost = Callable[[Any, Any], "tuple[float, Any, Any]"]


class Minimum(NamedTuple):
    """Parameters for which a cost is smallest, at least nearby."""

    parameters: "dict[str, float]"  #: By path.
    value: float  #: The cost.
    outcomes: "dict[str, float]"  #: Values of all outcomes and limits.
    slope: "dict[str, float]"  #: Derivative of the cost by parameter, in its unit.
    result: Result  #: Run with these parameters.
    converged: bool  #: Whether the search ended at a minimum.
    message: str  #: Why it ended.
    evaluations: int  #: Runs with their derivatives.

    def __repr__(self) -> str:
        rows = [f"{path:40} {value:.8g}" for path, value in self.parameters.items()]
        return "\n".join([f"cost {self.value:.8g} after {self.evaluations} runs: {self.message}", *rows])


class _Evaluations:
    """Outcomes and their derivatives by relative parameters; the last evaluation is kept."""

    def __init__(self, model: Model, overrides: Overrides, of: "list[str]", names: "list[str]", scale: Any) -> None:
        self.model, self.overrides, self.of, self.names, self.scale = model, overrides, of, names, scale
        self.count = 0
        self._at: Any = None
        self._found: "tuple[Any, Any]" = (None, None)

    def with_parameters(self, x: Any) -> "dict[str, Any]":
        """Overrides of a run."""
        return {**(self.overrides or {}), **dict(zip(self.names, (x * self.scale).tolist()))}

    def at(self, x: Any) -> "tuple[Any, Any]":
        """Values (n,) and derivatives (n, p)."""
        if self._at is None or not np.array_equal(x, self._at):
            self.count += 1
            found = gradients(source_of(self.model, self.with_parameters(x)), self.of, self.names, None, False)
            values = np.array([g.value for g in found])
            slopes = np.array([[g.by[path] for path in self.names] for g in found]) * self.scale
            self._at, self._found = np.array(x), (values, slopes)
        return self._found

    def forget(self) -> None:
        """Lets the next evaluation run anew, with its warnings."""
        self._at = None

    def safely_at(self, x: Any) -> "tuple[Any, Any]":
        """As at(), but those of the last design that did run for one that does not."""
        try:
            return self.at(x)
        except (ModelError, NotConverged):
            return self._found


def _squares(targets: Any) -> Cost:
    """Sum of squares of the differences from targets."""
    def cost(values: Any, _: Any) -> "tuple[float, Any, Any]":
        differences = values - targets
        return float(differences @ differences), 2.0 * differences, None

    return cost


def _value(values: Any, _: Any) -> "tuple[float, Any, Any]":
    return float(values[0]), np.ones(1), None


def minimize(
    model: Model,
    of: "Union[str, Mapping[str, float], Sequence[str]]",
    parameters: "Mapping[str, float]",
    *,
    cost: "Optional[Cost]" = None,
    bounds: "Optional[Mapping[str, tuple[Optional[float], Optional[float]]]]" = None,
    limits: "Optional[Mapping[str, tuple[float, float]]]" = None,
    sizes: "Optional[Mapping[str, float]]" = None,
    overrides: Overrides = None,
    tolerance: float = 1e-8,
    max_evaluations: int = 500,
) -> Minimum:
    """Finds parameters of a model for which an outcome of its run is smallest, by exact gradients.

    of:         an outcome, as polhode.gradient takes it: "probes.tip.z@max"; or {outcome: target}: the sum of squares
                of the differences from the targets is smallest; or a list of outcomes, for `cost`.
    parameters: initial guesses by path, as overrides: {"variables.L": 0.4}.
    cost:       function of the values of the outcomes (n,) and of the parameters (p,), in the order given; returns the
                cost, its derivatives by the outcomes (n,), and those by the parameters (p,) or None for zeros.
    bounds:     (lowest, highest) by path, None for none.
    limits:     (lowest, highest) of outcomes, -inf or inf for none: {"probes.tip.x@max": (-inf, 1.2)}.
    sizes:      typical sizes of parameters by path; the others have the size of their guess, or 1 for zero.
    overrides:  other changes of the model for these runs.
    tolerance:  largest slope of the cost at the end, by parameters relative to their sizes; with limits the last
                change of the cost is below 1e-4 of it.

    By SciPy's L-BFGS-B, with limits by SLSQP, which meets them and bounds exactly; one adjoint for each outcome, or
    tangents if there are more outcomes than parameters. A design that does not run counts as worse than all that do.
    A search that leaves for ten thousand sizes of a parameter ends unconverged: the message asks for bounds of it.
    Raises ModelError or NotConverged if the model does not run at the guesses or has no gradient, ValueError for a
    list without `cost`.
    """
    from scipy.optimize import NonlinearConstraint
    from scipy.optimize import minimize as search

    if isinstance(of, Mapping):
        if cost is not None:
            raise ValueError("targets are a cost already; give a list of outcomes with `cost`")
        outcomes, own = list(of), _squares(np.array(list(of.values()), dtype=float))
    else:
        outcomes = [of] if isinstance(of, str) else list(of)
        if cost is None and len(outcomes) != 1:
            raise ValueError("several outcomes require `cost`, or targets as {outcome: target}")
        own = cost or _value
    names = list(parameters)
    scale = np.array([(sizes or {}).get(k) or abs(parameters[k]) or 1.0 for k in names])
    start = np.array([parameters[k] for k in names]) / scale
    low, high = ranges_of(bounds, parameters, scale)
    watched = list(limits or {})
    runs = _Evaluations(model, overrides, outcomes + watched, names, scale)
    n, worst = len(outcomes), [0.0]
    left: "list[str]" = []

    def value(x: Any) -> "tuple[float, Any]":
        values, slopes = runs.at(x)
        number, by_values, by_parameters = own(values[:n], x * scale)
        slope = np.asarray(by_values, dtype=float) @ slopes[:n]
        if by_parameters is not None:
            slope = slope + np.asarray(by_parameters, dtype=float) * scale
        worst[0] = max(worst[0], abs(number))
        return float(number), slope

    def safely(x: Any) -> "tuple[float, Any]":
        if np.abs(x).max() > _FARTHEST:
            left.append(names[int(np.argmax(np.abs(x)))])
            return _WORSE * (worst[0] or 1.0), np.zeros(len(names))
        try:
            return value(x)
        except (ModelError, NotConverged):
            return _WORSE * (worst[0] or 1.0), np.zeros(len(names))

    value(start)  # what is wrong with the model is wrong here already
    sizes_of_limits = np.abs(runs.at(start)[0][n:])
    way: "dict[str, Any]" = {"method": "L-BFGS-B", "options": {"gtol": tolerance, "ftol": 1e-15,
                                                             "maxfun": max_evaluations, "maxiter": max_evaluations}}
    if limits:
        least, most = (np.array([limits[k][i] for k in watched], dtype=float) for i in (0, 1))
        constraint = NonlinearConstraint(lambda x: runs.safely_at(x)[0][n:], least, most,
                                         jac=lambda x: runs.safely_at(x)[1][n:])
        way = {"method": "SLSQP", "constraints": [constraint],
               "options": {"ftol": 1e-4 * tolerance, "maxiter": max_evaluations}}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # doubts about derivatives on the way; those at the end count
        found = search(safely, start, jac=True, bounds=list(zip(low, high)), **way)
    x = np.clip(found.x, low, high)
    runs.forget()
    number, slope = value(x)
    values, _ = runs.at(x)
    broken = []
    for k, v, size in zip(watched, values[n:], sizes_of_limits):
        least_value, most_value = limits[k] if limits else (-np.inf, np.inf)
        slack = 1e-6 * max(size, abs(v))
        if not least_value - slack <= v <= most_value + slack:
            broken.append(k)
    message = f"the limit of '{broken[0]}' cannot be met here" if broken else str(found.message)
    converged = bool(found.success) and not broken
    if left and not converged and not broken:
        message = (f"the cost falls on and on: the search left for '{left[0]}' beyond {_FARTHEST:g} times its guess. "
                   f"Give bounds={{'{left[0]}': (lowest, highest)}}, or a cost that grows with it")
    result = whole_run(model, runs.with_parameters(x))
    return Minimum(dict(zip(names, (x * scale).tolist())), number, dict(zip(outcomes + watched, values.tolist())),
                   dict(zip(names, (slope / scale).tolist())), result,
                   converged, message, runs.count)
