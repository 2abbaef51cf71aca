# SPDX-License-Identifier: Apache-2.0
"""Measures: numbers of a result, written as text: "max(joints.A.force.size)"."""

from __future__ import annotations

import re
from typing import Any, Callable, Protocol

import numpy as np

from . import _native
from ._result import Group, Result


class Channels(Protocol):
    """What measures need of a result: its channels by name, and their times."""

    def __getitem__(self, channel: str, /) -> Any: ...
    def times(self, channel: str) -> Any: ...


_CALL = re.compile(r"\s*(\w+)\s*\((.*)\)\s*")
_FIRST = re.compile(r"(.+?)\s*([<>])\s*([^<>]+)")
_FORMS = "max(CHANNEL), min, mean, rms, range, final, at(CHANNEL, TIME), first(CHANNEL > VALUE) or <"


def _mean(t: Any, values: Any) -> Any:
    """Mean over time by the trapezoidal rule."""
    if len(t) < 2 or t[-1] == t[0]:
        return values[-1]
    widths = np.diff(t)
    return np.tensordot(widths, 0.5 * (values[1:] + values[:-1]), 1) / (t[-1] - t[0])


_WHOLE: "dict[str, Callable[[Any, Any], Any]]" = {
    "max": lambda t, v: v.max(axis=0),
    "min": lambda t, v: v.min(axis=0),
    "mean": _mean,
    "rms": lambda t, v: np.sqrt(_mean(t, v * v)),
    "range": lambda t, v: v.max(axis=0) - v.min(axis=0),
    "final": lambda t, v: v[-1],
}


def series(result: Channels, channel: str) -> "tuple[Any, Any]":
    """Times and values (T, ...) of a channel, of a probe's column, of the size of a vector as CHANNEL.size, or of one
    of several numbers as CHANNEL.1."""
    above, _, last = channel.rpartition(".")
    if last.isdigit() and above:  # a number of the coordinates of a joint
        t, numbers = series(result, above)
        if numbers.ndim != 2 or int(last) >= numbers.shape[1]:
            raise KeyError(f"'{above}' has no number {last}")
        return t, numbers[:, int(last)]
    found = result[channel]
    if isinstance(found, Group):
        raise KeyError(f"'{channel}' is a group: name one of its channels: {', '.join(list(found)[:8])}")
    return np.asarray(result.times(channel)), np.asarray(found)


def unit_of(result: Result, channel: str) -> str:
    """Unit of a channel or of a column of a probe."""
    above, _, last = channel.rpartition(".")
    return result.unit(above if last.isdigit() else channel)


def _parts(name: str, form: str, value: Any) -> "dict[str, float]":
    """A number, or one for each component; `form` has {} for the name of the channel."""
    array = np.asarray(value)
    if array.ndim == 0:
        return {form.format(name): float(array)}
    letters = "" if name.endswith(("coordinates", "rates")) else {3: "xyz", 4: "wxyz"}.get(array.size, "")
    labels = list(letters) if letters and array.ndim == 1 else [str(k) for k in range(array.size)]
    return {form.format(f"{name}.{c}"): float(x) for c, x in zip(labels, array.ravel())}


def _number(text: str, of: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"'{of}': '{text.strip()}' is not a number in SI units") from None


def measure(result: Channels, text: str) -> "dict[str, float]":
    """Numbers of a result by name: of a channel its last value, or of a function of a channel over time.

    Functions: max, min, mean and rms (over time), range, final, at(CHANNEL, TIME) between frames linearly, NaN outside
    of the run, first(CHANNEL > VALUE): the first time, by linear interpolation, NaN if there is none. A vector gives a
    number for each component, CHANNEL.size its length; probes.NAME.COLUMN a column of a probe. Raises KeyError for an
    unknown channel, ValueError for an unknown function.
    """
    call = _CALL.fullmatch(text)
    if not call:
        name = text.strip()
        return _parts(name, "{}", series(result, name)[1][-1])
    function, inside = call.group(1), call.group(2)
    if function in _WHOLE:
        name = inside.strip()
        t, values = series(result, name)
        return _parts(name, f"{function}({{}})", _WHOLE[function](t, values))
    if function == "at":
        name, comma, when = (part.strip() for part in inside.rpartition(","))
        if not comma:
            raise ValueError(f"'{text}': write at(CHANNEL, TIME)")
        t, values = series(result, name)
        flat = values.reshape(len(t), -1)
        at = [np.interp(_number(when, text), t, column, np.nan, np.nan) for column in flat.T]
        return _parts(name, f"at({{}}, {when})", np.array(at).reshape(values.shape[1:]))
    if function == "first":
        return {text.strip(): _first(result, text, inside)}
    near = _native.closest(function, [*_WHOLE, "at", "first"])
    raise ValueError(f"'{text}': there is no function '{function}'" + (f". Did you mean '{near}'?" if near else "")
                     + f" Write {_FORMS}")


def channel_of(text: str) -> str:
    """The channel that a measure reads, without .size."""
    call = _CALL.fullmatch(text)
    name = text
    if call:
        function, name = call.group(1), call.group(2)
        if function == "at":
            name = name.rpartition(",")[0]
        elif function == "first":
            parts = _FIRST.fullmatch(name.strip())
            name = parts.group(1) if parts else name
    return name.strip().removesuffix(".size")


def _first(result: Channels, text: str, inside: str) -> float:
    """First time at which a channel is above or below a value."""
    parts = _FIRST.fullmatch(inside.strip())
    if not parts:
        raise ValueError(f"'{text}': write first(CHANNEL > VALUE)")
    t, values = series(result, parts.group(1).strip())
    if values.ndim > 1:
        raise ValueError(f"'{text}': name a component or .size of the vector")
    over = (values - _number(parts.group(3), text)) * (1 if parts.group(2) == ">" else -1)
    found = np.flatnonzero(over > 0)
    if not len(found):
        return float("nan")
    k = int(found[0])
    if k == 0:
        return float(t[0])
    return float(t[k - 1] + (t[k] - t[k - 1]) * (-over[k - 1]) / (over[k] - over[k - 1]))
