# SPDX-License-Identifier: Apache-2.0
"""The compared mechanisms: published definitions and a chain of hinges."""

from __future__ import annotations

import math

from mechanism import (
    GROUND,
    ZERO,
    Body,
    Joint,
    Mechanism,
    Moment,
    Observed,
    Spring,
    Vector,
    X,
    Y,
    Z,
    add,
    cross,
    scaled,
    times,
    transposed,
    turned,
    unit,
)

G_PLANAR: Vector = (0.0, -9.81, 0.0)
G: Vector = (0.0, 0.0, -9.81)
IFTOMM = "IFToMM TC Multibody Dynamics, Library of Computational Benchmark Problems"


def pendulum() -> Mechanism:
    """A point mass of 1 kg at 1 m, released level; a hinge in place of the rod, and an inertia without effect."""
    mass = Body("P1", 1.0, (1e-13, 1e-13, 1e-13), (-1.0, 0.0, 0.0))
    return Mechanism(
        "pendulum",
        "Planar pendulum (IFToMM A01), 10 s",
        "position of the mass [m]",
        f"{IFTOMM}, A01",
        G_PLANAR,
        10.0,
        (mass,),
        (Joint("O", "revolute", GROUND, "P1", ZERO, (Z,)),),
        (Observed("P1", mass.position, (0, 1)),),
        planar=True,
    )


def n_four_bar(cells: int) -> Mechanism:
    """N squares in a row that pass positions in which all bars lie on one line."""
    spin: Vector = (0.0, 0.0, -1.0)
    slide = cross(spin, Y)
    upright, level = (1.0 / 12.0, 1e-4, 1.0 / 12.0), (1e-4, 1.0 / 12.0, 1.0 / 12.0)
    bodies, joints = [], []
    for i in range(cells + 1):
        foot: Vector = (float(i), 0.0, 0.0)
        bodies.append(Body(f"upright_{i}", 1.0, upright, add(foot, scaled(0.5, Y)), scaled(0.5, slide), spin))
        joints.append(Joint(f"foot_{i}", "revolute", GROUND, f"upright_{i}", foot, (Z,)))
    for i in range(cells):
        end: Vector = (float(i), 1.0, 0.0)
        bodies.append(Body(f"bar_{i}", 1.0, level, add(end, scaled(0.5, X)), slide))
        joints.append(Joint(f"left_{i}", "revolute", f"upright_{i}", f"bar_{i}", end, (Z,)))
        joints.append(Joint(f"right_{i}", "revolute", f"bar_{i}", f"upright_{i + 1}", add(end, X), (Z,), closes=True))
    return Mechanism(
        f"n_four_bar_{cells}",
        f"N-four-bar (IFToMM A02), N = {cells}, 10 s",
        "position of B0 [m]",
        f"{IFTOMM}, A02",
        G_PLANAR,
        10.0,
        tuple(bodies),
        tuple(joints),
        (Observed("upright_0", Y, (0, 1)),),
        planar=True,
    )


