# SPDX-License-Identifier: Apache-2.0
"""Flat landings, wheels, corners, valleys and bowls of many faces: the motion does not depend on the features in contact."""
import math

from case import FLOOR, Case, Known, Variant, body, fall, last, model, rise, turn_y

G = 9.81
W = 2.0
ABSOLUTE = (1, 0.5, 0.1, 0.01, 0.001)  # 10, 5, 1, 0.1, 0.01 ms
SHORT = {1: 0.03, 0.5: 0.02, 0.1: 0.016, 0.01: 0.0139, 0.001: 0.0138}
CLOSED = "Closed forms give all results."


def flat_rebound():
    """A box, a cylinder and a body with two round feet that land flat: they rebound flat with e w, as their contact points have equal impulses by symmetry."""
    gap = W * 0.0137
    bodies = {**FLOOR, "box": {"shape": {"box": [0.3, 0.2, 0.2]}, "mass": 1, "position": [0, 0, 0.1 + gap], "velocity": [0, 0, -W]},
              "puck": {"shape": {"cylinder": [0.3, 0.1]}, "mass": 1, "position": [0, 2, 0.05 + gap], "velocity": [0, 0, -W]},
              "dumbbell": {"shape": [{"sphere": 0.1, "position": [-0.3, 0, 0]}, {"sphere": 0.1, "position": [0.3, 0, 0]}], "mass": 1, "inertia": [0.01, 0.1, 0.1],
                           "position": [0, 4, 0.05 + gap], "velocity": [0, 0, -W]},
              "table": {"fixed": True, "shape": {"box": [2, 2, 0.2]}, "position": [5, 0, -0.1]},
              "on_table": {"shape": {"box": [0.3, 0.2, 0.2]}, "mass": 1, "position": [5, 0, 0.1 + gap], "velocity": [0, 0, -W]}}
    names = ("box", "puck", "dumbbell", "on_table")
    variants = tuple(Variant(f"e {e}", {"e": e}, tuple(k for n in names for k in (
        Known(f"{n}: vz after", last(n, "vz"), e * W, 1e-4 * W),
        Known(f"{n}: tilts [m]", lambda run, n=n: abs(run.probe(n + "_x")["z"][-1] - run.probe(n)["z"][-1]), 0, 1e-6, below=True)))) for e in (0, 0.3, 0.7, 1))
    return Case("flat_rebound", "Bodies that land flat rebound flat with e w.",
                model("Flat rebound", bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts={"default": {"restitution": "e"}}, probes={k: p for n in names for k, p in body(n).items()}),
                1e-2, 0.03, variants, ABSOLUTE, spans=SHORT, compare=False, because=CLOSED)


