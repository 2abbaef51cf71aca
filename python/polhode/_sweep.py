# SPDX-License-Identifier: Apache-2.0
"""Studies: many runs of a model, and parameter estimation from data."""

from __future__ import annotations

import hashlib
import io
import json
import os
import pickle
from collections.abc import Mapping, Sequence
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np

from ._errors import ModelError, NotConverged
from ._gradient import tangents
from ._model import Model
from ._result import Result
from ._run import run

_FIGURES = ("t", "steps", "newton_iterations", "energy_drift", "constraint_residual_max", "wall_time_s", "result_hash")


def _points(parameters: "Mapping[str, Any]", n: Optional[int], method: str, seed: int) -> "list[dict[str, Any]]":
    """Values of all parameters, point by point."""
    import itertools

    names = list(parameters)
    if method == "grid":
        axes = [np.linspace(v[0], v[1], n or 5).tolist() if isinstance(v, tuple) else list(v)
                for v in parameters.values()]
        return [dict(zip(names, values)) for values in itertools.product(*axes)]
    if n is None:
        raise ValueError(f"the method {method} requires n, the number of points")
    pairs = np.array([tuple(v) for v in parameters.values()], dtype=float)
    if pairs.shape != (len(names), 2):
        raise ValueError(f"the method {method} requires two numbers for each parameter: "
                         + ("(mean, standard deviation)" if method == "normal" else "(lowest, highest)"))
    if method == "normal":
        values = np.random.default_rng(seed).normal(pairs[:, 0], pairs[:, 1], (n, len(names)))
    elif method in ("sobol", "lhs"):
        from scipy.stats import qmc

        maker = qmc.Sobol if method == "sobol" else qmc.LatinHypercube
        values = qmc.scale(maker(len(names), seed=seed).random(n), pairs[:, 0], pairs[:, 1])
    else:
        raise ValueError(f"unknown method '{method}'; use grid, sobol, lhs or normal")
    return [dict(zip(names, row)) for row in values.tolist()]


def _last(result: Result, outputs: "Sequence[str]") -> "dict[str, Any]":
    """Channels at the last frame, a number for each component."""
    row: "dict[str, Any]" = {}
    for name in outputs:
        value = np.asarray(result[name])[-1]
        letters = {3: "xyz", 4: "wxyz"}.get(value.size, "0123456789") if value.ndim else ""
        if value.ndim:
            row.update({f"{name}.{c}": float(x) for c, x in zip(letters, value.ravel())})
        else:
            row[name] = float(value)
    return row


def _one(task: "tuple[Model, dict[str, Any], Any]") -> "dict[str, Any]":
    """One run as a row; a failure is a row with its message."""
    model, point, outputs = task
    row: "dict[str, Any]" = {**point, "message": ""}
    try:
        result = run(model, overrides=point, progress=False)
        row.update({name: result.ledger[name] for name in _FIGURES})
        row.update(outputs(result) if callable(outputs) else _last(result, outputs))
    except NotConverged as error:
        row["message"] = str(error)
        if error.result is not None:
            row.update({name: error.result.ledger[name] for name in _FIGURES})
    except Exception as error:  # a row of a study also for exceptions of its callables
        row["message"] = f"{type(error).__name__}: {error}"
    return row


