# SPDX-License-Identifier: Apache-2.0
"""Models of the validation suite without contact: bodies, beams in motion and at rest, and every kind of solid element.

Of an error C Δt² of order two the constants C are twice the phase by which steps lag, ∫|ω|³ dt/12, times the lever of what is compared.
"""
import math

from case import Case, Known, Variant, at, falling, last, model, table

WAVES = ("[m/s^2]", "[N]", "[N m]")  # Columns that show waves in elastic bodies that a step does not resolve.
WHY_WAVES = "Elastic bodies that are released or loaded suddenly have waves that the step does not resolve: positions are compared; the case with shorter steps resolves them."
ROUNDING = 1e-9


def orders(known, *of, longer=1):
    return tuple(Variant(f"order {order}", {"analysis.order": str(order)}, tuple(known(order)), order, longer if order > 2 else 1) for order in of)


def case(name, about, made, step, span, variants=(Variant("", {}),), **more):
    return Case(name, about, made, step, span, variants, **{"order": 2, "smooth": True, "floor": ROUNDING, **more})


def pendulum():
    made = model("Planar pendulum", {"bob": {"mass": 1, "inertia": [0.001, 0.001, 0.001], "position": [-1, 0, 0]}}, gravity=(0, -9.81, 0),
                 joints={"rod": {"type": "distance", "bodies": ["ground", "bob"], "at": [[0, 0, 0], [-1, 0, 0]]}}, probes={"bob": {"body": "bob"}, "rod": {"joint": "rod"}})
    row = table("planar_pendulum")[0.4]
    known = lambda order: [Known(f"{c} at 0.4 s", at("bob", c, 0.4), row[k], (lambda h: 55 * h * h + 1e-9) if order == 2 else falling(1e-3, 1e-1, order, 1e-9)) for k, c in enumerate("xy")]  # noqa: E731
    return case("planar_pendulum", "IFToMM's A01: a mass on a rod.", made, 1e-2, 0.4, orders(known, 2, 6, longer=10))


def free_top():
    made = model("Free top", {"top": {"mass": 1, "inertia": [1, 2, 3], "position": [0, 0, 0], "angular_velocity": [1e-3, 5, 1e-3]}}, gravity=(0, 0, 0),
                 probes={c: {"body": "top", "point": p} for c, p in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1]))})
    w, x, y, z = table("free_asymmetric_top")[1.0][3:7]
    tip = {"x": 1 - 2 * (y * y + z * z), "y": 2 * (x * y + w * z), "z": 2 * (x * z - w * y)}
    known = lambda order: [Known(f"x axis, {c} at 1 s", at("x", c, 1.0), tip[c], (lambda h: 22 * h * h + 1e-9) if order == 2 else falling(1e-2, 2e-1, order, 1e-9)) for c in "xyz"]  # noqa: E731
    return case("free_top", "A body with three moments of inertia about its middle axis: Jacobi's functions.", made, 2e-2, 1.0, orders(known, 2, 8, longer=10))


def turned_antenna():
    made = model("A free satellite that turns its antenna", {"hull": {"mass": 20, "inertia": [3, 4, 5], "angular_velocity": [0.1, 0.3, 0.2]},
                 "antenna": {"mass": 4, "inertia": [0.3, 0.2, 0.1], "position": [0.8, 0, 0]}, "bob": {"mass": 1, "inertia": [0.01, 0.01, 0.01], "position": [1.4, 0, 0], "velocity": [0, 0.5, 0.2]}},
                 gravity=(0, 0, 0), probes={"hull": {"body": "hull"}, "bob": {"body": "bob"}, "drive": {"joint": "drive"}, "string": {"joint": "string"}},
                 joints={"drive": {"type": "fixed", "bodies": ["hull", "antenna"], "at": [0.5, 0, 0],
                                   "motion": {"x": "0.1*sin(2*t)", "euler": {"sequence": "zyx", "angles": ["0.4*sin(3*t)", "0.3*(1-cos(3*t))", "t"]}}},
                         "string": {"type": "spherical", "bodies": ["antenna", "bob"], "at": [1.1, 0, 0]}})
    return case("turned_antenna", "Prescribed motion between two free bodies.", made, 1e-2, 0.4, orders(lambda order: (), 2, 6, longer=4), skip=("drive.[J]", *(f"{joint}.[{unit}]" for joint in ("drive", "string") for unit in ("N s", "N m s"))),
                because="Rounding of multipliers adds up in work and impulses: 1e-8 of them in steps of order 6 of 0.4 ms.")


