# SPDX-License-Identifier: Apache-2.0
"""Bodies placed on an incline, with default settings except for friction: they stick, slide or roll as in elementary mechanics."""
import math

from case import Case, Known, Variant, model

G = 9.81
R = 0.1  # Half height or radius [m].
MASS = 2
TILT = math.radians(30)
STEPS = (1, 0.5, 0.1, 0.01)  # 10, 5, 1, 0.1 ms
CLOSED = "Closed forms give all results."
BAND = 1e-3 * R
NORMAL, ALONG = (math.sin(TILT), 0, math.cos(TILT)), (math.cos(TILT), 0, -math.sin(TILT))
STANDS = ("box", "puck")
# Moment of inertia over m r² of shapes that roll.
ROLLS = {"ball": 2 / 5, "cylinder": 1 / 2, "capsule": 0.45}
SHAPES = {"box": {"box": [0.4, 0.4, 2 * R]}, "puck": {"cylinder": [0.4, 2 * R]}, "ball": {"sphere": 2 * R},
          "cylinder": {"cylinder": [2 * R, 0.3]}, "capsule": {"capsule": [2 * R, 0.4]}}


def way(name):
    """Displacement down the incline at the end."""

    def read(run):
        table = run.probe(name)
        return sum((table[c][-1] - table[c][0]) * n for c, n in zip("xyz", ALONG))

    return read


def speed(name):
    """Speed down the incline at the end."""
    return lambda run: sum(run.probe(name)["v" + c][-1] * n for c, n in zip("xyz", ALONG))


def spin(name):
    """Angular velocity about y at the end."""
    return lambda run: run.probe(name)["wy"][-1]


def off(name):
    """Distance of the lowest point from the incline, above or below, over the band."""

    def read(run):
        table = run.probe(name)
        return max(abs(x * NORMAL[0] + z * NORMAL[2] - R) for x, z in zip(table["x"], table["z"])) / BAND

    return read


def creeps(name, after, unit=1.0):
    """Largest displacement from the position at a time on."""

    def read(run):
        t = run.probe(name)
        rows = [row[1:] for row in zip(t["t"], t["x"], t["y"], t["z"]) if row[0] >= after - 1e-9]
        return max(math.dist(row, rows[0]) for row in rows) / unit

    return read


def laid(friction, **law):
    """All shapes side by side on the incline, gap 0, at rest."""
    bodies = {"incline": {"fixed": True, "shape": {"plane": list(NORMAL)}}}
    for i, (name, shape) in enumerate(SHAPES.items()):
        bodies[name] = {"shape": dict(shape), "mass": MASS, "position": [R * NORMAL[0], 0.6 * i, R * NORMAL[2]],
                        "orientation": {"axis": "y", "angle": f"{TILT!r} rad"}}
        if name in ("cylinder", "capsule"):  # Its axis is the body's y.
            bodies[name]["shape"]["orientation"] = {"axis": "x", "angle": "90 deg"}
        if name in ROLLS:
            bodies[name]["inertia"] = [MASS * 0.02, MASS * ROLLS[name] * R * R, MASS * 0.02]
    return model("Incline", bodies, contacts={"default": {"friction": friction, **law}},
                 probes={name: {"body": name, "angular": True} for name in SHAPES})


def known_of(mu, span):
    """Displacement, speed and spin of all shapes after their release, with a coefficient below the tangent."""
    found = []
    for name in SHAPES:
        a, w = G * (math.sin(TILT) - mu * math.cos(TILT)), 0.0
        if name in ROLLS:
            k = ROLLS[name]
            if mu >= math.tan(TILT) * k / (1 + k):
                a = G * math.sin(TILT) / (1 + k)
                w = a / R
            else:
                w = mu * G * math.cos(TILT) / (k * R)
        found += [Known(f"{name}: speed down", speed(name), a * span, 1e-3 * a * span),
                  Known(f"{name}: way down [m]", way(name), a * span**2 / 2, 1e-3 * a * span**2 / 2),
                  Known(f"{name}: off the incline, of its band", off(name), 0, 0.15, below=True)]
        if name in ROLLS:
            found.append(Known(f"{name}: spin", spin(name), w * span, 1e-3 * w * span + 1e-9))
    return tuple(found)


def moves():
    span = 0.5
    built = laid("mu")
    built["variables"] = {"mu": 0}
    variants = tuple(Variant(f"mu {mu}", {"mu": mu}, known_of(mu, span)) for mu in (0, 0.1, 0.3, 0.5))
    return Case("incline_slides_and_rolls",
                "Slides with g (sin α - μ cos α), rolls with g sin α/(1 + I/(m r²)): 5/7 g sin α for a ball.",
                built, 1e-2, span, variants, STEPS, compare=False, because=CLOSED)


def sticks():
    span, known = 1.0, []
    for name in STANDS:
        known += [Known(f"{name}: creeps after 0.2 s [m]", creeps(name, 0.2), 0, 1e-8, below=True),
                  Known(f"{name}: gives way by, of its band", creeps(name, 0, BAND), 0, 0.5, below=True)]
    slide = G * (math.sin(TILT) - 0.5 * math.cos(TILT)) * span
    built = laid("mu", static_friction="most")
    built["variables"] = {"mu": 0.6, "most": 0.6}
    variants = [Variant(f"mu {mu}, static {most}", {"mu": mu, "most": most}, tuple(known))
                for mu, most in ((0.6, 0.6), (0.5, 0.6))]
    # Normal forces oscillate while a body settles in the band: within 4 % of the bound it may slip instead of sticking, and
    # stick some 30 ms longer before it slides.
    variants.append(Variant("mu 0.5, static 0.565", {"mu": 0.5, "most": 0.565},
                            tuple(Known(f"{name}: speed down", speed(name), slide, 0.04 * slide) for name in STANDS)))
    return Case("incline_sticks", "Below static friction it stays where it was laid, without creep; above it slides.",
                built, 1e-2, span, tuple(variants), STEPS, compare=False, because=CLOSED)


CASES = [moves(), sticks()]
