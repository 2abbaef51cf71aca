# SPDX-License-Identifier: Apache-2.0
"""A moment 2πEI/L bends a straight beam of length L to a circle: closed form, exact for this element on any mesh."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402

LENGTH, BENDING = 1.0, 210e9 * 10e-3 * 1e-9 / 12
# Newton ends at the round-off of forces: 1e-16 of E A, which bends the beam by some 1e-16 E A L²/(E I).
FLOOR = 16 * 2.2e-16 * 210e9 * 10e-6 * LENGTH**2 / BENDING


def main():
    report = Report()
    for turns in (1, 0.5):
        run = Run(HERE / "model.yaml", f"turns={turns}")
        radius = LENGTH / (2 * math.pi * turns)
        angle = 2 * math.pi * turns
        x, y, _ = run.points("tip")[-1]
        name = f"{turns} turns: "
        report.near(name + "x of the end [m]", x, radius * math.sin(angle), FLOOR)
        report.near(name + "y of the end [m]", y, radius * (1 - math.cos(angle)), FLOOR)
        middle = run.probe("middle")
        report.near(name + "curvature over the closed form", middle["curvature z"][-1] * radius, 1, FLOOR)
        report.near(name + "moment over the closed form", middle["mz"][-1] / (BENDING / radius), 1, FLOOR)
        report.near(name + "strain energy over M²L/2EI",
                    run.figures["strain_energy"] / (0.5 * BENDING / radius**2 * LENGTH), 1, FLOOR)
        report.near(name + "moment of the clamp over that of the load",
                    run.probe("clamp")["mz"][-1] / (-BENDING / radius), 1, FLOOR)
        report.near(name + "load steps", run.figures["steps"], 1, 0)
        report.below(name + "iterations", run.figures["newton_iterations"], 12)
    report.end()


main()
