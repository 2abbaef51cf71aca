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
from ._measure import series
from ._model import Model, Overrides
from ._result import Result
from ._run import whole_run

#: Singular values, relative to the largest, below which a direction of the parameters leaves the data unchanged: of
#: exact derivatives, and of central differences.
_INSEPARABLE, _INSEPARABLE_BY_DIFFERENCES = 1e-9, 1e-6
#: Part of a parameter in such a direction above which its error is infinite.
_INVOLVED = 1e-4
#: Relative step of central differences.
_DIFFERENCE = 1e-4
#: Difference of the channels of a run and of its gradient, as a part of the residuals' size, above which it is
#: reported: impacts are located in gradients only.
_SAME_RUN = 1e-6
#: Error of interpolation between frames, as a part of the residuals, above which it is reported.
_COARSE = 0.1
#: Part of the run within which two times are equal.
_SAME_TIME = 1e-9


class Experiment(NamedTuple):
    """Measurements of one run."""

    data: "Mapping[str, Any]"  #: Measured values by channel, including "time" [s].
    overrides: Overrides = None  #: Changes of the model for this run, by path.


class Fit(NamedTuple):
    """Least-squares estimates of parameters."""

    parameters: "dict[str, float]"  #: Estimates by path.
    covariance: Any  #: (p, p), in the order of `parameters`; infinite for those that the data do not tell apart.
    residuals: Any  #: (m,) at the estimates, of all experiments: in SI units, or in deviations where they are given.
    result: Result  #: Run with the estimates, of the first experiment.
    data: "dict[str, Any]"  #: Measured values of the first experiment by channel, including "time".
    results: "list[Result]"  #: Runs with the estimates, of all experiments.
    experiments: "list[Experiment]"  #: Measured values of all experiments.
    singular_values: Any  #: (p,) of the derivative of the residuals by the parameters, each relative to its guess.
    runs: int  #: Runs of the search, and one more for each tangent, adjoint or difference.
    converged: bool  #: Whether the search ended at a minimum.
    message: str  #: Why it ended.

    @property
    def errors(self) -> "dict[str, float]":
        """Standard errors of the estimates."""
        return dict(zip(self.parameters, np.sqrt(np.diag(self.covariance)).tolist()))

    @property
    def correlation(self) -> Any:
        """Correlation matrix (p, p) of the estimates; NaN for those that the data do not tell apart."""
        errors = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
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
    """Residuals of all experiments as functions of the parameters, both relative to their sizes."""

    def __init__(self, model: Model, experiments: "list[Experiment]", names: "list[str]", scale: Any,
                 sizes: "Mapping[str, float]", priors: "Mapping[str, tuple[float, float]]") -> None:
        self.model, self.experiments, self.names, self.scale = model, experiments, names, scale
        self.sizes, self.priors = sizes, priors
        self.runs = 0
        self.apart = 0.0  # of the channels of runs and of their gradients, relative to their sizes
        self._at: Any = None
        self._results: "list[Result]" = []

    def at(self, x: Any) -> "dict[str, float]":
        """The parameters by path."""
        return dict(zip(self.names, (x * self.scale).tolist()))

    def _overrides(self, e: Experiment, x: Any) -> "dict[str, Any]":
        return {**(e.overrides or {}), **self.at(x)}

    def results(self, x: Any) -> "list[Result]":
        """Runs of all experiments; those of the last parameters are kept."""
        if self._at is None or not np.array_equal(self._at, x):
            found = [whole_run(self.model, self._overrides(e, x)) for e in self.experiments]
            self._results, self._at = found, np.array(x)
            self.runs += len(found)
        return self._results

    def check(self, x: Any) -> None:
        """Raises ValueError for data of another shape than their channel, or at times outside the run."""
        for e, result in zip(self.experiments, self.results(x)):
            for name, values in _channels(e):
                t, channel = series(result, name)
                last = e.data["time"][-1]
                if e.data["time"][0] < t[0] - _SAME_TIME * t[-1] or last > t[-1] * (1 + _SAME_TIME):
                    raise ValueError(f"the data go from {e.data['time'][0]:g} to {last:g} s, and '{name}' from "
                                     f"{t[0]:g} to {t[-1]:g} s: set analysis.duration, or leave out those rows")
                flat = channel.shape[1:] if channel.shape[1:] != (1,) else ()
                own = values.shape[1:] if values.shape[1:] != (1,) else ()
                if own != flat:
                    raise ValueError(f"the data of '{name}' have the shape {values.shape}, and the channel has {flat} "
                                     "at each time: name a component, as in 'bodies.rod.position.z'")

    def parts(self, x: Any) -> "list[tuple[str, Any]]":
        """Computed less measured values of each experiment and channel, in their units."""
        from scipy.interpolate import CubicSpline

        found = []
        for e, result in zip(self.experiments, self.results(x)):
            for name, values in _channels(e):
                t, channel = series(result, name)
                at = CubicSpline(t, channel.reshape(len(t), -1))(e.data["time"])
                found.append((name, (at - values.reshape(len(values), -1)).ravel()))
        return found

    def residuals(self, x: Any) -> Any:
        """Those of the data in their sizes, and those of the priors."""
        known = [(self.at(x)[path] - mean) / deviation for path, (mean, deviation) in self.priors.items()]
        return np.concatenate([*(part / self.sizes[name] for name, part in self.parts(x)), known])

    def jacobian(self, x: Any) -> Any:
        """Derivatives of the residuals: splines through the derivatives of the channels at output times."""
        from scipy.interpolate import CubicSpline

        parts = []
        for e, result in zip(self.experiments, self.results(x)):
            times = np.asarray(result.time)
            counts = [(name, _numbers(result, name)) for name, _ in _channels(e)]
            source = source_of(self.model, self._overrides(e, x))
            values, by = tangents(source, [c for _, own in counts for c in own], times, self.names)
            smooth = CubicSpline(times, by)(e.data["time"])
            first = 0
            for name, own in counts:
                ran = series(result, name)[1].reshape(len(times), -1)
                apart = np.abs(values[:, first:first + len(own)] - ran) / self.sizes[name]
                self.apart = max(self.apart, float(np.max(apart)))
                parts.append(smooth[:, first:first + len(own)].reshape(-1, len(self.names)) / self.sizes[name])
                first += len(own)
            self.runs += len(self.names)
        return np.vstack([*parts, self._prior_rows()]) * self.scale

    def _prior_rows(self) -> Any:
        rows = [[1.0 / self.priors[path][1] if path == name else 0.0 for name in self.names] for path in self.priors]
        return np.array(rows).reshape(len(rows), len(self.names))

    def differences(self, x: Any) -> Any:
        """Derivatives of the residuals by central differences of runs, of one side where the other does not run: a
        damping of zero cannot fall."""
        here = self.residuals(x)
        columns = []
        for k in range(len(x)):
            step = np.zeros(len(x))
            step[k] = _DIFFERENCE * max(abs(x[k]), _DIFFERENCE)
            sides = []
            for side in (1, -1):
                try:
                    sides.append((side * step[k], self.residuals(x + side * step)))
                except (ModelError, NotConverged):
                    sides.append((0.0, here))
            (above, high), (below, low) = sides
            if above == below:
                raise NotConverged(f"no run beside the estimate of '{self.names[k]}' ends: its error is unknown")
            columns.append((high - low) / (above - below))
        return np.stack(columns, axis=1)

    def cost(self, x: Any) -> "tuple[float, Any]":
        """Half the sum of squares of the residuals, and its derivative by one adjoint for each experiment."""
        residuals = self.residuals(x)
        slope = np.zeros(len(self.names))
        first = 0
        for e, result in zip(self.experiments, self.results(x)):
            times = np.asarray(result.time)
            names: "list[str]" = []
            weights = []
            for name, values in _channels(e):
                own = residuals[first:first + values.size].reshape(len(values), -1) / self.sizes[name]
                names += _numbers(result, name)
                weights.append(_transposed_spline(times, e.data["time"], own))
                first += values.size
            source = source_of(self.model, self._overrides(e, x))
            slope += pulled_back(source, names, times, np.hstack(weights), self.names)
            self.runs += 1
        slope += residuals[first:] @ self._prior_rows()
        return 0.5 * float(residuals @ residuals), slope * self.scale

    def coarse(self, x: Any) -> "Optional[str]":
        """A channel whose interpolation between frames is too inaccurate for its data."""
        from scipy.interpolate import CubicSpline

        left = self.parts(x)
        for e, result in zip(self.experiments, self.results(x)):
            for name, _ in _channels(e):
                (_, part), left = left[0], left[1:]
                t, channel = series(result, name)
                if len(t) < 5:
                    continue
                keep = np.unique(np.append(np.arange(0, len(t), 2), len(t) - 1))
                flat = channel.reshape(len(t), -1)
                every, other = (CubicSpline(t[k], flat[k])(e.data["time"]) for k in (slice(None), keep))
                error = float(np.max(np.abs(every - other))) / 15.0  # the error of a cubic falls by 16
                if error > _COARSE * float(np.sqrt(np.mean(part**2))) and error > 1e-6 * float(np.ptp(flat)):
                    return name
        return None