def sweep(
    model: Model,
    parameters: "Mapping[str, Any]",
    *,
    n: Optional[int] = None,
    method: str = "grid",
    outputs: "Union[Sequence[str], Callable[[Result], dict[str, Any]]]" = (),
    processes: Optional[int] = None,
    resume: "Union[str, os.PathLike[str], None]" = None,
    seed: int = 0,
    client: Any = None,
) -> Any:
    """Runs a model at many values of its parameters; returns a pandas.DataFrame, a row for each run.

    parameters: by path, as overrides: {"bodies.rod.mass": [1, 2, 3], "variables.L": (0.8, 1.2)}.
    method:     "grid": all combinations; a list gives values, a tuple (from, to) n equal steps.
                "sobol", "lhs" (Latin hypercube): n points between (lowest, highest) of each.
                "normal": n points of (mean, standard deviation).
    outputs:    channels whose last values become columns, or a function of the Result that returns a
                dict; with several processes a function that can be pickled.
    processes:  number of parallel processes; None: one for each processor. 1 runs in this process.
    resume:     a file to which rows are appended as they are computed; its runs are not repeated.
    seed:       of sobol, lhs and normal.
    client:     a dask.distributed.Client: runs are distributed to its workers, which need Polhode; those of
                a lost worker are given to another one.

    A failed run is a row with its "message"; other messages are empty. Rows are in the order of the points,
    and their numbers do not depend on the number of processes or workers. Raises ValueError for an unknown
    method or values that do not suit it.
    """
    import pandas

    points = _points(parameters, n, method, seed)
    wanted = outputs if callable(outputs) else list(outputs)
    identity = hashlib.sha256(pickle.dumps((model.to_dict(), wanted))).hexdigest()
    rows: "dict[int, dict[str, Any]]" = {}
    path = os.fspath(resume) if resume is not None else None
    if path is not None and os.path.exists(path):
        rows = _rows_of(path, identity, points)
    tasks = {i: (model, point, outputs) for i, point in enumerate(points) if i not in rows}
    log = None
    if path is not None:
        log = io.open(path, "a", encoding="utf-8")
    try:
        for i, row in _on_workers(tasks, client) if client is not None else _run_all(tasks, processes):
            rows[i] = row
            if log is not None:
                log.write(json.dumps({"model": identity, "point": points[i], "row": row}) + "\n")
                log.flush()
    finally:
        if log is not None:
            log.close()
    return pandas.DataFrame([rows[i] for i in range(len(points))])


def _rows_of(path: str, identity: str, points: "list[dict[str, Any]]") -> "dict[int, dict[str, Any]]":
    """Rows of an earlier sweep of the same model, by index of their point."""
    index = {json.dumps(point): i for i, point in enumerate(points)}
    rows = {}
    with io.open(path, encoding="utf-8") as file:
        for line in file:
            try:
                entry = json.loads(line)
            except ValueError:
                continue  # the last line of a sweep that was killed
            if entry["model"] == identity and (i := index.get(json.dumps(entry["point"]))) is not None:
                rows[i] = entry["row"]
    return rows


def _run_all(tasks: "dict[int, Any]", processes: Optional[int]) -> Any:
    """Index and row of each task in the order of completion; runs of a killed process are repeated."""
    if processes == 1 or len(tasks) < 2:
        for i, task in tasks.items():
            yield i, _one(task)
        return
    from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    left, deaths = dict(tasks), 0
    while left:
        with ProcessPoolExecutor(processes or os.cpu_count(), mp_context=get_context("spawn")) as pool:
            waiting = {pool.submit(_one, task): i for i, task in left.items()}
            try:
                while waiting:
                    done, _ = wait(waiting, return_when=FIRST_COMPLETED)
                    for future in done:
                        i = waiting.pop(future)
                        row = future.result()
                        del left[i]
                        yield i, row
            except BrokenProcessPool:
                deaths += 1
                if deaths > 3:
                    raise


def _on_workers(tasks: "dict[int, Any]", client: Any) -> Any:
    """Index and row of each task in the order of completion by the workers of a Dask cluster."""
    import importlib

    as_completed: Any = importlib.import_module("distributed").as_completed

    # Not pure: equal points are separate runs. The scheduler gives the runs of a lost worker to others.
    waiting = {client.submit(_one, task, pure=False, retries=3): i for i, task in tasks.items()}
    for future in as_completed(waiting):
        yield waiting[future], future.result()


class Fit(NamedTuple):
    """Least-squares estimates of parameters."""

    parameters: "dict[str, float]"  #: Estimates by path.
    covariance: Any  #: (p, p), in the order of `parameters`, scaled by the variance of the residuals.
    residuals: Any  #: (m,) at the estimates.
    result: Result  #: Run with the estimates.
    data: "dict[str, Any]"  #: Measured values by channel, including "time".

    @property
    def errors(self) -> "dict[str, float]":
        """Standard errors of the estimates."""
        return dict(zip(self.parameters, np.sqrt(np.diag(self.covariance)).tolist()))

    def plot(self) -> Any:
        """Draws the run with the estimates and the measured values, a panel for each channel. Returns the figure."""
        names = [name for name in self.data if name != "time"]
        figure = self.result.plot(*names)
        for panel, name in zip(figure.axes, names):
            panel.plot(self.data["time"], np.reshape(self.data[name], (len(self.data["time"]), -1)), "k.", markersize=3,
                       zorder=1, label="measured")
            panel.legend(loc="best", fontsize="small")
        return figure


