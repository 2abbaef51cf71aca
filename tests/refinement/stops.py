# SPDX-License-Identifier: Apache-2.0
"""Stops of joints: impacts, and loads from the start. Restitution is the ratio of speeds by its definition."""
from case import Case, Known, Variant, fall, last, model, rise

ABSOLUTE = (1, 0.5, 0.05, 0.005, 0.0005)  # 20, 10, 1, 0.1, 0.01 ms
SPEED = 2.0
EXACT = 1e-4 * SPEED  # Relative to the approach velocity: a joint's stop is a central impact.


def slider():
    """A slider without gravity; it reaches the stop within a step of 20, 10 and 1 ms."""
    bodies = {"block": {"shape": {"box": [0.2, 0.1, 0.1]}, "mass": 2, "velocity": [SPEED, 0, 0]}}
    joints = {"slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": "x",
                        "limits": {"upper": SPEED * 0.0273, "restitution": "e"}}}
    variants = tuple(Variant(f"e {e}", {"e": e}, (Known("speed after", last("slide", "rate z"), -e * SPEED, EXACT),
                                                  Known("passes the stop [m]", lambda run: max(run.probe("slide")["z"]) - SPEED * 0.0273, 0, 1e-3, below=True)))
                     for e in (0, 0.5, 1))
    return Case("stop_of_slider", "2 m/s before, e 2 m/s after; passes the stop by half of its band at most, 1e-3 of the block.",
                model("Slider on its stop", bodies, gravity=(0, 0, 0), variables={"e": 0}, joints=joints, probes={"slide": {"joint": "slide"}}),
                2e-2, 0.08, variants, ABSOLUTE, compare=False, because="Closed forms give all results.")


def hinge():
    bodies = {"bar": {"shape": {"box": [1, 0.05, 0.05]}, "mass": 3, "position": [0.5, 0, 0], "velocity": [0, 0.5 * SPEED, 0], "angular_velocity": [0, 0, SPEED]}}
    joints = {"hinge": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0], "axis": "z",
                        "limits": {"upper": f"{SPEED * 0.0273} rad", "restitution": "e"}}}
    # At 20 ms the bar turns by 0.04 rad a step: Cayley's rotation rate differs from the angle's by a twelfth of its square.
    variants = tuple(Variant(f"e {e}", {"e": e}, (Known("rate after", last("hinge", "rate rz"), -e * SPEED, lambda h: EXACT + SPEED * (SPEED * h) ** 2 / 12),)) for e in (0, 0.5, 1))
    return Case("stop_of_hinge", "2 rad/s before, e 2 rad/s after.",
                model("Hinge on its stop", bodies, gravity=(0, 0, 0), variables={"e": 0}, joints=joints, probes={"hinge": {"joint": "hinge"}}),
                2e-2, 0.08, variants, ABSOLUTE, compare=False, because="Closed forms give all results.")


def chain():
    """The stop between two bars in a line: with e = 0 they continue as one body."""
    mass, length, width, omega = 1.0, 1.0, 0.05, 2.0
    start = -omega * 0.0273  # The second bar starts slightly before the straight position.
    bodies = {"first": {"shape": {"box": [length, width, width]}, "mass": mass, "position": [length / 2, 0, 0]},
              "second": {"shape": {"box": [length, width, width]}, "mass": mass,
                         "position": [f"{length} + {length / 2}*cos({start})", f"{length / 2}*sin({start})", 0],
                         "orientation": {"axis": "z", "angle": f"{start} rad"}, "angular_velocity": [0, 0, omega],
                         "velocity": [f"{-omega * length / 2}*sin({start})", f"{omega * length / 2}*cos({start})", 0]}}
    joints = {"base": {"type": "revolute", "bodies": ["ground", "first"], "at": [0, 0, 0], "axis": "z"},
              "elbow": {"type": "revolute", "bodies": ["first", "second"], "at": [length, 0, 0], "axis": "z", "limits": {"upper": f"{-start} rad", "restitution": 0}}}
    known = (Known("rate of the elbow after", last("elbow", "rate rz"), 0, EXACT),)
    return Case("stop_of_elbow", "The second of two bars hits its stop with e = 0: the bars continue as one body.",
                model("Elbow on its stop", bodies, gravity=(0, 0, 0), joints=joints, probes={"elbow": {"joint": "elbow"}, "base": {"joint": "base"}}),
                2e-2, 0.1, (Variant("", {}, known),), ABSOLUTE, skip=("elbow.impulses", "base.impulses", "elbow.speeds", "base.speeds"),
                because="Reactions at an instant do not contain the impulse of a stop; a step of 20 ms does not resolve the time at which speeds jump.")


def starts_at_stop():
    bodies = {"block": {"shape": {"box": [0.1, 0.1, 0.2]}, "mass": 2}, "bar": {"shape": {"box": [1, 0.05, 0.05]}, "mass": 3, "position": [0.5, 1, 0]}}
    joints = {"slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": "z", "limits": {"lower": 0, "restitution": "e"}},
              "hinge": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 1, 0], "axis": "-y", "limits": {"lower": "0 rad", "restitution": "e"}}}
    known = (Known("slider rises [m]", rise("slide", "z"), 0, 1e-6, below=True), Known("slider sinks [m]", fall("slide", "z"), 0, 1e-4, below=True),
             Known("hinge rises [rad]", rise("hinge", "rz"), 0, 1e-6, below=True), Known("hinge sinks [rad]", fall("hinge", "rz"), 0, 5e-4, below=True),
             )
    # At 20 ms the bar is still settling into the twentieth of its band that carries it.
    still = (Known("slider's rate at the end", last("slide", "rate z"), 0, 1e-4),
             Known("hinge's rate at the end", last("hinge", "rate rz"), 0, lambda h: 1e-4 if h < 0.02 else 5e-4))
    return Case("starts_at_its_stop", "Slider and bar lie on their stops under gravity: neither rises by more than 1e-6, nor sinks by more than half a band; "
                "with e < 1 they come to rest.",
                model("Starts at its stop", bodies, variables={"e": 0}, joints=joints, probes={"slide": {"joint": "slide"}, "hinge": {"joint": "hinge"}}),
                2e-2, 0.2, tuple(Variant(f"e {e}", {"e": e}, known + (still if e < 1 else ())) for e in (0, 0.5, 1)), ABSOLUTE, compare=False, because="It is at rest.")


CASES = [slider(), hinge(), chain(), starts_at_stop()]
