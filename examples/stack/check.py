# SPDX-License-Identifier: Apache-2.0
"""After a second the stack is at rest for a minute; each contact carries the weight above it."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, distance, nearest  # noqa: E402


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    t, x = run.probe("top")["t"], run.points("top")
    settled = nearest(t, 1.0)
    report.below("top box: largest motion from 1 s to 60 s [m]", max(distance(p, x[settled]) for p in x[settled:]), 1e-5)
    report.below("top box: speed at the end [m/s]", distance(run.points("top", "vx vy vz")[-1], (0, 0, 0)), 1e-9)
    # 1e-6: the force of 1e-12 m, Newton's tolerance, at the stiffness of lasting contact.
    report.near("floor under ten boxes [N]", run.probe("foot")["normal"][-1], 98.1, 1e-4)
    report.near("box 4 under five boxes [N]", abs(run.probe("middle")["fz"][-1]), 5 * 9.81, 1e-4)
    report.below("energy balance", run.figures["energy_drift"], 1e-10)
    report.end()


main()
