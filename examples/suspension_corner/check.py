# SPDX-License-Identifier: Apache-2.0
"""A car's corner on a shaker against the two masses of a quarter car, and the weights that its tyre carries."""
import cmath
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

G, STROKE = 9.81, 0.002
CHASSIS, WHEEL, ARM = 300.0, 40.0, 4.0
SPRING, DAMPER, TYRE, TYRE_DAMPER = 120e3, 6000.0, 200e3, 100.0
HALF = 0.5                                                   # the strut is in the middle of the arm


def quarter_car(frequency):
    """Motion of chassis and wheel over the shaker's: the arms are parallel bars."""
    w = 2 * math.pi * frequency
    k, c = SPRING * HALF**2, DAMPER * HALF**2
    # An arm between points moving by z_c and z_w: its middle moves by the mean, it rotates by (z_w - z_c)/0.4.
    turn = 2 * 0.05 / 0.4**2
    both, cross = 2 * ARM * 0.25 + turn, 2 * ARM * 0.25 - turn
    strut, tyre = k + 1j * w * c, TYRE + 1j * w * TYRE_DAMPER
    a, b = strut - w * w * (CHASSIS + both), -strut - w * w * cross
    d = strut + tyre - w * w * (WHEEL + both)
    det = a * d - b * b
    return -b * tyre / det, a * tyre / det


def harmonic(t, x, frequency):
    """Complex amplitude of x over the last four periods."""
    end, period = t[-1], 1 / frequency
    rows = [(a, b) for a, b in zip(t, x) if a > end - 4 * period + 1e-9]
    mean = sum(b for _, b in rows) / len(rows)
    return 2 / len(rows) * sum((b - mean) * cmath.exp(-2j * math.pi * frequency * a) for a, b in rows) * 1j


def main():
    report = Report()
    weight = (CHASSIS + WHEEL + 2 * ARM) * G
    for frequency in (1, 1.25, 10):  # four periods are whole numbers of 5 ms
        run = Run(HERE / "model.yaml", f"variables.frequency={frequency}", "output.every=5 ms")
        for name, wanted in zip(("chassis", "wheel"), quarter_car(frequency)):
            table = run.probe(name)
            found = harmonic(table["t"], table["z"], frequency) / STROKE
            report.near(f"{name} over shaker at {frequency} Hz", abs(found), abs(wanted), 0.01 * abs(wanted))
            report.near(f"{name}, phase [rad]", cmath.phase(found / wanted), 0, 0.01)
        tyre = run.probe("tyre")
        last = [f for t, f in zip(tyre["t"], tyre["fz"]) if t > tyre["t"][-1] - 4 / frequency + 1e-9]
        report.near(f"mean force of the tyre at {frequency} Hz [N]", sum(last) / len(last), weight, 1e-3 * weight)
        report.below(f"energy drift at {frequency} Hz", run.figures["energy_drift"], 10 * ROUND_OFF)
    coarse, fine = (Run(HERE / "model.yaml", f"analysis.step={ms} ms", "analysis.duration=2 s").probe("chassis")["z"]
                    for ms in (4, 0.5))
    report.below("chassis at 4 ms and at 0.5 ms, largest difference [m]",
                 max(abs(a - b) for a, b in zip(coarse, fine)), 2e-4)
    report.end()


main()
