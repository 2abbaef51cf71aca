# SPDX-License-Identifier: Apache-2.0
"""No ball passes through another or the walls, the energy never rises, the lowest ball ends on the floor."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    contacts = run.figures["contacts"]
    # A gap is the distance of surfaces; negative gaps are within gap_tolerance, 1e-3 of a radius.
    report.below("deepest overlap of the run [m]", max(0, -contacts["least_gap"]), 1e-4)
    ball = run.probe("b0")
    report.near("height of ball 0 at the end [m]", ball["z"][-1], 0.1, 1e-4)
    report.below("its vertical speed [m/s]", abs(ball["vz"][-1]), 1e-3)
    # Without rolling friction a ball with free space beside it may roll slowly.
    report.below("its speed along the floor [m/s]", max(abs(ball[c][-1]) for c in ("vx", "vy")), 0.1)
    report.below("energy balance with losses of impacts and friction", run.figures["energy_drift"], 1e-6)
    report.near("energy lost in impacts is positive", float(contacts["lost_in_impacts"] > 0), 1, 0)
    report.near("energy lost by friction is positive", float(contacts["lost_by_friction"] > 0), 1, 0)
    report.end()


main()
