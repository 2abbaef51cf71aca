# SPDX-License-Identifier: Apache-2.0
"""Scenes of the validation suite with contact, stops or friction, at many steps: balls on a slope, resistance to rolling, Hertz's
impact, static friction, friction of joints, a pendulum on its stop, a flat height field, beams, cables and a trolley with all of these."""
import math

from case import FLOOR, Case, Known, Variant, at, body, fall, last, model, rise

G = 9.81
CLOSED = "Closed forms give all results."


def slope():
    """Balls on a slope of 30 degrees: one rolls with 5/7 g sin, one slips with g (sin - μ cos) and spins with 5/2 μ g cos/r."""
    r, s, c, mu, end = 0.1, 0.5, 3**0.5 / 2, 0.1, 0.5
    bodies = {"slope": {"fixed": True, "shape": {"plane": [s, 0, c]}}}
    for i, name in enumerate(("rolls", "slips")):
        bodies[name] = {"shape": {"sphere": 2 * r}, "mass": 1, "position": [r * s, i, r * c]}
    down = lambda name: lambda run: c * last(name, "vx")(run) - s * last(name, "vz")(run)  # noqa: E731
    known = []
    for name, a in (("rolls", 5 / 7 * G * s), ("slips", G * (s - mu * c))):
        way = lambda run, n=name: c * (last(n, "x")(run) - r * s) - s * (last(n, "z")(run) - r * c)  # noqa: E731
        known += [Known(f"{name}: speed", down(name), a * end, 1e-4 * a * end), Known(f"{name}: way [m]", way, a * end * end / 2, 1e-4 * a * end * end / 2)]
    return Case("balls_on_a_slope", "One rolls with 5/7 g sin α, one slips with g (sin α - μ cos α).",
                model("Balls on a slope", bodies, contacts={"default": {"friction": 1}, "pairs": {"smooth": {"between": ["slips", "slope"], "friction": mu}}},
                      probes={"rolls": {"body": "rolls"}, "slips": {"body": "slips"}}),
                1e-2, end, (Variant("", {}, tuple(known)),), (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


def resistance():
    """Rolling and spin resistance of a ball, which slows down by 5/7 a g/r and b g/(2/5 r²)."""
    r, a, b, end = 0.1, 2e-3, 3e-3, 0.5
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [0, 0, r], "velocity": [1, 0, 0], "angular_velocity": [0, 10, 0]},
              "top": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [0, 1, r], "angular_velocity": [0, 0, 20]}}
    slows = 5 / 7 * a * G / r
    drills = b * G / (0.4 * r * r)

    def spin(run):
        c, x = run.probe("top"), run.probe("top_x")
        ex, ey = x["x"][-1] - c["x"][-1], x["y"][-1] - c["y"][-1]
        return ex * (x["vy"][-1] - c["vy"][-1]) - ey * (x["vx"][-1] - c["vx"][-1])

    known = (Known("speed of the ball", last("ball", "vx"), 1 - slows * end, 1e-4), Known("way of the ball [m]", last("ball", "x"), end - slows * end * end / 2, 1e-4),
             Known("spin of the top", spin, 20 - drills * end, 5e-3))
    return Case("rolling_resistance", "Slows by 5/7 a g/r, and by b g/(2/5 r²).",
                model("Rolling resistance", bodies, contacts={"default": {"friction": 0.5, "rolling_friction": a, "torsional_friction": b}},
                      probes={"ball": {"body": "ball"}, **body("top")}),
                1e-2, end, (Variant("", {}, known),), (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


def hertz():
    """A ball on a floor by Hertz's law, F = k d^(3/2), e = 1: it sinks to δ = (5 m w²/(4 k))^(2/5), in contact for 2.94 δ/w
    (Johnson, Contact Mechanics, 1985, 11.4)."""
    r, m, w, k = 0.05, 0.5, 1.0, 1e7
    deep = (5 * m * w * w / (4 * k)) ** 0.4
    lasts = 2.9432751 * deep / w
    begins = 2 * lasts
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": m, "position": [0, 0, r + w * begins], "velocity": [0, 0, -w]}}
    known = (Known("speed after", last("ball", "vz"), w, 1e-9), Known("sinks [m]", lambda run: r - min(run.probe("ball")["z"]), deep, lambda h: 1e-3 * deep + (math.pi * h / lasts) ** 2 / 8 * deep),
             Known("impulse [N s]", last("touch", "impulse"), 2 * m * w, 1e-9))
    return Case("hertz_impact", "Sinks to (5 m w²/(4 k))^(2/5) and leaves with its speed; steps from a tenth of its duration on.",
                model("Hertz's impact", bodies, gravity=(0, 0, 0), contacts={"default": {"law": "hertz", "hertz_stiffness": k, "restitution": 1}},
                      probes={"ball": {"body": "ball"}, "touch": {"contact": ["ball", "floor"]}}),
                lasts / 10, 4 * lasts, (Variant("", {}, known),), order=2, skip=("touch.impulses",), because="The impulse of the pair is a known number.")


def static_friction():
    """Blocks of 1 kg pulled with 5 N/s: each slips at μ_s m g = 6 N, after 1.2 s, with at least 1 m/s², since μ = 0.5."""
    shapes = {"box": {"box": [0.2, 0.2, 0.1]}, "puck": {"cylinder": [0.1, 0.1]}}
    bodies, loads, probes, known = dict(FLOOR), {}, {}, []
    for i, (name, shape) in enumerate(shapes.items()):
        bodies[name] = {"shape": shape, "mass": 1, "position": [0, i, 0.05]}
        loads["pull_" + name] = {"type": "force", "body": name, "force": ["5*t", 0, 0]}
        probes[name] = {"body": name}
        # v = (5 (t² - t0²)/2 - 5 (t - t0)) after it slips.
        speed = 2.5 * (1.224**2 - 1.2**2) - 5 * 0.024
        known += [Known(f"{name}: speed at 0.59 of its weight", at(name, "vx", 1.18), 0, 1e-3),
                  # Slip begins within 1 % of 0.6: 12 ms, at 1 m/s².
                  Known(f"{name}: speed 24 ms after 0.6 of its weight", at(name, "vx", 1.224), speed, 0.012)]
    return Case("static_friction", "Slip at 0.6 of the weight, to 1 %, and slide with 0.5.",
                model("Static friction", bodies, gravity=(0, 0, -10), loads=loads, contacts={"default": {"friction": 0.5, "static_friction": 0.6}}, probes=probes),
                6e-3, 1.224, (Variant("", {}, tuple(known)),), (1, 0.5, 0.1, 0.05), compare=False, because=CLOSED)


def joints_with_friction():
    """Friction of joints without gravity: a sled stops after m v²/(2 F), a wheel after J ω²/(2 M)."""
    v, omega, F, M, m = 1.0, 5.0, 4.0, 0.1, 2.0
    bodies = {"sled": {"shape": {"box": [0.2, 0.1, 0.1]}, "mass": m, "velocity": [v, 0, 0]},
              "wheel": {"mass": 1, "inertia": [0.01, 0.01, 0.02], "position": [0, 1, 0], "angular_velocity": [0, 0, omega]}}
    joints = {"rail": {"type": "prismatic", "bodies": ["ground", "sled"], "at": [0, 0, 0], "axis": "x", "friction": {"force": F}},
              "axle": {"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 1, 0], "axis": "z", "friction": {"moment": M}}}
    stops_sled, stops_wheel = m * v / F, 0.02 * omega / M
    known = (Known("way of the sled [m]", last("rail", "z"), m * v * v / (2 * F), lambda h: 1e-4 + v * h * h * F / m), Known("sled: speed half-way", at("rail", "rate z", stops_sled / 2), v / 2, 1e-4),
             Known("sled: speed at the end", last("rail", "rate z"), 0, 1e-6),
             Known("way of the wheel [rad]", last("axle", "rz"), 0.02 * omega**2 / (2 * M), lambda h: 5e-4 + (omega * h) ** 2), Known("wheel: rate half-way", at("axle", "rate rz", stops_wheel / 2), omega / 2, lambda h: 1e-3 + omega * (omega * h) ** 2 / 12),
             Known("wheel: rate at the end", last("axle", "rate rz"), 0, 1e-4))
    return Case("joints_with_friction", "Dry friction stops a sled after m v²/(2 F), a wheel after J ω²/(2 M).",
                model("Joints with friction", bodies, gravity=(0, 0, 0), joints=joints, probes={"rail": {"joint": "rail"}, "axle": {"joint": "axle"}}),
                2e-2, 1.2, (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def pendulum_on_a_stop():
    """A bar that falls from the horizontal about its end on a stop at 60 degrees: it rebounds with e √(3 g sin/l), and rises by e² of the height."""
    l, stop = 1.0, math.radians(60)
    variants = []
    for e in (0, 0.5, 1):
        # After the impact up to its greatest height or the end of the run, with θ'' = 3/2 g/l cos θ.
        rate = -e * (3 * G / l * math.sin(stop)) ** 0.5
        top = math.asin(max(0.0, math.sin(stop) - rate * rate * l / (3 * G)))
        known = [Known("passes the stop [rad]", lambda run: max(run.probe("hinge")["rz"]) - stop, 0, 1e-3, below=True)]
        if e == 0.5:
            known.append(Known("rises again to [rad]", lambda run: min(v for t, v in zip(run.probe("hinge")["t"], run.probe("hinge")["rz"]) if t > 0.62), top, 5e-4))
        if e == 0:
            known.append(Known("rate at the end", last("hinge", "rate rz"), 0, 1e-3))
        variants.append(Variant(f"e {e}", {"e": e}, tuple(known)))
    bodies = {"bar": {"shape": {"box": [l, 0.05, 0.05]}, "mass": 2, "inertia": [1e-3, 2 * l * l / 12, 2 * l * l / 12], "position": [l / 2, 0, 0]}}
    return Case("pendulum_on_a_stop", "Falls on its stop at 60 degrees; rises by e² of the height, stays with e = 0.",
                model("Pendulum on a stop", bodies, variables={"e": 0}, joints={"hinge": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0], "axis": "y",
                                                                                          "limits": {"upper": "60 deg", "restitution": "e"}}}, probes={"hinge": {"joint": "hinge"}}),
                1e-2, 0.9, tuple(variants), (1, 0.5, 0.1, 0.02), skip=("hinge.impulses", "hinge.speeds"), because="Reactions at an instant do not contain the impulse of a stop.")


def flat_field():
    """A smooth ball on a flat height field and in a trough along x: it keeps its speed on both."""
    r, v, cell, end = 0.1, 5.0, 0.02, 0.15
    flat = [[0] * 60 for _ in range(21)]
    bodies = {"field": {"fixed": True, "shape": {"height_field": {"spacing": cell, "heights": flat}}},
              "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [-0.4, 0.003, r], "velocity": [v, 0, 0], "angular_velocity": [3, 0, 5]}}
    known = (Known("speed", last("ball", "vx"), v, 1e-6 * v), Known("speed across", last("ball", "vy"), 0, 1e-6 * v), Known("hops [m]", rise("ball", "z"), 0, 1e-6, below=True))
    return Case("ball_over_flat_field", "Slides over 20 mm cells as over a plane.",
                model("Ball over a flat field", bodies, contacts={}, probes={"ball": {"body": "ball"}}),
                5e-3, end, (Variant("", {}, known),), (1, 0.5, 0.2, 0.05, 0.01), compare=False, because=CLOSED)


RUBBER = {"rubber": {"type": "elastic", "youngs_modulus": "50 MPa", "poisson_ratio": 0.4, "density": 1000}}


def crossing_rods():
    bar = {"elements": 10, "section": "bar", "contact": {}}
    beams = {"upper": {**bar, "points": [[-0.3, 0, 0.05], [0.3, 0, 0.05]], "velocity": [0, 0, -1], "angular_velocity": [0, 0, 2]},
             "lower": {**bar, "points": [[0.07, -0.3, 0], [0.07, 0.3, 0]]}}
    return Case("crossing_rods", "Two rods of rubber cross at 1 m/s: beam on beam.",
                model("Crossing rods", {}, gravity=(0, 0, 0), materials=RUBBER, sections={"bar": {"type": "circle", "diameter": "20 mm", "material": "rubber"}}, beams=beams,
                      contacts={"default": {"friction": 0, "restitution": 1}}, probes={name.replace(".", "_"): {"body": name} for name in ("upper.5", "lower.5", "upper.0", "lower.10")}),
                1e-3, 0.04, fractions=(1, 0.5, 0.2, 0.05))


def ball_on_cable():
    bodies = {"left": {"shape": {"box": [0.1, 0.2, 0.2]}, "density": 1000, "position": [-0.55, 0, 0]},
              "right": {"shape": {"box": [0.1, 0.2, 0.2]}, "density": 1000, "position": [0.55, 0, 0]},
              "ball": {"shape": {"sphere": "60 mm"}, "density": 2000, "position": [0.02, 0, 0.04], "velocity": [0, 0, -2]}}
    return Case("ball_on_cable", "A ball hits a cable between two free blocks.",
                model("Ball on a cable", bodies, gravity=(0, 0, 0), cables={"rope": {"through": [["left", [0.05, 0, 0]], ["right", [-0.05, 0, 0]]], "stiffness": "20 kN",
                                                                                     "mass_per_length": 0.05, "elements": 20, "contact": {"radius": "4 mm"}}},
                      contacts={"default": {"restitution": 1}}, probes={name: {"body": name} for name in ("left", "right", "ball")}),
                1e-3, 0.03, fractions=(1, 0.5, 0.2, 0.05))


def trolley():
    """The model of tests/validation/data/trolley.yaml, with probes."""
    box = lambda *sizes: {"box": list(sizes)}  # noqa: E731
    bodies = {**FLOOR, "wall": {"fixed": True, "position": [0.6, 0, 0.2], "shape": box(0.2, 1, 0.4)},
              "trolley": {"shape": box(0.4, 0.2, 0.1), "density": 1000, "position": [0, 0, 0.0502], "velocity": [2, 0, 0]},
              "bell": {"shape": box(0.04, 0.04, 0.2), "density": 1000, "position": [0.1, 0.13, 0.15], "velocity": [2, 0, 0]},
              "lamp": {"shape": {"sphere": 0.06}, "density": 500, "position": [-0.1, 0, 0.26], "velocity": [2, 0, 0]},
              "ball": {"shape": {"sphere": 0.08}, "density": 1500, "position": [-0.6, 0.02, 0.0401], "velocity": [4, 0, 0], "angular_velocity": [0, 100, 0]}}
    joints = {"hinge": {"type": "revolute", "bodies": ["trolley", "bell"], "at": [0.1, 0.12, 0.08], "axis": "y", "limits": {"lower": "-30 deg", "upper": "30 deg", "restitution": 0.5}}}
    block = lambda size, cells, place: {"block": {"size": size, "cells": cells}, "position": place}  # noqa: E731
    solids = {"buffer": {"mesh": block([0.04, 0.1, 0.06], [2, 2, 1], [0.22, 0, 0.0502]), "material": "rubber", "bonded": {"trolley": "xmin"}, "contact": {"surface": "xmax"}},
              "stalk": {"mesh": block([0.03, 0.03, 0.16], [1, 1, 2], [-0.1, 0, 0.1802]), "material": "rubber", "bonded": {"trolley": "zmin", "lamp": "zmax"}, "contact": {"touches": False}}}
    return Case("trolley", "Bodies on bodies, surfaces of solids and stops of joints: until the buffer hits the wall.",
                model("Trolley", bodies, joints=joints, solids=solids, materials={"rubber": {"type": "neo_hookean", "youngs_modulus": "1 MPa", "poisson_ratio": 0.35, "density": 1100}},
                      contacts={"default": {"friction": 0.2, "restitution": 0.4}, "exclude": [["trolley", "lamp"], ["lamp", "floor"], ["buffer", "floor"]]},
                      probes={name: {"body": name} for name in ("trolley", "bell", "lamp", "ball")}),
                1e-3, 0.12, fractions=(1, 0.5, 0.2, 0.05), until=0.12, floor=3e-4,
                because="Afterwards undamped waves in the buffer open and close its face: steps of 1 to 0.2 ms differ by half a per cent.")


def page_of_contacts():
    bodies = {**FLOOR, "wheel": {"shape": {"cylinder": [0.5, 0.1]}, "density": 1000, "position": [0, 0, 1], "contact": {"material": "rubber"}},
              "crate": {"shape": {"box": [0.4, 0.4, 0.4]}, "density": 300, "position": [2, 0, 0.2]}}
    known = (Known("crate rises [m]", rise("crate", "z"), 0, 1e-9, below=True), Known("crate sinks [m]", fall("crate", "z"), 0, 1e-5, below=True))
    return Case("page_of_contacts", "The model of the reference page on contact: the crate stays at rest.",
                model("Page of contacts", bodies, contacts={"default": {"friction": 0.3, "restitution": 0.2}, "materials": {"rubber": {"friction": 1, "restitution": 0.6}},
                                                            "pairs": {"feet": {"between": ["crate", "floor"], "friction": 0.5}}}, probes={"crate": {"body": "crate"}}),
                2e-3, 0.2, (Variant("", {}, known),), (1, 0.5, 0.05, 0.005), compare=False, because=CLOSED)


CASES = [slope(), resistance(), hertz(), static_friction(), joints_with_friction(), pendulum_on_a_stop(), flat_field(), crossing_rods(), ball_on_cable(), trolley(), page_of_contacts()]
