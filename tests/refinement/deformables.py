# SPDX-License-Identifier: Apache-2.0
"""Deformable solids and cables in contact from the start, or falling: no rebound from rest, and convergence of the falls."""
from case import FLOOR, Case, Known, Variant, fall, largest, last, model, rise

G = 9.81
STILL = "At rest apart from small vibrations."
RUBBER = {"rubber": {"type": "neo_hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000, "viscosity": {"shear": 100}}}
EDGE = 0.05


def block(height, **more):
    """A cube of 0.1 m, twice as wide as its elements."""
    return {"mesh": {"block": {"size": [0.1, 0.1, 0.1], "cells": [2, 2, 2]}, "position": [0, 0, height]}, "material": "rubber", **more}


def solid_touches_at_start():
    """A block placed with gap 0. Its top sinks by at most twice ρ g L²/(2E), the value of a bar."""
    sinks = 1000 * G * 0.1**2 / 2e6
    known = (Known("bottom rises [m]", rise("bottom", "z"), 0, 1e-6, below=True),
             Known("top rises [m]", rise("top", "z"), 0, 1e-6, below=True),
             Known("bottom sinks, of its band", lambda run: fall("bottom", "z")(run) / (1e-3 * EDGE), 0, 0.25, below=True),
             Known("top sinks [m]", fall("top", "z"), 2 * sinks, 0.15 * 2 * sinks, below=True))
    return Case("solid_touches_at_start", "A block of rubber on the floor: it does not leave the floor, its top oscillates about ρ g L²/(2E) below its start.",
                model("Rubber on the floor", FLOOR, contacts={}, materials=RUBBER, solids={"block": block(0.05)},
                      probes={"bottom": {"solid": "block", "point": [0, 0, -0.05]}, "top": {"solid": "block", "point": [0, 0, 0.05]}}),
                5e-3, 0.1, (Variant("", {}, known),), (1, 0.2, 0.02, 0.01), compare=False, because=STILL)


def solids_touch_at_start():
    """Two blocks at the smallest admissible initial distance."""
    start = 0.7e-3 * EDGE
    known = (Known("upper rises [m]", rise("upper", "z"), 0, 2e-6, below=True), Known("upper sinks [m]", fall("upper", "z"), 0, 4.5e-4, below=True))
    return Case("solids_touch_at_start", "Two blocks of rubber on each other: the upper one does not rise.",
                model("Rubber on rubber", FLOOR, contacts={}, materials=RUBBER, solids={"below": block(0.05), "above": block(0.15 + start)},
                      probes={"upper": {"solid": "above", "point": [0, 0, 0.05]}}),
                5e-3, 0.05, (Variant("", {}, known),), (1, 0.2, 0.04), compare=False, because=STILL + " Shorter steps take minutes.")


def cable_touches_at_start():
    """A cable that lies on the floor, attached to two light pegs."""
    r = 5e-3
    bodies = {**FLOOR}
    for name, x in (("left", 0), ("right", 1)):
        bodies[name] = {"mass": 1e-3, "inertia": [1e-8, 1e-8, 1e-8], "position": [x, 0, r], "shape": {"sphere": 2 * r}}
    probes = {"rope": {"contact": ["rope", "floor"]}, "left": {"body": "left"}}
    known = (Known("cable rises [m]", lambda run: max(run.probe("rope")["gap"]), 0, 1e-6, below=True), Known("cable sinks, of its radius", lambda run: -min(run.probe("rope")["gap"]) / r, 0, 1e-3, below=True),
             Known("peg rises [m]", rise("left", "z"), 0, 1e-6, below=True))
    return Case("cable_touches_at_start", "A rope on the floor between two pegs: none of them rises.",
                model("Rope on the floor", bodies, contacts={}, probes=probes,
                      cables={"rope": {"through": [["left"], ["right"]], "stiffness": 1e4, "mass_per_length": 0.1, "elements": 10, "contact": {"radius": r}}}),
                5e-3, 0.1, (Variant("", {}, known),), (1, 0.2, 0.02, 0.002), compare=False, because=STILL)


def touch_in_space():
    """Solids, cables and shapes in contact at the start, without weight: they stay at rest."""
    r, R, apart = 5e-3, 0.05, 0.7e-3 * 0.1
    peg = {"mass": 1e-3, "inertia": [1e-8, 1e-8, 1e-8]}
    cable = {"stiffness": 1e4, "mass_per_length": 0.1, "elements": 10, "contact": {"radius": r}}
    # A distant moving body gives the energy a scale.
    bodies, cables = {"ball": {"shape": {"sphere": 2 * R}, "mass": 1}, "away": {**peg, "position": [0, 9, 0], "velocity": [1, 0, 0]}}, {}
    for name, y, z, along in (("on_ball", 0, R + r, 0), ("on_block", 2, R + r, 0), ("low", 4, 0, 0), ("high", 4, 2 * r, 1)):
        for end, way in (("a", -0.5), ("b", 0.5)):
            bodies[f"{name}_{end}"] = {**peg, "position": [0 if along else way, y + way if along else y, z]}
        cables[name] = {**cable, "through": [[f"{name}_a"], [f"{name}_b"]]}
    solids = {name: {"mesh": {"block": {"size": [0.1, 0.1, 0.1], "cells": [1, 1, 1]}, "position": [0, y, z]}, "material": "rubber"}
              for name, y, z in (("block", 2, 0), ("below", 6, 0), ("above", 6, 0.1 + apart))}
    pairs = {"ball": ["on_ball", "ball"], "block": ["on_block", "block"], "cables": ["low", "high"], "solids": ["above", "below"]}
    moves = lambda probe: lambda run: max(abs(g - run.probe(probe)["gap"][0]) for g in run.probe(probe)["gap"])  # noqa: E731
    known = tuple(Known(f"gap changes, {name} [m]", moves(name), 0, 1e-9, below=True) for name in pairs)
    return Case("touch_in_space", "Cables on a ball, a solid and a cable, and solids on each other, all touching: they stay at rest.",
                model("Touch in space", bodies, gravity=(0, 0, 0), contacts={}, materials=RUBBER, solids=solids, cables=cables, probes={name: {"contact": pair} for name, pair in pairs.items()}),
                1e-3, 2e-3, (Variant("", {}, known),), (1, 0.1, 0.02), compare=False, because="The expected state is rest.")


def rope_falls():
    """A straight rope hits the floor flat, at 1 m/s and without weight: it rebounds with e times that, and its sliding speed is reduced by friction."""
    r, w, along = 5e-3, 1.0, 3.0
    peg = {"mass": 1e-3, "inertia": [1e-8, 1e-8, 1e-8], "velocity": [along, 0, -w]}

    def known(e, mu):
        return (Known("speed after", last("end", "vz"), e * w, 5e-3 * w), Known("speed along", last("end", "vx"), along - mu * (1 + e) * w, 5e-3 * w))

    return Case("rope_falls", "A rope hits the floor flat: restitution is that of its law, with the corresponding friction impulse (its nodes, coupled by their consistent mass, reverse one after the other at fine steps: 4e-3).",
                model("Rope falls", {**FLOOR, "left": {**peg, "position": [-0.1, 0, r + 1e-3]}, "right": {**peg, "position": [0.1, 0, r + 1e-3]}}, gravity=(0, 0, 0),
                      variables={"e": 0, "mu": 0}, contacts={"default": {"restitution": "e", "friction": "mu"}}, probes={"end": {"body": "left"}},
                      cables={"rope": {"through": [["left"], ["right"]], "stiffness": 1e4, "mass_per_length": 0.1, "elements": 2, "contact": {"radius": r}}}),
                1e-2, 0.02, tuple(Variant(f"e {e} mu {mu}", {"e": e, "mu": mu}, known(e, mu)) for e in (0, 0.3, 0.7, 1) for mu in (0, 0.1)), (1, 0.5, 0.1, 0.01, 0.001),
                spans={0.001: 2e-3}, compare=False, because=STILL)


def solid_falls():
    """A block of rubber falls flat from 20 mm and rebounds by its own elasticity."""
    known = (Known("error of the energy balance", lambda run: run.figures["energy_drift"] if "energy_drift" in run.figures else 0, 0, 1e-9),)
    return Case("solid_falls", "A block of rubber falls flat and rebounds: converges with the step.",
                model("Rubber falls", FLOOR, contacts={}, materials=RUBBER, solids={"block": block(0.07)},
                      probes={"top": {"solid": "block", "point": [0, 0, 0.05]}, "middle": {"solid": "block", "point": [0, 0, 0]}}),
                1e-3, 0.15, (Variant("", {}, known),), (1, 0.5, 0.2, 0.05), order=1, skip=("top.vz", "middle.vz"), because="Shorter steps take minutes.")


def cables_cross():
    """A cable falls across another one of equal mass, both of one element: they separate with e times the approach velocity."""
    r, w = 5e-3, 1.0
    peg = {"mass": 1e-3, "inertia": [1e-8, 1e-8, 1e-8]}
    cable = {"stiffness": 1e4, "mass_per_length": 0.1, "elements": 1, "contact": {"radius": r}}
    bodies, cables = {}, {}
    for name, axis, z, v in (("rope", 0, 2 * r + 1e-3, -w), ("stay", 1, 0, 0)):
        for end, way in (("a", -0.1), ("b", 0.1)):
            bodies[f"{name}_{end}"] = {**peg, "position": [way if axis == 0 else 0, way if axis == 1 else 0, z], "velocity": [0, 0, v]}
        cables[name] = {**cable, "through": [[f"{name}_a"], [f"{name}_b"]]}
    variants = tuple(Variant(f"e {e}", {"e": e}, (Known("rope: vz after", last("rope", "vz"), 0.5 * (e - 1) * w, 1e-4 * w), Known("stay: vz after", last("stay", "vz"), -0.5 * (1 + e) * w, 1e-4 * w))) for e in (0, 0.3, 0.7, 1))
    return Case("cables_cross", "Two crossing cables separate with e times their approach velocity at any step.",
                model("Cables cross", bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts={"default": {"restitution": "e"}}, cables=cables, probes={"rope": {"body": "rope_a"}, "stay": {"body": "stay_a"}}),
                5e-3, 0.02, variants, (1, 0.2, 0.02, 0.002), spans={0.02: 6e-3, 0.002: 3e-3}, compare=False, because="Closed forms give all results.")


def solids_part():
    """Solids bonded to bodies at all nodes collide centrally, face on face, as rigid bodies of equal mass."""
    w, both = 1.0, {"sphere": {"centre": [0, 0, 0], "radius": 9}}
    bodies, solids = {}, {}
    for name, a, z, v in (("below", 0.1, 0, w), ("above", 0.06, 0.082, -w)):
        bodies[name] = {"mass": 3 - 1000 * a**3, "inertia": [1e-2, 1e-2, 1e-2], "position": [0, 0, z], "velocity": [0, 0, v]}
        solids["of_" + name] = {"mesh": {"block": {"size": [a, a, a], "cells": [1, 1, 1]}, "position": [0, 0, z]}, "material": "rubber", "velocity": [0, 0, v], "bonded": {name: both}}
    variants = tuple(Variant(f"e {e}", {"e": e}, (Known("below: vz after", last("below", "vz"), -e * w, 1e-3 * w), Known("above: vz after", last("above", "vz"), e * w, 1e-3 * w))) for e in (0, 0.5, 1))
    return Case("solids_part", "Faces of solids without free nodes separate with e times their approach velocity at any step.",
                model("Solids part", bodies, gravity=(0, 0, 0), variables={"e": 0}, contacts={"default": {"restitution": "e"}}, materials=RUBBER, solids=solids, probes={"below": {"body": "below"}, "above": {"body": "above"}}),
                1e-3, 6e-3, variants, (1, 0.5, 0.2, 0.05, 0.01), spans={0.01: 3e-3}, compare=False, because="Closed forms give all results.")


CASES = [solid_touches_at_start(), solids_touch_at_start(), cable_touches_at_start(), touch_in_space(), rope_falls(), solid_falls(), cables_cross(), solids_part()]
