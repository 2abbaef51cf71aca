# SPDX-License-Identifier: Apache-2.0
"""A Geneva drive: the wheel's angle against that of the line from its axis to the pin, and the moment of the motor against the wheel's
inertia along that motion."""
import cmath
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

A, W, INERTIA = 0.05, math.pi, 2e-3
C = A * math.sqrt(2)
QUARTER = math.pi / 2


def wheel(t):
    """Angle since the start, and the motor's moment."""
    turns, crank = divmod(W * t, 2 * math.pi)                 # from the pin below
    inside = min(max(crank, QUARTER / 2), 1.5 * QUARTER)
    pin = A * cmath.exp(1j * (inside - QUARTER))
    angle = cmath.phase((pin - C) / cmath.rect(1, -1.5 * QUARTER)) - turns * QUARTER
    if inside != crank:
        return angle, 0.0
    first = 1j * pin / (pin - C)                              # derivatives of the line's angle by that of the crank
    second = (-pin / (pin - C) - first * first).imag
    return angle, INERTIA * first.imag * second * W * W


def main():
    report = Report()
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        axle, motor = run.probe("axle"), run.probe("motor")
        for t in (0.1, 0.3, 0.42, 0.5, 0.61, 0.7, 1.2, 2.0, 2.31, 2.6, 2.9):
            row = round(t / 0.01)
            angle, moment = wheel(t)
            report.near(f"angle of the wheel at {t} s, {ms} ms [rad]", axle["rz"][row], angle, 1e-10)
            report.near(f"moment of the motor at {t} s, {ms} ms [N m]", motor["mz"][row], moment, 1e-9)
        events = {event["event"]: event["time"] for event in run.figures["events"]}
        for name, t in (("in_1", 0.25), ("out_1", 0.75), ("in_2", 2.25), ("out_2", 2.75)):
            report.near(f"{name}, {ms} ms [s]", events[name], t, 3e-11)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
