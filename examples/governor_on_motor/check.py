# SPDX-License-Identifier: Apache-2.0
"""A governor whose shaft turns at a given speed: the steady tilt of its arms in closed form, and between them their tilt, the
moment and power of the motor and the force of a rod against the equation of the tilt."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, integrate  # noqa: E402

G, SLOW, FAST, L, BALL, ARM, SLEEVE, DAMPING = 9.81, 15.0, 20.0, 0.25, 1.0, 0.15, 3.0, 40.0
S = BALL * L + ARM * L / 2                                    # first and second moments of an arm about its pin
ALONG, ACROSS = 2e-5, BALL * L**2 + ARM * L**2 / 3
ABOUT_SHAFT = 2e-4 + 5e-3                                     # of shaft and sleeve


def speed(t):
    return SLOW + (FAST - SLOW) * (1 - math.cos(math.pi * min(max(t - 1, 0), 2) / 2)) / 2


def speed_rate(t):
    return (FAST - SLOW) * math.pi / 4 * math.sin(math.pi * min(max(t - 1, 0), 2) / 2)


def steady(omega):
    """Tilt from the vertical: arms, balls and half of the sleeve balance the centrifugal moment."""
    return math.acos((S + SLEEVE * L) * G / ((ACROSS - ALONG) * omega**2))


def tilting(t, y):
    """Rates by Lagrange's equation; the sleeve is 2 L cos(tilt) below the pins."""
    s, c, rate = math.sin(y[0]), math.cos(y[0]), y[1]
    moment = 2 * (ACROSS - ALONG) * speed(t) ** 2 * s * c - 2 * (S + SLEEVE * L) * G * s
    moment -= 4 * SLEEVE * L**2 * s * c * rate**2 + DAMPING * (2 * L * s) ** 2 * rate
    return [rate, moment / (2 * ACROSS + 4 * SLEEVE * L**2 * s**2)]


def drive(t, y):
    """Moment of the motor: the rate of the angular momentum about the shaft."""
    s, c = math.sin(y[0]), math.cos(y[0])
    inertia = ABOUT_SHAFT + 2 * (ACROSS * s**2 + ALONG * c**2)
    return inertia * speed_rate(t) + 4 * (ACROSS - ALONG) * s * c * y[1] * speed(t)


def rod(t, y):
    """Force of a rod: half of the force on the sleeve."""
    s, c, (rate, change) = math.sin(y[0]), math.cos(y[0]), tilting(t, y)
    lift = SLEEVE * (G + 2 * L * (s * change + c * rate**2)) + DAMPING * 2 * L * s * rate
    return lift / (2 * c)


def main():
    report = Report()
    instants = (0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 8.0)
    exact = integrate(tilting, [steady(SLOW), 0.0], instants, 0.01)
    report.near("the equation settles at the fast speed [rad]", exact[-1][0], steady(FAST), 1e-10)
    errors = {}
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        motor, pins, sleeve = run.probe("motor"), [run.probe(f"pin_{x}")["rz"] for x in "ab"], run.points("sleeve")
        forces = run.points("rod_a", "fx fy fz")
        bound = 1.6e-4 * (ms / 2) ** 2 + 1e-10
        for t, y in zip(instants[1:], exact[1:]):
            k, what = round(t / 0.02), f"{t} s, {ms} ms"
            report.near(f"tilt at {what} [rad]", steady(SLOW) + pins[0][k], y[0], bound)
            report.near("of the other arm [rad]", steady(SLOW) + pins[1][k], y[0], bound)
            report.near("height of the sleeve [m]", sleeve[k][2], 0.6 - 2 * L * math.cos(y[0]), bound)
            report.near("moment of the motor [N m]", motor["mz"][k], drive(t, y), bound)
            report.near("its power [W]", motor["power"][k], drive(t, y) * speed(t), 20 * bound)
            report.near("force of a rod [N]", math.hypot(*forces[k]), rod(t, y), 10 * bound)
        stepped = 2e3 / ms * math.tan(FAST * ms / 2e3)       # the speed of Cayley rotations of a step
        report.near(f"steady tilt at tan(speed step/2)/(step/2), {ms} ms [rad]", steady(SLOW) + pins[0][-1], steady(stepped), 1e-8)
        errors[ms] = abs(steady(SLOW) + pins[0][75] - exact[2][0])
        report.below("energy drift", run.figures["energy_drift"], ROUND_OFF)
    report.near("order of the tilt at 1.5 s", math.log(errors[2] / errors[0.1], 20), 2, 0.01)
    report.end()


if __name__ == "__main__":
    main()
