# SPDX-License-Identifier: Apache-2.0
"""The coin follows the path of a disc that rolls without slipping, by separate integration of its equations."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, nearest  # noqa: E402

# t, x, y, z of the middle: thin disc in pure rolling from the same start.
ROLLING = ((0.1, -5.74238789804e-05, 0.0014262443494, 0.00989213727083),
           (0.2, -0.00288884313923, -0.000117900025943, 0.00968106467221),
           (0.3, -0.000455139426481, -0.00130935971765, 0.00997155873673),
           (0.4, 0.000116284165909, -0.000608099106387, 0.00999288412497),
           (0.5, 8.27529184482e-05, 0.0015817819005, 0.00976087384258))


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    t, x = run.probe("centre")["t"], run.points("centre")
    error = max(abs(x[nearest(t, row[0])][i] - row[1 + i]) for row in ROLLING for i in range(3))
    # The edge is 10 um thick and the gap at rest some micrometres.
    report.below("largest distance from the rolling disc, radius 10 mm [m]", error, 2e-5)
    status = run.probe("foot")["status"][1:]
    report.near("fraction of the time in which it sticks", sum(s == 1 for s in status) / len(status), 1, 0)
    report.below("energy balance", run.figures["energy_drift"], 1e-8)
    report.end()


main()
