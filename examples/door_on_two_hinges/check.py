# SPDX-License-Identifier: Apache-2.0
"""Swing against the damped oscillator's closed form, forces of the hinges against weight and acceleration."""
import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, largest, polhode, step_error  # noqa: E402

MASS, WIDTH, THICK, G = 30.0, 0.9, 0.04, 9.81
LOW, HIGH, HALF = 0.25, 1.75, 1.0  # heights of the hinges and of the centre
STIFFNESS, DAMPING, PUSH = 12.0, 8.0, 2.0
J = MASS * (WIDTH**2 + THICK**2) / 12 + MASS * WIDTH**2 / 4  # about the hinges


def swing(t):
    decay = DAMPING / (2 * J)
    w = math.sqrt(STIFFNESS / J - decay**2)
    return PUSH / w * math.exp(-decay * t) * math.sin(w * t)


def main():
    report = Report()
    found = json.loads(polhode("check", HERE / "model.yaml", "--json"))
    report.near("mobility", found["mobility"], 1, 0)
    report.near("redundant rows", found["redundant_rows"], 5, 0)
    assert found["redundant"] == ["joint 'lower'", "joint 'upper'"], found["redundant"]

    # The door at rest. The hinges carry its weight together; the horizontal forces are the couple that balances its moment.
    run = Run(HERE / "model.yaml", "push=0", "analysis.duration=0.1 s")
    low, high = run.probe("lower"), run.probe("upper")
    rounding = 1e-12 * MASS * G
    report.near("at rest: vertical force of both hinges [N]", low["fz"][-1] + high["fz"][-1], MASS * G, 10 * rounding)
    report.near("at rest: horizontal force of both [N]", low["fx"][-1] + high["fx"][-1], 0, 10 * rounding)
    # Moments about the middle of the door's edge; each hinge may also carry a moment.
    couple = (high["fx"][-1] * (HIGH - HALF) + low["fx"][-1] * (LOW - HALF) + high["my"][-1] + low["my"][-1])
    report.near("at rest: moment of both about y [N m]", couple, -MASS * G * WIDTH / 2, 10 * rounding)

    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=10 ms")
    angle = run.probe("lower")["rz"]
    times = run.probe("lower")["t"]
    report.below("swing, largest difference from the closed form [rad]", largest(angle, [swing(t) for t in times]),
                 step_error(coarse.probe("lower")["rz"], angle, 2, 1e-10))
    centre, low, high = run.probe("centre"), run.probe("lower"), run.probe("upper")
    for axis, weight in (("x", 0), ("y", 0), ("z", MASS * G)):
        worst = max((abs(low["f" + axis][i] + high["f" + axis][i] - MASS * centre["a" + axis][i] - weight)
                     for i in range(len(times))))
        report.below(f"swinging: force of both hinges along {axis} less mass times acceleration and weight [N]", worst,
                     100 * rounding)
    report.below("energy drift, including the losses of the closer", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
