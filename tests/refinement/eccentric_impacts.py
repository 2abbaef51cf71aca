# SPDX-License-Identifier: Apache-2.0
"""Eccentric impacts of rods, boxes and capsules at one point, at 2 m/s, without gravity.

Without friction the impulse is p = (1 + e) w/(n·K n), K the sum of both bodies' mobilities at the point
(tools/references/routh_impact.py); with friction the script integrates Routh's equations. Within the step of the impact a
body turns by up to ω h, and so does the arm of its point: results differ by order h, and are exact where a step resolves
the impact.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "references"))
from case import FLOOR, Case, Known, Variant, body, last, model, spin_y  # noqa: E402
from central_impacts import chain_compliance  # noqa: E402
from routh_impact import cross, dot, impact, inverse, mobility, rotation, times, turned  # noqa: E402

W = 2.0  # m/s of approach
GAP = W * 0.0137  # An impact after 13.7 ms: within a step of 10, 5 and 1 ms.
EXACT = 1e-4 * W
ABSOLUTE = (1, 0.5, 0.1, 0.01, 0.001)  # 10, 5, 1, 0.1, 0.01 ms
SHORT = {1: 0.03, 0.5: 0.02, 0.1: 0.016, 0.01: 0.0139, 0.001: 0.0138}  # An impact takes two steps; with e = 0 bodies that turn together touch again later.
RESTITUTIONS = (0, 0.3, 0.7, 1)
CLOSED = "Closed forms give all results."


class Solid:
    """A box or capsule of 1 kg, rotated by an angle about an axis: its lowest point, and the effect of an impulse there."""

    mass = 1.0

    def __init__(self, shape, axis, angle):
        self.axis, self.angle, self.R = list(axis), angle, rotation(axis, angle)
        if shape[0] == "box":
            a, b, c = shape[1]
            self.shape = {"box": [a, b, c]}
            self.moments = [(b * b + c * c) / 12, (a * a + c * c) / 12, (a * a + b * b) / 12]
            r = 1e-3 * min(a, b, c) / 2  # Corners are rounded by 1e-3 of the smallest half size.
            corners = [times(self.R, [i * (a / 2 - r), 0 if axis == (0, 1, 0) else j * (b / 2 - r), k * (c / 2 - r)])
                       for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
            self.arm = min(corners, key=lambda corner: corner[2])
            self.arm[2] -= r
        else:
            thick, over_all = shape[1]  # Along z of the body.
            r, long = thick / 2, over_all - thick
            self.shape = {"capsule": [thick, over_all]}
            volume = (math.pi * r * r * long, 4 / 3 * math.pi * r**3)
            cylinder, ball = (v / sum(volume) for v in volume)
            across = cylinder * (r * r / 4 + long * long / 12) + ball * (0.4 * r * r + long * long / 4 + 0.375 * long * r)
            self.moments = [across, across, cylinder * r * r / 2 + ball * 0.4 * r * r]
            end = times(self.R, [0, 0, long / 2])
            self.arm = [(-x if end[2] > 0 else x) for x in end]
            self.arm[2] -= r
        self.J = turned(self.R, self.moments)
        self.K = mobility(self.mass, self.J, self.arm)

    def lowered(self, point, velocity=(0, 0, -W), **more):
        """The body as an entry of a model, its lowest point `GAP` above a point."""
        return {"shape": self.shape, "mass": self.mass, "inertia": self.moments,
                "position": [p - a for p, a in zip((point[0], point[1], point[2] + GAP), self.arm)],
                "orientation": {"axis": self.axis, "angle": f"{self.angle} deg"}, "velocity": list(velocity), **more}

    def spin(self, impulse):
        return times(inverse(self.J), cross(self.arm, impulse))

    def turning(self, impulse):
        """Relative change of n·K n per second by the spin that an impulse causes."""
        return math.sqrt(dot(self.spin(impulse), self.spin(impulse)))


SOLIDS = {"rod_on_edge": Solid(("box", (1, 0.1, 0.1)), (0, 1, 0), 20), "steep_rod": Solid(("box", (1, 0.1, 0.1)), (0, 1, 0), 70),
          "rod_on_corner": Solid(("box", (1, 0.1, 0.1)), (1, 3, 0), 40), "box_on_edge": Solid(("box", (0.4, 0.3, 0.2)), (0, 1, 0), 30),
          "box_on_corner": Solid(("box", (0.4, 0.3, 0.2)), (1, 2, 0), 30), "capsule": Solid(("capsule", (0.1, 0.6)), (0, 1, 0), 50)}
FLAT = ("rod_on_edge", "steep_rod", "box_on_edge", "capsule")  # Shapes that rotate about y only.


def smooth(name, e, more=0.0, turns=0.0):
    """Known numbers of a body in an impact without friction: `more` is the other body's part of n·K n, `turns` the
    other body's angular velocity by a unit impulse."""
    solid = SOLIDS[name]
    p = (1 + e) * W / (solid.K[2][2] + more)
    P = [0, 0, p]
    slack = solid.turning(P) + p * turns
    known = [Known(f"{name}: vz after", last(name, "vz"), -W + p / solid.mass, lambda h: EXACT + p * slack * h)]
    if name in FLAT:
        spin = solid.spin(P)[1]
        known.append(Known(f"{name}: spin after", spin_y(name, name + "_x"), spin, lambda h: (EXACT + p * slack * h) * abs(spin) / p))
    return known


