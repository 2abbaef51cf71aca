# SPDX-License-Identifier: Apache-2.0
"""Attitude, wheels and work of a slew without angular momentum, in closed form."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, largest, step_error  # noqa: E402

SLEW, TIME, WHEEL = math.radians(60), 20.0, 0.08
INERTIA = {"x": 40.0, "y": 60.0, "z": 50.0}
DIRECTION = {"x": 1 / 3, "y": 2 / 3, "z": 2 / 3}


def angle(t):
    u = t / TIME
    return SLEW * (10 * u**3 - 15 * u**4 + 6 * u**5)


def rate(t):
    u = t / TIME
    return SLEW / TIME * 30 * u**2 * (1 - u) ** 2


def energy(t):
    """Of satellite and wheels, all of it work of the wheels' drives."""
    rates = {axis: DIRECTION[axis] * rate(t) for axis in DIRECTION}
    return sum(0.5 * J * rates[axis] ** 2 + 0.5 * (J * rates[axis]) ** 2 / WHEEL for axis, J in INERTIA.items())


def main():
    report = Report()
    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=0.2 s", "output.every=0.2 s")
    times = run.probe("satellite")["t"]
    half = coarse.probe("satellite")["t"]

    def compare(what, probe, column, exact, scale):
        fine, rough = run.probe(probe)[column], coarse.probe(probe)[column]
        tolerance = step_error(rough, fine[::2], 6, ROUND_OFF * scale)
        report.below(what, largest(fine, [exact(t) for t in times]), tolerance)

    assert len(half) == len(times[::2])
    def scaled(factor, function):
        return lambda t: factor * function(t)

    for axis, J in INERTIA.items():
        share = DIRECTION[axis]
        compare(f"rotation about {axis}, largest difference [rad]", "satellite", f"theta{axis}", scaled(share, angle), 1)
        compare(f"momentum of the wheel {axis}, likewise [N m s]", axis, "axial_momentum", scaled(-J * share, rate), 3)
        compare("its speed [rad/s]", axis, "speed", scaled(-(J / WHEEL + 1) * share, rate), 50)
    works = [sum(run.probe(axis)["work"][k] for axis in INERTIA) for k in range(len(times))]
    rough = [sum(coarse.probe(axis)["work"][k] for axis in INERTIA) for k in range(len(half))]
    report.below("work of all wheels, largest difference [J]", largest(works, [energy(t) for t in times]),
                 step_error(rough, works[::2], 6, ROUND_OFF * 100))
    for figure in ("energy_drift", "angular_momentum_drift"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    report.end()


main()