def general(EA, GA, GJ, EI, mass, inertia):
    return {"type": "general", "EA": EA, "GA_y": GA, "GA_z": GA, "GJ": GJ, "EI_y": EI, "EI_z": EI, "mass_per_length": mass, "inertia_per_length": inertia}


def beam_model(title, points, elements, section, loads, probes, gravity=(0, 0, 0), bodies=None, bonded=None, joints=None, up="z"):
    beam = {"points": points, "elements": "n", "section": "bar", "up": up}
    if bonded:
        beam["bonded"] = bonded
    return model(title, bodies or {}, gravity=gravity, probes=probes, variables={"n": elements}, sections={"bar": section}, beams={"beam": beam}, loads=loads, joints=joints or {})


def ramp(*rows):
    return {"table": [list(row) for row in rows]}


def flying_beam():
    push = lambda part: ramp((0, 0), (2.5, 200 * part), (5, 0), (6, 0))  # noqa: E731
    made = beam_model("Flying beam", [[6, 0, 0], [0, 8, 0]], 10, general(1e4, 1e4, 500, 500, 1, [20, 10, 10]),
                      {"push": {"type": "force", "body": "beam.start", "force": [push(0.1), 0, 0]}, "turn": {"type": "moment", "body": "beam.start", "moment": [0, push(-0.5), push(-1)]}},
                      {"start": {"body": "beam.start"}, "end": {"body": "beam.end"}})
    resolved = case("flying_beam_resolved", "Simo and Vu-Quoc's flying spaghetti at the beginning of its load, its waves resolved.", made, 2.5e-3, 0.1)
    return (case("flying_beam", "Simo and Vu-Quoc's flying spaghetti under its load.", made, 5e-2, 1.0, order=1.4, skip=WAVES + ("[m/s]",), meshes=({"n": "20"}, {"n": "40"}), mesh_floor=2e-3,
                 mesh_skip=("[m/s]", "[m/s^2]"), because=WHY_WAVES), resolved)


def right_angle():
    made = beam_model("Right-angle cantilever", [[0, 0, 0], [0, 10, 0], [10, 10, 0]], 10, general(1e6, 1e6, 1e3, 1e3, 1, [20, 10, 10]),
                      {"blow": {"type": "force", "body": "beam.5", "force": [0, 0, ramp((0, 0), (1, 50), (2, 0), (3, 0))]}},
                      {"tip": {"body": "beam.end"}, "clamp": {"joint": "beam.start"}}, bonded={"ground": "start"})
    return case("right_angle_cantilever", "Simo and Vu-Quoc's cantilever under a short force across its plane.", made, 2.5e-2, 0.5)


def spin_up():
    # The end turns by 0.4 (1 − cos(2 π t/15)) rad/s² for 15 s.
    made = beam_model("Spin-up", [[0, 0, 0], [10, 0, 0]], 8, general(2.8e7, 1e7, 1.4e4, 1.4e4, 1.2, [12e-4, 6e-4, 6e-4]),
                      {"motor": {"type": "moment", "body": "rotor", "moment": [0, 0, "4e9*(1 - cos(2*pi*t/15))"]}},
                      {"tip": {"body": "beam.end"}, "hub": {"joint": "axle"}}, bodies={"rotor": {"mass": 1, "inertia": [1e10, 1e10, 1e10], "position": [0, 0, 0]}},
                      joints={"axle": {"type": "revolute", "bodies": ["ground", "rotor"], "at": [0, 0, 0], "axis": "z"}}, bonded={"rotor": "start"})
    turned = 0.4 * (1.0**2 / 2 + (15 / (2 * math.pi)) ** 2 * (math.cos(2 * math.pi / 15) - 1))
    known = (Known("turn of the hub at 1 s [rad]", at("hub", "rz", 1.0), turned, lambda h: 0.1 * h * h + 1e-9),)
    return case("spin_up_beam", "Simo and Vu-Quoc's beam on a rotor; the rotor's angle in closed form.", made, 1e-2, 1.0, (Variant("", {}, known),), fractions=(1, 0.5, 0.2, 0.05),
                skip=("[N m]",), because="The bearing carries no moment.")


