# SPDX-License-Identifier: Apache-2.0
"""Textbook motions under gravity with contact: ladder, billiard balls, rocking block, turning table, Painlevé's rod, a chain.

Each has a closed form, or an ordinary differential equation of one or two unknowns that is solved here.
"""
import math

from case import FLOOR, Case, Known, Variant, at, body, last, model

G = 9.81
CLOSED = "Closed forms give all results."


def runge_kutta(rates, y, t, step, until=math.inf, stop=None):
    """Classical steps of the fourth order, up to a time or to where stop(y) becomes positive, there to 1e-12 of a step."""

    def one(y, h):
        k1 = rates(y)
        k2 = rates([a + h / 2 * b for a, b in zip(y, k1)])
        k3 = rates([a + h / 2 * b for a, b in zip(y, k2)])
        k4 = rates([a + h * b for a, b in zip(y, k3)])
        return [a + h / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(y, k1, k2, k3, k4)]

    while t < until:
        h = min(step, until - t)
        new = one(y, h)
        if stop and stop(new) > 0:
            low, high = 0.0, h
            for _ in range(50):
                middle = (low + high) / 2
                low, high = (low, middle) if stop(one(y, middle)) > 0 else (middle, high)
            return t + high, one(y, high)
        t, y = t + h, new
        if h < step:
            break
    return t, y