def _transposed_spline(times: Any, at: Any, weights: Any) -> Any:
    """Weights of values at frames, from those (m, c) of a cubic spline through them at other times."""
    from scipy.interpolate import BSpline, CubicSpline
    from scipy.sparse.linalg import splu

    if len(times) < 4:
        return CubicSpline(times, np.eye(len(times)))(at).T @ weights
    knots = np.concatenate([[times[0]] * 4, times[2:-2], [times[-1]] * 4])  # not a knot: as CubicSpline
    inside = np.clip(at, times[0], times[-1])
    through = BSpline.design_matrix(times, knots, 3).tocsc()
    return splu(through).solve(BSpline.design_matrix(inside, knots, 3).T @ weights, "T")


def _channels(e: Experiment) -> "list[tuple[str, Any]]":
    return [(name, e.data[name]) for name in e.data if name != "time"]


def _numbers(result: Result, channel: str) -> "list[str]":
    array = series(result, channel)[1]
    return components(channel, array.reshape(len(array), -1).shape[1])


def _checked(data: Any, parameters: "Mapping[str, float]") -> "list[Experiment]":
    """Experiments with arrays. Raises ValueError for what is no table of numbers with increasing times."""
    given = list(data) if isinstance(data, Sequence) and not isinstance(data, Experiment) else [data]
    experiments = []
    for e in given:
        own = e if isinstance(e, Experiment) else Experiment(e)
        if not hasattr(own.data, "keys"):
            raise ValueError("data must be a table by channel, or a list of these or of polhode.Experiment")
        arrays = {name: np.asarray(own.data[name], dtype=float) for name in own.data}
        if "time" not in arrays:
            raise ValueError("the data have no 'time'")
        if len(arrays) < 2:
            raise ValueError("the data have no channel beside 'time'")
        if not arrays["time"].size:
            raise ValueError("the data have no rows")
        for name, values in arrays.items():
            if len(values) != len(arrays["time"]):
                raise ValueError(f"'{name}' has {len(values)} values at {len(arrays['time'])} times")
            if not np.all(np.isfinite(values)):
                row = int(np.argwhere(~np.isfinite(values))[0][0])
                raise ValueError(f"'{name}' is not a finite number in row {row + 1}: leave out that row")
        if np.any(np.diff(arrays["time"]) < 0):
            raise ValueError("the times of the data must not decrease")
        for path in own.overrides or {}:
            if path in parameters:
                raise ValueError(f"'{path}' is fitted, so an experiment cannot set it")
        experiments.append(Experiment(arrays, own.overrides))
    if not experiments:
        raise ValueError("there are no data")
    return experiments