def flexible_pendulum():
    EI = 1e7 * 1e-4 / 12
    made = beam_model("Flexible pendulum", [[0, 0, 0], [2, 0, 0]], 16, general(1e5, 1e7, EI, EI, 10, [2e-3 * 1e-1 / 12, 1e-3 * 1e-1 / 12, 1e-3 * 1e-1 / 12]), {},
                      {"tip": {"body": "beam.end"}}, gravity=(0, -9.81, 0), joints={"pin": {"type": "revolute", "bodies": ["ground", "beam.start"], "at": [0, 0, 0], "axis": "z"}})
    # Cables of another program, 64 elements at 0.1 ms, to the digits in which its own meshes agree.
    known = tuple(Known(f"tip {c} at 0.25 s", at("tip", c, 0.25), value, lambda h: 30 * h * h + 5e-4) for c, value in (("x", 1.9535647), ("y", -0.3563068)))
    return case("flexible_pendulum", "A soft pendulum released horizontally; tip by cables of another program.", made, 2e-3, 0.25, (Variant("", {}, known),), fractions=(1, 0.5, 0.2, 0.1),
                meshes=({"n": "32"}, {"n": "64"}), mesh_floor=1e-3, skip=("[m/s^2]",), mesh_skip=("[m/s]",),
                because=WHY_WAVES.split(";")[0] + ". Finer steps take minutes.")


