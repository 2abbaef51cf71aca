# SPDX-License-Identifier: Apache-2.0
"""Stresses at points of solids, on coarse meshes and on finer ones: bending, Lamé's tube, Kirsch's hole.

At two quadratic elements they are within 5 % of the known values; halving the element size reduces this to a quarter at most.
"""
import math

from case import Case, Known, Variant, last, model

STEEL = {"type": "elastic", "youngs_modulus": 200e9, "poisson_ratio": 0.3, "density": 7800}


def statics(title, solid, loads, points, variables, poisson=0.3, bodies=None):
    made = model(title, bodies or {}, gravity=(0, 0, 0), variables=variables, materials={"steel": {**STEEL, "poisson_ratio": poisson}}, solids={"plate": solid}, loads=loads,
                 probes={name: {"solid": "plate", "point": point, "stress": True} for name, point in points.items()})
    made["analysis"] = {"type": "statics"}
    return made


def bending():
    """σ = M z/I at the surface half-way along a cantilever: F = 1 N, 1 m long, 0.1 m square, so 3 kPa."""
    made = statics("Cantilever", {"mesh": {"block": {"size": [1, 0.1, 0.1], "cells": ["10*n", 1, "n"]}}, "element": "hex20", "material": "steel", "bonded": {"ground": "xmin"}},
                   {"shear": {"type": "traction", "solid": "plate", "surface": "xmax", "traction": [0, 0, 100]}}, {"top": [0, 0.05, 0.05], "bottom": [0, -0.05, -0.05]}, {"n": 1}, 0)
    allowed = {"hex20": 0.01, "hex27": 0.01, "hex8_eas9": 0.02, "tet10": 0.05}
    variants = tuple(Variant(kind, {"solids.plate.element": kind}) for kind in allowed)
    known = (Known("stress at the top [Pa]", last("top", "sxx"), -3000, lambda h: 150 if h > 0.6 else 100), Known("von Mises at the bottom [Pa]", last("bottom", "von_mises"), 3000, lambda h: 150 if h > 0.6 else 100))
    return Case("bending_stress", "A cantilever one, two and four elements thick.", made, 1, 1, variants, statics=True, fractions=(1, 0.5), floor=1e-8, compare=False, mesh_known=known,
                meshes=({"n": "2"}, {"n": "4"}), mesh_floor=0.02, because="Deformations are negligible, so fewer load steps give the same result.")


def lame():
    """A pressure p in a tube with radii a, b: p a²/(b² − a²) (1 ± b²/r²) around and across."""
    p, a, b = 1e6, 0.1, 0.2
    made = statics("Tube", {"mesh": {"tube": {"outer": 2 * b, "inner": 2 * a, "length": 0.05, "cells": ["n", "8*n", 1]}}, "element": "hex20", "material": "steel",
                            "prescribed": {"below": {"nodes": "start", "z": 0}, "above": {"nodes": "end", "z": 0}}},
                   {"inside": {"type": "pressure", "solid": "plate", "surface": "inner", "pressure": p}}, {"inside": [a, 0, 0], "middle": [0.15, 0, 0], "outside": [b, 0, 0]}, {"n": 2})
    part = p * a * a / (b * b - a * a)
    most = part * (1 + b * b / a / a)
    known = tuple(Known(f"{name} stress {how}, r = {r} m [Pa]", last(point, column), part * (1 + sign * b * b / r / r), lambda h: 0.05 * most * max(h, 0.05) ** 2)
                  for point, r in (("inside", a), ("middle", 0.15), ("outside", b)) for name, how, column, sign in (("hoop", "around", "syy", 1), ("radial", "across", "sxx", -1)))
    return Case("lame_tube", "Lamé's tube with two elements across its wall, then four and eight.", made, 1, 1, statics=True, fractions=(1, 0.5), floor=1e-8, compare=False, mesh_known=known,
                meshes=({"n": "4"}, {"n": "8"}), mesh_floor=0.02, because="Deformations are negligible, so fewer load steps give the same result.")


CASES = [bending(), lame()]
