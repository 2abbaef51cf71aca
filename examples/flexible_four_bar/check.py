# SPDX-License-Identifier: Apache-2.0
"""Beam against solid, conservation, and the rigid four-bar as the limit of a stiff coupler."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, distance, largest  # noqa: E402

HALF = "analysis.duration=0.5 s"  # of the comparison: later the small difference of the frequencies adds up


def bending(run):
    """Distance of the middle of the coupler from the straight line between the eyes [m]."""
    out = []
    for b, c, m in zip(run.points("B"), run.points("C"), run.points("middle")):
        (x, y, _), length = [q - p for p, q in zip(b, c)], distance(b, c)
        out.append(((m[1] - b[1]) * x - (m[0] - b[0]) * y) / length)
    return out


def main():
    report = Report()
    beam, solid = Run(HERE / "model.yaml"), Run(HERE / "model_solid.yaml", HALF)
    for name, run in (("beam", beam), ("solid", solid)):
        report.below(name + ": energy drift", run.figures["energy_drift"], ROUND_OFF)
        report.below(name + ": joints", run.figures["constraint_residual_max"], ROUND_OFF)
    first, second = bending(beam)[:101], bending(solid)
    size = max(map(abs, second))
    report.near("largest bending of the middle [m]", max(map(abs, first)), size, 0.01 * size)
    # Each mesh is off by half a percent in its first frequency, of which three periods pass.
    report.below("difference of beam and solid, of that bending", largest(first, second) / size, 0.03)
    # A coupler a million times stiffer. Steps do not resolve its vibrations; they stay below 1e-4 of the bending above.
    stiff = Run(HERE / "model.yaml", "materials.polyamide.youngs_modulus=1.2e15", HALF)
    length = [distance(b, c) for b, c in zip(stiff.points("B"), stiff.points("C"))]
    report.near("stiff coupler: distance of the eyes [m]", max(length, key=lambda x: abs(x - 1.3)), 1.3, 1e-4 * size)
    report.below("stiff coupler: bending [m]", max(map(abs, bending(stiff))), 1e-4 * size)
    report.end()


main()
