# SPDX-License-Identifier: Apache-2.0
"""Flat triangles and round tubes: bodies slide over a height field as over a plane, and roll in and on a tube on their radii."""
import math

from case import FLOOR, Case, Known, Variant, body, largest, last, model, turn_y

G = 9.81
CLOSED = "Closed forms give all results."


def slides_over_triangles():
    """Sliding without friction at 5 m/s: the speed is constant across all edges."""
    cell, columns, rows, v = 0.02, 100, 80, 5.0
    bodies = {"field": {"fixed": True, "shape": {"height_field": {"spacing": cell, "heights": [[0.0] * columns] * rows}}}}
    shapes = {"ball": {"sphere": 0.2}, "crate": {"box": [0.3, 0.2, 0.2]}, "rod": {"capsule": [0.2, 0.4]}}
    for i, (name, shape) in enumerate(shapes.items()):
        bodies[name] = {"shape": shape, "density": 300, "position": [-0.613, 0.5 * (i - 1), 0.1], "velocity": [v * math.cos(0.03), v * math.sin(0.03), 0]}
        if name == "rod":
            bodies[name]["orientation"] = {"axis": "x", "angle": "90 deg"}
    known = []
    for name in shapes:
        known += [Known(f"{name}: vx", last(name, "vx"), v * math.cos(0.03), 1e-6), Known(f"{name}: vy", last(name, "vy"), v * math.sin(0.03), 1e-6),
                  Known(f"{name}: largest vz", largest(name, "vz", after=0.1), 0, 1e-3), Known(f"{name}: height [m]", last(name, "z"), 0.1, 1e-5),
                  Known(f"{name}: tilts [m]", lambda run, n=name: run.probe(n + "_x")["z"][-1] - run.probe(n)["z"][-1], 0, 1e-6)]
    probes = {}
    for name in shapes:
        probes.update(body(name))
    return Case("slides_over_triangles", "Ball, crate and rod keep 5 m/s over cells of 20 mm.",
                model("Slides over triangles", bodies, contacts={"default": {"friction": 0}}, probes=probes),
                5e-3, 0.2, (Variant("", {}, tuple(known)),), (1, 0.5, 0.2, 0.02), compare=False, because=CLOSED)


def rolls_in_a_tube():
    """A ball that oscillates about the bottom with ω² = g/((1 + 2/5)(R - ρ)), on its own radius."""
    inner, r, start = 0.5, 0.1, 0.1
    lies = {"axis": "x", "angle": "90 deg"}
    bodies = {"tube": {"fixed": True, "shape": {"tube": [1.2, 2 * inner, 1]}, "orientation": lies},
              "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [(inner - r) * math.sin(start), 0, -(inner - r) * math.cos(start)]}}
    period = 2 * math.pi * math.sqrt(1.4 * (inner - r) / G) * (1 + start**2 / 16)

    def crossing(run):
        table = run.probe("ball")
        rows = list(zip(table["t"], table["x"]))
        found = [t0 + (t1 - t0) * x0 / (x0 - x1) for (t0, x0), (t1, x1) in zip(rows, rows[1:]) if x0 * x1 < 0]
        return found[2] - found[0]

    known = (Known("period [s]", crossing, period, 1e-4 * period),
             Known("largest miss of its circle, of its radius", lambda run: max(abs(math.hypot(x, z) - (inner - r)) / r for x, z in zip(run.probe("ball")["x"], run.probe("ball")["z"])), 0, 1e-4))
    return Case("rolls_in_a_tube", "A ball in a tube swings as in a round one.",
                model("Rolls in a tube", bodies, contacts={"default": {"friction": 0.5}}, probes=body("ball")),
                5e-3, 2.2, (Variant("", {}, known),), (1, 0.2, 0.05), compare=False, because=CLOSED)


def tube_rolls():
    """A tube that rolls on a plane on its own radius."""
    r, v = 0.3, 2.0
    bodies = {**FLOOR, "wheel": {"shape": {"tube": [2 * r, 0.4, 0.1]}, "density": 800, "position": [0, 0, r], "orientation": {"axis": "x", "angle": "90 deg"},
                                 "velocity": [v, 0, 0], "angular_velocity": [0, v / r, 0]}}
    known = (Known("speed", last("wheel", "vx"), v, 1e-4 * v),
             Known("way over angle, of the radius", lambda run: (run.probe("wheel")["x"][-1] - run.probe("wheel")["x"][0]) / turn_y("wheel", "wheel_x")(run)[-1] / r, 1,
                   # Cayley's rotation of a step turns by 2 atan(θ/2).
                   lambda h: 1e-4 + (v / r * h) ** 2 / 11))
    return Case("tube_rolls", "Rolls on its own radius, on the plane.", model("Tube rolls", bodies, contacts={"default": {"friction": 0.5}}, probes=body("wheel")),
                5e-3, 0.5, (Variant("", {}, known),), (1, 0.2, 0.02), compare=False, because=CLOSED)


CASES = [slides_over_triangles(), rolls_in_a_tube(), tube_rolls()]
