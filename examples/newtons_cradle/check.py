# SPDX-License-Identifier: Apache-2.0
"""The momentum of the first ball is transmitted to the last one; energy is conserved."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    angles = [run.probe(f"h{i}")["rz"] for i in range(5)]
    # h0 starts lifted: the zero of its angle is there.
    angles[0] = [a - math.radians(30) for a in angles[0]]
    t = run.probe("h0")["t"]
    # The first swing: from the first impact, at half a second, until before the ball returns.
    later = [i for i, x in enumerate(t) if 0.6 < x < 1.0]
    top = max(angles[4][i] for i in later)
    # Balls hang 2 mm apart, so that impacts happen up to 8 mm from the lowest point: relative to the height this is (8/500)²/2.
    report.near("last ball: height it rises to [deg]", math.degrees(top), 30, 0.1)
    for i in (1, 2, 3):
        # They have moved by the gap.
        report.below(f"ball {i}: largest angle meanwhile [deg]", max(abs(math.degrees(angles[i][k])) for k in later), 0.5)
    report.below("first ball: largest angle meanwhile [deg]", max(abs(math.degrees(angles[0][k])) for k in later), 0.5)
    report.below("energy drift", run.figures["energy_drift"], 1e-9)
    report.below("energy lost in impacts [J]", run.figures["contacts"]["lost_in_impacts"], 1e-12)
    report.below("constraint residual [m]", run.figures["constraint_residual_max"], 1e-12)
    report.end()


main()
