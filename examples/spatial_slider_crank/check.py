# SPDX-License-Identifier: Apache-2.0
"""The slider's place against an independent solution and a submission to the IFToMM library."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, nearest, step_error  # noqa: E402

# Explicit order 8 at a relative tolerance of 1e-13 on accelerations, projected onto the constraints: x, crank's angle.
REFERENCE = {
    0.1: (0.226787188553, 0.560031482093),
    0.2: (0.263038972581, 1.28724232688),
    0.5: (0.184952629778, 5.5837625533),
    1.0: (0.21172166139, 10.9135907299),
    2.0: (0.289085197065, 21.0727445225),
    3.0: (0.228484813682, 32.0083277554),
    4.0: (0.18823047557, 43.601753906),
    5.0: (0.24071957377, 54.3333321675),
}
# x as M. Gonzalez submitted it; their solution runs at most 0.11 ms late, which at 0.63 m/s (the largest speed of the
# slider) is 7e-5 m.
GONZALEZ = {0.2: 0.263034975, 1.0: 0.211754668, 3.0: 0.228450093, 5.0: 0.240761815}


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    coarse = Run(HERE / "model.yaml", "analysis.step=4 ms", "output.every=20 ms")
    times, x, angle = run.probe("slider")["t"], run.probe("slider")["x"], run.probe("crank")["rz"]
    angle_coarse = coarse.probe("crank")["rz"]
    x_tolerance = step_error(coarse.probe("slider")["x"], x[::2], 6, 0.08 * 1e-9)  # 80 mm times the angle's
    angle_tolerance = step_error(angle_coarse, angle[::2], 6, 1e-9)
    for t, (place, turned) in REFERENCE.items():
        i = nearest(times, t)
        report.near(f"slider at {t} s [m]", x[i], place, x_tolerance)
        report.near(f"crank at {t} s [rad]", angle[i], turned, angle_tolerance)
    for t, place in GONZALEZ.items():
        report.near(f"slider at {t} s, IFToMM submission [m]", x[nearest(times, t)], place, 7e-5)
    report.below("energy drift", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
