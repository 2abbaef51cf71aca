# SPDX-License-Identifier: Apache-2.0
"""The heavy top against published values and an independent solution of high order."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, angular_velocity, distance, nearest, step_error  # noqa: E402

# Centre of mass: quaternions and the fixed point as coordinates, explicit order 8 at a relative tolerance of 1e-13;
# two tolerances agree to 1.4e-11.
CENTRE = {
    0.5: (-0.702468297057, -0.0211651847018, -0.711400257652),
    1.0: (0.173343964098, 0.64008859207, -0.748490791134),
    1.5: (-0.968165715638, 0.250306062133, -0.00142208385119),
    2.0: (-0.150416822746, -0.724165591637, -0.67302226956),
}
# Angular velocity about the world's y axis, published with the Exudyn test model of this top.
PUBLISHED = {0.01: 149.8473939540758, 2.0: -106.1638041431}


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    coarse = Run(HERE / "model.yaml", "analysis.step=2 ms", "output.every=10 ms")
    times = run.probe("centre")["t"]
    centre = run.points("centre")
    tolerance = step_error(coarse.points("centre"), centre[::2], 8, 1e-10)
    for t, reference in CENTRE.items():
        report.below(f"centre of mass at {t} s, distance from the reference [m]",
                     distance(centre[nearest(times, t)], reference), tolerance)
    omega = angular_velocity(run, "centre", ("x_tip", "y_tip", "z_tip"))
    omega_coarse = angular_velocity(coarse, "centre", ("x_tip", "y_tip", "z_tip"))
    tolerance = step_error(omega_coarse, omega[::2], 8, 2 * 150 * ROUND_OFF)
    for t, reference in PUBLISHED.items():
        report.near(f"angular velocity about y at {t} s [rad/s]", omega[nearest(times, t)][1], reference, tolerance)
    for figure in ("energy_drift", "angular_momentum_drift"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    report.end()


main()