def andrews_squeezer() -> Mechanism:
    """Seven plates, driven by a motor, with a spring; without gravity."""
    beta, theta, gamma = -0.06171389001427645, 0.0, 0.45527981916307037
    phi, delta = 0.22266839016588588, 0.48736497954384256
    omega, epsilon = -0.22266839016588588, 1.2305474445498212
    o: Vector = ZERO
    a: Vector = (-0.06934, -0.00227, 0.0)
    b: Vector = (-0.03635, 0.03273, 0.0)
    c: Vector = (0.014, 0.072, 0.0)

    def on(origin: Vector, angle: float, x: float, y: float) -> Vector:
        return add(origin, times(turned(Z, angle), (x, y, 0.0)))

    f, g, h = on(o, beta, 0.007, 0.0), on(a, delta, 0.04, 0.0), on(a, epsilon, 0.0, -0.04)
    e, d = on(b, gamma, 0.0, -0.035), on(b, gamma, 0.02, -0.018)
    plates = {  # mass, moment of inertia, origin, angle, centre of mass from the origin
        "K1": (0.04325, 2.194e-6, o, beta, 0.00092, 0.0),
        "K2": (0.00365, 4.410e-7, f, beta + theta, -0.0115, 0.0),
        "K3": (0.02373, 5.255e-6, b, gamma, 0.01043, -0.01874),
        "K5": (0.07050, 1.169e-5, a, delta, 0.02308, 0.00916),
        "K4": (0.00706, 5.667e-7, g, phi + delta, 0.0, -0.00579),
        "K7": (0.05498, 1.912e-5, a, epsilon, -0.00449, -0.01228),
        "K6": (0.00706, 5.667e-7, h, omega + epsilon, 0.00579, 0.0),
    }
    bodies = tuple(
        Body(name, mass, (j, j, j), on(origin, angle, x, y), axes=turned(Z, angle))
        for name, (mass, j, origin, angle, x, y) in plates.items()
    )
    joints = tuple(
        Joint(name, "revolute", parent, child, at, (Z,), closes=name[0] == "E")
        for name, parent, child, at in (
            ("O", GROUND, "K1", o),
            ("F", "K1", "K2", f),
            ("B", GROUND, "K3", b),
            ("A5", GROUND, "K5", a),
            ("G", "K5", "K4", g),
            ("A7", GROUND, "K7", a),
            ("H", "K7", "K6", h),
            ("E2", "K3", "K2", e),
            ("E4", "K3", "K4", e),
            ("E6", "K3", "K6", e),
        )
    )
    angles = tuple(
        Observed(joint=joint, offset=start)
        for joint, start in (
            ("O", beta),
            ("F", theta),
            ("B", gamma),
            ("G", phi),
            ("A5", delta),
            ("H", omega),
            ("A7", epsilon),
        )
    )
    return Mechanism(
        "andrews_squeezer",
        "Andrews' squeezer (IFToMM A03), 30 ms",
        "seven angles [rad]",
        "W. Schiehlen (ed.), Multibody Systems Handbook, Springer 1990; IVP Test Set, problem andrews",
        ZERO,
        0.03,
        bodies,
        joints,
        angles,
        (Spring("spring", (GROUND, "K3"), (c, d), 4530.0, 0.0, 0.07785),),
        (Moment("motor", "K1", (0.0, 0.0, 0.033)),),
        planar=True,
    )


def flyball_governor() -> Mechanism:
    """A shaft with two rods whose stiff dampers carry a slider: rates of 2.7e4 per second."""
    turn: Vector = (0.0, 0.0, 2.0 * math.pi)
    tilt, length, hinge, rod, ball = math.radians(30.0), 1.0, 0.05, 0.3, 5.0
    mass = rod + ball
    centre = (rod * length / 2.0 + ball * length) / mass
    across = 0.0250025 + rod * (centre - length / 2.0) ** 2 + ball * (length - centre) ** 2

    def along(side: float, distance: float) -> Vector:
        return (side * (hinge + distance * math.cos(tilt)), 0.0, 1.0 - distance * math.sin(tilt))

    bodies = [
        Body("shaft", 0.3, (0.0250025, 0.0250025, 5e-6), (0.0, 0.0, 0.5), ZERO, turn),
        Body("slider", 3.0, (0.005, 0.005, 0.005), (0.0, 0.0, 0.5), ZERO, turn),
    ]
    joints = [
        Joint("bearing", "revolute", GROUND, "shaft", ZERO, (Z,)),
        Joint("guide", "prismatic", "shaft", "slider", (0.0, 0.0, 0.5), (Z,)),
    ]
    springs = []
    for name, side in (("a", 1.0), ("b", -1.0)):
        at = along(side, centre)
        axes = turned(Y, tilt if side > 0.0 else math.pi - tilt)
        bodies.append(Body(f"rod_{name}", mass, (5e-6, across, across), at, cross(turn, at), turn, axes))
        joints.append(Joint(f"hinge_{name}", "revolute", "shaft", f"rod_{name}", (side * hinge, 0.0, 1.0), (Y,)))
        springs.append(
            Spring(
                f"spring_{name}",
                ("slider", f"rod_{name}"),
                ((side * hinge, 0.0, 0.5), along(side, length / 2.0)),
                8e5,
                4e4,
                0.5,
            )
        )
    return Mechanism(
        "flyball_governor",
        "Stiff flyball governor (IFToMM A05), 10 s",
        "height of the slider [m]",
        f"{IFTOMM}, A05",
        G,
        10.0,
        tuple(bodies),
        tuple(joints),
        (Observed("slider", (0.0, 0.0, 0.5), (2,)),),
        tuple(springs),
    )


