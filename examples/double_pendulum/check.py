# SPDX-License-Identifier: Apache-2.0
"""The double pendulum against its two equations of Lagrange, and the order of the method."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, integrate, largest, step_error  # noqa: E402

L, T, G = 1.0, 0.05, 9.81
M = 1000 * L * T * T
J = M * (L**2 + T**2) / 12  # about the centre of a bar


def rate(_, state):
    """Angles a, b of the bars below the horizontal, and their rates."""
    a, b, p, q = state
    k = M * L * L / 2  # couples the bars: m L l with l = L/2
    A, B, C = J + M * L * L / 4 + M * L * L, k * math.cos(a - b), J + M * L * L / 4
    u = 1.5 * M * G * L * math.cos(a) - k * math.sin(a - b) * q * q
    v = 0.5 * M * G * L * math.cos(b) + k * math.sin(a - b) * p * p
    D = A * C - B * B
    return [p, q, (C * u - B * v) / D, (A * v - B * u) / D]


def main():
    report = Report()
    runs = {ms: Run(HERE / "model.yaml", f"analysis.step={ms} ms", "output.every=20 ms") for ms in (20, 10, 5)}
    tips = {ms: run.points("tip") for ms, run in runs.items()}
    times = runs[10].probe("tip")["t"]
    exact = [(L * (math.cos(a) + math.cos(b)), 0.0, -L * (math.sin(a) + math.sin(b)))
             for a, b, _, _ in integrate(rate, [0, 0, 0, 0], times, 0.02)]
    floor = 1e-10  # Rounding errors, which the motion amplifies by a factor of 1000 and more.
    report.below("tip, largest distance from Lagrange's equations, 10 ms [m]", largest(tips[10], exact),
                 step_error(tips[20], tips[10], 6, floor))
    report.below("the same at 5 ms [m]", largest(tips[5], exact), step_error(tips[10], tips[5], 6, floor))
    order = math.log2(largest(tips[20], exact) / largest(tips[10], exact))
    report.near("order of accuracy, 20 ms to 10 ms", order, 6, 0.5)
    for ms, run in runs.items():
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
