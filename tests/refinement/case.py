# SPDX-License-Identifier: Apache-2.0
"""Cases of the refinement suite: a model, its steps, and the expected results.

A model is the path of a model file or a dictionary of the same form; `tools/refine.py --write NAME` prints the latter.
"""
import dataclasses
import math
import pathlib
import typing

FRACTIONS = (1, 0.5, 0.2, 0.05, 0.01)  # Of the base step; a case with others gives the reason.


@dataclasses.dataclass(frozen=True)
class Known:
    """A number that is known without this program."""

    what: str
    read: typing.Callable  # From the run to the number.
    value: float
    tolerance: typing.Callable | float  # A number, or a function of the step.
    below: bool = False  # The number may be less than the value, but must not exceed it by more than the tolerance.

    def allowed(self, step):
        return self.tolerance(step) if callable(self.tolerance) else self.tolerance


@dataclasses.dataclass(frozen=True)
class Variant:
    """One setting of a case's variables, with its known numbers."""

    label: str
    settings: dict
    known: tuple = ()
    order: float | None = None  # Order of convergence, if not that of the case.
    longer: float = 1  # Factor on the steps of the case: high orders are visible where errors are above rounding.


@dataclasses.dataclass(frozen=True)
class Case:
    """A model at several steps."""

    name: str
    about: str  # Subject of the case, and formula and source of its known numbers.
    model: typing.Any
    step: float  # [s], the base step.
    span: float  # [s]
    variants: tuple | typing.Callable = (Variant("", {}),)  # Or a function that returns them, if that takes time.
    fractions: tuple = FRACTIONS
    spans: dict = dataclasses.field(default_factory=dict)  # Fraction to span, where it differs from the one above.
    order: float = 1  # Order of convergence: 1 with impacts, whose time a step does not resolve.
    floor: float = 1e-4  # Differences below this part of a probe's range count as equal: 1e-3 of a shape is the gap's tolerance.
    compare: bool = True  # False where closed forms give all results and comparing phases of impacts is meaningless.
    skip: tuple = ()  # Probes, or "probe.kind", that are not compared; if smooth "probe.column", "probe.[unit]" or "[unit]".
    drift: float = 1e-9  # Bound of the error of the energy balance at every step, in which dissipation is included.
    until: float = math.inf  # [s], end of the comparison.
    because: str = ""  # Reason for a short span, other fractions or no comparison.
    smooth: bool = False  # No jumps: every column is compared, including forces and accelerations, at instants common to all runs.
    statics: bool = False  # Parts of a step are parts of the load. No order: the equilibrium does not depend on them.
    meshes: tuple = ()  # Settings of finer meshes, each with half the element size of the one before; the first one halves that of the model.
    mesh_order: float = 2  # Order of convergence of differences between meshes.
    mesh_floor: float = 1e-3
    mesh_skip: tuple = ()  # Probes, or "probe.kind", that are not compared between meshes, where element numbers are other positions.
    mesh_known: tuple = ()  # Known limits of refined meshes; the tolerance is a function of the element size, 1 for that of the model.
    open: str = ""  # Reason why it is not a test yet: the actual result. `tools/refine.py NAME` runs it nevertheless.


def falling(size, step, order, floor=0.0):
    """A tolerance that is `size` at a step and decreases with an order of the step."""
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
    """A column's value at a time, interpolated linearly between rows."""
    return lambda run: run.value(probe, column, time)


def rise(probe, column):
    """Largest rise of a column above its initial value."""

    def read(run):
        values = run.probe(probe)[column]
        return max(values) - values[0]

    return read


def fall(probe, column):
    """Largest fall of a column below its initial value."""

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
    """Angular velocity about y at the end of a body that rotates about y only, from probes at its centre and at x = 1."""

    def read(run):
        a, b = run.probe(centre), run.probe(tip)
        ex, ez = b["x"][-1] - a["x"][-1], b["z"][-1] - a["z"][-1]
        vx, vz = b["vx"][-1] - a["vx"][-1], b["vz"][-1] - a["vz"][-1]
        return (ez * vx - ex * vz) / (ex * ex + ez * ez)

    return read


def turn_y(centre, tip):
    """Angles about y at all rows relative to the start, whole turns counted; between rows less than half a turn."""

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