def case(title, about, bodies, known, names, **sections):
    """Variants without friction for all restitutions; known(e) returns their known numbers."""
    contacts = {"default": {"restitution": "e"}, **sections.pop("contacts", {})}
    probes = {key: probe for name in names for key, probe in body(name).items()}
    return Case(title.lower().replace(" ", "_"), about,
                model(title, bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts=contacts, probes=probes, **sections),
                1e-2, 0.024, tuple(Variant(f"e {e}", {"e": e}, tuple(known(e))) for e in RESTITUTIONS), ABSOLUTE,
                spans=SHORT, compare=False, because=CLOSED)


def on_floor():
    bodies = dict(FLOOR)
    for i, (name, solid) in enumerate(SOLIDS.items()):
        bodies[name] = solid.lowered((0, 3 * i, 0))
    return case("Corners on floor", "Rods, boxes and a capsule, on an edge, a corner, an end: p = (1 + e) w/(n·K n).",
                bodies, lambda e: [known for name in SOLIDS for known in smooth(name, e)], SOLIDS)


def on_free_plates():
    """Impacts on the faces of free plates, 0.15 m beside their centres."""
    a, thick, mass, beside = 0.6, 0.1, 2.0, 0.15
    moments = [mass * (a * a + thick * thick) / 12] * 2 + [mass * a * a / 6]
    K = mobility(mass, turned(rotation((0, 0, 1), 0), moments), [beside, 0, thick / 2])
    names, bodies = ("rod_on_edge", "box_on_corner", "capsule"), {}
    for i, name in enumerate(names):
        bodies[name] = SOLIDS[name].lowered((beside, 3 * i, thick / 2))
        bodies[name + "_plate"] = {"shape": {"box": [a, a, thick]}, "mass": mass, "position": [0, 3 * i, 0]}

    def known(e):
        for name in names:
            p = (1 + e) * W / (SOLIDS[name].K[2][2] + K[2][2])
            turns = beside / moments[0]
            yield from smooth(name, e, K[2][2], turns)
            slack = p * turns + SOLIDS[name].turning([0, 0, p])
            yield Known(f"{name}: vz of the plate", last(name + "_plate", "vz"), -p / mass, lambda h, p=p, slack=slack: EXACT + p * slack * h)

    return case("Corners on free plates", "The same against free plates, beside their centres: n·K n is the sum of both.",
                bodies, known, (*names, *(name + "_plate" for name in names)))


def on_hinged_plates():
    length, thick, mass, reach = 1.0, 0.04, 2.0, 0.8
    inertia = mass * (length**2 + thick**2) / 12 + mass * length**2 / 4
    names, bodies, joints = ("rod_on_edge", "box_on_corner", "capsule"), {}, {}
    for i, name in enumerate(names):
        bodies[name] = SOLIDS[name].lowered((reach, 3 * i, thick / 2))
        bodies[name + "_plate"] = {"shape": {"box": [length, 0.2, thick]}, "mass": mass, "position": [length / 2, 3 * i, 0]}
        joints[name + "_hinge"] = {"type": "revolute", "bodies": ["ground", name + "_plate"], "at": [0, 3 * i, 0], "axis": "y"}
    return case("Corners on hinged plates", "The same against plates on hinges: a²/J is added, J about the hinge.",
                bodies, lambda e: [k for name in names for k in smooth(name, e, reach**2 / inertia, reach / inertia)], names, joints=joints)


def on_chain():
    count, length, thick, mass, place = 3, 0.5, 0.04, 1.0, 1.45
    inertia = mass * (length**2 + thick**2) / 12
    more = chain_compliance(count, length, mass, inertia, place)
    names, bodies, joints, exclude = ("rod_on_edge", "capsule"), {}, {}, []
    for k, name in enumerate(names):
        bodies[name] = SOLIDS[name].lowered((place, 3 * k, thick / 2))
        links = [f"{name}_link_{i}" for i in range(count)]
        exclude.append([links[0], links[2]])
        for i, link in enumerate(links):
            bodies[link] = {"shape": {"box": [length, 0.2, thick]}, "mass": mass, "position": [(i + 0.5) * length, 3 * k, 0]}
            joints[f"{name}_hinge_{i}"] = {"type": "revolute", "bodies": [links[i - 1] if i else "ground", link], "at": [i * length, 3 * k, 0], "axis": "y"}
    # The last link has the largest rotation: with a free end a unit impulse gives it 6/(m l) or less.
    return case("Corners on chains", "The same near the end of three hinged links in a line; their compliance by elimination.",
                bodies, lambda e: [k for name in names for k in smooth(name, e, more, 6 / (mass * length))], names, joints=joints, contacts={"exclude": exclude})


