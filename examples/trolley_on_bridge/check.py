# SPDX-License-Identifier: Apache-2.0
"""A mass that moves over a simply supported beam at a constant speed: the equations of the beam's modes, with the mass in them."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, integrate  # noqa: E402

L, EI, PER_LENGTH, MASS, SPEED, G = 12.0, 6e6, 150.0, 600.0, 15.0, 9.81
MODES = 16                                                    # the rest is 1e-4 of the deflection


def shapes(x):
    """Sines at x, and their first and second derivatives."""
    k = [math.pi * (n + 1) / L for n in range(MODES)]
    return ([math.sin(a * x) for a in k], [a * math.cos(a * x) for a in k], [-a * a * math.sin(a * x) for a in k])


def rate(t, y):
    """(m L/2) q'' + M phi z'' + K q = -M g phi, with z = phi(vt) q the height of the mass: one equation of rank one for z''."""
    q, v = y[:MODES], y[MODES:]
    phi, slope, bend = shapes(SPEED * t)
    free = [-(EI * (math.pi * (n + 1) / L) ** 4 / PER_LENGTH) * q[n] for n in range(MODES)]
    carried = sum(2 * SPEED * s * r + SPEED * SPEED * b * p for s, b, p, r in zip(slope, bend, q, v))
    own = carried + sum(p * a for p, a in zip(phi, free))
    per = 2 / (PER_LENGTH * L)
    contact = MASS * (G + own) / (1 + MASS * per * sum(p * p for p in phi))    # force on the beam, downwards
    return v + [a - per * contact * p for a, p in zip(free, phi)]


def main():
    report = Report()
    times = [0.0] + [0.08 * k for k in range(1, 10)]
    exact = integrate(rate, [0.0] * (2 * MODES), times, 5e-4)
    at_rest = MASS * G * L ** 3 / (48 * EI)
    for ms in (4, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        trolley, wheel, middle = run.probe("trolley"), run.probe("wheel"), run.probe("middle")
        for t, y in list(zip(times, exact))[1:]:
            k = round(t / 0.004)
            z = sum(p * q for p, q in zip(shapes(SPEED * t)[0], y))
            half = sum(p * q for p, q in zip(shapes(L / 2)[0], y))
            report.near(f"height of the trolley at {t:.2f} s, {ms} ms [m]", trolley["z"][k], z, 1e-2 * at_rest)
            report.near(f"height of the middle at {t:.2f} s, {ms} ms [m]", middle["z"][k], half, 1e-2 * at_rest)
            report.near(f"position at {t:.2f} s, {ms} ms [m]", wheel["position"][k], SPEED * t, 1e-9)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], 1e-9)
    report.end()


main()
