# SPDX-License-Identifier: Apache-2.0
"""Equilibria with published or closed-form solutions on refined meshes: the Princeton beam, Cook's membrane, a compressed block."""
import json
import math
import pathlib

from case import Case, Known, Variant, last, model

ROWS = {line.split(",")[0]: [float(cell) for cell in line.split(",")[1:]]
        for line in (pathlib.Path(__file__).resolve().parent.parent / "validation" / "data" / "static_beams.csv").read_text().splitlines() if line.startswith("princeton")}


def princeton():
    """Dowell, Traybar, Hodges: a blade bent and twisted by a weight at its tip, at an angle to its section; reference by ordinary differential equations."""
    L, h, w, E, nu = 0.508, 0.0123777, 0.0032024, 7.17e10, 0.31
    A, strong, weak, G = h * w, w * h**3 / 12, h * w**3 / 12, 7.17e10 / 2 / 1.31
    blade = {"type": "general", "EA": E * A, "GA_y": G * A, "GA_z": G * A, "GJ": 0.198 * G * (strong + weak), "EI_y": E * weak, "EI_z": E * strong, "mass_per_length": 0.1, "inertia_per_length": [1e-6, 1e-6, 1e-6]}
    made = model("Princeton beam", {}, gravity=(0, 0, 0), probes={"tip": {"body": "blade.end"}}, variables={"n": 8, "F": 4.448, "angle": "45 deg"}, sections={"blade": blade},
                 beams={"blade": {"points": [[0, 0, 0], [L, 0, 0]], "elements": "n", "section": "blade", "up": "y", "bonded": {"ground": "start"}}},
                 loads={"weight": {"type": "force", "body": "blade.end", "force": [0, "-F*cos(angle)", "F*sin(angle)"]}})
    made["analysis"] = {"type": "statics"}
    variants = []
    for k, F in ((1, 4.448), (2, 8.896), (3, 13.345)):
        for angle in (15, 45, 75):
            u = ROWS[f"princeton_F{k}_{angle}"]
            variants.append((Variant(f"{F} N at {angle} degrees", {"F": str(F), "angle": f"{angle} deg"}),
                             tuple(Known(f"tip {axis} [m]", last("tip", axis), (L if i == 0 else 0) + u[i], lambda size: 3.5e-5 * size**2 + 1e-9) for i, axis in enumerate("xyz"))))
    # Errors of 8 elements are below 3.5e-5 m, of 16 a quarter of that (tests/validation/static_beams_test.cpp).
    return tuple(Case(f"princeton_beam_{variant.settings['F'].split('.')[0]}_N_{variant.settings['angle'].split()[0]}", "The Princeton beam, bent and twisted; ordinary differential equations.", made, 1, 1,
                      (variant,), statics=True, fractions=(1, 0.5, 0.2), floor=1e-8, meshes=({"n": "16"}, {"n": "32"}), mesh_known=known, mesh_floor=1e-9)
                 for variant, known in variants)


def quadrilaterals(n, place):
    """A mesh of n by n hexahedra in one layer; nodes of each hexahedron in the order of VTK."""
    node = lambda i, j, k: (k * (n + 1) + j) * (n + 1) + i  # noqa: E731
    places = [[*place(i / n, j / n), k] for k in (0, 1) for j in range(n + 1) for i in range(n + 1)]
    cells = [[node(i + a, j + b, k) for k in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))] for j in range(n) for i in range(n)]
    clamp = [node(0, j, k) for k in (0, 1) for j in range(n + 1)]
    sets = {"clamp": clamp, "loose": [i for i in range(len(places)) if i not in set(clamp)], "end": [node(n, j, k) for k in (0, 1) for j in range(n + 1)]}
    return {"nodes": places, "elements": cells, "sets": sets}