def ranges_of(bounds: "Optional[Mapping[str, Any]]", parameters: "Mapping[str, float]",
              scale: Any) -> "tuple[Any, Any]":
    """Lowest and highest values of parameters, relative to their sizes; None in a pair is no bound. Raises ValueError
    for a bound of something else, and for a guess outside."""
    for path in bounds or {}:
        if path not in parameters:
            raise ValueError(f"bounds name '{path}', which is not a parameter. Parameters: {', '.join(parameters)}")
    low, high = [], []
    for path, guess in parameters.items():
        least, most = (bounds or {}).get(path, (None, None))
        low.append(-np.inf if least is None else least)
        high.append(np.inf if most is None else most)
        if not low[-1] <= guess <= high[-1]:
            raise ValueError(f"the guess {guess:g} of '{path}' is outside of its bounds {low[-1]:g} to {high[-1]:g}")
    return np.array(low) / scale, np.array(high) / scale


def _covariance(misfit: _Misfit, x: Any, slopes: Any, threshold: float, known: bool) -> "tuple[Any, Any, list[str]]":
    """Covariance of the estimates, singular values, and parameters which the data do not tell apart.

    @param known  Whether deviations of the data are given: their residuals have the variance 1. Else each channel has
    that of its own residuals.
    """
    lengths = np.linalg.norm(slopes, axis=0)
    columns = slopes / np.where(lengths > 0, lengths, 1.0)
    _, values, directions = np.linalg.svd(columns, full_matrices=True)
    values = np.concatenate([values, np.zeros(len(x) - len(values))])
    free = values <= threshold * values[0]
    free |= values == 0
    lost = np.any(np.abs(directions[free]) > _INVOLVED, axis=0) if np.any(free) else np.zeros(len(x), dtype=bool)
    inverse = np.where(free, 0.0, 1.0 / np.where(free, 1.0, values))
    normal = directions.T * inverse**2 @ directions  # (J^T J)^-1 without what is free
    if not known:
        rows = columns @ normal
        rank = int(np.sum(~free))
        first, middle = 0, np.zeros_like(normal)
        pooled: "dict[str, list[Any]]" = {}
        for name, part in misfit.parts(x):
            pooled.setdefault(name, []).append(part / misfit.sizes[name])
        total = sum(len(p) for parts in pooled.values() for p in parts)
        variance = {name: float(np.mean(np.concatenate(parts)**2)) * total / max(1, total - rank)
                    for name, parts in pooled.items()}
        for name, part in misfit.parts(x):
            own = rows[first:first + len(part)]
            middle += variance[name] * own.T @ own
            first += len(part)
        normal = middle
    sizes = misfit.scale / np.where(lengths > 0, lengths, 1.0)
    covariance = normal * np.outer(sizes, sizes)
    covariance[lost] = covariance[:, lost] = np.nan
    covariance[lost, lost] = np.inf
    return covariance, values, [n for n, gone in zip(misfit.names, lost) if gone]


