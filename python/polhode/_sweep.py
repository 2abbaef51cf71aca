# SPDX-License-Identifier: Apache-2.0
"""Studies: many runs of a model."""

from __future__ import annotations

import hashlib
import io
import json
import os
import pickle
from collections.abc import Mapping, Sequence
from typing import Any, Callable, Optional, Union

import numpy as np

from . import _native
from ._errors import NotConverged
from ._gradient import gradients as gradients_of
from ._gradient import source_of
from ._measure import channel_of, measure
from ._model import Model, Overrides
from ._result import Result
from ._run import whole_run

#: Runs of a batch whose rows are stored at once.
_BLOCK = 1024
_FIGURES = ("t", "steps", "newton_iterations", "energy_drift", "constraint_residual_max", "wall_time_s", "result_hash")


def _points(parameters: "Mapping[str, Any]", n: Optional[int], method: str, seed: int) -> "list[dict[str, Any]]":
    """Values of all parameters, point by point."""
    import itertools

    names = list(parameters)
    if method == "grid":
        # 15 digits: 0.45 instead of 0.44999999999999996.
        axes = [[float(f"{x:.15g}") for x in np.linspace(v[0], v[1], n or 5)] if isinstance(v, tuple) else list(v)
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


def _one(task: "tuple[Model, dict[str, Any], dict[str, Any], Any, list[str]]") -> "dict[str, Any]":
    """One run as a row; a failure is a row with its message."""
    model, fixed, point, outputs, outcomes = task
    overrides = {**fixed, **point}
    row: "dict[str, Any]" = {**point, "message": ""}
    try:
        result = whole_run(model, overrides)
        row.update({name: result.ledger[name] for name in _FIGURES})
        for text in () if callable(outputs) else outputs:
            row.update(measure(result, text))
        if callable(outputs):
            row.update(outputs(result))
        for g in gradients_of(source_of(model, overrides), outcomes, list(point), None, False) if outcomes else ():
            row.update({f"d({g.outcome})/d({path})": slope for path, slope in g.by.items()})
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
    overrides: Overrides = None,
    outputs: "Union[Sequence[str], Callable[[Result], dict[str, Any]]]" = (),
    gradients: "Sequence[str]" = (),
    processes: Optional[int] = None,
    resume: "Union[str, os.PathLike[str], None]" = None,
    seed: int = 0,
    client: Any = None,
    batch: bool = False,
) -> Any:
    """Runs a model at many values of its parameters; returns a pandas.DataFrame, a row for each run.

    parameters: by path, as overrides: {"bodies.rod.mass": [1, 2, 3], "variables.L": (0.8, 1.2)}.
    method:     "grid": all combinations; a list gives values, a tuple (from, to) n equal steps.
                "sobol", "lhs" (Latin hypercube): n points between (lowest, highest) of each.
                "normal": n points of (mean, standard deviation).
    overrides:  changes of the model for all runs, by path: {"analysis.duration": "2 s"}.
    outputs:    channels whose last values become columns, or measures: "max(joints.A.force.size)", min, mean, rms,
                range, "at(bodies.b.position.x, 0.5)", "first(probes.tip.z > 0.3)" as a time; or a function of the
                Result that returns a dict, with several processes one that can be pickled.
    gradients:  outcomes, as polhode.gradient takes them, whose derivatives by the varied parameters become columns:
                "d(probes.tip.z@end)/d(variables.L)".
    processes:  number of parallel processes; None: one for each processor. 1 runs in this process.
    resume:     a file to which rows are appended as they are computed; its runs are not repeated.
    seed:       of sobol, lhs and normal.
    client:     a dask.distributed.Client: runs are distributed to its workers, which need Polhode; those of
                a lost worker are given to another one.
    batch:      runs side by side in one system, as by polhode.batch: several times the speed for small mechanisms with
                fixed steps. Rows have no figures of their run, such as steps and energy_drift, and frames are at
                output.every. `processes` is then the number of threads.

    A failed run is a row with its "message"; other messages are empty. Rows are in the order of the points,
    and their numbers do not depend on the number of processes or workers. Raises ValueError for an unknown
    method or values that do not suit it.
    """
    import pandas

    points = _points(parameters, n, method, seed)
    wanted = outputs if callable(outputs) else list(outputs)
    fixed = dict(overrides or {})
    changes = (sorted(fixed.items()),) if fixed else ()
    identity = hashlib.sha256(pickle.dumps((model.to_dict(), wanted, *gradients, *changes))).hexdigest()
    rows: "dict[int, dict[str, Any]]" = {}
    path = os.fspath(resume) if resume is not None else None
    if path is not None and os.path.exists(path):
        rows = _rows_of(path, identity, points)
    if batch:
        if callable(outputs) or not wanted or gradients or client is not None:
            raise ValueError("a batch takes outputs as texts, at least one, and no gradients and no client")
        left = {i: p for i, p in enumerate(points) if i not in rows}
        rows_in_turn = _in_blocks(model, fixed, left, list(outputs), processes)
    tasks = {i: (model, fixed, point, wanted, list(gradients)) for i, point in enumerate(points) if i not in rows}
    log = None
    if path is not None:
        log = io.open(path, "a", encoding="utf-8")
    try:
        if not batch:
            rows_in_turn = _on_workers(tasks, client) if client is not None else _run_all(tasks, processes)
        for i, row in rows_in_turn:
            rows[i] = row
            if log is not None:
                log.write(json.dumps({"model": identity, "point": points[i], "row": row}) + "\n")
                log.flush()
    finally:
        if log is not None:
            log.close()
    return pandas.DataFrame([rows[i] for i in range(len(points))])


def _in_blocks(model: Model, fixed: "dict[str, Any]", points: "dict[int, dict[str, Any]]", outputs: "list[str]",
               threads: Optional[int]) -> Any:
    """Index and row of each point, by batches of neighbours."""
    from ._batch import batch

    channels = list(dict.fromkeys(channel_of(text) for text in outputs))
    numbers = list(points)
    for first in range(0, len(numbers), _BLOCK):
        block = numbers[first:first + _BLOCK]
        values = {path: [points[i][path] for i in block] for path in points[block[0]]}
        done = batch(model, values, channels, overrides=fixed, threads=threads)
        for k, i in enumerate(block):
            row: "dict[str, Any]" = {**points[i], "message": done.messages[k]}
            for text in outputs:
                row.update(measure(done.run(k), text))
            yield i, row


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


def _take_one_thread() -> None:
    """Runs of this process have one thread each, as the processes share the processors."""
    _native.set_threads(1)


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
        with ProcessPoolExecutor(processes or os.cpu_count(), get_context("spawn"), _take_one_thread) as pool:
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
