# SPDX-License-Identifier: Apache-2.0
"""The point P3 against an independent solution; one redundant row, one freedom."""
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, distance, nearest, polhode, step_error  # noqa: E402

# Explicit order 8 at a relative tolerance of 1e-13, accelerations by a pseudo-inverse, projected onto the constraints.
P3 = {
    0.5: (0.774717808039, -0.979815047656, -0.199906158954),
    1.0: (0.274481319264, -0.886707938735, -0.462330002687),
    2.0: (-0.778135373033, -0.980352683443, -0.197252670617),
    3.0: (-0.771281358969, -0.97926932984, -0.202562532654),
    5.0: (0.999932742302, -0.999999997738, -6.72554357533e-05),
    8.0: (-0.764352602234, -0.97815379441, -0.207882549729),
    10.0: (0.999730987304, -0.999999963826, -0.000268976511887),
}


def main():
    report = Report()
    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=40 ms", "output.every=40 ms")
    times, points = run.probe("P3")["t"], run.points("P3")
    tolerance = step_error(coarse.points("P3"), points[::2], 6, 1e-9)
    for t, reference in P3.items():
        report.below(f"P3 at {t} s, distance from the reference [m]", distance(points[nearest(times, t)], reference),
                     tolerance)
    for figure in ("energy_drift", "constraint_residual_max"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    found = json.loads(polhode("check", HERE / "model.yaml", "--json"))
    report.near("mobility", found["mobility"], 1, 0)
    report.near("redundant rows", found["redundant_rows"], 1, 0)
    report.end()


main()
