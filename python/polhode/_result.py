# SPDX-License-Identifier: Apache-2.0
"""Results of a run, in memory or in a file results.h5: the same object."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _native
from ._derivatives import Differentiable
from ._plot import components_of, plot
from ._stores import FileStore, Store
from ._tree import counted
from .rotations import matrix_from_quaternion

if TYPE_CHECKING:
    from ._show import Page

_QUANTITIES = {
    "bodies": ("position", "orientation", "velocity", "angular_velocity"),
    "joints": ("coordinates", "rates", "force", "moment"),
    "loads": ("values",),
    "contacts": ("gap", "normal_force", "impulse", "energy_lost", "points", "status", "force", "friction", "point"),
}
# Data sets without a frame for each time.
_FIXED = ("/names", "/types", "/first", "/count", "/reference", "/connectivity", "/offsets", "/vtk_type", "/model")


class Group(Mapping):  # type: ignore[type-arg]
    """Results under a common name: `r.bodies["crank"]` has position, velocity, ...

    Quantities are read as attributes or items: arrays whose first dimension is the frame, SI units,
    world axes.
    """

    def __init__(self, result: "Result", path: str) -> None:
        self._result, self._path = result, path

    def __getitem__(self, name: str) -> Any:
        found = self._result._find(f"{self._path}/{name}")
        if found is None:
            near = _native.closest(name, list(self))
            hint = f" Did you mean '{near}'?" if near else f" There are: {', '.join(list(self)[:20])}."
            raise KeyError(f"{self._path[1:].replace('/', '.')} has no '{name}'.{hint}")
        return found

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __iter__(self) -> "Iterator[str]":
        return iter(self._result._names(self._path))

    def __len__(self) -> int:
        return len(self._result._names(self._path))

    def __dir__(self) -> "list[str]":
        return [name for name in self if name.isidentifier()] + ["keys", "values", "items", "unit"]

    def _ipython_key_completions_(self) -> "list[str]":
        return list(self)

    def unit(self, name: str) -> str:
        """Unit of a quantity, such as "m/s"."""
        return self._result.unit(f"{self._path[1:]}.{name}".replace("/", "."))

    def __repr__(self) -> str:
        names = list(self)
        shown = ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")
        return f"<{self._path[1:].replace('/', '.')}: {shown}>"


class Table(Mapping):  # type: ignore[type-arg]
    """Rows of a probe by column: `r.probes["tip"].z` (T,), SI units, with its own times in `t`.

    Three columns of a vector have a length as well, which is computed: r.probes["tip"]["v.size"], "f.size", and
    "distance" of x, y, z.
    """

    def __init__(self, name: str, header: "list[str]", rows: Any) -> None:
        self.name = name
        self._units = {cell.split(" [")[0]: cell.split(" [")[1].rstrip("]") for cell in header}
        self._rows = rows

    def __getitem__(self, name: str) -> Any:
        names = list(self._units)
        if name not in self._units and (parts := self._vector(name)):
            return np.linalg.norm([self._rows[..., names.index(part)] for part in parts], axis=0)
        if name not in self._units:
            near = _native.closest(name, names)
            hint = f" Did you mean '{near}'?" if near else f" There are: {', '.join(names)}."
            raise KeyError(f"probes.{self.name} has no '{name}'.{hint}")
        return self._rows[..., names.index(name)]

    def _vector(self, name: str) -> "list[str]":
        """Columns of the vector whose length is named; none if there is no such vector."""
        head = "" if name == "distance" else name[:-len(".size")] if name.endswith(".size") else None
        for between in ("", " "):
            columns = [f"{head}{between}{axis}" for axis in "xyz"]
            if head is not None and all(column in self._units for column in columns):
                return columns
        return []

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __iter__(self) -> "Iterator[str]":
        return iter(self._units)

    def __len__(self) -> int:
        return len(self._units)

    def __dir__(self) -> "list[str]":
        return [name for name in self if name.isidentifier()] + ["keys", "values", "items", "unit", "name"]

    def _ipython_key_completions_(self) -> "list[str]":
        return list(self)

    def unit(self, name: str) -> str:
        """Unit of a column, such as "m/s"."""
        return self._units[(self._vector(name) or [name])[0]]

    def __repr__(self) -> str:
        if np.ndim(self._rows) == 1:
            return "\n".join(f"{key:18} {self[key]:.6g} {self.unit(key)}" for key in self)
        return f"<probes.{self.name}: {', '.join(self)}; {len(self._rows)} rows>"


class Report(dict):  # type: ignore[type-arg]
    """Summary of a run with the names of `polhode run --json`, as items or attributes."""

    def __getattr__(self, name: str) -> Any:
        if name in self:
            return self[name]
        near = "" if name.startswith("__") else _native.closest(name, list(self))
        raise AttributeError(name + (f". Did you mean '{near}'?" if near else f". There are: {', '.join(self)}."))

    def __dir__(self) -> "list[str]":
        return [*self]

    def __repr__(self) -> str:
        return "\n".join(f"{key:34} {value}" for key, value in self.items() if not isinstance(value, (dict, list)))


class Result(Differentiable):
    """Results of a run, frame by frame. SI units; vectors are in world axes.

    time (T,) [s]; bodies[name].position (T, 3) [m], .orientation (T, 4) quaternion (w, x, y, z) body
    to world, .velocity [m/s], .angular_velocity [rad/s], .angular_velocity_body along the body's own axes
    (computed, not stored); joints[name].force (T, 3) [N] of the first
    body on the second, .moment [N m], .coordinates (T, free) [rad or m], .rates; loads, contacts,
    solids, beams and cables by name; energy, momentum and solver. Arrays are read-only, and those of a run
    are views of the engine's memory: `.copy()` gives one to change. docs/reference/results_file.md lists them all.
    gradient, push_forward, pull_back and uncertainty differentiate the run by numbers of its model.
    """

    def __init__(self, store: Store, ledger: "Optional[dict[str, Any]]" = None) -> None:
        self._store = store
        self._ledger = ledger
        self._tables: "Optional[dict[str, list[str]]]" = None
        self._columns: "dict[str, dict[str, int]]" = {}
        self._written = ""  # folder that a run wrote, too

    def show(self, height: int = 600) -> "Page":
        """The motion in the viewer, as output of a notebook cell, with a height in pixels. Requires a
        results file: raises ValueError for a result that was computed without `output`."""
        from ._show import page_of

        file = self._store.file if isinstance(self._store, FileStore) else self._written
        if not file:
            raise ValueError("these results are in memory only; run with output=\"folder\" to show them")
        return page_of(file, height)

    # Looking up

    @property
    def time(self) -> Any:
        """Times of the frames (T,) [s]; in statics the load factor."""
        return self._store.read("/time")

    @property
    def probes(self) -> "dict[str, Table]":
        """Tables of output.probes by name, each with rows at its own rate."""
        return {name: Table(name, *table) for name, table in self._store.probes().items()}

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.time)

    @property
    def ledger(self) -> Report:
        """Summary of the run: drifts of energy and momenta [-], constraint residuals, steps, wall time
        [s]. For an opened file those numbers that follow from its channels."""
        if self._ledger is not None:
            return Report(self._ledger)
        solver = self.solver
        figures = Report(t=float(self.time[-1]), steps=int(solver.steps[-1]), frames=self.frames,
                         rejected_steps=int(solver.rejected[-1]), newton_iterations=int(solver.iterations[-1]),
                         energy_drift=float(self.energy.drift[-1]))
        if trusted := self._store.attribute("/provenance", "trusted"):
            figures["trusted"] = trusted == "yes"
            figures["distrust"] = str(self._store.attribute("/provenance", "distrust") or "").splitlines()
            figures["warnings"] = str(self._store.attribute("/provenance", "warnings") or "").splitlines()
        return figures

    @property
    def cut_short(self) -> bool:
        """Whether the file is cut short, by an interrupted copy or a full disk: its complete frames are read."""
        return bool(self._store.cut_text)

    @property
    def end(self) -> str:
        """End of the run: finished, interrupted or not_converged; "" if a file does not contain it."""
        return str((self._ledger or {}).get("end", ""))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        found = self._find("/" + name)
        if found is None:
            raise AttributeError(f"the results have no '{name}'; there are: {', '.join(self._names(''))}")
        return found

    def __dir__(self) -> "list[str]":
        own = [name for name in type(self).__dict__ if not name.startswith("_")]
        return sorted({*own, *self._names("")})

    def _children(self) -> "dict[str, list[str]]":
        """Names under each path."""
        if self._tables is None:
            tables: "dict[str, dict[str, None]]" = {}
            for path in self._store.paths():
                parts = path.split("/")
                for i in range(1, len(parts)):
                    tables.setdefault("/".join(parts[:i]), {})[parts[i]] = None
            self._tables = {path: list(names) for path, names in tables.items()}
        return self._tables

    def _packed_names(self, group: str) -> "dict[str, int]":
        if group not in self._columns:
            path = f"/packed/{group}/names"
            known = "names" in self._children().get(f"/packed/{group}", ())
            self._columns[group] = {n: i for i, n in enumerate(self._store.read(path))} if known else {}
        return self._columns[group]

    def _names(self, path: str) -> "list[str]":
        names = list(self._children().get(path, ()))
        parts = path.split("/")
        if len(parts) == 2 and not names:
            return list(self._packed_names(parts[1]))
        if len(parts) == 3 and not names and parts[1] in _QUANTITIES:
            return [q for q in _QUANTITIES[parts[1]] if self._packed(path + "/" + q) is not None]
        if path == "":
            packed = [k[len("/packed/"):] for k in self._children() if k.startswith("/packed/")]
            names = [n for n in [*names, *packed] if n not in ("packed", "provenance")]
            return list(dict.fromkeys(names))
        return names

    def _find(self, path: str) -> Any:
        children = self._children()
        above, _, name = path.rpartition("/")
        if name in children.get(above, ()):
            return Group(self, path) if path in children else self._array(path)
        parts = path.split("/")
        if len(parts) == 2 and f"/packed/{name}" in children:
            return Group(self, path)
        if len(parts) == 3 and name in self._packed_names(parts[1]):
            return Group(self, path)
        return self._packed(path) if len(parts) == 4 else None

    def _packed(self, path: str) -> Any:
        """A quantity of one object from the array of all bodies or joints."""
        _, group, name, quantity = path.split("/")
        if (group, quantity) == ("bodies", "angular_velocity_body"):  # computed, not stored
            spin, turn = (self._packed(f"/bodies/{name}/{q}") for q in ("angular_velocity", "orientation"))
            return None if spin is None or turn is None else in_body_axes(spin, turn)
        index = self._packed_names(group).get(name)
        if index is None or quantity not in self._children().get(f"/packed/{group}", ()):
            return None
        array = self._array(f"/packed/{group}/{quantity}")
        if quantity not in ("coordinates", "rates", "values"):
            return array[:, index]
        first = self._store.read(f"/packed/{group}/first")[index]
        count = self._store.read(f"/packed/{group}/count")[index]
        return array[:, first : first + count] if count else None

    def _array(self, path: str) -> Any:
        array = self._store.read(path)
        # A run that was killed may leave unfinished frames after the last complete one.
        frames = len(self._store.read("/time"))
        longer = isinstance(array, np.ndarray) and not path.endswith(_FIXED) and len(array) > frames
        return array[:frames] if longer else array

    def _resolve(self, channel: str) -> "tuple[str, Any]":
        """Path and array or group of "joints.A.force"; names may have points, "joints.mast.start.force"."""
        path, found = "", None
        parts = channel.split(".")
        while parts:
            for count in range(1, len(parts) + 1):
                further = f"{path}/{'.'.join(parts[:count])}"
                if (found := self._find(further)) is not None:
                    break
            else:
                raise KeyError(f"'{channel}' is not a channel: {path[1:] or 'the results'} has no '{parts[0]}'")
            path, parts = further, parts[count:]
        return path, found

    def __getitem__(self, channel: str) -> Any:
        """An array or group by its dotted name: r["joints.A.force"]; for vectors and quaternions also a
        component: r["joints.A.force.z"], for vectors the length: r["joints.A.force.size"]. A column of a probe is
        r["probes.tip.z"], with its times r.times("probes.tip.z"). Raises KeyError for an unknown name."""
        if channel.startswith("probes."):
            table, column = self._probe(channel)
            return table[column]
        if vector := self._sized(channel):
            found = self[vector]
            if not isinstance(found, np.ndarray) or found.ndim != 2:
                raise KeyError(f"'{vector}' is no vector, so it has no size")
            return np.linalg.norm(found, axis=1)
        above, index = self._component(channel)
        return self._resolve(channel)[1] if index < 0 else self._resolve(above)[1][..., index]

    def times(self, channel: str) -> Any:
        """Times of a channel (T,) [s]: those of the frames, and of a probe's column those of its rows."""
        return self._probe(channel)[0]["t"] if channel.startswith("probes.") else self.time

    @staticmethod
    def _sized(channel: str) -> str:
        """The vector of "joints.A.force.size"; "" of other names."""
        return channel[:-len(".size")] if channel.endswith(".size") else ""

    def _probe(self, channel: str) -> "tuple[Table, str]":
        """The table and the column of "probes.tip.z"; names of probes may have points."""
        tail, probes = channel[len("probes."):], self.probes
        fitting = [name for name in probes if tail.startswith(name + ".")]
        if not fitting:
            name = tail.partition(".")[0]
            near = _native.closest(name, list(probes))
            if name in probes:
                raise KeyError(f"'{channel}' is a probe: name one of its columns: {', '.join(probes[name])}")
            raise KeyError(f"there is no probe '{name}'" + (f". Did you mean '{near}'?" if near else ""))
        name = max(fitting, key=len)
        return probes[name], tail[len(name) + 1:]

    def _component(self, channel: str) -> "tuple[str, int]":
        """The vector or quaternion of a component, and the component's index; the channel and -1 otherwise."""
        above, _, last = channel.rpartition(".")
        if above and last in ("w", "x", "y", "z"):
            found = self._resolve(above)[1]
            letters = {3: "xyz", 4: "wxyz"}.get(found.shape[-1], "") if isinstance(found, np.ndarray) else ""
            if last in letters:
                return above, letters.index(last)
        return channel, -1

    def unit(self, channel: str) -> str:
        """Unit of a channel: r.unit("bodies.crank.velocity") is "m/s"."""
        if channel.startswith("probes."):
            table, column = self._probe(channel)
            return table.unit(column)
        channel = self._sized(channel) or channel
        path = self._resolve(self._component(channel)[0])[0]
        above, _, name = path.rpartition("/")
        if name in self._children().get(above, ()):
            return self._store.unit(path)
        parts = path.split("/")
        return self._store.unit(f"/packed/{parts[1]}/{parts[-1].removesuffix('_body')}")

    def channels(self) -> "list[str]":
        """Dotted names of all channels over time."""
        names = []

        def walk(path: str) -> None:
            for name in self._names(path):
                found = self._find(f"{path}/{name}")
                if isinstance(found, Group):
                    walk(f"{path}/{name}")
                elif isinstance(found, np.ndarray) and len(found) == self.frames:
                    names.append(f"{path}/{name}"[1:].replace("/", "."))

        walk("")
        return names

    # For other libraries

    def to_pandas(self, *channels: str) -> Any:
        """A pandas.DataFrame with the time as index and a column for each component, such as
        "bodies.crank.position.x"; by default of all channels."""
        import pandas

        columns: "dict[str, Any]" = {}
        for name in self._expand(channels):
            array = np.asarray(self[name])
            flat = array.reshape(len(array), -1)
            labels = components_of(array.shape[1:])
            for k, label in enumerate(labels):
                columns[name + label] = flat[:, k]
        frame = pandas.DataFrame(columns, index=pandas.Index(self.time, name="time"))
        return frame.drop(columns="time", errors="ignore")

    def to_xarray(self, *channels: str) -> Any:
        """An xarray.Dataset with the dimension time; units are attributes. Arrays are not copied."""
        import xarray

        data = {}
        for name in self._expand(channels):
            if name == "time":
                continue
            array = self[name]
            axes = {(3,): ["axis"], (4,): ["quaternion"]}.get(array.shape[1:])
            dims = ["time"] + (axes or [f"{name}_{k}" for k in range(1, array.ndim)])
            data[name] = xarray.DataArray(array, dims=dims, attrs={"units": self.unit(name)})
        coordinates = {"time": ("time", self.time, {"units": "s"}), "axis": list("xyz"), "quaternion": list("wxyz")}
        return xarray.Dataset(data, coords=coordinates)

    def to_parquet(self, path: "Union[str, os.PathLike[str]]", *channels: str) -> None:
        """Writes a Parquet file with pyarrow: the time "t" and a column for each component of the
        channels, by default of all, with their units as metadata of the columns."""
        import pyarrow
        from pyarrow import parquet

        names, units, columns = ["t"], ["s"], [np.asarray(self.time, dtype=float)]
        for name in self._expand(channels):
            if name == "time":
                continue
            array = np.asarray(self[name], dtype=float)
            flat = array.reshape(len(array), -1)
            for k, label in enumerate(components_of(array.shape[1:])):
                names.append(name + label)
                units.append(self.unit(name))
                columns.append(flat[:, k])
        fields = [pyarrow.field(n, pyarrow.float64(), metadata={"unit": u}) for n, u in zip(names, units)]
        arrays = [pyarrow.array(column) for column in columns]
        parquet.write_table(pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields)), path)

    def plot(self, *channels: str, axes: Any = None) -> Any:
        """Draws channels over time with matplotlib, one panel each: r.plot("energy", "joints.A.force").
        A group draws all its channels in one panel, a probe its columns, those of one unit in one. Returns the
        figure."""
        return plot(self, channels or ("energy",), axes)

    def _expand(self, channels: "tuple[str, ...]") -> "list[str]":
        if not channels:
            return self.channels()
        every = None
        names = []
        for channel in channels:
            if isinstance(self[channel], Group):
                every = every or self.channels()
                names += [c for c in every if c.startswith(channel + ".")]
            else:
                names.append(channel)
        return names

    def __getstate__(self) -> "dict[str, Any]":
        return {"_store": self._store, "_ledger": self._ledger, "_tables": None, "_columns": {},
                "_written": self._written, "_origin": self._origin}

    def __setstate__(self, state: "dict[str, Any]") -> None:
        self.__dict__.update(state)

    def __repr__(self) -> str:
        t = self.time
        span = f"{self.frames} frames from {t[0]:g} to {t[-1]:g} s" if len(t) else "no frames"
        counts = [counted(len(self._names("/" + g)), g) for g in ("bodies", "joints", "loads") if self._names("/" + g)]
        return f"<polhode.Result: {', '.join([span, *counts, *([self.end] if self.end else [])])}>"


def in_body_axes(vectors: Any, orientations: Any) -> Any:
    """Vectors (3,) or (T, 3) of the world along the axes of bodies with these quaternions (4,) or (T, 4)."""
    return np.einsum("...ij,...i->...j", matrix_from_quaternion(orientations), vectors)


def open(path: "Union[str, os.PathLike[str]]") -> Result:
    """The results in a file results.h5, or in the folder of a run. Raises OSError if there are none.

    Data sets are read at first use. The run may still be in progress. A file that is cut short is read up to its last
    complete frame, with a warning; `Result.cut_short` says so.
    """
    name = os.fspath(path)
    store = FileStore(os.path.join(name, "results.h5") if os.path.isdir(name) else name)
    if store.cut_text:
        warnings.warn(store.cut_text, stacklevel=2)
    return Result(store)
