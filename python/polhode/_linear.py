# SPDX-License-Identifier: Apache-2.0
"""Linearisation about a state, and inverse dynamics."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Callable, NamedTuple, Union

import numpy as np

from . import _native, rotations
from ._model import Model, Overrides, load
from ._simulation import Simulation

#: Step of the differences in coordinates of the tangent and in time along the motion, scaled [-]: truncation is its
#: sixth power over 140, rounding 1e-16 over it.
_CHANGE, _ALONG = 5e-3, 1e-2
#: Difference from whole numbers that is rounding of these differences [-].
_ROUNDING = 1e-8
#: Points and weights of the first derivative, exact for polynomials of degree 6.
_FIRST = ((1, 3 / 4), (-1, -3 / 4), (2, -3 / 20), (-2, 3 / 20), (3, 1 / 60), (-3, -1 / 60))


class StateSpace(NamedTuple):
    """Linear system x' = A x + B u, y = C x + D u for small deviations from a state.

    states: names of x, (2 f,): f joint coordinates [m or rad] or positions [m], then their rates.
    inputs, outputs: names of u and y, one for each component.

    control.ss(s.A, s.B, s.C, s.D) and scipy.signal.StateSpace accept these matrices.
    """

    A: Any
    B: Any
    C: Any
    D: Any
    states: "list[str]"
    inputs: "list[str]"
    outputs: "list[str]"


def _known(name: str, names: "list[str]", what: str) -> int:
    if name not in names:
        near = _native.closest(name, names)
        raise KeyError(f"unknown {what} '{name}'." + (f" Did you mean '{near}'?" if near else ""))
    return names.index(name)


def _quantity(engine: Any, name: str) -> "tuple[Callable[[Any], Any], list[str]]":
    """Function that reads an output from an engine, and the names of its components."""
    parts = name.split(".")
    if len(parts) < 3 or parts[0] not in ("bodies", "joints"):
        raise KeyError(f"'{name}' is not an output. Write joints.A.coordinates, joints.A.force or bodies.b.velocity.")
    is_body = parts[0] == "bodies"
    component = parts.pop() if len(parts) > 3 else None
    index = _known(".".join(parts[1:-1]), engine.bodies if is_body else engine.joints, parts[0][:-1].replace("ie", "y"))
    key = parts[-1]

    def all_of(e: Any) -> Any:
        return np.atleast_1d(np.asarray((e.body(index) if is_body else e.joint(index))[key], dtype=float))

    found = engine.body(index) if is_body else engine.joint(index)
    if key not in found:
        raise KeyError(f"'{name}': there is no '{key}'; there are {', '.join(found)}")
    size = all_of(engine).size
    letters = list({3: "xyz", 4: "wxyz"}.get(size, "0123456789")[:size])
    letters = [str(i) for i in range(size)] if key in ("coordinates", "rates") else letters
    stem = ".".join(parts)
    if component is None:
        return all_of, [f"{stem}.{c}" for c in letters]
    k = _known(component, letters, "component")
    return lambda e: all_of(e)[k : k + 1], [name]


def _quaternion_product(p: Any, q: Any) -> Any:
    w, v = p[0], np.asarray(p[1:])
    return np.concatenate([[w * q[0] - v @ q[1:]], w * q[1:] + q[0] * v + np.cross(v, q[1:])])


class _Chart:
    """Small displacements from the state of an engine."""

    def __init__(self, engine: Any) -> None:
        self.engine = engine
        self.moving = [i for i, fixed in enumerate(engine.fixed) if not fixed]
        self.now = [engine.body(i) for i in self.moving]

    def put(self, displacements: Any, velocities: Any, turned: bool = True) -> Any:
        """An engine of the same model with changed positions and velocities of all bodies: both (6 n,), world axes.
        turned: angular velocities turn with their bodies before they change."""
        engine = self.engine.copy()
        d, v = displacements.reshape(-1, 6), velocities.reshape(-1, 6)
        turns = rotations.quaternion_from_rotation_vector(d[:, 3:])
        spins = rotations.matrix_from_rotation_vector(d[:, 3:] if turned else np.zeros_like(d[:, 3:]))
        engine.set_bodies([
            (i, (m["position"] + d[k, :3]).tolist(), _quaternion_product(turns[k], m["orientation"]).tolist(),
             (m["velocity"] + v[k, :3]).tolist(), (spins[k] @ m["angular_velocity"] + v[k, 3:]).tolist())
            for k, (i, m) in enumerate(zip(self.moving, self.now))
        ])
        return engine

    def free_directions(self) -> Any:
        """Displacements of all moving bodies that the joints allow, orthonormal columns (6 n, f)."""
        M, _, _, G = (np.asarray(a) for a in _native.matrices(self.engine))
        if len(M) != 6 * len(self.moving):
            raise ValueError("a model with solids cannot be linearised here; use polhode.matrices")
        kept = np.flatnonzero(np.diag(M) > 0)  # a point mass has no rotation
        free = np.eye(len(kept))
        if len(G):
            _, sizes, rows = np.linalg.svd(G[:, kept])
            free = rows[int(np.sum(sizes > 1e-9 * sizes.max())) :].T
        T = np.zeros((len(M), free.shape[1]))
        T[kept] = free
        return T


def _rates_of(engine: Any, read: "Callable[[Any], Any]") -> Any:
    """Derivatives of readings by time: differences along the motion of constant acceleration."""
    chart = _Chart(engine)
    v = np.concatenate([[*m["velocity"], *m["angular_velocity"]] for m in chart.now])
    a = np.concatenate([[*m["acceleration"], *m["angular_acceleration"]] for m in chart.now])
    h = _ALONG / max(1.0, np.abs(v).max(initial=0.0), np.sqrt(np.abs(a).max(initial=0.0)))
    total = 0.0
    for at, weight in _FIRST:
        s = at * h
        total = total + weight / h * read(chart.put(s * v + 0.5 * s * s * a, s * a, turned=False))
    return total


def _joined(readers: "Sequence[Callable[[Any], Any]]") -> "Callable[[Any], Any]":
    def read(engine: Any) -> Any:
        return np.concatenate([np.zeros(0), *[r(engine) for r in readers]])

    return read


def _choose(slopes: Any, preferred: int, f: int) -> "list[int]":
    """Indices of the most independent rows of slopes (k, f), those of the first `preferred` rows before the rest."""
    left = slopes.copy()
    chosen: "list[int]" = []
    for rows in (range(preferred), range(preferred, len(slopes))):
        while rows and len(chosen) < f:
            sizes = np.linalg.norm(left[list(rows)], axis=1)
            best = rows[int(np.argmax(sizes))]
            if sizes.max() < 1e-5 * max(1e-300, np.abs(slopes).max()):
                break
            chosen.append(best)
            direction = left[best] / np.linalg.norm(left[best])
            left = left - np.outer(left @ direction, direction)
    return sorted(chosen)


def _input(engine: Any, name: str) -> "tuple[str, int]":
    """Load and component of "loads.push.force.x", "push.x" or "motor"."""
    parts = name.split(".")
    parts = parts[1:] if parts[0] == "loads" else parts
    if ".".join(parts) in engine.loads:
        return ".".join(parts), -1
    letter = "xyz".find(parts[-1]) if len(parts) > 1 else -1
    _known(parts[0], engine.loads, "load")
    return parts[0], letter


def linearize(
    simulation: "Union[Simulation, Model, str, os.PathLike[str]]",
    inputs: "Sequence[str]" = (),
    outputs: "Sequence[str]" = (),
    *,
    overrides: Overrides = None,
) -> StateSpace:
    """Linearises the motion about the present state of a simulation, or the start of a model.

    inputs:  components of forces and moments, and drives of motors that are forces or moments:
             "push.x", "loads.motor". Their values at the state are u = 0.
    outputs: "joints.A.coordinates", "joints.A.force.z", "bodies.cart.velocity".

    The state may be in motion; cyclic coordinates, such as the angle of a rotor, may then change.
    States are coordinates of joints as far as they determine the configuration, then positions of bodies.
    Loads are evaluated at the time of the state. Derivatives are differences of sixth order of the accelerations, which
    are solved for to round-off: their errors are 1e-11 of the largest entry, or less. Returns a StateSpace. Raises
    KeyError for unknown names, ValueError if coordinates and positions do not determine the configuration, as for a
    free body that rotates, for solids, or where a contact or stop with the law rigid is closed, ModelError for a
    faulty model or an unknown input.
    """
    if not isinstance(simulation, Simulation):
        simulation = Simulation(simulation, overrides)
    engine = simulation._engine
    if touching := _native.touching(engine.copy()):
        raise ValueError(
            f"{touching[0]} is closed here, and the motion is not linear about it. Linearise where nothing touches, "
            "or use polhode.modes, in which contacts and stops with a force hold like joints"
        )
    chart = _Chart(engine)
    T = chart.free_directions()
    f = T.shape[1]
    still = np.zeros(len(T))

    names: "list[str]" = []
    speeds: "list[str]" = []
    for joint in engine.joints:
        count = len(engine.joint(engine.joints.index(joint))["coordinates"])
        names += [f"joints.{joint}.coordinates.{k}" for k in range(count)]
        speeds += [f"joints.{joint}.rates.{k}" for k in range(count)]
    of_joints = len(names)
    for i in chart.moving:
        names += [f"bodies.{engine.bodies[i]}.position.{c}" for c in "xyz"]
        speeds += [f"bodies.{engine.bodies[i]}.velocity.{c}" for c in "xyz"]

    def slope(read: "Callable[[Any], Any]", displaced: Any, faster: Any) -> Any:
        return sum(w / _CHANGE * read(chart.put(s * _CHANGE * displaced, s * _CHANGE * faster)) for s, w in _FIRST)

    where = _joined([_quantity(engine, name)[0] for name in names])
    slopes = np.array([slope(where, T[:, k], still) for k in range(f)]).T.reshape(len(names), f)
    chosen = _choose(slopes, of_joints, f)
    if len(chosen) < f:
        raise ValueError(
            f"{f - len(chosen)} of {f} degrees of freedom are neither coordinates of joints nor positions of bodies, "
            "as the rotation of a free body. Connect free bodies by joints with these coordinates"
        )
    position = _joined([_quantity(engine, names[k])[0] for k in chosen])
    speed = _joined([_quantity(engine, speeds[k])[0] for k in chosen])
    found = [_quantity(engine, name) for name in outputs]
    seen = _joined([read for read, _ in found])
    state = _joined([position, speed])

    def everything(e: Any) -> Any:
        return np.concatenate([position(e), speed(e), _rates_of(e, state), seen(e)])

    columns = [slope(everything, T[:, k], still) for k in range(f)]
    columns += [slope(everything, still, T[:, k]) for k in range(f)]
    J = np.array(columns).T
    effects = []
    for name in inputs:
        load_name, component = _input(engine, name)
        ends = []
        for sign in (1.0, -1.0):
            changed = simulation._compiled.copy()
            changed.add_offset(load_name, component, sign)
            other = _native.Engine(changed)
            other.restore(simulation.state)
            ends.append(everything(other))
        effects.append(0.5 * (ends[0] - ends[1]))
    U = np.array(effects).T.reshape(len(J), len(inputs))
    to_states = np.linalg.inv(J[: 2 * f])
    A, B = np.zeros((2 * f, 2 * f)), np.zeros((2 * f, len(inputs)))
    A[f:] = J[3 * f : 4 * f] @ to_states
    B[f:] = U[3 * f : 4 * f]
    # Rates are derivatives of coordinates but for those of rotation vectors, which are angular velocities.
    A[:f, f:] = np.eye(f)
    along = J[2 * f : 3 * f] @ to_states
    if np.abs(along - A[:f]).max(initial=0.0) > _ROUNDING * max(1.0, np.abs(along).max(initial=0.0)):
        A[:f] = along
    states = [names[k] for k in chosen] + [speeds[k] for k in chosen]
    return StateSpace(A, B, J[4 * f :] @ to_states, U[4 * f :], states, list(inputs),
                      [n for _, components in found for n in components])


def inverse_dynamics(
    model: "Union[Model, str, os.PathLike[str]]",
    time: Any,
    motion: "Mapping[str, Any]",
    *,
    overrides: Overrides = None,
) -> "dict[str, Any]":
    """Forces and moments that drive joints along a given motion (inverse dynamics).

    time:   (n,) from 0 on [s]; the model's own duration and output interval are not used.
    motion: by joint, (n,) angles [rad] of revolute joints, or displacements [m] of prismatic ones,
            interpolated by cubic splines: they should be smooth and begin with the position and
            velocity of the model.

    Returns by joint the moments [N m] or forces [N] on its second body (n, 3), world axes. Joints
    without a given motion are free. Raises ModelError if a joint cannot be driven, NotConverged if a
    step does not converge.
    """
    from scipy.interpolate import CubicSpline

    from ._run import whole_run

    whole = (model if isinstance(model, Model) else load(model)).copy()
    times = np.asarray(time, dtype=float)
    for joint, values in motion.items():
        slides = joint in whole.joints and whole.joints[joint].type == "prismatic"
        along = CubicSpline(times, np.asarray(values, dtype=float))
        drive = {"displacement" if slides else "angle": lambda t, along=along: float(along(t))}
        whole.add_load(f"drives-{joint}", "linear_motor" if slides else "rotary_motor", joint=joint, **drive)
    whole.analysis.duration = f"{float(times[-1])!r} s"
    whole.output.every = None
    found = whole_run(whole, overrides)
    result = {}
    for joint in motion:
        report = found.loads[f"drives-{joint}"]
        vector = report.force if "force" in dir(report) else report.moment
        result[joint] = CubicSpline(found.time, np.asarray(vector))(times)
    return result