def ladder():
    """A rod that slides down between a smooth wall and a smooth floor from rest at θ₀. While it touches both, energy gives
    θ'² = 3 g/l (sin θ₀ - sin θ); the wall's force vanishes at sin θ = ⅔ sin θ₀, from where the centre keeps the velocity
    ⅓ sin θ₀ √(g l sin θ₀) along the floor."""
    l, r, start = 2.0, 0.02, math.radians(60)
    s0 = math.sin(start)
    leaves = (2 / 3) * s0
    # θ'' = -3g/(2l) cos θ from rest; after that the centre is free along the floor, z = l/2 sin θ, I = m l²/12.
    t_leaves, y = runge_kutta(lambda y: [y[1], -1.5 * G / l * math.cos(y[0])], [start, 0.0], 0.0, 1e-3, stop=lambda y: leaves - math.sin(y[0]))
    assert abs(y[1] ** 2 - 3 * G / l * (s0 - leaves)) < 1e-9

    def alone(y):
        # N ℓ/2 cos θ = -I θ'', N - m g = m z''.
        a, c, s = l / 2, math.cos(y[0]), math.sin(y[0])
        return [y[1], (-G * a * c + a * a * c * s * y[1] ** 2) / (l * l / 12 + a * a * c * c)]

    end = t_leaves + 0.15
    _, after = runge_kutta(alone, y, t_leaves, 1e-3, until=end)
    speed = s0 / 3 * math.sqrt(G * l * s0)
    where = r + l / 2 * math.cos(math.asin(leaves)) + speed * (end - t_leaves)
    bodies = {"floor": {"fixed": True, "shape": {"plane": "z"}}, "wall": {"fixed": True, "shape": {"plane": "x"}},
              "ladder": {"shape": {"capsule": [2 * r, l + 2 * r]}, "mass": 3, "inertia": [3 * l * l / 12, 3 * l * l / 12, 1e-3],
                         "position": [r + l / 2 * math.cos(start), 0, r + l / 2 * s0], "orientation": {"axis": "y", "angle": f"{-90 + 60} deg"}}}

    def steepness(run):
        return (run.probe("ladder_z")["z"][-1] - run.probe("ladder")["z"][-1])

    # The times at which it starts and leaves the wall are known to a step, so later values lag by up to h times their rate.
    rate = math.cos(after[0]) * abs(after[1])
    known = (Known("speed along the floor at the end", last("ladder", "vx"), speed, 1e-4 * speed), Known("its centre from the wall [m]", last("ladder", "x"), where, lambda h: 1e-4 + speed * h),
             Known("sine of its angle", steepness, math.sin(after[0]), lambda h: 1e-4 + rate * h),
             Known("impulse of the wall [N s]", last("wall", "impulse"), 3 * speed, 3e-4 * speed))
    return Case("ladder", "Leaves the wall at two thirds of its height, and keeps ⅓ sin θ₀ √(g l sin θ₀).",
                model("Ladder", bodies, contacts={}, probes={"ladder": {"body": "ladder"}, "ladder_z": {"body": "ladder", "point": [0, 0, 1]}, "wall": {"contact": ["ladder", "wall"]}}),
                5e-3, round(end, 5), (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def billiard():
    """A ball slides until it rolls at 5/7 v, after 2 v/(7 μ g) and 12 v²/(49 μ g). A rolling ball that hits an equal one
    centrally, e = 1, transfers its whole speed and keeps its spin: 5/7 v and 2/7 v once both roll again."""
    r, v, mu = 0.03, 2.0, 0.2
    t_rolls, way = 2 * v / (7 * mu * G), 12 * v * v / (49 * mu * G)
    end, gap = 0.6, 0.02 * v
    ball = {"shape": {"sphere": 2 * r}, "mass": 0.2}
    bodies = {**FLOOR, "slides": {**ball, "position": [0, 1, r], "velocity": [v, 0, 0]},
              "cue": {**ball, "position": [0, 0, r], "velocity": [v, 0, 0], "angular_velocity": [0, v / r, 0]},
              "object": {**ball, "position": [2 * r + gap, 0, r]}}
    rolls = 5 / 7 * v * (end - t_rolls) + way
    met = gap / v  # The other one is accelerated from rest to 2/7 v in the same time.
    # In the step of the impact, which is at its end, the friction is that of the slip before it: an error of some ±μ g h.
    stroke = lambda h: 2e-4 * v + 1.2 * mu * G * h  # noqa: E731
    known = (Known("sliding ball: speed at the end", last("slides", "vx"), 5 / 7 * v, 1e-4 * v), Known("sliding ball: way [m]", last("slides", "x"), rolls, 1e-4 * rolls),
             Known("sliding ball: speed half-way to rolling", at("slides", "vx", t_rolls / 2), v - mu * G * t_rolls / 2, 1e-4 * v),
             Known("cue ball: speed at the end", last("cue", "vx"), 2 / 7 * v, stroke), Known("object ball: speed at the end", last("object", "vx"), 5 / 7 * v, stroke),
             Known("object ball: way [m]", lambda run: last("object", "x")(run) - 2 * r - gap, 5 / 7 * v * (end - met - t_rolls) + way, lambda h: 1e-4 + 0.5 * stroke(h)))
    return Case("billiard", "Sliding becomes rolling at 5/7 v; a central impact gives 2/7 v and 5/7 v.",
                model("Billiard", bodies, contacts={"default": {"friction": mu}, "pairs": {"click": {"between": ["cue", "object"], "friction": 0, "restitution": 1}}},
                      probes={name: {"body": name} for name in ("slides", "cue", "object")}),
                5e-3, end, (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def rocking_block():
    """Housner, Bull. Seismol. Soc. Am. 53 (1963), 403-417: a block rocks about its edges, I θ'' = -m g R sin(α - θ), I = 4/3 m R²,
    and keeps the part (1 - 3/2 sin²α)² of its energy whenever it lands with e = 0 on the other edge. Its equation is solved
    for finite angles."""
    b, t, high = 0.2, 0.3, 0.8  # Width across the edges, thickness, height.
    rounding = 1e-3 * b / 2
    half, up = b / 2 - rounding, high / 2  # It rotates about the centre of its rounded edge, to 1e-4.
    R, alpha = math.hypot(half, up), math.atan2(half, up)
    gyration = (b * b + high * high) / 12 + R * R
    start = 0.5 * alpha
    rates = lambda y: [y[1], -G * R / gyration * math.sin(alpha - y[0])]  # noqa: E731
    t1, y = runge_kutta(rates, [start, 0.0], 0.0, 1e-3, stop=lambda y: -y[0])
    # Angular momentum about the other edge: that of the block's spin and of its centre's speed R θ', turned by 2 α.
    keeps = 1 - R * R / gyration * (1 - math.cos(2 * alpha))
    rate = -y[1] * keeps
    t_top, top = runge_kutta(rates, [0.0, rate], t1, 1e-3, stop=lambda y: -y[1])
    end = round(t_top, 3)
    angle = lambda run: math.atan2(run.probe("block_x")["z"][-1] - run.probe("block")["z"][-1], run.probe("block_x")["x"][-1] - run.probe("block")["x"][-1])  # noqa: E731

    def landing(run):
        """Time at which the centre passes the middle between both edges."""
        table = run.probe("block_x")
        tilt = [a - c for a, c in zip(table["z"], run.probe("block")["z"])]
        i = next(i for i, v in enumerate(tilt) if v > 0)
        return table["t"][i - 1] + (table["t"][i] - table["t"][i - 1]) * tilt[i - 1] / (tilt[i - 1] - tilt[i])

    # Tilted by θ₀ to the right about its right lower edge: the centre is R away at α - θ₀ from the vertical.
    bodies = {**FLOOR, "block": {"shape": {"box": [b, t, high]}, "mass": 2,
                                 "position": [half - R * math.sin(alpha - start), 0, rounding + R * math.cos(alpha - start)],
                                 "orientation": {"axis": "y", "angle": f"{start} rad"}}}
    # In the two steps of an impact both edges carry: the moment of gravity, m g R sin α, is missing for up to 2 h. A change of
    # the rate after it changes the greatest tilt by as much times θ' I/(m g R sin(α - θ)).
    tops = lambda h: 1e-3 * top[0] + 2 * h * rate * math.sin(alpha) / math.sin(alpha - top[0])  # noqa: E731
    known = (Known("lands after [s]", landing, t1, lambda h: 1e-4 * t1 + h), Known("tilt when it has risen again [rad]", angle, top[0], tops))
    return Case("rocking_block", "Falls from half its critical angle, lands after the time of its equation, keeps (1 - 3/2 sin²α)² of the energy.",
                model("Rocking block", bodies, contacts={"default": {"friction": 2}}, probes=body("block")),
                5e-3, end, (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def turning_table():
    """A ball that rolls on a table rotating at Ω moves in a circle of radius 7 v/(2 Ω) with 2/7 Ω: v' = 2/7 Ω × v
    (Weltner, Am. J. Phys. 47, 1979, 984-986)."""
    r, v, omega, end = 0.05, 0.3, 4.0, 0.8
    rate = 2 / 7 * omega
    bodies = {"table": {"shape": {"box": [2, 2, 0.2]}, "mass": 1e6, "inertia": [1e6, 1e6, 1e6], "position": [0, 0, -0.1], "angular_velocity": [0, 0, omega]},
              "ball": {"shape": {"sphere": 2 * r}, "mass": 1, "position": [0, 0, r], "velocity": [v, 0, 0], "angular_velocity": [0, v / r, 0]}}
    x, y = v / rate * math.sin(rate * end), v / rate * (1 - math.cos(rate * end))
    known = (Known("x at the end [m]", last("ball", "x"), x, 1e-3 * v / rate), Known("y at the end [m]", last("ball", "y"), y, 1e-3 * v / rate),
             Known("speed at the end", lambda run: math.hypot(last("ball", "vx")(run), last("ball", "vy")(run)), v, 1e-3 * v))
    return Case("turning_table", "A rolling ball moves in a circle at 2/7 of the table's rate.",
                model("Turning table", bodies, joints={"axle": {"type": "revolute", "bodies": ["ground", "table"], "at": [0, 0, -0.1], "axis": "z"}},
                      contacts={"default": {"friction": 1}}, probes={"ball": {"body": "ball"}}),
                1e-2, end, (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def sliding_rod():
    """Painlevé's rod where its equations have one solution: its lower end slides on the floor, μ below the paradox. With
    the arm c from the centre to the contact point, forces (-μ s N, N) there and the end's path on the floor,
    N follows from z'' of the end's centre = 0; two equations are integrated."""
    l, r, mu, start, slip = 1.0, 0.01, 0.3, math.radians(60), 1.0
    moment = l * l / 12  # Of 1 kg.

    def rates(y):
        theta, w, x, vx = y
        ax, az = -l / 2 * math.cos(theta), -l / 2 * math.sin(theta) - r
        s = math.copysign(1, vx - w * az)
        # z'' of the centre: l/2 (cos θ θ'' - sin θ θ'²) = N - g; θ'' = (ax N - az (-μ s N))/I.
        turn = (ax + az * mu * s) / moment
        N = (G - l / 2 * math.sin(theta) * w * w) / (1 - l / 2 * math.cos(theta) * turn)
        return [w, turn * N, vx, -mu * s * N]

    end = 0.3
    _, y = runge_kutta(rates, [start, 0.0, 0.0, slip], 0.0, 5e-4, until=end)
    assert y[3] - y[1] * (-l / 2 * math.sin(y[0]) - r) > 0.1, "slip ends before"
    # The body's z is the rod; it leans towards -x so that its upper end is at larger x.
    bodies = {**FLOOR, "rod": {"shape": {"capsule": [2 * r, l + 2 * r]}, "mass": 1, "inertia": [moment, moment, 1e-4], "position": [0, 0, r + l / 2 * math.sin(start)],
                               "orientation": {"axis": "y", "angle": f"{math.pi / 2 - start} rad"}, "velocity": [slip, 0, 0]}}
    known = (Known("x at the end [m]", last("rod", "x"), y[2], lambda h: 2e-4 + slip * h), Known("speed at the end", last("rod", "vx"), y[3], lambda h: 2e-4 * slip + mu * G * h),
             Known("sine of its angle", lambda run: run.probe("rod_z")["z"][-1] - run.probe("rod")["z"][-1], math.sin(y[0]), lambda h: 2e-4 + abs(y[1]) * h))
    return Case("painleve_rod", "Slides with its lower end on the floor, where its equations have one solution.",
                model("Painlevé's rod", bodies, contacts={"default": {"friction": mu}}, probes={"rod": {"body": "rod"}, "rod_z": {"body": "rod", "point": [0, 0, 1]}}),
                5e-3, end, (Variant("", {}, known),), (1, 0.5, 0.1, 0.02), compare=False, because=CLOSED)


def dropped_chain():
    """Five hinged links that fall on the floor one after the other, e = 0, without friction: no known numbers, but a unique solution."""
    count, length, thick, tilt = 5, 0.2, 0.03, math.radians(12)
    bodies, joints, exclude = dict(FLOOR), {}, []
    for i in range(count):
        bodies[f"link_{i}"] = {"shape": {"capsule": [thick, length]}, "mass": 0.3,
                               "position": [(i + 0.5) * length * math.cos(tilt), 0, 0.05 + (i + 0.5) * length * math.sin(tilt)],
                               "orientation": {"axis": "y", "angle": f"{math.pi / 2 - tilt} rad"}}
        if i:
            joints[f"hinge_{i}"] = {"type": "revolute", "bodies": [f"link_{i - 1}", f"link_{i}"],
                                    "at": [i * length * math.cos(tilt), 0, 0.05 + i * length * math.sin(tilt)], "axis": "y"}
        exclude += [[f"link_{j}", f"link_{i}"] for j in range(i)]
    return Case("dropped_chain", "Links land one after the other with e = 0.",
                model("Dropped chain", bodies, joints=joints, contacts={"exclude": exclude}, probes={f"link_{i}": {"body": f"link_{i}"} for i in range(count)}),
                2e-3, 0.3, fractions=(1, 0.5, 0.2, 0.05, 0.01))


CASES = [ladder(), billiard(), rocking_block(), turning_table(), sliding_rod(), dropped_chain()]
