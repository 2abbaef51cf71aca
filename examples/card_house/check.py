# SPDX-License-Identifier: Apache-2.0
"""The house stands with a tenth more friction than it needs and falls with a tenth less."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, distance, nearest  # noqa: E402

PHI, TALL, THICK = math.radians(20), 1.0, 0.02
NEEDED = math.tan(PHI) / 2 - THICK / (2 * TALL)  # Moments of one plate about its foot.


def main():
    report = Report()
    stands, falls = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "margin=0.9", "analysis.duration=1.5 s")
    t, x = stands.probe("right")["t"], stands.points("right")
    settled = nearest(t, 1.0)
    report.below("stands: largest motion from 1 s to 5 s [m]", max(distance(p, x[settled]) for p in x[settled:]), 1e-5)
    foot = stands.probe("foot")
    report.near("stands: thrust at a foot over normal force", abs(foot["ftx"][-1]) / foot["normal"][-1], NEEDED, 1e-3)
    report.near("stands: normal force of a foot [N]", foot["normal"][-1], 9.81, 1e-4)
    report.below("falls: height of the middle after 1.5 s [m]", falls.points("right")[-1][2], 0.3)
    for name, run in (("stands", stands), ("falls", falls)):
        report.below(f"{name}: energy balance", run.figures["energy_drift"], 1e-8)
    report.end()


main()
