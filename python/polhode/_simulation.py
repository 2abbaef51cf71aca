# SPDX-License-Identifier: Apache-2.0
"""A model that is run step by step."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np

from . import _native
from ._errors import NotConverged
from ._joint_space import JointSpace, drive
from ._model import Model, Overrides, load
from ._result import Report, Result, Table, in_body_axes
from ._stores import MemoryStore, read_only


class Step(NamedTuple):
    """An accepted step."""

    time: float  #: Reached [s]; in statics the load factor.
    dt: float  #: Length [s].
    iterations: int  #: Newton iterations of the last trial.
    rejected: int  #: Trials that were rejected before.


class _Things(Mapping):  # type: ignore[type-arg]
    """Bodies, joints or loads of a simulation by name."""

    def __init__(self, names: "list[str]", make: "Callable[[int], Any]") -> None:
        self._index = {name: i for i, name in enumerate(names)}
        self._make = make

    def __getitem__(self, name: str) -> Any:
        if name not in self._index:
            near = _native.closest(str(name), list(self._index))
            names = ", ".join([*list(self._index)[:20], *(["..."] if len(self._index) > 20 else [])]) or "none"
            hint = f" Did you mean '{near}'?" if near else f" There are: {names}."
            raise KeyError(f"unknown name '{name}'.{hint}")
        return self._make(self._index[name])

    def __iter__(self) -> "Iterator[str]":
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def _ipython_key_completions_(self) -> "list[str]":
        return list(self._index)

    def __repr__(self) -> str:
        return f"<{', '.join(self._index)}>"


class _Now(Mapping):  # type: ignore[type-arg]
    """A body, joint or load at the present time: every access reads the simulation as it is then.

    Quantities are attributes or items; arrays are read-only copies.
    """

    def __init__(self, read: "Callable[[], Mapping[str, Any]]") -> None:
        object.__setattr__(self, "_read", read)

    def __getitem__(self, name: str) -> Any:
        now = self._read()
        if name not in now:
            near = _native.closest(str(name), list(now))
            raise KeyError(f"{name}. " + (f"Did you mean '{near}'?" if near else f"There are: {', '.join(now)}."))
        return read_only(now[name])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{name} cannot be set: it follows from the motion of the bodies. "
                             "Set position, orientation, velocity or angular_velocity of a body")

    def __iter__(self) -> "Iterator[str]":
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())

    def __dir__(self) -> "list[str]":
        return [*self]

    def __repr__(self) -> str:
        return "\n".join(f"{name:20} {value}" for name, value in self._read().items())


class BodyNow(_Now):
    """A body at the present time; position, orientation, velocity and angular_velocity can be set.

    Every access reads the simulation as it is then. Arrays are read-only copies: set a whole quantity.
    """

    _settable = ("position", "orientation", "velocity", "angular_velocity")

    def __init__(self, simulation: "Simulation", index: int) -> None:
        super().__init__(lambda: simulation._engine.body(index))
        object.__setattr__(self, "_simulation", simulation)
        object.__setattr__(self, "_index", index)

    def __getitem__(self, name: str) -> Any:
        if name != "angular_velocity_body":
            return super().__getitem__(name)
        now = self._read()
        return read_only(in_body_axes(now["angular_velocity"], now["orientation"]))

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._settable:
            raise AttributeError(f"{name} cannot be set; {', '.join(self._settable)} can")
        self.set(**{name: value})

    def set(self, **values: Any) -> None:
        """Sets several quantities at once: body.set(position=..., velocity=...). Raises TypeError for
        others, ModelError if the joints cannot be assembled there, if shapes overlap, with solids and in statics."""
        numbers = {name: None if (v := values.get(name)) is None else [float(x) for x in v] for name in self._settable}
        if set(values) - set(self._settable):
            raise TypeError(
                f"{', '.join(sorted(set(values) - set(self._settable)))} cannot be set; {', '.join(self._settable)} can"
            )
        self._simulation._engine.set_body(self._index, *numbers.values())

    def __dir__(self) -> "list[str]":
        return [*self, "set"]


class LoadNow(_Now):
    """A load at the present time: its reported quantities by name, or its numbers by index in the order
    of docs/reference/loads.md. Every access reads the simulation as it is then."""

    def __init__(self, engine: Any, index: int) -> None:
        channels = engine.load_channels(index)

        def read() -> "dict[str, Any]":
            numbers, now, first = np.array(engine.load(index)), {}, 0
            for name, size in channels:
                now[name] = numbers[first] if size == 1 else numbers[first : first + size]
                first += size
            return now

        super().__init__(read)
        object.__setattr__(self, "_numbers", lambda: engine.load(index))

    def __getitem__(self, name: Any) -> Any:
        return super().__getitem__(name) if isinstance(name, str) else self._numbers()[name]

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.array(self._numbers(), dtype=dtype)


class ProbeNow(Table):
    """A probe at the present time: its columns. Every access reads the simulation as it is then."""

    def __init__(self, engine: Any, name: str) -> None:
        super().__init__(name, engine.probe(name)[0], None)
        self._engine = engine

    @property
    def _rows(self) -> Any:
        return read_only(np.array(self._engine.probe(self.name)[1]))

    @_rows.setter
    def _rows(self, rows: Any) -> None:
        """The constructor of Table has none to give."""


class Simulation(JointSpace):
    """A model with its state, for steps and runs; the state can be read, set, copied and restored.

        sim = polhode.Simulation(m)
        for step in sim:
            print(step.time, sim.bodies["arm"].position)

    bodies[name] has position (3,) [m], orientation (4,) quaternion (w, x, y, z) body to world,
    velocity [m/s], angular_velocity [rad/s], acceleration [m/s²]: of the centre of mass, world axes;
    and angular_velocity_body along the body's own axes.
    joints[name] has coordinates, rates, force, moment and residual. What bodies[name], joints[name],
    loads[name] and probes[name] return follows the simulation: every access reads its present state, and
    arrays are read-only copies. Raises ModelError for a model with faults.

    q, qd and qdd are all coordinates of joints and their derivatives as arrays, in the order of `coordinates`.
    tau=True, or a list of coordinates, adds moments and forces along them that are set as the array sim.tau.
    """

    def __init__(
        self,
        model: "Union[Model, str, os.PathLike[str]]",
        overrides: Overrides = None,
        *,
        tau: "Union[bool, Sequence[str], None]" = None,
    ) -> None:
        model = model if isinstance(model, Model) else load(model)
        self._compiled = model._compile(overrides)
        self._driven = drive(self._compiled, tau)
        self._engine = _native.Engine(self._compiled)
        self._end = 1.0 if self._compiled.analysis == "statics" else float(self._compiled.duration)

    @property
    def time(self) -> float:
        """[s]; in statics the load factor."""
        return float(self._engine.time)

    @property
    def end(self) -> float:
        """End time of the model's analysis [s]; infinite for `duration: none`."""
        return self._end

    @property
    def bodies(self) -> "_Things":
        """Bodies by name: their motion, to read and to set."""
        return _Things(self._engine.bodies, lambda i: BodyNow(self, i))

    @property
    def joints(self) -> "_Things":
        """Joints by name: coordinates, rates, force, moment, residual."""
        return _Things(self._engine.joints, lambda i: _Now(lambda: self._engine.joint(i)))

    @property
    def loads(self) -> "_Things":
        """Loads by name: their reported quantities, also by number in the order of docs/reference/loads.md."""
        return _Things(self._engine.loads, lambda i: LoadNow(self._engine, i))

    @property
    def probes(self) -> "_Things":
        """Probes of output.probes by name: present values by column, sim.probes["tip"].z."""
        names = self._engine.probes
        return _Things(names, lambda i: ProbeNow(self._engine, names[i]))

    @property
    def energy(self) -> Report:
        """kinetic, potential, total, put_in, dissipated [J]; linear_momentum, angular_momentum."""
        return Report({name: read_only(value) for name, value in self._engine.energy().items()})

    @property
    def ledger(self) -> Report:
        """Summary so far, as that of a run."""
        figures = json.loads(self._engine.summary())
        for key in ("end", "exit_code", "results", "frames"):
            figures.pop(key)
        return Report(figures)

    def step(self, until: Optional[float] = None) -> Step:
        """Takes one accepted step, not beyond `until` [s]. Raises NotConverged if there is none; the state
        is then that before the step."""
        accepted, t, dt, rejected, iterations, message = self._engine.step(self._end if until is None else until)
        if not accepted:
            raise NotConverged(message)
        return Step(t, dt, iterations, rejected)

    def __iter__(self) -> "Iterator[Step]":
        """Steps to the end of the analysis; endlessly for `duration: none`."""
        while self.time < self.end * (1 - 1e-9):
            yield self.step()

    def run(
        self,
        until: Optional[float] = None,
        *,
        stop: "Optional[Callable[[Simulation], Any]]" = None,
        observe: "Optional[Callable[[Simulation], Any]]" = None,
    ) -> Result:
        """Steps until a time [s] or until stop(simulation) is true after a step; observe(simulation)
        is called at the beginning and after every step. Returns the frames of all steps. With `duration: none`
        one of `until` and `stop` is required."""
        end = self.end if until is None else until
        if math.isinf(end) and stop is None:
            raise ValueError("the model has the duration none: give `until` [s], or `stop`")
        recording = self._engine.record()
        ended = "finished"
        while True:
            self._engine.record_frame(recording)
            if observe is not None:
                observe(self)
            if stop is not None and recording.frames > 1 and stop(self):
                ended = "stopped"
                break
            if self.time >= end * (1 - 1e-9):
                break
            self.step(end)
        store = MemoryStore(recording.channels(), recording.views(), recording.fixed(), recording.probes())
        return Result(store, {"end": ended, **self.ledger})

    @property
    def state(self) -> bytes:
        """Complete state with tau, bit for bit, as bytes to store, compare and restore."""
        return bytes(self._engine.state)

    def restore(self, state: bytes) -> None:
        """Restores a state of this model; later steps are equal bit for bit. Raises ModelError
        if the state belongs to another model."""
        self._engine.restore(state)

    def copy(self) -> "Simulation":
        """An independent simulation at the same state."""
        other = object.__new__(Simulation)
        other._compiled, other._driven, other._end = self._compiled, self._driven, self._end
        other._engine = self._engine.copy()
        return other

    def __repr__(self) -> str:
        of = "" if math.isinf(self.end) else f" of {self.end:g} s"
        return f"<polhode.Simulation at t = {self.time:g} s{of}>"
