# SPDX-License-Identifier: Apache-2.0
"""Bodies that touch from the start, roll, slide to a halt, land flat: gaps, displacements and speeds of elementary mechanics."""
from case import FLOOR, Case, Known, Variant, body, fall, last, model, rise, turn_y

G = 9.81
ABSOLUTE = (1, 0.5, 0.1, 0.01, 0.001)  # 10, 5, 1, 0.1, 0.01 ms
STILL = "It is at rest."
CLOSED = "Closed forms give all results."


def touches_at_start():
    """Bodies placed with gap 0, as in most models. The band is 1e-3 of the smallest half size, 1e-4 m or less."""
    shapes = {"ball": ({"sphere": 0.2}, 0.1), "crate": ({"box": [0.4, 0.4, 0.4]}, 0.2),
              "wheel": ({"cylinder": [0.6, 0.2]}, 0.3), "rod": ({"capsule": [0.02, 2]}, 0.01)}
    bodies = dict(FLOOR)
    for i, (name, (shape, height)) in enumerate(shapes.items()):
        bodies[name] = {"shape": shape, "density": 300, "position": [0, 3 * i, height]}
        if name in ("wheel", "rod"):
            bodies[name]["orientation"] = {"axis": "x", "angle": "90 deg"}
    known = []
    for name, (_, height) in shapes.items():
        band = 1e-3 * min(height, 0.1 if name == "wheel" else height)
        known += [Known(f"{name} rises [m]", rise(name, "z"), 0, 1e-9, below=True),
                  Known(f"{name} sinks, of its band", lambda run, n=name, b=band: fall(n, "z")(run) / b, 0, 0.12, below=True),
                  Known(f"{name}: speed at the end", last(name, "vz"), 0, 1e-3)]
    return Case("touches_at_start", "Ball, crate, wheel and rod on the floor: none rises, each sinks by the part of its band that carries it.",
                model("Touch at the start", bodies, contacts={"default": {"friction": 0.3}}, probes={name: {"body": name} for name in shapes}),
                1e-2, 0.1, (Variant("", {}, tuple(known)),), ABSOLUTE, compare=False, because=STILL)


def set_down():
    """A rolling ball of 8 m/s that falls from 1 mm: neither friction nor impact changes its speed."""
    r = 0.3
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": 2, "position": [0, 0, r + 1e-3], "velocity": [8, 0, 0], "angular_velocity": [0, 8 / r, 0]}}
    known = (Known("speed", last("ball", "vx"), 8, 8e-4),
             Known("way over angle, of the radius", lambda run: (run.probe("ball")["x"][-1] - run.probe("ball")["x"][0]) / turn_y("ball", "ball_x")(run)[-1] / r, 1,
                   # Cayley's rotation of a step turns by 2 atan(θ/2).
                   lambda h: 1e-4 + (8 / r * h) ** 2 / 11))
    return Case("rolling_ball_set_down", "Rolls on at 8 m/s, on its own radius.",
                model("Rolling ball set down", bodies, contacts={"default": {"friction": 0.5}}, probes=body("ball")),
                1e-2, 0.5, (Variant("", {}, known),), (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


def spinning_set_down():
    """A spinning ball without friction: its spin is constant."""
    r = 0.3
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": 2, "position": [0, 0, r + 1e-2], "velocity": [3, 0, 0], "angular_velocity": [0, 5, 0]}}
    known = (Known("speed", last("ball", "vx"), 3, 1e-10), Known("angle [rad]", lambda run: turn_y("ball", "ball_x")(run)[-1], 2.5, 2e-3))
    return Case("smooth_ball_set_down", "A frictionless ball keeps speed and spin for any restitution.",
                model("Smooth ball set down", bodies, variables={"e": 0}, contacts={"default": {"restitution": "e"}}, probes=body("ball")),
                1e-2, 0.5, tuple(Variant(f"e {e}", {"e": e}, known) for e in (0, 0.5)), (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


def cylinder_on_a_box():
    """A cylinder that slides on its flat face: it stops after v²/(2 μ g)."""
    v, mu = 2.0, 0.4
    bodies = {"table": {"fixed": True, "shape": {"box": [4, 1, 0.2]}, "position": [1, 0, -0.1]},
              "puck": {"shape": {"cylinder": [0.2, 0.1]}, "mass": 1, "position": [0, 0, 0.05], "velocity": [v, 0, 0]}}
    known = (Known("way until it stops [m]", lambda run: run.probe("puck")["x"][-1], v * v / (2 * mu * G), 5e-3), Known("speed at the end", last("puck", "vx"), 0, 1e-3))
    return Case("cylinder_on_a_box", "Stops after v²/(2 μ g) = 0.510 m.",
                model("Cylinder on a box", bodies, contacts={"default": {"friction": mu}}, probes={"puck": {"body": "puck"}}),
                1e-2, 0.7, (Variant("", {}, known),), (1, 0.5, 0.1), compare=False, because=CLOSED + " Shorter steps take minutes.")


def lands_flat():
    """A box that lands with e = 0 and stays: if it slides it loses μ w of its speed, if it sticks it stops."""
    bodies = {**FLOOR, "box": {"shape": {"box": [0.2, 0.2, 0.2]}, "mass": 1, "position": [0, 0, 0.1 + 2 * 0.0137], "velocity": ["v", 0, -2]}}
    variants = []
    for v, mu in ((0, 0), (10, 0.05), (0.5, 0.5)):
        after = max(0, v - mu * 2)
        variants.append(Variant(f"v {v}, mu {mu}", {"v": v, "mu": mu},
                                (Known("vz", last("box", "vz"), 0, 2e-4), Known("vx", last("box", "vx"), after, 2e-4), Known("tilts [m]", lambda run: abs(run.probe("box_x")["z"][-1] - run.probe("box")["z"][-1]), 0, 1e-6, below=True))))
    return Case("box_lands_flat", "With e = 0 it stays, flat; vx - μ w, or 0 where it sticks.",
                model("Box lands flat", bodies, gravity=(0, 0, 0), variables={"v": 0, "mu": 0}, contacts={"default": {"friction": "mu"}}, probes=body("box")),
                1e-2, 0.04, tuple(variants), ABSOLUTE, compare=False, because=CLOSED)


def lifted_after_landing():
    """A ball with a spring law that lands, e = 0, and is lifted by twice its weight: the penetration left by the impact
    adds no energy on its way up."""
    r, mass, lifted, end = 0.05, 0.1, 0.05, 0.1
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * r}, "mass": mass, "position": [0, 0, r + 0.0137],
                                "velocity": [0, 0, -1]}}
    lift = {"type": "force", "body": "ball", "force": [0, 0, f"t < {lifted} ? 0 : {2 * mass * G!r}"]}
    built = model("Lifted after landing", bodies, contacts={"default": {"law": "linear", "restitution": "e"}},
                  probes={"ball": {"body": "ball"}}, loads={"lift": lift})
    built["variables"] = {"e": 0}
    speed = G * (end - lifted)
    # It starts from within the tolerance, 5e-5 m, and the spring that carried it releases m g times half of that.
    known = (Known("speed at the end", last("ball", "vz"), speed, lambda h: 5e-3 * speed + G * h),)
    return Case("lifted_after_landing", "Rises with g, without energy of the impact.", built, 1e-3, end,
                tuple(Variant(law, {"contacts.default.law": law}, known) for law in ("barrier", "linear", "hertz")),
                (1, 0.5, 0.1, 0.01), compare=False, because=CLOSED)


CASES = [touches_at_start(), set_down(), spinning_set_down(), cylinder_on_a_box(), lands_flat(), lifted_after_landing()]