def rolling_wheels():
    """A wheel, a capsule and a ball that roll at 2 m/s, each on its own radius to 1e-4 of it."""
    v, end = 2.0, 0.3
    shapes = {"wheel": ({"cylinder": [0.6, 0.1]}, 0.3), "roller": ({"capsule": [0.2, 0.8]}, 0.1), "ball": ({"sphere": 0.4}, 0.2)}
    bodies, known, probes = dict(FLOOR), [], {}
    for i, (name, (shape, r)) in enumerate(shapes.items()):
        bodies[name] = {"shape": shape, "density": 500, "position": [0, 2 * i, r], "velocity": [v, 0, 0], "angular_velocity": [0, v / r, 0]}
        if name != "ball":
            bodies[name]["orientation"] = {"axis": "x", "angle": "90 deg"}
        probes.update(body(name))
        known += [Known(f"{name}: speed", last(name, "vx"), v, 1e-4 * v),
                  Known(f"{name}: way over angle, of the radius", lambda run, n=name, r=r: run.probe(n)["x"][-1] / turn_y(n, n + "_x")(run)[-1] / r, 1, lambda h, r=r: 1e-4 + (v / r * h) ** 2 / 11)]
    return Case("rolling_wheels", "Roll on at 2 m/s, on their own radii.",
                model("Rolling wheels", bodies, contacts={"default": {"friction": 0.5}}, probes=probes),
                1e-2, end, (Variant("", {}, tuple(known)),), (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


def into_a_corner():
    """A smooth ball that hits the right-angled corner of two walls, at once and one after the other: each velocity is reversed with e."""
    r, gap = 0.1, 0.0137
    variants = []
    for name, vx, vz in (("at once", 1.0, 1.0), ("one after the other", 1.0, 0.9)):
        for e in (0, 0.5, 1):
            known = (Known("vx after", last("ball", "vx"), e * vx, 1e-4), Known("vz after", last("ball", "vz"), e * vz, 1e-4))
            variants.append(Variant(f"{name}, e {e}", {"e": e, "vx": -vx, "vz": -vz}, known))
    bodies = {**FLOOR, "wall": {"fixed": True, "shape": {"plane": "x"}},
              "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [r + gap, 0, r + gap], "velocity": ["vx", 0, "vz"]}}
    return Case("into_a_corner", "Each velocity is reversed with e.",
                model("Into a corner", bodies, gravity=(0, 0, 0), variables={"e": 0, "vx": 0, "vz": 0}, contacts={"default": {"restitution": "e"}}, probes={"ball": {"body": "ball"}}),
                1e-2, 0.05, tuple(variants), ABSOLUTE, compare=False, because=CLOSED)


def swing_in_a_trough():
    """A smooth ball in a trough whose cross section is a parabola of fine cells, x²/(2 R): energy and amplitude are constant."""
    R, r, cell, count, start = 1.0, 0.05, 0.02, 61, 0.3
    heights = [[((i - count // 2) * cell) ** 2 / (2 * R) for i in range(count)] for _ in range(7)]
    slope = start / R
    n = math.hypot(1, slope)
    bodies = {"trough": {"fixed": True, "shape": {"height_field": {"spacing": cell, "heights": heights}}},
              "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [start - r * slope / n, 0.003, start**2 / (2 * R) + r / n + 4e-5]}}

    def highest(run):
        table = run.probe("ball")
        return max(0.5 * (vx * vx + vy * vy + vz * vz) + G * z for vx, vy, vz, z, t in zip(table["vx"], table["vy"], table["vz"], table["z"], table["t"]) if t > 0.1)

    def lowest(run):
        table = run.probe("ball")
        return min(0.5 * (vx * vx + vy * vy + vz * vz) + G * z for vx, vy, vz, z in zip(table["vx"], table["vy"], table["vz"], table["z"]))

    energy = G * (start**2 / (2 * R) + r / n + 4e-5)
    swing = G * start**2 / (2 * R)
    # With e = 0 each kink of the valley may remove the velocity normal to it, (cell/R)² of the energy there: half of that of the swing on
    # average. It begins with a fall of less than 4e-5 m.
    kinks = 2 * start / cell * 1.25 * 0.5 * (cell / R) ** 2 + 4e-5 * G / swing
    known = (Known("gains energy, of the swing's", lambda run: (highest(run) - energy) / swing, 0, 1e-6, below=True),
             Known("loses energy, of the swing's", lambda run: (energy - lowest(run)) / swing, 0, kinks, below=True),
             Known("turns at, of the start", lambda run: -min(run.probe("ball")["x"]) / (start - r * slope / n), 1, kinks / 2), Known("drifts along [m]", lambda run: max(abs(y - 0.003) for y in run.probe("ball")["y"]), 0, 1e-5, below=True))
    return Case("swing_in_a_trough", "Slides through a valley of 20 mm cells and up again.",
                model("Swing in a trough", bodies, contacts={}, probes={"ball": {"body": "ball"}}),
                5e-3, 1.25, (Variant("", {}, known),), (1, 0.5, 0.2, 0.05, 0.01), compare=False, because=CLOSED)


def over_a_hull():
    """A smooth ball that slides over the flat top of a hull of many points, of a box and of a plane: the same motion."""
    r, v, end = 0.1, 5.0, 0.15
    points = [[x, y, z] for x in (-0.5, -0.25, 0, 0.2, 0.5) for y in (-0.3, 0.1, 0.3) for z in (-0.2, 0)]
    shapes = {"hull": {"hull": {"points": points}}, "box": {"box": [1, 0.6, 0.2], "position": [0, 0, -0.1]}, "plane": {"plane": "z"}}
    bodies, known, probes = {}, [], {}
    for i, (name, shape) in enumerate(shapes.items()):
        bodies[name] = {"fixed": True, "position": [0, 0, 0], "shape": shape, "contact": {"groups": [name], "meets": ["on_" + name]}}
        ball = "on_" + name
        bodies[ball] = {"shape": {"sphere": 2 * r}, "mass": 1, "position": [-0.4, 0.013, r], "velocity": [v, 0.1, 0], "angular_velocity": [3, 0, 5], "contact": {"groups": [ball], "meets": [name]}}
        probes[ball] = {"body": ball}
        known += [Known(f"{ball}: speed", last(ball, "vx"), v, 1e-6 * v), Known(f"{ball}: speed across", last(ball, "vy"), 0.1, 1e-6 * v), Known(f"{ball}: hops [m]", rise(ball, "z"), 0, 1e-6, below=True),
                  Known(f"{ball}: sinks [m]", fall(ball, "z"), 0, 1e-5, below=True)]
    return Case("over_a_hull", "Slides over hull, box and plane alike.",
                model("Over a hull", bodies, contacts={}, probes=probes), 5e-3, end, (Variant("", {}, tuple(known)),), (1, 0.5, 0.2, 0.05, 0.01), compare=False, because=CLOSED)


def nonsmooth_ball():
    r, mu, variants = 0.1, 0.2, []
    for e in (0, 0.5, 1):
        p = min(mu * (1 + e) * W, 3 / 3.5)
        variants.append(Variant(f"e {e}", {"e": e}, (Known("vz after", last("ball", "vz"), e * W, 1e-4 * W), Known("vx after", last("ball", "vx"), 3 - p, 1e-4 * W))))
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [0, 0, r + W * 0.0137], "velocity": [3, 0, -W]}}
    return Case("nonsmooth_ball", "Impact of a ball on the floor with the non-smooth law: e w, friction μp.",
                model("Non-smooth ball", bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts={"default": {"law": "nonsmooth", "restitution": "e", "friction": mu}},
                      probes={"ball": {"body": "ball"}}),
                1e-2, 0.05, tuple(variants), ABSOLUTE, compare=False, because=CLOSED)


def nonsmooth_slide():
    v, mu = 2.0, 0.4
    bodies = {**FLOOR, "box": {"shape": {"box": [0.2, 0.2, 0.2]}, "mass": 1, "position": [0, 2, 0.1], "velocity": [v, 0, 0]}}
    known = (Known("way until it stops [m]", last("box", "x"), v * v / (2 * mu * G), 1e-4), Known("speed at the end", last("box", "vx"), 0, 1e-6), Known("sinks [m]", fall("box", "z"), 0, 1e-5, below=True))
    return Case("nonsmooth_slide", "A box slides to a halt by the non-smooth law.",
                model("Non-smooth slide", bodies, contacts={"default": {"law": "nonsmooth", "friction": mu}}, probes={"box": {"body": "box"}}),
                1e-2, 0.6, (Variant("", {}, known),), (1, 0.5, 0.1, 0.01), drift=1e-7, compare=False, because=CLOSED + " Sweeps end at a fraction of gravity's velocity change of a step, which limits the accuracy of the energy.")


CASES = [flat_rebound(), rolling_wheels(), into_a_corner(), swing_in_a_trough(), over_a_hull(), nonsmooth_ball(), nonsmooth_slide()]