def heavy_top() -> Mechanism:
    spin: Vector = (0.0, 150.0, -4.61538)
    top = Body("top", 15.0, (0.234375, 0.46875, 0.234375), Y, cross(spin, Y), spin)
    return Mechanism(
        "heavy_top",
        "Heavy top, 2 s",
        "centre of mass [m]",
        "O. Bruls, A. Cardona, J. Comput. Nonlinear Dyn. 5 (2010) 031002",
        G,
        2.0,
        (top,),
        (Joint("tip", "spherical", GROUND, "top", ZERO, (Y,)),),
        (Observed("top", Y, (0, 1, 2)),),
    )


def chain(links: int) -> Mechanism:
    """Rods of 0.1 m and 1 kg in a line, held at one end, with hinges about two axes in turn."""
    rod, bodies, joints = 0.1, [], []
    across = rod * rod / 12.0 + 1e-3
    for i in range(links):
        bodies.append(Body(f"b{i}", 1.0, (1e-3, across, across), (rod * (i + 0.5), 0.0, 0.0)))
        axis = Y if i % 2 == 1 else unit((0.2, 1.0, 0.3))
        joints.append(Joint(f"j{i}", "revolute", f"b{i - 1}" if i else GROUND, f"b{i}", (rod * i, 0.0, 0.0), (axis,)))
    return Mechanism(
        f"chain_{links}",
        f"Chain of {links} hinges, 1 s",
        "end of the first body [m]",
        "`polhode examples chain`",
        G,
        1.0,
        tuple(bodies),
        tuple(joints),
        (Observed("b0", (rod, 0.0, 0.0), (0, 1, 2)),),
    )


def spatial_slider_crank() -> Mechanism:
    b: Vector = (0.0, 0.1, 0.2)
    c: Vector = (0.2, 0.0, 0.0)
    along, pin = unit((0.2, -0.1, -0.2)), unit((0.0, 2.0, -1.0))
    axes = transposed((along, pin, cross(along, pin)))
    bodies = (
        Body("crank", 0.12, (1e-4, 1e-4, 1e-5), (0.0, 0.1, 0.16), (0.0, -0.24, 0.0), (6.0, 0.0, 0.0)),
        Body("slider", 2.0, (1e-4, 1e-4, 1e-4), c, (0.24, 0.0, 0.0)),
        Body("rod", 0.5, (4e-4, 4e-3, 4e-3), scaled(0.5, add(b, c)), (0.12, -0.24, 0.0), (1.92, -0.96, 0.48), axes),
    )
    joints = (
        Joint("A", "revolute", GROUND, "crank", (0.0, 0.1, 0.12), (X,)),
        Joint("guide", "prismatic", GROUND, "slider", c, (X,)),
        Joint("C", "universal", "slider", "rod", c, (X, pin)),
        Joint("B", "spherical", "crank", "rod", b, closes=True),
    )
    return Mechanism(
        "spatial_slider_crank",
        "Spatial slider-crank, 5 s",
        "position of the slider [m]",
        "E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, Allyn & Bacon 1989",
        G,
        5.0,
        bodies,
        joints,
        (Observed("slider", c, (0,)),),
    )


def all_cases() -> dict[str, Mechanism]:
    made = (
        pendulum(),
        n_four_bar(40),
        andrews_squeezer(),
        flyball_governor(),
        heavy_top(),
        chain(10),
        spatial_slider_crank(),
    )
    return {case.name: case for case in made}
