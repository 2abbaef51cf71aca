# SPDX-License-Identifier: Apache-2.0
"""Precession against the fast-top formula, and every instant against the equations of rings and rotor."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, integrate, largest, step_error  # noqa: E402

G, SPIN, ARM, STEEL = 9.81, 300.0, 0.06, 7800.0
BALL, RADIUS, WIDTH = 0.024, 0.04, 0.01
m = STEEL * math.pi * BALL**3 / 6
rotor = STEEL * math.pi * RADIUS**2 * WIDTH
C, B = rotor * RADIUS**2 / 2, rotor * (3 * RADIUS**2 + WIDTH**2) / 12  # of the rotor, along and across its axle
OUTER_Z = 3e-4
ball = m * BALL**2 / 10
INNER = (1.5e-4 + ball, 1.5e-4 + ball + m * ARM**2, 2.8e-4 + ball + m * ARM**2)  # inner ring with the weight
H = C * SPIN  # The angular momentum about the axle is constant: its bearing is free.


def across(theta):
    """Moment of inertia about the vertical without the rotor's spin, and its derivative."""
    s, c = math.sin(theta), math.cos(theta)
    return OUTER_Z + INNER[0] * s * s + (INNER[2] + B) * c * c, 2 * s * c * (INNER[0] - INNER[2] - B)


def rate(_, state):
    """phi about the vertical, theta of the inner ring (positive: weight down), rate of theta. The momentum about the
    vertical, which is zero at the start, gives the rate of phi."""
    _, theta, theta_rate = state
    J, slope = across(theta)
    phi_rate = H * math.sin(theta) / J
    moment = 0.5 * phi_rate**2 * slope - H * phi_rate * math.cos(theta) + m * G * ARM * math.cos(theta)
    return [phi_rate, theta_rate, moment / (INNER[1] + B)]


def main():
    report = Report()
    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=2 ms")
    times = run.probe("stand")["t"]
    phi, theta = run.probe("stand")["rz"], run.probe("gimbal")["rz"]
    states = integrate(rate, [0.0, 0.0, 0.0], times, 0.002)
    for name, values, probe, column in (("stand", phi, "stand", 0), ("gimbal", theta, "gimbal", 1)):
        tolerance = step_error(coarse.probe(probe)["rz"], values, 6, 1e-9)
        report.below(f"angle of the {name}, largest difference from the equations [rad]",
                     largest(values, [s[column] for s in states]), tolerance)

    # Nutation about the equilibrium has the frequency H / sqrt(J_vertical J_horizontal); its second harmonic and
    # its effect on the precession are of the order of its amplitude relative to 1.
    fast_top = m * G * ARM / H
    nodding = H / math.sqrt(across(0)[0] * (INNER[1] + B))
    amplitude = fast_top * across(0)[0] / H
    periods = math.floor(times[-1] * nodding / (2 * math.pi))
    until = periods * 2 * math.pi / nodding
    i = min(range(len(times)), key=lambda k: abs(times[k] - until))
    report.near("precession over whole nutation periods [rad/s]", phi[i] / times[i], fast_top,
                fast_top * (amplitude + 2 * amplitude + 2 / (nodding * until)))
    ups = [k for k in range(1, len(theta) - 1) if theta[k - 1] < theta[k] >= theta[k + 1]]
    period = (times[ups[-1]] - times[ups[0]]) / (len(ups) - 1)
    report.near("frequency of nutation [rad/s]", 2 * math.pi / period, nodding,
                nodding * (amplitude + 2 * (times[1] - times[0]) / (times[ups[-1]] - times[ups[0]])))
    for figure in ("energy_drift", "angular_momentum_drift"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    report.end()


main()