def cantilever():
    steel = {"type": "elastic", "youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7850}
    made = {**beam_model("Cantilever", [[0, 0, 0], [2, 0, 0]], 8, {"type": "rectangle", "height": 0.5, "width": 0.1, "material": "steel"},
                         {"push": {"type": "force", "body": "beam.end", "force": [0, 62.5e6, 0]}}, {"tip": {"body": "beam.end"}, "clamp": {"joint": "beam.start"}}, bonded={"ground": "start"}, up="y"),
            "materials": {"steel": steel}}
    made["analysis"] = {"type": "statics"}
    # Shooting (tests/validation/data/static_beams.csv); the error of 8 elements is four times that of 16.
    known = (Known("tip x", last("tip", "x"), 2 - 0.15097114423929137, lambda h: 3.2e-5 * h * h), Known("tip y", last("tip", "y"), 0.7105685978536354, lambda h: 3.2e-5 * h * h))
    return Case("cantilever_beam", "A cantilever with large bending; ordinary differential equations.", made, 1, 1, statics=True, floor=1e-8, meshes=({"n": "16"}, {"n": "32"}), mesh_known=known, mesh_floor=1e-9)


def arc():
    unit = {"type": "elastic", "youngs_modulus": 1e7, "poisson_ratio": 0, "density": 1}
    c, s = 1 - math.cos(math.pi / 8), math.sin(math.pi / 8)
    made = model("Arc", {}, gravity=(0, 0, 0), probes={"tip": {"body": "bend.end"}}, variables={"n": 8}, materials={"unit": unit},
                 sections={"square": {"type": "rectangle", "height": 1, "width": 1, "material": "unit", "torsion_factor": "1/6 / 0.140577014955154", "shear_factor_y": "5/6", "shear_factor_z": "5/6"}},
                 beams={"bend": {"arc": [[0, 0, 0], [100 * s, 100 * c, 0], [100 * math.sin(math.pi / 4), 100 * (1 - math.cos(math.pi / 4)), 0]], "elements": "n", "section": "square", "bonded": {"ground": "start"}}},
                 loads={"pull": {"type": "force", "body": "bend.end", "force": [0, 0, 600]}})
    made["analysis"] = {"type": "statics"}
    known = tuple(Known(f"tip {axis}", last("tip", axis), value, lambda h: 1.2e-2 * h * h + 3e-7) for axis, value in (("x", 47.15009624), ("y", 15.68468948), ("z", 53.47547800)))
    return Case("arc_of_45_degrees", "Bathe and Bolourchi's arc bent out of its plane; ordinary differential equations.", made, 1, 1, statics=True, floor=1e-8,
                meshes=({"n": "16"}, {"n": "32"}), mesh_known=known, mesh_floor=1e-9)


COMPRESSIBLE = {"type": "neo_hookean", "youngs_modulus": 2000, "poisson_ratio": 0.3, "density": 0.5}
UNCOUPLED = {"type": "mooney_rivlin_uncoupled", "c1": 300, "c2": 80, "bulk_modulus": 20000, "density": 0.5}


def elements():
    """Every kind of element: a soft bar on a tumbling body."""
    made = model("Spinning bar", {"hub": {"mass": 2, "inertia": [0.3, 0.4, 0.55], "position": [0, 0, 0], "angular_velocity": [0.7, -1.1, 2.95]}}, gravity=(0, 0, 0),
                 materials={"rubber": COMPRESSIBLE, "nearly": UNCOUPLED},
                 solids={"bar": {"mesh": {"block": {"size": [6, 0.5, 0.5], "cells": [2, 1, 1]}, "position": [3.5, 0, 0]}, "element": "hex20", "material": "rubber", "bonded": {"hub": "xmin"}}},
                 probes={"hub": {"body": "hub"}, "tip": {"solid": "bar", "node": 5}, "root": {"solid": "bar", "interface": "hub"}})
    variants = tuple(Variant(kind, {"solids.bar.element": kind, "solids.bar.material": "nearly" if kind == "hex8_q1p0" else "rubber"})
                     for kind in ("hex8_standard", "hex8_eas9", "hex8_q1p0", "hex20", "hex27", "tet4", "tet10", "tet15", "wedge6", "wedge15"))
    return (case("solid_elements", "Each kind of element on a tumbling body.", made, 2e-2, 0.2, variants, skip=WAVES + ("tip.[m/s]",), fractions=(1, 0.5, 0.2, 0.05), because=WHY_WAVES),
            case("solid_elements_resolved", "Each kind of element on a tumbling body, its waves resolved.", made, 1e-3, 0.01, variants, fractions=(1, 0.5, 0.2, 0.05)))


def solid_orders():
    made = model("Solid bar", {"hub": {"mass": 2, "inertia": [0.3, 0.4, 0.55], "position": [0, 0, 0], "angular_velocity": [0.7, -1.1, 2.95]}}, gravity=(0, 0, 0), materials={"rubber": COMPRESSIBLE},
                 solids={"bar": {"mesh": {"block": {"size": [6, 0.5, 0.5], "cells": [2, 1, 1]}, "position": [3.5, 0, 0]}, "element": "hex8", "material": "rubber", "bonded": {"hub": "xmin"}}},
                 probes={"hub": {"body": "hub"}, "tip": {"solid": "bar", "node": 5}})
    return case("solid_at_higher_orders", "A solid on a body at orders 4, 6 and 8.", made, 2e-3, 0.04, orders(lambda order: (), 4, 6, 8), fractions=(1, 0.5, 0.2), floor=1e-7,
                because="Newton's tolerance of positions is 1e-12 of the size, and that of speeds is this over the step.")


def spring_chain():
    """Springs and dampers of every kind between bodies on joints, and a moment whose direction rotates in time."""
    bodies = {f"b{i}": {"shape": {"box": [0.4, 0.1, 0.05]}, "density": 1000, "position": [0.4 * i + 0.2, 0, 0]} for i in range(3)}
    made = model("Chain", bodies, joints={"j0": {"type": "spherical", "bodies": ["ground", "b0"], "at": [0, 0, 0]}, "j1": {"type": "universal", "bodies": ["b0", "b1"], "at": [0.4, 0, 0], "axes": ["y", "z"]},
                                          "j2": {"type": "revolute", "bodies": ["b1", "b2"], "at": [0.8, 0, 0], "axis": "y"}},
                 loads={"spring": {"type": "spring_damper", "bodies": ["ground", "b2"], "at": [[1.2, 0, 0.5], [1.2, 0, 0]], "stiffness": 200, "damping": 5, "free_length": 0.4},
                        "coil": {"type": "torsional_spring", "joint": "j2", "stiffness": 3, "damping": 0.05},
                        "push": {"type": "force", "body": "b2", "at": [1.2, 0, 0], "force": [0, "3*sin(7*t)", 0]}},
                 probes={"tip": {"body": "b2", "point": [0.2, 0, 0]}, "first": {"joint": "j0"}, "second": {"joint": "j1"}, "third": {"joint": "j2"}, "spring": {"load": "spring"}, "coil": {"load": "coil"}})
    return case("spring_chain", "Bodies on spherical, universal and revolute joints with springs, dampers and a force that depends on time.", made, 5e-3, 0.15, orders(lambda order: (), 2))


CASES = [pendulum(), free_top(), turned_antenna(), *flying_beam(), right_angle(), spin_up(), flexible_pendulum(), cantilever(), arc(), *elements(), solid_orders(), spring_chain()]