def _components(channel: str, count: int) -> "list[str]":
    """Names of the numbers of a channel of results."""
    if channel.endswith(".coordinates"):
        return [f"{channel}.{k}" for k in range(count)]
    return [channel] if count == 1 else [f"{channel}.{axis}" for axis in "xyz"[:count]]


def fit(
    model: Model,
    data: "Mapping[str, Any]",
    parameters: "Mapping[str, float]",
    *,
    bounds: "Optional[Mapping[str, tuple[float, float]]]" = None,
    jacobian: str = "differences",
) -> Fit:
    """Estimates parameters of a model from measured channels, by scipy.optimize.least_squares.

    data:       measured values by channel, including "time": {"time": t (m,) [s], "joints.A.coordinates": y},
                or a pandas.DataFrame. Results are interpolated at these times by cubic splines.
    parameters: initial guesses, by path as overrides: {"loads.damper.damping": 0.1}.
    bounds:     (lowest, highest) by path.
    jacobian:   "differences" of runs, or "exact" tangents of one run, as polhode.gradient: for positions and
                velocities of bodies and coordinates of joints, with a fixed step.

    Raises ModelError or NotConverged if the model does not run at the initial guesses, ValueError if the
    lengths of the data differ or times decrease.
    """
    if jacobian not in ("differences", "exact"):
        raise ValueError(f"jacobian is '{jacobian}': use differences or exact")
    from scipy.interpolate import CubicSpline
    from scipy.optimize import least_squares

    times = np.asarray(data["time"], dtype=float)
    measured = {name: np.asarray(data[name], dtype=float) for name in data if name != "time"}
    if np.any(np.diff(times) < 0):
        raise ValueError("the times of the data must not decrease")
    for name, values in measured.items():
        if len(values) != len(times):
            raise ValueError(f"'{name}' has {len(values)} values at {len(times)} times")
    names = list(parameters)
    scale = np.array([abs(parameters[k]) or 1.0 for k in names])

    runs: "list[int]" = []
    latest: "list[Any]" = []  # the last parameters, and their run

    def run_at(x: Any) -> Result:
        return run(model, overrides=dict(zip(names, (x * scale).tolist())), progress=False)

    def residuals(x: Any) -> Any:
        try:
            result = run_at(x)
        except (ModelError, NotConverged):
            if not runs:
                raise
            # Not finite: the search takes a shorter step.
            return np.full(sum(values.size for values in measured.values()), np.inf)
        runs.append(1)
        latest[:] = [x, result]
        parts = []
        for name, values in measured.items():
            channel = np.asarray(result[name]).reshape(len(result.time), -1)
            parts.append((CubicSpline(result.time, channel)(times) - values.reshape(len(times), -1)).ravel())
        return np.concatenate(parts)

    def slopes(x: Any) -> Any:
        """Derivatives of the residuals: splines through the derivatives of the channels at output times."""
        at = dict(zip(names, (x * scale).tolist()))
        result = latest[1] if np.array_equal(latest[0], x) else run_at(x)
        parts = []
        for name in measured:
            channel = np.asarray(result[name]).reshape(len(result.time), -1)
            by = tangents(model, _components(name, channel.shape[1]), result.time, names, at)
            parts.append(CubicSpline(result.time, by)(times).reshape(-1, len(names)) * scale)
        return np.concatenate(parts)

    limits = [(bounds or {}).get(k, (-np.inf, np.inf)) for k in names]
    low, high = (np.array([b[i] for b in limits]) / scale for i in (0, 1))
    start = np.array([parameters[k] for k in names]) / scale
    way: "dict[str, Any]" = {"jac": slopes} if jacobian == "exact" else {"diff_step": 1e-5}
    found = least_squares(residuals, start, bounds=(low, high), x_scale="jac", xtol=1e-12, ftol=1e-12, **way)
    freedoms = max(1, len(found.fun) - len(names))
    covariance = np.linalg.inv(found.jac.T @ found.jac) * (found.fun @ found.fun / freedoms) * np.outer(scale, scale)
    return Fit(dict(zip(names, (found.x * scale).tolist())), covariance, found.fun, run_at(found.x),
               {"time": times, **measured})
