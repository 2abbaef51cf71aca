# SPDX-License-Identifier: Apache-2.0
"""Contacts that are rows of the step, `law: rigid`: exact at every step, so all bounds are of round-off.

Without slip that stops or turns within an impact, its law is Newton's, and steps of any length give the same velocities.
"""
import math

from case import FLOOR, Case, Known, Variant, body, last, model

ABSOLUTE = (1, 0.1, 0.01, 0.001)  # 10, 1, 0.1, 0.01 ms
FEWER = (1, 0.1, 0.01)
R, W = 0.1, 2.0  # m, m/s of approach
ROUND_OFF = 1e-12


def rows(**more):
    return {"default": {"law": "rigid", **more}}


def on_floor():
    """A ball slides or sticks where it lands: the friction impulse is μp, or what ends the slip, 2/7 of it."""
    slip = 3.0
    variants = []
    for e in (0, 0.3, 0.7, 1):
        for mu in (0, 0.1, 0.5):
            impulse = min(mu * (1 + e) * W, slip / 3.5)
            variants.append(Variant(f"e {e}, mu {mu}", {"e": e, "mu": mu},
                                    (Known("vz after", last("ball", "vz"), e * W, ROUND_OFF * W), Known("vx after", last("ball", "vx"), slip - impulse, ROUND_OFF * slip))))
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * R}, "mass": 1, "position": [0, 0, R + 0.0274], "velocity": [slip, 0, -W]}}
    return Case("rigid_ball_on_floor", "Leaves with e w; slides: vx - μ(1 + e) w; sticks: 5/7 vx.",
                model("Ball on the floor", bodies, gravity=(0, 0, 0), variables={"e": 0, "mu": 0}, contacts=rows(restitution="e", friction="mu"), probes=body("ball")),
                1e-2, 0.06, tuple(variants), ABSOLUTE, compare=False, because="Closed forms give all results.")


def bat():
    """A wall on a drive of 1 m/s hits a ball at rest."""
    bodies = {"wall": {"shape": {"box": [0.1, 1, 1]}, "mass": 5, "position": [-0.05, 0, 0], "velocity": [1, 0, 0],
                       "motion": {"x": "t", "y": 0, "z": 0, "rotation_vector": [0, 0, 0]}},
              "ball": {"shape": {"sphere": 2 * R}, "mass": 1, "position": [R + 0.0274, 0, 0]}}
    variants = tuple(Variant(f"e {e}", {"e": e}, (Known("speed of the ball", last("ball", "vx"), 1 + e, ROUND_OFF),)) for e in (0, 0.5, 1))
    return Case("rigid_bat", "A driven wall returns 1 + e times its speed: the drive does the work.",
                model("Bat", bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts=rows(restitution="e"), probes=body("ball")),
                1e-2, 0.06, variants, ABSOLUTE, compare=False, because="Closed forms give all results.")


def cradle():
    """Four balls that touch: Newton's law for all of them at once, whatever the step."""
    bodies = {f"b{i}": {"shape": {"sphere": 0.1}, "mass": 0.5, "position": [0.1 * i, 0, 0]} for i in range(1, 5)}
    bodies["b0"] = {"shape": {"sphere": 0.1}, "mass": 0.5, "position": [-0.0023, 0, 0], "velocity": [1, 0, 0]}
    known = (Known("speed of the first", last("b0", "vx"), -0.6, 1e-11), *(Known(f"speed of ball {i}", last(f"b{i}", "vx"), 0.4, 1e-11) for i in range(1, 5)))
    probes = {}
    for i in range(5):
        probes.update(body(f"b{i}"))
    return Case("rigid_cradle", "A ball hits four that touch, e = 1: -0.6 and four times 0.4 of its speed.",
                model("Cradle", bodies, gravity=(0, 0, 0), contacts=rows(restitution=1), probes=probes),
                1e-2, 0.04, (Variant("", {}, known),), ABSOLUTE, compare=False, because="Closed forms give all results.")


def pressed_light_block():
    """1 g under 100 N, pulled with 10 N, which friction of up to 30 N holds."""
    bodies = {**FLOOR, "b": {"shape": {"box": [0.02, 0.02, 0.02]}, "mass": 0.001, "position": [0, 0, 0.01]}}
    loads = {"pull": {"type": "force", "body": "b", "force": ["10*min(t/0.05, 1)", 0, -100]}}
    known = (Known("creeps [m]", last("b", "x"), 0, 1e-12), Known("sinks [m]", last("b", "z"), 0.01, 1e-12))
    return Case("rigid_pressed_light_block", "A block that friction holds does not move at all.",
                model("Pressed light block", bodies, loads=loads, contacts=rows(friction=0.3), probes=body("b")),
                1e-2, 0.2, (Variant("", {}, known),), FEWER, compare=False, because="It is at rest.")


def incline():
    """A box dropped by 0.1 mm on an incline of 0.9 of the limit stops dead; above the limit it slides with g (sin - μ cos)."""
    mu, g = 0.4, 9.81
    bodies = {**FLOOR, "box": {"shape": {"box": [0.2, 0.2, 0.1]}, "mass": 2, "position": [0, 0, "0.05 + drop"]}}
    variants = []
    for f, e, drop in ((0.9, 0, 0), (0.999, 0, 0), (0.9, 0.5, 1e-4)):
        variants.append(Variant(f"{f} of the limit, e {e}, drop {drop}", {"f": f, "e": e, "drop": drop},
                                (Known("speed at the end", last("box", "vx"), 0, ROUND_OFF), Known("height at the end", last("box", "z"), 0.05, ROUND_OFF))))
    a = g * (math.sin(math.atan(1.001 * mu)) - mu * math.cos(math.atan(1.001 * mu)))
    variants.append(Variant("1.001 of the limit", {"f": 1.001, "e": 0, "drop": 0}, (Known("speed at the end", last("box", "vx"), a, lambda h: a * h + ROUND_OFF),)))
    return Case("rigid_incline", "At rest below the limit, exactly; slides above it.",
                model("Box on an incline", bodies, gravity=("9.81*sin(atan(f*0.4))", 0, "-9.81*cos(atan(f*0.4))"), variables={"f": 0.9, "e": 0, "drop": 0},
                      contacts=rows(friction=mu, restitution="e"), probes=body("box")),
                1e-2, 1.0, tuple(variants), (1, 0.1), compare=False, because="Closed forms give all results.")


def heavy_on_light():
    """A box of 100 kg falls by 1 cm on three of 1 kg that stand on each other."""
    bodies = {**FLOOR, **{f"b{i}": {"shape": {"box": [0.2, 0.2, 0.1]}, "mass": 1, "position": [0, 0, 0.05 + 0.1 * i]} for i in range(3)},
              "top": {"shape": {"box": [0.2, 0.2, 0.1]}, "mass": 100, "position": [0, 0, 0.36]}}
    known = (Known("height of the top", last("top", "z"), 0.35, 1e-11), Known("its speed", last("top", "vz"), 0, 1e-10), Known("height of the lowest", last("b0", "z"), 0.05, 1e-11))
    return Case("rigid_heavy_on_light", "Rests on the stack at gaps of zero.",
                model("Heavy box on light ones", bodies, contacts=rows(friction=0.4), probes={**body("b0"), **body("top")}),
                1e-2, 0.1, (Variant("", {}, known),), (1, 0.5, 0.1), compare=False, because="It is at rest.")


CASES = [on_floor(), bat(), cradle(), pressed_light_block(), incline(), heavy_on_light()]
