# SPDX-License-Identifier: Apache-2.0
"""The kink of the taut line and the parabolas of the heavy one, with the same contact force on both."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402

RADIUS, EA, G = 5e-3, 5e4, 9.81
BELOW = 1.0  # half of its span, m
ABOVE, FREE, START = 2.0, 3.995, 0.0101


def press_below(depth, free):
    """Force at the kink of a line without weight."""
    length = math.hypot(BELOW, depth)
    return 2 * EA * (2 * length / free - 1) * depth / length


def press_above(depth, mass):
    """Force on the heavy line at its middle, which is by `depth` below its ends: each half is a parabola."""
    weight = mass * FREE / (2 * ABOVE) * G  # per length of its span
    tension = EA * (2 * ABOVE / FREE - 1)
    for _ in range(100):
        length = ABOVE + depth**2 / (2 * ABOVE) + weight**2 * ABOVE**3 / (24 * tension**2)
        tension = EA * (2 * length / FREE - 1)
    return weight * ABOVE - 2 * tension * depth / ABOVE


def depths(mass, free):
    """Depths of both middles and the contact force, by equality of the forces. Inclined lines have a slightly larger distance in height."""
    low, high = 0.0, 0.2
    for _ in range(60):
        below = (low + high) / 2
        apart = 2 * RADIUS * math.hypot(1, below / BELOW)
        above = below - apart + START
        low, high = (below, high) if press_below(below, free) < press_above(above, mass) else (low, below)
    return below, above, press_below(below, free)


def main():
    report = Report()
    for mass, free in ((1.0, 1.99), (0.3, 1.99), (1.0, 1.995)):
        run = Run(HERE / "model.yaml", f"heavy={mass} kg/m", f"tight={free} m")
        below, above, force = depths(mass, free)
        case = f"{mass} kg/m on {free} m"
        press = run.probe("press")
        report.near(f"{case}: depth of the taut line", -run.probe("below")["z"][-1], below, 2e-3 * below)
        report.near(f"{case}: depth of the heavy line", START - run.probe("above")["z"][-1], above, 2e-3 * below)
        report.near(f"{case}: force between them", -press["fz"][-1], force, 2e-3 * force)
        report.below(f"{case}: lateral force, relative to it", math.hypot(press["fx"][-1], press["fy"][-1]) / force, 1e-6)
        report.below(f"{case}: gap over the tolerance", abs(press["gap"][-1]) / (1e-3 * RADIUS), 1)
    report.end()


main()
