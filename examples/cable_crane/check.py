# SPDX-License-Identifier: Apache-2.0
"""A crane against the equations of its hook, with the rope's length as a function of its points, and the balance of work."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, integrate  # noqa: E402

G, MASS, EA, DAMPING = 9.81, 500.0, 2e6, 2000.0
T, PULL, LUFF, JIB, SLOPE = 4.0, 3.0, math.radians(20), 6.0, math.radians(30)
TOP = 8j                                                      # points of the plane x + i z
TIP = 2j + JIB * complex(math.cos(SLOPE), math.sin(SLOPE))
LENGTH = 4 + abs(TIP - TOP) + 2 * (TIP.imag - 1)
FREE = LENGTH / (1 + MASS * G / 2 / EA)


def lift(t):
    """Part of the lift, and its rate."""
    if t >= T:
        return 1.0, 0.0
    return (1 - math.cos(math.pi * t / T)) / 2, math.pi / (2 * T) * math.sin(math.pi * t / T)


def rope(t, hook, v):
    """Tension, and the direction from the hook to the tip."""
    part, rate = lift(t)
    arm = JIB * complex(math.cos(SLOPE + LUFF * part), math.sin(SLOPE + LUFF * part))
    tip, v_tip = 2j + arm, 1j * arm * LUFF * rate
    u, w = (tip - hook) / abs(tip - hook), (tip - TOP) / abs(tip - TOP)
    length = 4 + PULL * part + abs(tip - TOP) + 2 * abs(tip - hook)
    change = PULL * rate + (w.conjugate() * v_tip).real + 2 * (u.conjugate() * (v_tip - v)).real
    return (EA / FREE * (length - FREE) + DAMPING * change if length > FREE else 0.0), u, length


def rate(t, y):
    tension, u, _ = rope(t, complex(y[0], y[1]), complex(y[2], y[3]))
    return [y[2], y[3], 2 * tension * u.real / MASS, 2 * tension * u.imag / MASS - G]


def main():
    report = Report()
    times = (0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0)              # the law of the lift has a kink at 4 s
    exact = integrate(rate, [TIP.real, 1.0, 0.0, 0.0], times, 0.02)
    for ms in (20, 5, 0.2):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        hook, cable = run.probe("hook"), run.probe("rope")
        for t, y in list(zip(times, exact))[1:]:
            k, bound = round(t / 0.02), 3e-5 * (ms / 5) ** 2 + 1e-8
            report.near(f"hook x at {t:g} s, {ms} ms [m]", hook["x"][k], y[0], bound)
            report.near(f"hook z at {t:g} s, {ms} ms [m]", hook["z"][k], y[1], bound)
            tension, _, length = rope(t, complex(y[0], y[1]), complex(y[2], y[3]))
            report.near(f"tension at {t:g} s, {ms} ms [N]", cable["tension"][k], tension, 400 * bound)
            report.near(f"length of the rope at {t:g} s, {ms} ms [m]", cable["length"][k], length, bound)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], 1e-10)
    report.end()


main()