def fit(
    model: Model,
    data: "Union[Mapping[str, Any], Experiment, Sequence[Union[Experiment, Mapping[str, Any]]]]",
    parameters: "Mapping[str, float]",
    *,
    bounds: "Optional[Mapping[str, tuple[Optional[float], Optional[float]]]]" = None,
    jacobian: str = "differences",
    deviations: "Optional[Mapping[str, float]]" = None,
    priors: "Optional[Mapping[str, tuple[float, float]]]" = None,
) -> Fit:
    """Estimates parameters of a model from measured channels, by scipy.optimize.least_squares.

    data:       measured values by channel, including "time": {"time": t (m,) [s], "joints.A.coordinates": y},
                or a pandas.DataFrame; several experiments as a list of these, or of Experiment with overrides.
                Results are interpolated at these times by cubic splines between frames: leave out output.every.
    parameters: initial guesses, by path as overrides: {"loads.damper.damping": 0.1}.
    bounds:     (lowest, highest) by path, None for none.
    jacobian:   "differences" of runs; "exact": tangents of one run, as polhode.gradient; "adjoint": the exact
                derivative of the sum of squares by one adjoint, for many parameters, with L-BFGS-B. The exact ones
                are for positions and velocities of bodies and coordinates of joints; automatic steps are those of
                the present parameters.
    deviations: standard deviations of measured values by channel, by which residuals are divided, of all channels or
                none: then residuals are divided by the spread of each channel's values, and the errors of the estimates
                follow from the residuals of each channel.
    priors:     (mean, standard deviation) of parameters known before, by path; require deviations.

    A UserWarning names parameters that the data do not tell apart, whose errors are infinite, and those at a bound.
    Raises ModelError or NotConverged if the model does not run at the initial guesses, KeyboardInterrupt when a run is
    stopped, ValueError for data that are no finite numbers at increasing times within the run, in the shape of their
    channel, for guesses outside of bounds, and for deviations that are missing or not positive.
    """
    if jacobian not in ("differences", "exact", "adjoint"):
        raise ValueError(f"jacobian is '{jacobian}': use differences, exact or adjoint")
    experiments = _checked(data, parameters)
    known = dict(priors or {})
    measured = list(dict.fromkeys(name for e in experiments for name, _ in _channels(e)))
    missing = [name for name in measured if name not in (deviations or {})]
    if missing and (known or deviations):
        raise ValueError(f"'{missing[0]}' has no standard deviation: give deviations of all channels")
    for path, size in [*(deviations or {}).items(), *((path, pair[1]) for path, pair in known.items())]:
        if not size > 0:
            raise ValueError(f"the standard deviation of '{path}' must be positive")
    for path in known:
        if path not in parameters:
            raise ValueError(f"'{path}' has a prior and is not a parameter of the fit")
    sizes = dict(deviations) if deviations else {name: _spread(experiments, name) for name in measured}
    names = list(parameters)
    scale = np.array([abs(parameters[k]) or 1.0 for k in names])
    low, high = ranges_of(bounds, parameters, scale)
    misfit = _Misfit(model, experiments, names, scale, sizes, known)
    start = np.array([parameters[k] for k in names]) / scale
    misfit.check(start)  # a model that does not run is refused here
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # doubts about derivatives on the way; those at the end count
        best, converged, message = _search(misfit, start, low, high, jacobian)
    differences = jacobian == "differences"
    slopes = misfit.differences(best) if differences else misfit.jacobian(best)
    covariance, values, lost = _covariance(misfit, best, slopes, _INSEPARABLE_BY_DIFFERENCES if differences
                                           else _INSEPARABLE, bool(deviations))
    if misfit.apart > _SAME_RUN:
        warnings.warn("impacts and events end steps in the gradient, but not in the runs: their channels differ by "
                      f"{misfit.apart:.1g} of their size, and the estimates are as inexact. Take shorter steps",
                      stacklevel=2)
    if lost:
        warnings.warn(f"the data do not tell these parameters apart, or do not depend on them: {', '.join(lost)}. Fix "
                      "some of them, or give priors", stacklevel=2)
    for name, x, least, most in zip(names, best, low, high):
        if min(x - least, most - x) <= 1e-9 * max(1.0, abs(x)):
            warnings.warn(f"'{name}' ends at its bound, so that its error is not that of a free estimate", stacklevel=2)
    if not converged:
        warnings.warn(f"the search did not end at a minimum: {message}", stacklevel=2)
    if coarse := misfit.coarse(best):
        warnings.warn(f"the frames of '{coarse}' are too far apart for its data: leave out output.every, or shorten it",
                      stacklevel=2)
    results = misfit.results(best)
    left = np.concatenate([part / ((deviations or {}).get(name, 1.0)) for name, part in misfit.parts(best)])
    return Fit(misfit.at(best), covariance, left, results[0], dict(experiments[0].data), results, experiments, values,
               misfit.runs, converged, message)


