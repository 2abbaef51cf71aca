# SPDX-License-Identifier: Apache-2.0
"""Runs of a model from start to end."""

from __future__ import annotations

import json
import logging
import os
import warnings
from typing import Any, Optional, Union

from . import _native
from ._errors import NotConverged, fault
from ._gradient import source_of
from ._model import Model, Overrides, load, overrides_list
from ._progress import Bar
from ._result import Result
from ._stores import MemoryStore

_log = logging.getLogger("polhode")


def run(
    model: "Union[Model, str, os.PathLike[str]]",
    *,
    overrides: Overrides = None,
    output: "Union[str, os.PathLike[str], None]" = None,
    progress: "Optional[bool]" = None,
) -> Result:
    """Runs a model to the end of its analysis and returns the results.

    model:     a Model, or the path of a model file.
    overrides: changes for this run only, by path: {"analysis.step": "1 ms", "variables.L": 2}.
    output:    a folder for the files that `polhode run -o` writes; None: results in memory only.
    progress:  show a bar with tqdm; None: if tqdm is installed and the run takes more than a second.

    Frames are stored at output.every, by default after every step. Other Python threads continue during the
    run. Ctrl-C stops it: the result then has the frames so far, and its `end` is "interrupted".
    Raises ModelError for a model with faults, NotConverged (with `result`) if a step does not
    converge, OSError if the folder cannot be written.
    """
    if not isinstance(model, Model):
        model = load(model)
    compiled = model._compile(overrides)
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


def whole_run(model: Model, overrides: Overrides) -> Result:
    """A run of a study. Raises KeyboardInterrupt if Ctrl-C stops it: its results would be taken for whole ones."""
    result = run(model, overrides=overrides, progress=False)
    if result.end == "interrupted":
        raise KeyboardInterrupt
    return result


def _report(ledger: "dict[str, Any]") -> None:
    """Sends the chosen methods to logging, and warnings of the run to the module warnings."""
    for line in ledger["narration"].splitlines():
        _log.info(line)
    _log.info("reached t = %g in %d steps, %.3g s", ledger["t"], ledger["steps"], ledger["wall_time_s"])
    for warning in ledger["warnings"]:
        warnings.warn(warning, stacklevel=3)
    if ledger["end"] == "interrupted":
        warnings.warn(f"the run was stopped at t = {ledger['t']:g} s", stacklevel=3)
