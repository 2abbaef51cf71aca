# SPDX-License-Identifier: Apache-2.0
"""A trebuchet against the equations of its motion: times of its events, the throw, and the balance of energy."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, integrate, solve  # noqa: E402

G = 9.81
LONG, SHORT, DROP, HEIGHT, SLING, HANG = 3.2, 0.8, 2.6, 3.0, 2.4, 0.7
ARM, ARM_J, WEIGHT, WEIGHT_J, BALL = 40.0, 55.0, 600.0, 40.0, 6.0
CENTRE = (LONG - SHORT) / 2
SLOPE = math.asin(DROP / LONG)
FIRE, LET_GO = 0.2, math.radians(128)


def accelerations(y, trough):
    """Accelerations of the arm's angle a, the weight's angle b, and the ball x, z; then the multipliers of sling and trough."""
    a, b, x, z, da, db, dx, dz = y
    # Unit vector from the axle to the long end, and its derivative by the turn.
    s = math.pi + SLOPE - a
    e, de = (math.cos(s), math.sin(s)), (math.sin(s), -math.cos(s))
    d, dd = (math.sin(b), -math.cos(b)), (math.cos(b), math.sin(b))
    swing = WEIGHT * SHORT * HANG * (de[0] * dd[0] + de[1] * dd[1])
    M = [[ARM_J + ARM * CENTRE**2 + WEIGHT * SHORT**2, -swing], [-swing, WEIGHT_J + WEIGHT * HANG**2]]
    # The weight is at -SHORT e + HANG d; e'' = -e a'^2, d'' = -d b'^2.
    drift = [SHORT * e[k] * da * da - HANG * d[k] * db * db for k in (0, 1)]
    force = [-WEIGHT * drift[0], -WEIGHT * (G + drift[1])]
    right = [-SHORT * (de[0] * force[0] + de[1] * force[1]) - ARM * G * CENTRE * de[1], HANG * (dd[0] * force[0] + dd[1] * force[1]), 0.0, -BALL * G]
    # Sling: half the square of its length is constant.
    r = (x - LONG * e[0], z - HEIGHT - LONG * e[1])
    v = (dx - LONG * de[0] * da, dz - LONG * de[1] * da)
    rows = [[-LONG * (r[0] * de[0] + r[1] * de[1]), 0.0, r[0], r[1]]]
    rates = [-(v[0] ** 2 + v[1] ** 2) - (r[0] * e[0] + r[1] * e[1]) * LONG * da * da]
    if trough:
        rows.append([0.0, 0.0, 0.0, 1.0])
        rates.append(0.0)
    n = 4 + len(rows)
    A = [[0.0] * n for _ in range(n)]
    for i in (0, 1):
        for j in (0, 1):
            A[i][j] = M[i][j]
    A[2][2] = A[3][3] = BALL
    for k, row in enumerate(rows):
        for j, value in enumerate(row):
            A[4 + k][j], A[j][4 + k] = value, -value
    return solve(A, right + rates)


def until(y, trough, margin):
    """Integrates until the margin is zero; time and state there."""
    rate = lambda _, s: list(s[4:]) + accelerations(s, trough)[:4]  # noqa: E731
    t, h = 0.0, 0.02
    while True:
        after = integrate(rate, y, [0, h], h)[-1]
        if margin(after) < 0:
            y, t = after, t + h
            continue
        low, high = 0.0, h
        f_low, f_high = margin(y), margin(after)
        for _ in range(60):
            x = 0.5 * (low + high) if _ % 3 == 2 else (low * f_high - high * f_low) / (f_high - f_low)
            state = integrate(rate, y, [0, x], x)[-1]
            f = margin(state)
            if f < 0:
                low, f_low = x, f
            else:
                high, f_high = x, f
            if high - low < 1e-13 or abs(f) < 1e-14:
                break
        return t + x, state


def throw():
    """Times at which the ball lifts off and the sling opens, after the opening of the latch, and the ball's state then."""
    c = math.sqrt(1 - (DROP / LONG) ** 2)
    y = [0.0, 0.0, -LONG * c + math.sqrt(SLING**2 - (HEIGHT - DROP - 0.1) ** 2), 0.1, 0.0, 0.0, 0.0, 0.0]
    t_1, y = until(y, True, lambda s: -accelerations(s, True)[5])
    t_2, y = until(y, False, lambda s: s[0] - LET_GO)
    return t_1, t_1 + t_2, y


def main():
    report = Report()
    lift, let_go, y = throw()
    x, z, dx, dz = y[2], y[3], y[6], y[7]
    flight = (dz + math.sqrt(dz * dz + 2 * G * (z - 0.1))) / G
    for ms in (4, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        events = {e["event"]: e for e in run.figures["events"]}
        bound = 4e-6 * ms**2 + 1e-9
        report.near(f"the latch opens, {ms} ms [s]", events["fire"]["time"], FIRE, 1e-15)
        report.near(f"the ball lifts off, {ms} ms [s]", events["lift"]["time"], FIRE + lift, bound)
        report.near(f"the sling opens, {ms} ms [s]", events["throw"]["time"], FIRE + let_go, bound)
        report.near(f"the ball lands, {ms} ms [s]", events["land"]["time"], FIRE + let_go + flight, 20 * bound)
        ball = {name: column[-1] for name, column in run.probe("ball").items()}
        rest = events["land"]["time"] - ball["t"]             # the last row is up to 10 ms earlier
        report.near(f"range, {ms} ms [m]", ball["x"] + rest * ball["vx"], x + dx * flight, 400 * bound)
        report.near(f"height of the ball there, {ms} ms [m]", ball["z"] + rest * ball["vz"] - G * rest**2 / 2, 0.1, 1e-10)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], 1e-10)
    report.end()


if __name__ == "__main__":
    main()
