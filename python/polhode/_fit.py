# SPDX-License-Identifier: Apache-2.0
"""Parameter estimation from measured channels."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from ._derivatives import components
from ._errors import ModelError, NotConverged
from ._gradient import pulled_back, source_of, tangents
from ._model import Model, Overrides
from ._result import Result
from ._run import run

_INSEPARABLE = 1e-10  #: Ratio of singular values below which a direction of the parameters leaves the data unchanged.


class Experiment(NamedTuple):
    """Measurements of one run."""

    data: "Mapping[str, Any]"  #: Measured values by channel, including "time" [s].
    overrides: Overrides = None  #: Changes of the model for this run, by path.


class Fit(NamedTuple):
    """Least-squares estimates of parameters."""

    parameters: "dict[str, float]"  #: Estimates by path.
    covariance: Any  #: (p, p), in the order of `parameters`, from deviations of the data or else from the residuals.
    residuals: Any  #: (m,) at the estimates, of all experiments, in the deviations where they are given.
    result: Result  #: Run with the estimates, of the first experiment.
    data: "dict[str, Any]"  #: Measured values of the first experiment by channel, including "time".
    results: "list[Result]"  #: Runs with the estimates, of all experiments.
    experiments: "list[Experiment]"  #: Measured values of all experiments.
    singular_values: Any  #: (p,) of the derivative of the residuals by the parameters, each relative to its guess.
    runs: int  #: Runs of the search, those for derivatives counted as such: one for each parameter, tangent or adjoint.

    @property
    def errors(self) -> "dict[str, float]":
        """Standard errors of the estimates."""
        return dict(zip(self.parameters, np.sqrt(np.diag(self.covariance)).tolist()))

    @property
    def correlation(self) -> Any:
        """Correlation matrix (p, p) of the estimates."""
        errors = np.sqrt(np.diag(self.covariance))
        return self.covariance / np.outer(errors, errors)

    def plot(self, experiment: int = 0) -> Any:
        """Draws the run with the estimates and the measured values of an experiment, a panel for each channel.
        Returns the figure."""
        data = self.experiments[experiment].data
        names = [name for name in data if name != "time"]
        figure = self.results[experiment].plot(*names)
        for panel, name in zip(figure.axes, names):
            panel.plot(data["time"], np.reshape(data[name], (len(data["time"]), -1)), "k.", markersize=3,
                       zorder=1, label="measured")
            panel.legend(loc="best", fontsize="small")
        return figure

    def __repr__(self) -> str:
        errors = self.errors
        return "\n".join(f"{path:40} {value:.8g} +- {errors[path]:.2g}" for path, value in self.parameters.items())


class _Misfit:
    """Residuals of all experiments as functions of the parameters, relative to their sizes."""

    def __init__(self, model: Model, experiments: "list[Experiment]", names: "list[str]", scale: Any,
                 deviations: "Mapping[str, float]", priors: "Mapping[str, tuple[float, float]]") -> None:
        self.model, self.experiments, self.names, self.scale = model, experiments, names, scale
        self.deviations, self.priors = deviations, priors
        self.runs = 0
        self._at: Any = None
        self._results: "list[Result]" = []

    def at(self, x: Any) -> "dict[str, float]":
        """The parameters by path."""
        return dict(zip(self.names, (x * self.scale).tolist()))

    def results(self, x: Any) -> "list[Result]":
        """Runs of all experiments; those of the last parameters are kept."""
        if self._at is None or not np.array_equal(self._at, x):
            self._results = [run(self.model, overrides={**(e.overrides or {}), **self.at(x)}, progress=False)
                             for e in self.experiments]
            self._at = np.array(x)
            self.runs += len(self.experiments)
        return self._results

    def _prior_parts(self, x: Any) -> "list[Any]":
        return [np.array([(self.at(x)[path] - mean) / deviation for path, (mean, deviation) in self.priors.items()])]

    def residuals(self, x: Any) -> Any:
        """Computed less measured values, and those of the priors."""
        from scipy.interpolate import CubicSpline

        parts = []
        for e, result in zip(self.experiments, self.results(x)):
            for name, values in _channels(e):
                channel = np.asarray(result[name]).reshape(len(result.time), -1)
                wanted = np.asarray(values, dtype=float).reshape(len(e.data["time"]), -1)
                differences = CubicSpline(result.time, channel)(e.data["time"]) - wanted
                parts.append(differences.ravel() / self.deviations.get(name, 1.0))
        return np.concatenate(parts + self._prior_parts(x))

    def jacobian(self, x: Any) -> Any:
        """Derivatives of the residuals: splines through the derivatives of the channels at output times."""
        from scipy.interpolate import CubicSpline

        parts = []
        for e, result in zip(self.experiments, self.results(x)):
            source = source_of(self.model, {**(e.overrides or {}), **self.at(x)})
            names = [c for name, _ in _channels(e) for c in _numbers(result, name)]
            _, by = tangents(source, names, result.time, self.names)
            smooth = CubicSpline(result.time, by)(e.data["time"])
            first = 0
            for name, _ in _channels(e):
                last = first + len(_numbers(result, name))
                parts.append(smooth[:, first:last].reshape(-1, len(self.names)) / self.deviations.get(name, 1.0))
                first = last
            self.runs += len(self.names)
        rows = [[1.0 / self.priors[path][1] if path == name else 0.0 for name in self.names] for path in self.priors]
        return np.vstack([*parts, *([np.array(rows)] if rows else [])]) * self.scale

    def cost(self, x: Any) -> "tuple[float, Any]":
        """Half the sum of squares of the residuals, and its derivative by one adjoint for each experiment."""
        from scipy.interpolate import CubicSpline

        residuals = self.residuals(x)
        slope = np.zeros(len(self.names))
        first = 0
        for e, result in zip(self.experiments, self.results(x)):
            times = np.asarray(result.time)
            # Values at measured times are linear in those of the frames.
            spline = CubicSpline(times, np.eye(len(times)))(e.data["time"])
            names, weights = [], []
            for name, values in _channels(e):
                count = np.asarray(values).size
                own = residuals[first:first + count].reshape(len(e.data["time"]), -1)
                names += _numbers(result, name)
                weights.append(spline.T @ own / self.deviations.get(name, 1.0))
                first += count
            source = source_of(self.model, {**(e.overrides or {}), **self.at(x)})
            slope += pulled_back(source, names, times, np.hstack(weights), self.names)
            self.runs += 1
        for path, (_, deviation) in self.priors.items():
            slope[self.names.index(path)] += residuals[first] / deviation
            first += 1
        return 0.5 * float(residuals @ residuals), slope * self.scale


def _channels(e: Experiment) -> "list[tuple[str, Any]]":
    return [(name, e.data[name]) for name in e.data if name != "time"]


def _numbers(result: Result, channel: str) -> "list[str]":
    array = np.asarray(result[channel])
    return components(channel, array.reshape(len(array), -1).shape[1])


def _checked(data: Any) -> "list[Experiment]":
    """Experiments with arrays. Raises ValueError for lengths that differ or times that decrease."""
    given = list(data) if isinstance(data, Sequence) else [Experiment(data)]
    experiments = []
    for e in given:
        own = e if isinstance(e, Experiment) else Experiment(e)
        arrays = {name: np.asarray(own.data[name], dtype=float) for name in own.data}
        if "time" not in arrays:
            raise ValueError("the data have no 'time'")
        if np.any(np.diff(arrays["time"]) < 0):
            raise ValueError("the times of the data must not decrease")
        for name, values in arrays.items():
            if len(values) != len(arrays["time"]):
                raise ValueError(f"'{name}' has {len(values)} values at {len(arrays['time'])} times")
        if len(arrays) < 2:
            raise ValueError("the data have no channel beside 'time'")
        experiments.append(Experiment(arrays, own.overrides))
    if not experiments:
        raise ValueError("there are no data")
    return experiments


def _inseparable(jacobian: Any, names: "list[str]") -> "tuple[Any, str]":
    """Singular values, and parameters which the data do not tell apart, or ""."""
    _, values, directions = np.linalg.svd(jacobian, full_matrices=False)
    if len(values) == 0 or values[-1] > _INSEPARABLE * values[0]:
        return values, ""
    direction = directions[-1]
    involved = [n for n, part in zip(names, direction) if abs(part) > 0.1 * np.max(np.abs(direction))]
    return values, ", ".join(involved)


def fit(
    model: Model,
    data: "Union[Mapping[str, Any], Sequence[Union[Experiment, Mapping[str, Any]]]]",
    parameters: "Mapping[str, float]",
    *,
    bounds: "Optional[Mapping[str, tuple[float, float]]]" = None,
    jacobian: str = "differences",
    deviations: "Optional[Mapping[str, float]]" = None,
    priors: "Optional[Mapping[str, tuple[float, float]]]" = None,
) -> Fit:
    """Estimates parameters of a model from measured channels, by scipy.optimize.least_squares.

    data:       measured values by channel, including "time": {"time": t (m,) [s], "joints.A.coordinates": y},
                or a pandas.DataFrame; several experiments as a list of these, or of Experiment with overrides.
                Results are interpolated at these times by cubic splines.
    parameters: initial guesses, by path as overrides: {"loads.damper.damping": 0.1}.
    bounds:     (lowest, highest) by path.
    jacobian:   "differences" of runs; "exact": tangents of one run, as polhode.gradient; "adjoint": the exact
                derivative of the sum of squares by one adjoint, for many parameters, with L-BFGS-B. The exact ones
                are for positions and velocities of bodies and coordinates of joints, with a fixed step.
    deviations: standard deviations of measured values by channel: residuals are divided by them. All channels or none.
    priors:     (mean, standard deviation) of parameters known before, by path; require deviations.

    A UserWarning names parameters that the data do not tell apart. Raises ModelError or NotConverged if the model
    does not run at the initial guesses, ValueError if the lengths of the data differ, times decrease, or deviations
    are missing or not positive.
    """
    if jacobian not in ("differences", "exact", "adjoint"):
        raise ValueError(f"jacobian is '{jacobian}': use differences, exact or adjoint")
    from scipy.optimize import least_squares, minimize

    experiments = _checked(data)
    sizes, known = dict(deviations or {}), dict(priors or {})
    measured = list(dict.fromkeys(name for e in experiments for name, _ in _channels(e)))
    missing = [name for name in measured if name not in sizes]
    if known and missing or sizes and missing:
        raise ValueError(f"'{missing[0]}' has no standard deviation: give deviations of all channels")
    for path, size in [*sizes.items(), *((path, pair[1]) for path, pair in known.items())]:
        if not size > 0:
            raise ValueError(f"the standard deviation of '{path}' must be positive")
    for path in known:
        if path not in parameters:
            raise ValueError(f"priors name '{path}', which is not a parameter of the fit")
    names = list(parameters)
    scale = np.array([abs(parameters[k]) or 1.0 for k in names])
    misfit = _Misfit(model, experiments, names, scale, sizes, known)
    start = np.array([parameters[k] for k in names]) / scale
    limits = [(bounds or {}).get(k, (-np.inf, np.inf)) for k in names]
    low, high = (np.array([b[i] for b in limits]) / scale for i in (0, 1))
    count = len(misfit.residuals(start))

    def residuals(x: Any) -> Any:
        try:
            return misfit.residuals(x)
        except (ModelError, NotConverged):
            return np.full(count, np.inf)  # the search takes a shorter step

    if jacobian == "adjoint":
        found = minimize(misfit.cost, start, jac=True, method="L-BFGS-B", bounds=list(zip(low, high)),
                         options={"ftol": 1e-15, "gtol": 1e-12 * max(1.0, misfit.cost(start)[0]), "maxiter": 1000})
        best = found.x
        slopes = misfit.jacobian(best)
    else:
        way: "dict[str, Any]" = {"jac": misfit.jacobian} if jacobian == "exact" else {"diff_step": 1e-5}
        least = least_squares(residuals, start, bounds=(low, high), x_scale="jac", xtol=1e-12, ftol=1e-12, **way)
        best, slopes = least.x, least.jac
    final = misfit.residuals(best)
    values, doubtful = _inseparable(slopes, names)
    if doubtful:
        warnings.warn(f"the data do not tell these parameters apart: {doubtful}. Fix one of them, or give priors",
                      stacklevel=2)
    normal = slopes.T @ slopes
    variance = 1.0 if sizes else final @ final / max(1, len(final) - len(names))
    inverse = np.linalg.pinv(normal, hermitian=True) if doubtful else np.linalg.inv(normal)
    results = misfit.results(best)
    measured_count = len(final) - len(known)
    return Fit(misfit.at(best), inverse * variance * np.outer(scale, scale), final[:measured_count], results[0],
               dict(experiments[0].data), results, experiments, values, misfit.runs)
