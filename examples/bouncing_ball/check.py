# SPDX-License-Identifier: Apache-2.0
"""The elastic ball returns to its height bounce after bounce; the others lose the square of their restitution."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402

G, R, DT = 9.81, 0.05, 5e-3
SURFACE = R  # Position at which contact forces begin.


def heights(table):
    """Height over the surface from the energy of each flight."""
    flights, last = [], None
    for z, v in zip(table["z"], table["vz"]):
        if z <= SURFACE:
            last = None
        elif last is None:
            flights.append([])
            last = flights[-1]
        if last is not None:
            last.append(z + v * v / (2 * G) - SURFACE)
    return [sorted(f)[len(f) // 2] for f in flights if len(f) > 4]


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    elastic = heights(run.probe("elastic"))
    report.below("elastic ball: largest loss of height in 11 bounces", max(abs(h / elastic[0] - 1) for h in elastic), 1e-6)
    report.near("elastic ball: flights", len(elastic), 12, 0)
    for name, e, least in (("lively", 0.8, 10), ("dull", 0.5, 5)):
        h = heights(run.probe(name))
        # The law is for flights of more than four steps.
        ratios = [math.sqrt(b / a) for a, b in zip(h, h[1:]) if 2 * math.sqrt(2 * b / G) > 4 * DT]
        report.below(f"{name} ball: error of the restitution in {len(ratios)} bounces", max(abs(r - e) for r in ratios), 1e-3)
        report.below(f"{name} ball: bounces missing of {least}", max(0, least - len(ratios)), 0)
        report.below(f"{name} ball: speed at the end, at rest", run.probe(name)["vz"][-1], 1e-9 if name == "dull" else 1)
    touch = run.probe("touch")
    # Total impulse of the floor: weight times time, and the momentum.
    momentum = run.probe("lively")["vz"][-1]
    report.near("lively ball: impulse of the floor over weight times time", touch["impulse"][-1] / (G * 10), 1 + momentum / (G * 10), 1e-9)
    lost = run.figures["contacts"]
    drift = run.figures["energy_drift"]
    report.below("energy balance with losses of impacts", drift, 1e-7)
    report.below("energy lost other than by impacts [J]", lost["lost_by_friction"], 0)
    report.end()


main()
