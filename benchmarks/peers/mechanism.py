# SPDX-License-Identifier: Apache-2.0
"""A mechanism as plain numbers, from which the model of every program is made.

All vectors are in SI units and in the axes of the world, at the start. Joint coordinates are zero at the start.
"""

from __future__ import annotations

import dataclasses
import math

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

ZERO: Vector = (0.0, 0.0, 0.0)
X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)
IDENTITY: Matrix = (X, Y, Z)
GROUND = "ground"


def add(a: Vector, b: Vector) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scaled(factor: float, a: Vector) -> Vector:
    return (factor * a[0], factor * a[1], factor * a[2])


def minus(a: Vector, b: Vector) -> Vector:
    return add(a, scaled(-1.0, b))


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a: Vector) -> Vector:
    return scaled(1.0 / math.sqrt(dot(a, a)), a)


def turned(axis: Vector, angle: float) -> Matrix:
    """Rotation matrix, by rows."""
    n, c, s = unit(axis), math.cos(angle), math.sin(angle)

    def column(e: Vector) -> Vector:
        return add(add(scaled(c, e), scaled(s, cross(n, e))), scaled((1.0 - c) * dot(n, e), n))

    return transposed((column(X), column(Y), column(Z)))


def transposed(m: Matrix) -> Matrix:
    return ((m[0][0], m[1][0], m[2][0]), (m[0][1], m[1][1], m[2][1]), (m[0][2], m[1][2], m[2][2]))


def times(m: Matrix, a: Vector) -> Vector:
    return (dot(m[0], a), dot(m[1], a), dot(m[2], a))


def frame_with_x(axis: Vector) -> Matrix:
    """A rotation matrix whose first column is an axis."""
    first = unit(axis)
    helper = min((X, Y, Z), key=lambda e: abs(dot(e, first)))
    second = unit(cross(first, helper))
    return transposed((first, second, cross(first, second)))


@dataclasses.dataclass(frozen=True)
class Body:
    name: str
    mass: float
    inertia: Vector  # principal moments about the centre of mass, in the axes of the body [kg m^2]
    position: Vector  # of the centre of mass
    velocity: Vector = ZERO  # of the centre of mass
    angular_velocity: Vector = ZERO
    axes: Matrix = IDENTITY  # its columns are the axes of the body

    def inertia_in_world(self) -> Matrix:
        rows = [
            [sum(self.axes[i][k] * self.inertia[k] * self.axes[j][k] for k in range(3)) for j in range(3)]
            for i in range(3)
        ]
        return (
            (rows[0][0], rows[0][1], rows[0][2]),
            (rows[1][0], rows[1][1], rows[1][2]),
            (rows[2][0], rows[2][1], rows[2][2]),
        )

    def velocity_of(self, point: Vector) -> Vector:
        return add(self.velocity, cross(self.angular_velocity, minus(point, self.position)))


@dataclasses.dataclass(frozen=True)
class Joint:
    """A joint at a point.

    `axes` are the axis of a revolute or prismatic joint, the two axes of a universal joint (the first fixed to the
    parent, the second to the child), and for a spherical joint the axis of the fast spin, which programs that describe
    it by angles must know. `closes` is true for joints that close loops; the others form a tree.
    """

    name: str
    kind: str
    parent: str
    child: str
    at: Vector
    axes: tuple[Vector, ...] = ()
    closes: bool = False


@dataclasses.dataclass(frozen=True)
class Spring:
    """Spring and damper in parallel between two points, with their forces along the line."""

    name: str
    bodies: tuple[str, str]
    at: tuple[Vector, Vector]
    stiffness: float
    damping: float
    free_length: float


@dataclasses.dataclass(frozen=True)
class Moment:
    """A constant moment in the axes of the world."""

    name: str
    body: str
    moment: Vector


@dataclasses.dataclass(frozen=True)
class Observed:
    """Compared at the end: components of a point of a body, or the coordinate of a joint plus an offset."""

    body: str = ""
    point: Vector = ZERO
    components: tuple[int, ...] = ()
    joint: str = ""
    offset: float = 0.0


@dataclasses.dataclass(frozen=True)
class Link:
    """A link of a tree of hinges and sliders alone; without a body inside a universal or spherical joint."""

    parent: int  # -1: the ground
    slides: bool
    axis: Vector
    at: Vector
    rate: float
    body: Body | None


@dataclasses.dataclass(frozen=True)
class Mechanism:
    name: str
    title: str
    compared: str
    source: str
    gravity: Vector
    duration: float
    bodies: tuple[Body, ...]  # parents before their children
    joints: tuple[Joint, ...]
    observed: tuple[Observed, ...]
    springs: tuple[Spring, ...] = ()
    moments: tuple[Moment, ...] = ()
    planar: bool = False  # in the plane of x and y

    def body(self, name: str) -> Body:
        return next(b for b in self.bodies if b.name == name)

    def joint_of(self, body: str) -> Joint:
        """The joint that carries a body in the tree."""
        return next(j for j in self.joints if j.child == body and not j.closes)

    def loops(self) -> tuple[Joint, ...]:
        return tuple(j for j in self.joints if j.closes)

    def dissipates(self) -> bool:
        return any(s.damping > 0.0 for s in self.springs)

    def origin(self, body: str) -> Vector:
        """The point of a body that its joint of the tree holds."""
        return ZERO if body == GROUND else self.joint_of(body).at

    def motion(self, body: str, point: Vector) -> tuple[Vector, Vector]:
        """Velocity of a point of a body, and the angular velocity of the body."""
        if body == GROUND:
            return ZERO, ZERO
        b = self.body(body)
        return b.velocity_of(point), b.angular_velocity

    def rates(self, joint: Joint) -> tuple[float, ...]:
        """Rates of the coordinates at the start; of a spherical joint the relative angular velocity."""
        (va, wa), (vb, wb) = self.motion(joint.parent, joint.at), self.motion(joint.child, joint.at)
        if joint.kind == "prismatic":
            return (dot(joint.axes[0], minus(vb, va)),)
        turning = minus(wb, wa)
        if joint.kind == "spherical":
            return turning
        if joint.kind == "revolute":
            return (dot(joint.axes[0], turning),)
        first, second = joint.axes  # at a right angle at the start
        return (dot(first, turning), dot(second, turning))

    def links(self) -> list[Link]:
        """The tree with universal and spherical joints as hinges in a row, the fast spin last."""
        links: list[Link] = []
        last = {GROUND: -1}
        for body in self.bodies:
            joint = self.joint_of(body.name)
            axes = joint.axes
            if joint.kind == "spherical":
                spin, second, third = transposed(frame_with_x(axes[0] if axes else X))
                axes = (second, third, spin)
            parent, turning = last[joint.parent], self.rates(joint)
            for k, axis in enumerate(axes):
                rate = dot(axis, (turning[0], turning[1], turning[2])) if joint.kind == "spherical" else turning[k]
                links.append(
                    Link(parent, joint.kind == "prismatic", axis, joint.at, rate, body if k == len(axes) - 1 else None)
                )
                parent = len(links) - 1
            last[body.name] = parent
        return links
