# SPDX-License-Identifier: Apache-2.0
"""Batches: one small mechanism run with many values of its numbers, several runs in one system."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _native
from ._errors import fault
from ._gradient import source_of
from ._measure import measure
from ._model import Model, Overrides, load

#: Largest number of runs in one system: more of them do not fit into the first cache of a processor.
_TOGETHER = 32


class BatchRun:
    """One run of a batch, whose channels are read like those of a Result: run["probes.tip.x"]."""

    def __init__(self, batch: "Batch", number: int) -> None:
        self._batch, self._number = batch, number

    @property
    def time(self) -> Any:
        """Times of the frames (T,) [s]."""
        return self._batch.time

    def times(self, channel: str) -> Any:
        """Times of a channel (T,) [s], those of the frames."""
        return self._batch.time

    def __getitem__(self, channel: str) -> Any:
        """The numbers of a channel of the batch (T, ...), of a component of it, or its length as CHANNEL.size."""
        return self._batch[channel][self._number]

    def __repr__(self) -> str:
        message = self._batch.messages[self._number]
        return f"<run {self._number} of a batch: {message or 'finished'}>"


class Batch:
    """Numbers of many runs of one mechanism.

    time:       times of the frames (T,) [s].
    parameters: values by path, (runs,) or (runs, n).
    messages:   by run, why it was not finished or is not to be trusted; "" if it was and is.
    finished:   by run, whether it was, and is to be trusted (runs,).
    alone:      by run, whether it was in a system of its own (runs,): its numbers are those of polhode.run, bit for
                bit; of the others to rounding.
    why_alone:  why all were; "" if they need not be.
    """

    def __init__(self, parameters: "dict[str, Any]", found: "tuple[Any, Any, list[str], list[bool], str]") -> None:
        self.parameters = parameters
        self.time, channels, self.messages, alone, self.why_alone = found
        self.alone = np.array(alone, dtype=bool)
        self._arrays = {name: array for name, _, array in channels}
        self._units: "dict[str, str]" = {name: unit for name, unit, _ in channels}

    @property
    def finished(self) -> Any:
        return np.array([not message for message in self.messages], dtype=bool)

    @property
    def channels(self) -> "list[str]":
        """Names of the channels."""
        return list(self._arrays)

    def __len__(self) -> int:
        """The number of runs."""
        return len(self.messages)

    def __getitem__(self, channel: str) -> Any:
        """Numbers of a channel (runs, T, ...), NaN after the end of a run that failed. A number of a vector is
        CHANNEL.x, .y, .z, .w or CHANNEL.0, its length CHANNEL.size. Raises KeyError for an unknown name."""
        if channel in self._arrays:
            return self._arrays[channel]
        above, _, last = channel.rpartition(".")
        array = self._arrays.get(above)
        if array is None or array.ndim != 3:
            near = _native.closest(channel, self.channels)
            raise KeyError(f"'{channel}' is not among the channels of the batch: {', '.join(self.channels)}"
                           + (f". Did you mean '{near}'?" if near else ""))
        if last == "size":
            return np.linalg.norm(array, axis=2)
        letters = {3: "xyz", 4: "wxyz"}.get(array.shape[2], "")
        k = int(last) if last.isdigit() else letters.find(last) if last else -1
        if not 0 <= k < array.shape[2]:
            raise KeyError(f"'{above}' has no number '{last}'")
        return array[:, :, k]

    def unit(self, channel: str) -> str:
        """Unit of a channel: b.unit("bodies.crank.velocity") is "m/s"."""
        return self._units[channel if channel in self._units else channel.rpartition(".")[0]]

    def run(self, number: int) -> BatchRun:
        """One of the runs. Raises IndexError if there is none of that number."""
        if not -len(self) <= number < len(self):
            raise IndexError(f"there is no run {number}: the batch has {len(self)}")
        return BatchRun(self, number % len(self))

    def to_pandas(self, *measures: str) -> Any:
        """A pandas.DataFrame with a row for each run: its parameters, measures as those of polhode.sweep,
        "max(CHANNEL)", "at(CHANNEL, TIME)", CHANNEL for its last value, and its message."""
        import pandas

        rows = []
        for k in range(len(self)):
            row: "dict[str, Any]" = {}
            for path, values in self.parameters.items():
                row[path] = values[k] if values.ndim == 1 else values[k].tolist()
            for text in measures:
                row.update(measure(self.run(k), text))
            rows.append({**row, "message": self.messages[k]})
        return pandas.DataFrame(rows)

    def __repr__(self) -> str:
        failed = len(self) - int(self.finished.sum())
        alone = f", each alone as {self.why_alone}" if self.why_alone else f", {int(self.alone.sum())} of them alone"
        return (f"<polhode.Batch of {len(self)} runs{alone}; {failed} failed; {len(self.time)} frames to "
                f"{self.time[-1]:g} s of {', '.join(self.channels)}>")


def _columns(parameters: "Mapping[str, Any]") -> "dict[str, Any]":
    """Values of parameters as arrays of one length."""
    arrays = {path: np.asarray(values, dtype=float) for path, values in parameters.items()}
    lengths = {len(a) for a in arrays.values() if a.ndim > 0}
    if len(lengths) > 1:
        raise ValueError("the parameters have different numbers of values: "
                         + ", ".join(f"{path} {len(a)}" for path, a in arrays.items() if a.ndim > 0))
    if not lengths:
        raise ValueError("no parameter varies: give an array of values, one for each run")
    runs = lengths.pop()
    for path, array in arrays.items():
        if array.ndim > 2:
            raise ValueError(f"'{path}' has {array.ndim} dimensions: give an array (runs,), or (runs, n) for lists")
        if not np.isfinite(array).all():
            raise ValueError(f"'{path}' has a value that is not finite")
    return {path: np.full(runs, float(a)) if a.ndim == 0 else a for path, a in arrays.items()}


def batch(
    model: "Union[Model, str, os.PathLike[str]]",
    parameters: "Mapping[str, Any]",
    channels: "Sequence[str]" = (),
    *,
    overrides: Overrides = None,
    threads: Optional[int] = None,
) -> Batch:
    """Runs a mechanism with many values of its numbers, several runs side by side in one system.

    model:      a Model, or the path of a model file.
    parameters: by path, arrays of one value for each run: {"variables.L": (runs,), "gravity": (runs, 3)}; numbers are
                in the model's units.
    channels:   what is kept of each run: "bodies.NAME.position", velocity, acceleration, orientation,
                angular_velocity, "joints.NAME.coordinates", rates, force, moment, "loads.NAME.COLUMN", "probes.NAME" or
                one of its columns, or a number of these, "bodies.NAME.position.x". None: the model's probes, or
                positions and orientations of its bodies.
    overrides:  changes of the model for all runs, by path.
    threads:    None: one for each processor. Numbers do not depend on it.

    Frames are at multiples of output.every, or every step. Runs are side by side if steps are fixed, and the model has
    bodies, joints without friction and stops, and loads only; others are run one by one, and the result says why.
    Numbers side by side are those of a run alone to rounding. A run that fails has a message and NaN; it does not
    disturb the others. Raises ModelError for faults of the first run's model or a channel that is not known,
    ValueError for arrays that do not fit, KeyboardInterrupt for Ctrl-C.
    """
    if not isinstance(model, Model):
        model = load(model)
    arrays = _columns(parameters)
    source = source_of(model, overrides)
    if source.called[0]:
        raise fault(f"loads.{source.called[0]}", "a function in Python cannot be in a batch",
                    "Write an expression of t, or use polhode.sweep")
    values = np.ascontiguousarray(np.column_stack(list(arrays.values())))
    widths = [(path, 0 if a.ndim == 1 else a.shape[1]) for path, a in arrays.items()]
    count = threads if threads is not None else os.cpu_count() or 1
    found = _native.batch(source.text, source.name, source.overrides, widths, values, list(channels), max(1, count),
                          _TOGETHER)
    return Batch(arrays, found)
