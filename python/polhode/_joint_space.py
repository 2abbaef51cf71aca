# SPDX-License-Identifier: Apache-2.0
"""Joint coordinates of a simulation: positions, rates, forces, matrices and kinematics as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _native
from ._errors import NotReached


class Pose(NamedTuple):
    """Position and orientation of a body."""

    position: Any  #: (3,) of the centre of mass, world axes [m]; (T, 3) of T positions.
    orientation: Any  #: (4,) quaternion (w, x, y, z) body to world; (T, 4).


def _array(values: Any) -> Any:
    return np.ascontiguousarray(values, dtype=np.float64)


def _optional(values: Any) -> Any:
    return None if values is None else _array(values)


class JointSpace:
    """What a simulation has in joint coordinates; n is their number.

    Coordinates are those that joints report, [rad] or [m], then x, y, z, rx, ry, rz of free bodies. Where joints close
    loops they are independent ones, which determine the others. Rates are their derivatives, of three free rotations
    (a ball joint, a free body) the angular velocity in the axes of the joint's first body (the world's). The equations
    of motion are M(q) qdd + c(q, qd) + g(q) = tau, with the forces and moments of all loads in tau. Everything here
    raises ModelError for a model without such coordinates: one with solids, beams or rolling wheels. Where events
    switch joints, coordinates are those of the joints that act at the present time.
    """

    _engine: Any
    _driven: "Optional[list[str]]"
    _bodies: "Optional[list[str]]" = None

    @property
    def coordinates(self) -> "list[str]":
        """Names of the n coordinates, in the order of joints: "elbow", "wrist.rx", "hull.z"."""
        return [c[0] for c in self._engine.coordinates]

    @property
    def coordinate_limits(self) -> Any:
        """Stops of the joints, lower and upper (n, 2) [rad, m]; infinite without."""
        return np.array([c[5:7] for c in self._engine.coordinates], dtype=float).reshape(-1, 2)

    @property
    def q(self) -> Any:
        """Coordinates (n,) [rad, m], turns counted. Set them to place all bodies at the present time, joints closed,
        with unchanged rates: this resets the ledger. Raises ModelError where a loop cannot be closed, where shapes
        overlap, and beyond stops."""
        return self._engine.q

    @q.setter
    def q(self, values: Any) -> None:
        self._engine.set_coordinates(_array(values), None)

    @property
    def qd(self) -> Any:
        """Rates of the coordinates (n,) [rad/s, m/s], to read and to set as q."""
        return self._engine.qd

    @qd.setter
    def qd(self, values: Any) -> None:
        self._engine.set_coordinates(None, _array(values))

    @property
    def qdd(self) -> Any:
        """Second derivatives (n,) [rad/s², m/s²] at the present state, by all loads, with friction and contact."""
        return self._engine.qdd

    @property
    def driven(self) -> "list[str]":
        """Names of the coordinates that tau acts along, in its order; none without tau."""
        return list(self._driven or [])

    @property
    def tau(self) -> Any:
        """Moments and forces along the driven coordinates, as an array [N m, N]: copies are read and set.

        They act from the next step on, constant until they are set again, as loads named "tau.elbow". Only a
        simulation made with Simulation(model, tau=True), or a list of coordinates, has them; others raise
        AttributeError.
        """
        self._require_tau()
        return self._engine.held()

    @tau.setter
    def tau(self, values: Any) -> None:
        self._require_tau()
        self._engine.hold(_array(values))

    def _require_tau(self) -> None:
        if self._driven is None:
            raise AttributeError("tau is not part of this simulation. Make it with Simulation(model, tau=True), "
                                 "or with a list of coordinates: tau=[\"elbow\"]")

    def reset(self, q: Any = None, qd: Any = None) -> None:
        """Returns to the start of the model at time 0, with tau zero; then sets coordinates and rates, if given."""
        self._engine.reset()
        if q is not None or qd is not None:
            self._engine.set_coordinates(_optional(q), _optional(qd))

    def mass_matrix(self, q: Any = None) -> Any:
        """M (n, n) [kg m², kg m, kg], at coordinates q or at the present ones. The simulation stays as it is, here and
        in all functions below."""
        return self._engine.mass_matrix(_optional(q))

    def gravity_moments(self, q: Any = None) -> Any:
        """g (n,) [N m, N]: moments and forces along the coordinates that hold the bodies at rest against gravity. q may
        be (T, n), and so is g then."""
        if np.ndim(q) == 2:
            rest = np.zeros(len(self.coordinates))
            return self.inverse_dynamics(rest, q, rest)
        return self._engine.gravity_forces(_optional(q))

    def coriolis(self, q: Any = None, qd: Any = None) -> Any:
        """c (n,) [N m, N]: those that keep the rates constant, without gravity. q and qd: the present ones unless
        given, or (T, n), and so is c then."""
        if np.ndim(q) == 2 or np.ndim(qd) == 2:
            steady = self.inverse_dynamics(np.zeros(len(self.coordinates)), q, qd)
            return steady - self.gravity_moments(q)
        return self._engine.velocity_forces(_optional(q), _optional(qd))

    def inverse_dynamics(self, qdd: Any, q: Any = None, qd: Any = None) -> Any:
        """tau = M qdd + c + g (n,) of given second derivatives [N m, N]: those of all loads together.

        Arrays may be (T, n), one row for each time; T at once cost less than one by one. q and qd are the present ones
        unless given. Raises ValueError for arrays of other shapes.
        """
        return self._engine.inverse_dynamics(_array(qdd), _optional(q), _optional(qd))

    def jacobian(self, body: str, point: Any = (0.0, 0.0, 0.0), q: Any = None) -> Any:
        """J (6, n): velocity of a point of a body (rows 0 to 2, [m/s]) and its angular velocity (3 to 5, [rad/s]) by
        the rates, world axes. point: in the coordinates of the body, as in the model [m]."""
        return self._engine.jacobian(self._body(body), [float(x) for x in point], _optional(q))

    def forward_kinematics(self, q: Any) -> "dict[str, Pose]":
        """Position and orientation of all bodies at coordinates q (n,), or (T, n); by name."""
        rows = _array(q)
        positions, orientations = self._engine.forward_kinematics(rows)
        if rows.ndim < 2:
            positions, orientations = positions[0], orientations[0]
        return {name: Pose(positions[..., i, :], orientations[..., i, :]) for i, name in enumerate(self._engine.bodies)}

    def solve(
        self,
        body: str,
        position: Any = None,
        orientation: Any = None,
        *,
        point: Any = (0.0, 0.0, 0.0),
        q: Any = None,
    ) -> Any:
        """Coordinates (n,) that bring a body to a position, an orientation, or both (inverse kinematics).

        position: (3,) of the point, world [m]; point: in the coordinates of the body, its origin unless given.
        orientation: (4,) quaternion (w, x, y, z) body to world. q: coordinates to begin from, unless the present ones.
        Of several solutions it is one near these. Stops of joints are kept, shapes may overlap. Raises NotReached with
        the distance that remains if none is found.
        """
        if position is None and orientation is None:
            raise ValueError("Give a position, an orientation, or both.")
        found, distance, angle, reached = self._engine.reach(
            self._body(body), [float(x) for x in point],
            None if position is None else [float(x) for x in position],
            None if orientation is None else [float(x) for x in orientation], _optional(q))
        if not reached:
            away = [f"{distance:.4g} m"] * (position is not None) + [f"{angle:.4g} rad"] * (orientation is not None)
            raise NotReached(f"'{body}' cannot be brought there: {' and '.join(away)} remain. "
                             "Give a target within reach, or coordinates q to begin from", found, distance, angle)
        return found

    def _body(self, name: str) -> int:
        if self._bodies is None:
            self._bodies = list(self._engine.bodies)
        if name not in self._bodies:
            near = _native.closest(str(name), self._bodies)
            raise KeyError(f"unknown body '{name}'." + (f" Did you mean '{near}'?" if near else ""))
        return self._bodies.index(name)


def drive(compiled: Any, tau: "Union[bool, Sequence[str], None]") -> "Optional[list[str]]":
    """Adds the loads of tau to a compiled model. Returns names of coordinates, None without."""
    if tau is None or tau is False:
        return None
    if isinstance(tau, str):
        raise TypeError(f"tau is a list of coordinates: tau=[{tau!r}]")
    names: "list[str]" = _native.add_held_loads(compiled, None if tau is True else [str(name) for name in tau])
    return names
