#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""References at the end of every case: `references.json`, and the runs that make it.

    POLHODE=build/release/apps/polhode/polhode FOLDER/bin/python benchmarks/peers/references.py

A value is a closed form, or that of Polhode at order 12 by extrapolation; the difference of its two steps, and that
from composition of order 8 where the case has it, are recorded with it, and so are published values.
"""

from __future__ import annotations

import dataclasses
import json
import math
import pathlib
from collections.abc import Sequence
from typing import Any

import cases

PATH = pathlib.Path(__file__).with_name("references.json")
CLOSED = {  # Jacobi's elliptic functions, to twelve digits
    "pendulum": (-0.275087462577, -0.961419205099),
    "n_four_bar_40": (0.180512226684, 0.983572740583),
}
PUBLISHED = {
    "andrews_squeezer": (
        "IVP Test Set, PSIDE",
        (
            15.81077119629904,
            -15.75637105984298,
            0.04082224013073101,
            -0.5347301163226948,
            0.5244099658805303,
            0.5347301163226948,
            1.048080741042263,
        ),
    ),
    "flyball_governor": ("three coordinates, Radau and DOP853", (0.619622917061,)),
    "heavy_top": ("quaternion, DOP853", (-0.150416822746, -0.724165591637, -0.67302226956)),
    "spatial_slider_crank": ("index 1 with projection, DOP853", (0.24071957377,)),
}
STEPS = {
    "andrews_squeezer": 1e-4,
    "flyball_governor": 5e-3,
    "heavy_top": 5e-3,
    "chain_10": 0.01,
    "spatial_slider_crank": 5e-3,
}


@dataclasses.dataclass(frozen=True)
class Reference:
    value: tuple[float, ...]
    uncertainty: float
    source: str


def distance(a: Sequence[float], b: Sequence[float]) -> float:
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b, strict=True)))


def load(path: pathlib.Path = PATH) -> dict[str, Reference]:
    return {
        name: Reference(tuple(entry["value"]), entry["uncertainty"], entry["source"])
        for name, entry in json.loads(path.read_text()).items()
    }


def compute(name: str) -> dict[str, Any]:
    from program import Method
    from with_polhode import Polhode

    if name in CLOSED:
        return {"value": CLOSED[name], "uncertainty": 1e-12, "source": "closed form"}
    mechanism, program, step = cases.all_cases()[name], Polhode(), STEPS[name]
    twelve = Method("extrapolation, order 12", "step", ())
    fine, coarse = (program.run(mechanism, twelve, h).end for h in (step, 1.4142 * step))
    entry: dict[str, Any] = {"value": fine, "step": step, "of_two_steps": distance(fine, coarse)}
    apart = [distance(fine, coarse)]
    entry["source"] = f"Polhode, extrapolation of order 12, steps of {1e3 * step:g} ms"
    if not mechanism.dissipates():
        eight = program.run(mechanism, Method("composition, order 8", "step", ()), 0.25 * step).end
        apart.append(distance(fine, eight))
        entry["from_composition_of_order_8"] = apart[-1]
    entry["uncertainty"] = max(apart)
    if name in PUBLISHED:
        entry["published"], value = PUBLISHED[name]
        entry["from_published"] = distance(fine, value)
        entry["source"] += f"; {entry['from_published']:.1e} from the published value ({entry['published']})"
    return entry


if __name__ == "__main__":
    PATH.write_text(json.dumps({name: compute(name) for name in cases.all_cases()}, indent=1) + "\n")
    print(PATH.read_text())
