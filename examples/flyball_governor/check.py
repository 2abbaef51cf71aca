# SPDX-License-Identifier: Apache-2.0
"""The height of the slider against the three equations of the symmetric motion."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, nearest, step_error  # noqa: E402

# Height s of the slider [m] and angular velocity of the shaft [rad/s]: shaft's turn, slider's height and tilt of the
# rods as coordinates, solved by Radau and by explicit order 8, which agree to 4e-11.
REFERENCE = {
    0.25: (0.622092721596, 5.53667201983),
    0.5: (0.743249424786, 5.10341542197),
    1.0: (0.50142092238, 6.27112574188),
    2.0: (0.505909294297, 6.23622361444),
    4.0: (0.523223371026, 6.10800805311),
    6.0: (0.549928665906, 5.92865022706),
    8.0: (0.58317833671, 5.73278832137),
    10.0: (0.619622917061, 5.54820362265),
}


def main():
    report = Report()
    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=5 ms")
    times = run.probe("slider")["t"]
    s, speed = run.probe("slider")["z"], run.probe("shaft")["rate rz"]
    s_tolerance = step_error(coarse.probe("slider")["z"], s, 2, 1e-10)
    speed_tolerance = step_error(coarse.probe("shaft")["rate rz"], speed, 2, 1e-9)
    for t, (height, turning) in REFERENCE.items():
        i = nearest(times, t)
        report.near(f"slider's height at {t} s [m]", s[i], height, s_tolerance)
        report.near(f"shaft's speed at {t} s [rad/s]", speed[i], turning, speed_tolerance)
    report.near("largest height [m]", max(s), 0.743563764, s_tolerance + 1e-5)  # 10 ms between the rows
    report.below("energy drift, including the losses of the dampers", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
