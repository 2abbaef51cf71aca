# SPDX-License-Identifier: Apache-2.0
"""Impacts that are transmitted by other contacts: with e = 0 everywhere there is no rebound.

An impulse at one point loads another one that is closed and has no velocity of approach: it must react at once, and with
e = 0 all normal velocities of the island are zero or separating afterwards.
"""
import math

from case import FLOOR, Case, Known, Variant, body, last, model

G = 9.81
ABSOLUTE = (1, 0.5, 0.1, 0.025, 0.005, 0.001)  # 10, 5, 1, 0.25, 0.05, 0.01 ms
CLOSED = "Closed forms give all results."
BAND = 2e-4  # m: two tolerances of 1e-3 of the smallest radius, within which bodies come to rest.


def rises(name):
    """Largest rise after the lowest position [m]."""

    def read(run):
        z = run.probe(name)["z"]
        low = z.index(min(z))
        return max(z[low:]) - z[low]

    return read


def falls_flat():
    """A rod, a wide box and a disc on one edge, tilted by 5 degrees, that fall on the other edge: both edges end at rest.
    Wide bodies do not rock, since the landing loads the first edge."""
    tilt = math.radians(5)
    l, r, b, high = 1.0, 0.02, 0.8, 0.2
    bodies = {**FLOOR, "rod": {"shape": {"capsule": [2 * r, l + 2 * r]}, "mass": 1, "position": [0, 0, r + l / 2 * math.sin(tilt)],
                               "orientation": {"axis": "y", "angle": f"{math.pi / 2 - tilt} rad"}},
              "box": {"shape": {"box": [b, 0.3, high]}, "mass": 1, "position": [0, 3, high / 2 * math.cos(tilt) + b / 2 * math.sin(tilt)], "orientation": {"axis": "y", "angle": f"{tilt} rad"}},
              "disc": {"shape": {"cylinder": [b, high / 2]}, "mass": 1, "position": [0, 6, high / 4 * math.cos(tilt) + b / 2 * math.sin(tilt)], "orientation": {"axis": "y", "angle": f"{tilt} rad"}}}
    known = tuple(Known(f"{name}: comes up after it landed [m]", rises(name), 0, BAND, below=True) for name in ("rod", "box", "disc"))
    return Case("falls_flat", "Bodies that fall flat with e = 0 stay at rest.",
                model("Falls flat", bodies, variables={"mu": 0}, contacts={"default": {"friction": "mu"}}, probes={name: {"body": name} for name in ("rod", "box", "disc")}),
                1e-2, 0.25, tuple(Variant(f"mu {mu}", {"mu": mu}, known) for mu in (0, 0.5)), ABSOLUTE, compare=False, because=CLOSED)


def carried_on():
    """A ball that falls on a box at rest, at its middle and beside it; two boxes and two balls, one on the other, that fall together."""
    ball = {"shape": {"sphere": 0.1}, "mass": 1}
    box = {"shape": {"box": [0.3, 0.3, 0.1]}, "mass": 1}
    big = {"shape": {"sphere": 0.2}, "mass": 1}
    bodies = {**FLOOR, "anvil": {**box, "position": [0, 0, 0.05]}, "hammer": {**ball, "position": [0, 0, 0.2]},
              "low_box": {**box, "position": [0, 2, 0.15]}, "high_box": {"shape": {"box": [0.15, 0.15, 0.1]}, "mass": 1, "position": [0, 2, 0.25]},
              "low_ball": {**big, "position": [0, 4, 0.2]}, "high_ball": {**big, "position": [0, 4, 0.4]}}
    names = [name for name in bodies if name != "floor"]
    stands_on_another = {"hammer", "high_box", "high_ball"}  # the bands of both contacts add
    known = tuple(Known(f"{name}: comes up after it fell [m]", rises(name), 0, (1 + (name in stands_on_another)) * BAND, below=True) for name in names)
    return Case("carried_on", "An impact with e = 0 on a body that rests on the floor or lands at the same time: all stay at rest.",
                model("Carried on", bodies, contacts={"default": {"friction": 0.3}}, probes={name: {"body": name} for name in names}),
                1e-2, 0.2, (Variant("", {}, known),), ABSOLUTE, compare=False, because=CLOSED)


def face_on_face():
    """A box without weight that hits the face of another one with e = 0, in its middle or with its lower edges on the edge of that
    face, as a box on the floor hits a wall on the floor: its energy is lost, and no more."""
    v = 2.0
    bodies = {"wall": {"fixed": True, "shape": {"box": [0.2, 2, 1]}, "position": [0.4, 0, 0]},
              "box": {"shape": {"box": [0.2, 0.2, 0.2]}, "mass": 1, "position": [0, 0, "z"], "velocity": [v, 0, 0]}}
    known = (Known("speed after", last("box", "vx"), 0, 1e-4 * v), Known("energy lost [J]", last("touch", "lost"), v * v / 2, 1e-6))
    return Case("face_on_face", "Box on box, e = 0: ½ m v² is lost.",
                model("Face on face", bodies, gravity=(0, 0, 0), variables={"z": 0}, contacts={}, probes={**body("box"), "touch": {"contact": ["box", "wall"]}}),
                1e-2, 0.12, (Variant("middle", {"z": 0}, known), Variant("edge", {"z": -0.4}, known)), ABSOLUTE, compare=False, because=CLOSED)


def two_stops():
    """Two bars that fall about their hinges. The first rests on its stop at 40 degrees when the second, at 7.9 rad/s relative to it,
    hits its own at 20: that loads the first stop, and with e = 0 both stay closed under their weight."""
    bodies = {"first": {"shape": {"box": [1, 0.05, 0.05]}, "mass": 1, "position": [0.5, 0, 0]}, "second": {"shape": {"box": [1, 0.05, 0.05]}, "mass": 1, "position": [1.5, 0, 0]}}
    joints = {"base": {"type": "revolute", "bodies": ["ground", "first"], "at": [0, 0, 0], "axis": "y", "limits": {"upper": "40 deg", "restitution": 0}},
              "elbow": {"type": "revolute", "bodies": ["first", "second"], "at": [1, 0, 0], "axis": "y", "limits": {"upper": "20 deg", "lower": "-20 deg", "restitution": 0}}}

    def after(joint):
        return lambda run: max(abs(v) for t, v in zip(run.probe(joint)["t"], run.probe(joint)["rate rz"]) if t >= 0.51)

    # They settle a twentieth of the band deep, 5e-5 rad, under their weight, 3/2 g/l cos 60°: √(2 a δ) = 0.027 rad/s at most.
    settling = (2 * 1.5 * G * 0.5 * 0.05e-3) ** 0.5
    known = tuple(Known(f"{joint}: greatest rate from 0.51 s on", after(joint), 0, settling, below=True) for joint in ("base", "elbow"))
    return Case("two_stops", "The stop of one joint carries the impact on that of another: with e = 0 both stay.",
                model("Two stops", bodies, joints=joints, probes={"base": {"joint": "base"}, "elbow": {"joint": "elbow"}}),
                5e-3, 0.6, (Variant("", {}, known),), (1, 0.5, 0.2, 0.05, 0.01), compare=False, because=CLOSED)


CASES = [falls_flat(), carried_on(), face_on_face(), two_stops()]