def upright_capsule():
    """A central impact: friction cannot change the normal impulse. A unit of it ends 1/m + a²/J of slip, a to the centre."""
    solid, slip = Solid(("capsule", (0.1, 0.6)), (0, 1, 0), 0), 3.0
    variants = []
    for e in RESTITUTIONS:
        for mu in (0, 0.1, 0.5):
            p = (1 + e) * W * solid.mass
            P = min(mu * p, slip / solid.K[0][0])
            spin = solid.spin([-P, 0, 0])[1]
            # The end is round: while it turns by ω h its lowest point moves by that part of its radius.
            slack = abs(spin) * (p + P)
            known = (Known("vz after", last("capsule", "vz"), e * W, lambda h, s=slack: EXACT + s * h), Known("vx after", last("capsule", "vx"), slip - P, lambda h, s=slack: EXACT + s * h),
                     Known("spin after", spin_y("capsule", "capsule_x"), spin, lambda h, s=slack: (EXACT + s * h) * 0.3 / solid.moments[0]))
            variants.append(Variant(f"e {e}, mu {mu}", {"e": e, "mu": mu}, known))
    return Case("upright_capsule", "Rebound with e w; friction μp, or the impulse that ends the slip of 3 m/s: 1/(1/m + a²/J) of it.",
                model("Upright capsule", {**FLOOR, "capsule": solid.lowered((0, 0, 0), (slip, 0, -W))}, gravity=(0, 0, 0), variables={"e": 0, "mu": 0},
                      contacts={"default": {"restitution": "e", "friction": "mu"}}, probes=body("capsule")),
                1e-2, 0.024, tuple(variants), ABSOLUTE, spans=SHORT, compare=False, because=CLOSED)


SLIPS = {"rod_on_edge": (-1, 0), "steep_rod": (1, 0), "rod_on_corner": (1, 0.5), "box_on_edge": (1, 0), "box_on_corner": (-0.5, 1), "capsule": (-1, 0)}
WITHIN = {"steep_rod": 10}


def rough(title, about, names, on_plates, turning=1):
    """With friction, against Routh's equations with Stronge's restitution, on the floor or on free plates.

    Within the step of the impact the body turns by the spin it leaves with, once for the impulse's place and once for its
    direction: `turning` times as much as a frictionless one. That of the steep rod passes near its
    centre, so that its final spin is no bound: it needs up to nine times as much.
    """
    a, thick, mass, beside = 0.6, 0.1, 2.0, 0.15
    moments = [mass * (a * a + thick * thick) / 12] * 2 + [mass * a * a / 6]
    plate = mobility(mass, turned(rotation((0, 0, 1), 0), moments), [beside, 0, thick / 2])
    bodies = {} if on_plates else dict(FLOOR)
    for i, name in enumerate(names):
        slid = SLIPS[name][0] * GAP / W  # Displacement during the approach.
        place = (beside - slid, 3 * i, thick / 2) if on_plates else (0, 3 * i, 0)
        bodies[name] = SOLIDS[name].lowered(place, (*SLIPS[name], -W))
        if on_plates:
            bodies[name + "_plate"] = {"shape": {"box": [a, a, thick]}, "mass": mass, "inertia": moments, "position": [0, 3 * i, 0]}

    def variants():
        for e in RESTITUTIONS:
            for mu in (0.1, 0.5):
                known = []
                for name in names:
                    solid, before = SOLIDS[name], (*SLIPS[name], -W)
                    K = [[x + y for x, y in zip(*row)] for row in zip(solid.K, plate)] if on_plates else solid.K
                    found = impact(K, before, mu, e)
                    size = math.sqrt(dot(found.impulse, found.impulse))
                    slack = (solid.turning(found.impulse) + (beside + thick / 2) * size / moments[0] * on_plates) * size * WITHIN.get(name, turning)
                    known += [Known(f"{name}: v{axis} after, {found.mode}", last(name, "v" + axis), v + found.impulse[k] / solid.mass, lambda h, s=slack: EXACT + s * h)
                              for k, (axis, v) in enumerate(zip("xyz", before)) if k != 1 or name not in FLAT]
                yield Variant(f"e {e}, mu {mu}", {"e": e, "mu": mu}, tuple(known))

    return Case(title.lower().replace(" ", "_"), about,
                model(title, bodies, gravity=(0, 0, 0), variables={"e": 0, "mu": 0}, contacts={"default": {"restitution": "e", "friction": "mu"}}, probes={name: {"body": name} for name in names}),
                1e-2, 0.024, variants, ABSOLUTE, spans=SHORT, compare=False, because=CLOSED)


IN_SPACE = tuple(name for name in SOLIDS if name not in FLAT)
CASES = [on_floor(), on_free_plates(), on_hinged_plates(), on_chain(), upright_capsule(),
         rough("Rough edges on floor", "Impacts in a plane with friction: Routh's equations of slip with Stronge's restitution.", FLAT, False, 3),
         rough("Rough capsule on plate", "The same on a free plate, sliding from first to last: there all laws of restitution agree.", ("capsule",), True),
         rough("Rough rod on plate", "A rod that sticks, or slips back, on a free plate.", ("rod_on_edge",), True, 3),
         rough("Rough corners on floor", "Impacts in space with friction: slip turns while it lasts.", IN_SPACE, False, 6)]