def _spread(experiments: "list[Experiment]", name: str) -> float:
    """Size of a channel's values, by which its residuals are divided: channels of different units count alike."""
    values = np.concatenate([e.data[name].reshape(len(e.data[name]), -1) for e in experiments if name in e.data])
    return float(np.max(np.std(values, axis=0))) or float(np.max(np.abs(values))) or 1.0


def _search(misfit: _Misfit, start: Any, low: Any, high: Any, jacobian: str) -> "tuple[Any, bool, str]":
    """Estimates, whether they are a minimum, and why the search ended."""
    from scipy.optimize import least_squares, minimize

    count = len(misfit.residuals(start))
    if jacobian == "adjoint":
        first = max(1.0, misfit.cost(start)[0])

        def cost(x: Any) -> "tuple[float, Any]":
            try:
                return misfit.cost(x)
            except (ModelError, NotConverged):
                return 10.0 * first, np.zeros(len(x))  # the search takes a shorter step

        found = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=list(zip(low, high)),
                         options={"ftol": 1e-15, "gtol": 1e-12 * first, "maxiter": 1000, "maxfun": 2000})
        # A search that round-off ends is at a minimum, too.
        return found.x, bool(found.success) or found.status == 2, str(found.message)

    def residuals(x: Any) -> Any:
        try:
            return misfit.residuals(x)
        except (ModelError, NotConverged):
            return np.full(count, np.inf)  # the search takes a shorter step

    way: "dict[str, Any]" = {"jac": misfit.jacobian} if jacobian == "exact" else {"diff_step": 1e-5}
    least = least_squares(residuals, start, bounds=(low, high), x_scale="jac", xtol=1e-12, ftol=1e-12, **way)
    return least.x, least.status > 0, str(least.message)
