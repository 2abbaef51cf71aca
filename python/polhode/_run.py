# SPDX-License-Identifier: Apache-2.0
"""Runs of a model from start to end."""

from __future__ import annotations

import json
import logging
import math
import os
import warnings
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _native
from ._errors import NotConverged, fault
from ._gradient import source_of
from ._model import Model, Overrides, load, overrides_list
from ._progress import Bar
from ._result import Result
from ._stores import MemoryStore

_log = logging.getLogger("polhode")
_FRAMES = 10000  #: Largest number of steps for which each is a frame by default.


def run(
    model: "Union[Model, str, os.PathLike[str]]",
    *,
    overrides: Overrides = None,
    output: "Union[str, os.PathLike[str], None]" = None,
    progress: "Optional[bool]" = None,
    threads: "Optional[int]" = None,
) -> Result:
    """Runs a model to the end of its analysis and returns the results.

    model:     a Model, or the path of a model file.
    overrides: changes for this run only, by path: {"analysis.step": "1 ms", "variables.L": 2}.
    output:    a folder for the files that `polhode run -o` writes; None: results in memory only.
    progress:  show a bar with tqdm; None: if tqdm is installed and the run takes more than a second.
    threads:   for the members of extrapolated steps, instead of the model's analysis.threads; results have the same
               bits with any number.

    Frames are stored at output.every. Without it they are all steps, but for runs in memory of more than
    10,000 fixed steps: then equally spaced ones, at most 10,001, which the log says. Probes without a rate of their own
    have a row for each step. Other Python threads continue during the run. Ctrl-C stops it: the result then has the
    frames so far, and its `end` is "interrupted".
    Raises ModelError for a model with faults, NotConverged (with `result`) if a step does not
    converge, OSError if the folder cannot be written.
    """
    if threads is not None:
        if threads < 1:
            raise ValueError(f"threads is {threads}; give 1 or more")
        overrides = {**(overrides or {}), "analysis.threads": threads}
    return _run(model, overrides, output, progress, False)


def _run(model: "Union[Model, str, os.PathLike[str]]", overrides: Overrides,
         output: "Union[str, os.PathLike[str], None]", progress: "Optional[bool]", all_steps: bool) -> Result:
    """A run as above; with all_steps they are frames without output.every, however many."""
    if not isinstance(model, Model):
        model = load(model)
    compiled = model._compile(overrides)
    if math.isinf(compiled.duration):
        raise fault("analysis.duration", "is none, but a run needs an end",
                    "Give a duration, in the model or in overrides, or take steps of a Simulation")
    if not all_steps and output is None and (thinned := _thinned(model, compiled, overrides or {})):
        compiled = model._compile({**(overrides or {}), **thinned})
    if compiled.analysis == "modes":
        raise fault("analysis.type", "an analysis of modes has no motion", "Call polhode.modes(model)")
    engine = _native.Engine(compiled)
    recording = engine.record()
    end = 1.0 if compiled.analysis == "statics" else compiled.duration
    with Bar(end, progress) as bar:
        text = engine.run(recording, os.fspath(output) if output is not None else "", model._source()[0],
                          overrides_list(overrides), bar.show)
    ledger = json.loads(text)
    for key in ("exit_code", "results"):
        ledger.pop(key)
    store = MemoryStore(recording.channels(), recording.views(), recording.fixed(), recording.probes())
    result = Result(store, ledger)
    result._origin = source_of(model, overrides)
    if output is not None:
        result._written = os.path.abspath(os.fspath(output))
    _report(ledger)
    if ledger["end"] == "not_converged":
        raise NotConverged(ledger["message"], result)
    return result


def _thinned(model: Model, compiled: "_native.CompiledModel", overrides: "Mapping[str, Any]") -> "dict[str, Any]":
    """Changes of a model that has no output.every and many fixed steps, by which every n-th step is a frame; the steps
    and the rows of its probes stay."""
    step = compiled.step
    if compiled.analysis != "dynamics" or step is None or compiled.duration <= _FRAMES * step * (1 + 1e-9):
        return {}
    if model.output.get("every") is not None or any(k == "output" or k == "output.every" for k in overrides):
        return {}
    steps = math.ceil(compiled.duration / step * (1 - 1e-9))
    each = math.ceil(steps / _FRAMES)
    _log.info("a frame is stored every %g s, each %d of some %d steps; output.every gives another time",
              each * step, each, steps)
    changes: "dict[str, Any]" = {"output.every": f"{each * step!r} s"}
    for name, probe in (model.output.get("probes") or {}).items():
        if probe.get("every") is None and f"output.probes.{name}.every" not in overrides:
            changes[f"output.probes.{name}.every"] = f"{step * 1e-6!r} s"  # due at the end of each step
    return changes


def whole_run(model: Model, overrides: Overrides) -> Result:
    """A run of a study, with all its steps as frames. Raises KeyboardInterrupt if Ctrl-C stops it: its results would be
    taken for whole ones."""
    result = _run(model, overrides, None, False, True)
    if result.end == "interrupted":
        raise KeyboardInterrupt
    return result


def _report(ledger: "dict[str, Any]") -> None:
    """Sends the chosen methods to logging, and warnings of the run to the module warnings."""
    for line in ledger["narration"].splitlines():
        _log.info(line)
    _log.info("reached t = %g in %d steps, %.3g s", ledger["t"], ledger["steps"], ledger["wall_time_s"])
    for warning in ledger["warnings"]:
        warnings.warn(warning, stacklevel=4)
    if ledger["end"] == "interrupted":
        warnings.warn(f"the run was stopped at t = {ledger['t']:g} s", stacklevel=4)
