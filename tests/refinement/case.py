# SPDX-License-Identifier: Apache-2.0
"""What a case of the refinement suite states: a model, the steps it is run at, and what must come out.

A model is the path of a model file or a dictionary of the same form; `tools/refine.py --write NAME` prints the latter.
"""
import dataclasses
import math
import pathlib
import typing

FRACTIONS = (1, 0.5, 0.2, 0.05, 0.01)  # Of the base step: what every case is run at unless it says why not.


@dataclasses.dataclass(frozen=True)
class Known:
    """A number that is known without this program."""

    what: str
    read: typing.Callable  # From the run to the number.
    value: float
    tolerance: typing.Callable | float  # A number, or a function of the step.
    below: bool = False  # The number must not exceed the value by more than the tolerance; it may lie under it.

    def allowed(self, step):
        return self.tolerance(step) if callable(self.tolerance) else self.tolerance


@dataclasses.dataclass(frozen=True)
class Variant:
    """One setting of a case's variables, with what is known of it."""

    label: str
    settings: dict
    known: tuple = ()
    order: float | None = None  # With which differences fall, if not that of the case.
    longer: float = 1  # Its steps are longer than those of the case by this: high orders are seen where errors are above rounding.


@dataclasses.dataclass(frozen=True)
class Case:
    """A model at several steps."""

    name: str
    about: str  # What it asks, and the formula and source of what is known.
    model: typing.Any
    step: float  # [s], the base step.
    span: float  # [s]
    variants: tuple | typing.Callable = (Variant("", {}),)  # Or a function that makes them, where that takes a while.
    fractions: tuple = FRACTIONS
    spans: dict = dataclasses.field(default_factory=dict)  # Fraction to span, where it is not that above.
    order: float = 1  # With which differences fall: 1 with impacts, whose time a step cannot resolve.
    floor: float = 1e-4  # Differences below this part of a probe's range count as equal: 1e-3 of a shape is the gap's tolerance.
    compare: bool = True  # False where closed forms ask everything, and phases of impacts would be compared in vain.
    skip: tuple = ()  # Probes, or "probe.kind", that are not compared; if smooth "probe.column", "probe.[unit]" or "[unit]".
    drift: float = 1e-9  # Bound of the energy that the ledger misses, at every step: dissipation is booked, and nothing is gained.
    until: float = math.inf  # [s], up to which it is compared.
    because: str = ""  # Why not longer, why other fractions or no comparison.
    smooth: bool = False  # Nothing jumps: every column is compared, forces and accelerations too, at instants that all runs have.
    statics: bool = False  # Parts of a step are parts of the load. No order: the equilibrium does not depend on them.
    meshes: tuple = ()  # Settings of finer meshes, each with half the element size of the one before; the first one halves that of the model.
    mesh_order: float = 2  # With which differences between meshes fall.
    mesh_floor: float = 1e-3
    mesh_skip: tuple = ()  # Probes, or "probe.kind", that are not compared between meshes: numbers of elements mean other places there.
    mesh_known: tuple = ()  # Known numbers that meshes approach: the tolerance is a function of the element size, 1 for that of the model.
    open: str = ""  # Why it is not among the tests yet: what the engine does instead. `tools/refine.py NAME` runs it all the same.


def falling(size, step, order, floor=0.0):
    """A tolerance that is `size` at a step and falls with an order."""
    return lambda h: floor + size * (h / step) ** order


def table(name):
    """Rows of a reference solution of tests/validation/data, by their times."""
    lines = (pathlib.Path(__file__).resolve().parent.parent / "validation" / "data" / f"{name}.csv").read_text().splitlines()
    return {row[0]: row[1:] for row in ([float(cell) for cell in line.split(",")] for line in lines if not line.startswith("#"))}


def constant(value):
    return lambda run: value


def last(probe, column):
    """A column's value at the end of the run."""
    return lambda run: run.probe(probe)[column][-1]


def at(probe, column, time):
    """A column's value at a time, between its rows on a straight line."""
    return lambda run: run.value(probe, column, time)


def rise(probe, column):
    """How far a column rose above its start."""

    def read(run):
        values = run.probe(probe)[column]
        return max(values) - values[0]

    return read


def fall(probe, column):
    """How far a column fell below its start."""

    def read(run):
        values = run.probe(probe)[column]
        return values[0] - min(values)

    return read


def largest(probe, column, after=0.0):
    """Largest magnitude of a column after a time."""

    def read(run):
        table = run.probe(probe)
        return max(abs(v) for t, v in zip(table["t"], table[column]) if t >= after)

    return read


def spin_y(centre, tip):
    """Angular velocity about y at the end, of a body that turns about y only: from probes at its centre and at x = 1."""

    def read(run):
        a, b = run.probe(centre), run.probe(tip)
        ex, ez = b["x"][-1] - a["x"][-1], b["z"][-1] - a["z"][-1]
        vx, vz = b["vx"][-1] - a["vx"][-1], b["vz"][-1] - a["vz"][-1]
        return (ez * vx - ex * vz) / (ex * ex + ez * ez)

    return read


def turn_y(centre, tip):
    """Angles about y at all rows from the start on, whole turns counted: of rows that turn by less than half a turn."""

    def read(run):
        a, b = run.probe(centre), run.probe(tip)
        angles = [math.atan2(za - zb, xb - xa) for xa, za, xb, zb in zip(a["x"], a["z"], b["x"], b["z"])]
        total, turns = 0.0, [0.0]
        for before, after in zip(angles, angles[1:]):
            total += math.remainder(after - before, 2 * math.pi)
            turns.append(total)
        return turns

    return read


def body(name, **more):
    """A pair of probes of a body, at its centre and at one metre along its x."""
    return {name: {"body": name, **more}, name + "_x": {"body": name, "point": [1, 0, 0], **more}}


def model(title, bodies, duration=1, step=1e-2, gravity=(0, 0, -9.81), probes=None, **sections):
    """A model as a dictionary."""
    return {"format": 1, "title": title, "gravity": list(gravity), **sections, "bodies": bodies,
            "analysis": {"type": "dynamics", "duration": duration, "step": step},
            "output": {"hdf5": False, "probes": probes or {}}}


FLOOR = {"floor": {"fixed": True, "shape": {"plane": "z"}}}
