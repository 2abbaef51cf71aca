# SPDX-License-Identifier: Apache-2.0
"""The top turns over; the component of its angular momentum along the arm to the foot (Jellett's constant) is conserved."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, angular_velocity, dot, subtract  # noqa: E402

M, R = 6e-3, 15e-3
A, J, J3 = 0.3 * R, 131 / 350 * M * R**2, 0.4 * M * R**2


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    centre = run.points("origin")
    axes = [[subtract(tip, c) for tip, c in zip(run.points(name), centre)] for name in ("x_tip", "y_tip", "z_tip")]
    omega = angular_velocity(run, "origin", ("x_tip", "y_tip", "z_tip"))
    jellett = []
    for x, y, z, w in zip(*axes, omega):
        momentum = [J * dot(w, x) * x[i] + J * dot(w, y) * y[i] + J3 * dot(w, z) * z[i] for i in range(3)]
        jellett.append(-dot(momentum, [A * z[i] - (R if i == 2 else 0) for i in range(3)]))
    tilt = [math.degrees(math.acos(max(-1, min(1, z[2])))) for z in axes[2]]
    report.near("tilt at the start [deg]", tilt[0], math.degrees(0.1), 1e-6)
    # With friction at one point it stops rising near 152 degrees, as the published top with these data.
    report.near("tilt at the end, above 90: inverted [deg]", tilt[-1], 152, 5)
    report.below("Jellett's constant, largest change", max(abs(j / jellett[0] - 1) for j in jellett), 0.01)
    report.below("energy balance with losses of friction", run.figures["energy_drift"], 1e-10)
    report.end()


main()