def cook():
    """Corners (0,0), (48,44), (48,60), (0,44), plane strain, sheared by 100/16 at its end: u_y at (48,52), by the extrapolation of tests/validation/cook_membrane_test.cpp."""
    mesh = lambda n: quadrilaterals(n, lambda s, t: (48 * s, 44 * s + t * (44 * (1 - s) + 16 * s)))  # noqa: E731
    mu = 80.1938
    made = model("Cook's membrane", {}, gravity=(0, 0, 0), probes={"middle": {"solid": "membrane", "point": [48, 52, 0]}},
                 materials={"soft": {"type": "neo_hookean", "youngs_modulus": 2.6 * mu, "poisson_ratio": 0.3, "density": 1},
                            "nearly": {"type": "mooney_rivlin_uncoupled", "c1": 0.5 * mu, "c2": 0, "bulk_modulus": 5000 * mu, "density": 1}},
                 solids={"membrane": {"mesh": mesh(8), "element": "hex8_eas9", "material": "soft", "bonded": {"ground": {"set": "clamp"}}, "prescribed": {"plane": {"nodes": {"set": "loose"}, "z": 0}}}},
                 loads={"shear": {"type": "traction", "solid": "membrane", "surface": {"set": "end"}, "traction": [0, 6.25, 0]}})
    made["analysis"] = {"type": "statics"}
    finer = tuple({"solids.membrane.mesh": json.dumps(mesh(n))} for n in (16, 32))
    common = {"statics": True, "fractions": (1, 0.5, 0.2), "floor": 1e-7, "meshes": finer, "mesh_order": 1, "mesh_floor": 2e-3}
    # Errors fall with order 1.2 to 1.7, for the corner at the clamp.
    return (Case("cooks_membrane", "Cook's membrane with enhanced strains.", made, 1, 1, mesh_known=(Known("rise of the middle", last("middle", "uy"), 8.893, lambda h: 0.09 * h**1.2),), **common),
            Case("cooks_membrane_nearly_incompressible", "Cook's membrane, K = 5000 mu, with mean dilatation.", made, 1, 1,
                 (Variant("", {"solids.membrane.element": "hex8_q1p0", "solids.membrane.material": "nearly"}),),
                 mesh_known=(Known("rise of the middle", last("middle", "uy"), 6.957, lambda h: 0.3 * h**1.2),), **common))


def compressed():
    """A nearly incompressible block (K = 1000 mu) compressed to 0.7 of its height by smooth plates, plane strain: sides stay straight, and σ_zz = μ(λ² − λ⁻²) up to 1/1000."""
    stretch, mu = 0.7, 1.0
    made = model("Compressed block", {}, gravity=(0, 0, 0), variables={"n": 2}, materials={"rubber": {"type": "mooney_rivlin_uncoupled", "c1": mu / 2, "c2": 0, "bulk_modulus": 1000 * mu, "density": 1}},
                 solids={"block": {"mesh": {"block": {"size": [1, 0.25, 1], "cells": ["n", 1, "n"]}}, "element": "hex8_q1p0", "material": "rubber",
                                   "prescribed": {"plane": {"nodes": {"plane": {"axis": "y", "at": -0.125}}, "y": 0}, "other": {"nodes": {"plane": {"axis": "y", "at": 0.125}}, "y": 0},
                                                  "left": {"nodes": "xmin", "x": 0}, "bottom": {"nodes": "zmin", "z": 0}, "top": {"nodes": "zmax", "z": stretch - 1}}}},
                 probes={"side": {"solid": "block", "point": [0.5, 0, 0]}, "top": {"solid": "block", "interface": "top"}})
    made["analysis"] = {"type": "statics"}
    # Per undeformed area μ(λ − λ⁻³); the sides move to 1/λ.
    known = (Known("side of the block [m]", last("side", "ux"), 1 / stretch - 1, 3e-3), Known("force on the plate [N]", last("top", "fz"), 0.25 * mu * (stretch - stretch**-3), 3e-3))
    variants = tuple(Variant(kind, {"solids.block.element": kind}, known) for kind in ("hex8_q1p0", "hex20", "hex27", "tet10"))
    return Case("compressed_block", "A nearly incompressible block between smooth plates; closed form.", made, 1, 1, variants, statics=True, fractions=(1, 0.5, 0.2), floor=1e-7,
                skip=("[N m]",), meshes=({"n": "4"}, {"n": "8"}), mesh_floor=1e-7, because="The state is homogeneous: meshes agree to rounding. Moments depend on the point where the plate is held.")


CASES = [*princeton(), *cook(), compressed()]
