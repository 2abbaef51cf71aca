#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The models of the five quick starts against closed forms and independent integrations: Euler's equations and Jacobi's period of the
racket, the gyrostat's equations of the craft, energy of the four-bar, Lagrange's equations of the arm, balance of forces of the pad.

POLHODE names the program. Numbers that the pages state are compared with these solutions, too.
"""
import csv
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
POLHODE = os.environ.get("POLHODE", str(ROOT / "build/release/apps/polhode/polhode"))


class Run:
    """A run of the model of a page."""

    def __init__(self, page, folder):
        self.text = (ROOT / f"docs/quick_start/{page}.md").read_text()
        name, model = re.search(r"Save this as `(\w+\.yaml)`.*?```yaml\n(.*?)```", self.text, re.S).groups()
        (folder / name).write_text(model)
        subprocess.run([POLHODE, "run", name, "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)
        self.results = folder / name.replace(".yaml", ".results")

    def probe(self, name):
        """Columns of a probe by their names without units."""
        with (self.results / f"probes/{name}.csv").open() as file:
            head, *rows = csv.reader(file)
        return {title.split(" [")[0]: [float(row[at]) for row in rows] for at, title in enumerate(head)}

    def body_rates(self, body):
        """Times, and the angular velocity of a body in its own axes at each."""
        table = self.results / "rates.csv"
        subprocess.run([POLHODE, "convert", str(self.results), str(table), "--channels", f"bodies.{body}.angular_velocity", f"bodies.{body}.orientation"], check=True,
                       stdout=subprocess.DEVNULL, timeout=60)
        with table.open() as file:
            rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
        return [row[0] for row in rows], [turned_back(row[1:4], row[4:8]) for row in rows]

    def stated(self, pattern):
        """The number of the page that a pattern finds."""
        return float(re.search(pattern, self.text)[1])


def turned_back(v, q):
    """Components in the body of a vector in space; q is (w, x, y, z), body to space."""
    w, u = q[0], [-c for c in q[1:]]
    t = [2 * c for c in cross(u, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(u, t))]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def integrated(rate, state, times, step):
    """States at the times, by Runge and Kutta's method of order four."""
    found, t = [], 0.0
    for end in times:
        count = math.ceil((end - t) / step - 1e-9)
        h = (end - t) / max(count, 1)
        for k in range(count):
            at = t + k * h
            a = rate(at, state)
            b = rate(at + h / 2, [s + h / 2 * r for s, r in zip(state, a)])
            c = rate(at + h / 2, [s + h / 2 * r for s, r in zip(state, b)])
            d = rate(at + h, [s + h * r for s, r in zip(state, c)])
            state = [s + h / 6 * (p + 2 * q + 2 * r + w) for s, p, q, r, w in zip(state, a, b, c, d)]
        t = end
        found.append(state)
    return found


def largest(mine, theirs):
    return max(abs(a - b) for one, other in zip(mine, theirs) for a, b in zip(one, other))


def quarter_period(m):
    """Complete elliptic integral of the first kind by its parameter, from Gauss's mean."""
    a, b = 1.0, math.sqrt(1 - m)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a)


def classroom(run):
    inertia, start = (1.0, 2.0, 3.0), [0.01, 5.0, 0.01]
    times, rates = run.body_rates("racket")
    exact = integrated(lambda _, w: [-m / i for m, i in zip(cross(w, [i * c for i, c in zip(inertia, w)]), inertia)], start, times, 2e-3)
    error = largest(rates, exact)
    twice, square = sum(i * w * w for i, w in zip(inertia, start)), sum((i * w) ** 2 for i, w in zip(inertia, start))
    i1, i2, i3 = inertia  # the squared momentum is above 2 E I2: Landau and Lifshitz, Mechanics, section 37
    assert square > twice * i2
    half = 2 * quarter_period((i2 - i1) * (twice * i3 - square) / ((i3 - i2) * (square - twice * i1))) * math.sqrt(i1 * i2 * i3 / ((i3 - i2) * (square - twice * i1)))
    flips = [t + (u - t) * a[1] / (a[1] - b[1]) for t, u, a, b in zip(times, times[1:], rates, rates[1:]) if a[1] * b[1] < 0]
    between = [v - u for u, v in zip(flips, flips[1:])]
    assert len(flips) >= 3 and max(abs(b - half) for b in between) < 2e-3, (between, half)  # linear between frames of 50 ms
    assert abs(run.stated(r"turns over every ([\d.]+) s") - half) < 5e-3, half
    return f"rates within {error:.1e} rad/s, turns over every {half:.4f} s", error, 2e-4


def spacecraft(run):
    mass, distance = 200 * 5 / 205, 0.3  # reduced mass of craft and wheel
    total = (40.02 + mass * distance**2, 60.02 + mass * distance**2, 50.0)  # the wheel's part along its axis is in h

    def rate(moment, state):
        w, h = state[:3], state[3]
        turn = cross(w, [total[0] * w[0], total[1] * w[1], total[2] * w[2] + h])
        return [-turn[0] / total[0], -turn[1] / total[1], (-turn[2] - moment) / total[2], moment]

    times, rates = run.body_rates("bus")
    first = [t for t in times if t <= 20 + 1e-9]
    exact = integrated(lambda _, s: rate(0.02, s), [0.01, 0.002, 0.0, 0.0], first, 0.02)
    exact += integrated(lambda _, s: rate(0.0, s), exact[-1], [t - 20 for t in times[len(first):]], 0.02)
    error = largest(rates, exact)
    speed, wanted = run.probe("wheel")["rate rz"][-1], exact[-1][3] / 0.04 - exact[-1][2]
    assert abs(speed - wanted) < 1e-6 * wanted, (speed, wanted)
    assert abs(run.stated(r"wheel at ([\d.]+) rad/s") - wanted) < 5e-3, wanted
    return f"rates within {error:.1e} rad/s, the wheel at {wanted:.3f} rad/s", error, 1e-8


def mechanism(run):
    base, crank, rise = 0.3, 0.1, 0.3
    lengths = crank, math.hypot(base, rise - crank), rise
    masses = [7800 * 0.02**2 * length for length in lengths]
    inertias = [m * (length**2 + 0.02**2) / 12 for m, length in zip(masses, lengths)]

    def angle(t):
        return 12 * t * t if t < 0.5 else 3 + 12 * (t - 0.5)

    def places(t):
        """Crank's pin and rocker's pin, the latter on its side of the line from the former to the ground."""
        b = crank * math.sin(angle(t)), crank * math.cos(angle(t))
        dx, dz = base - b[0], -b[1]
        d = math.hypot(dx, dz)
        along = (lengths[1] ** 2 - lengths[2] ** 2 + d * d) / (2 * d)
        aside = math.sqrt(lengths[1] ** 2 - along**2)
        return b, (b[0] + (along * dx - aside * dz) / d, b[1] + (along * dz + aside * dx) / d)

    assert math.dist(places(0)[1], (base, rise)) < 1e-12

    def energy(t):
        h, sum_ = 1e-5, 0.0
        before, after, now = places(t - h), places(t + h), places(t)
        ground = ((0.0, 0.0), (base, 0.0))
        bars = [tuple((ground[0], p[0]) for p in (before, now, after)), tuple((p[0], p[1]) for p in (before, now, after)), tuple((ground[1], p[1]) for p in (before, now, after))]
        for m, i, length, (u, v, w) in zip(masses, inertias, lengths, bars):
            middle = [[(a + b) / 2 for a, b in zip(*bar)] for bar in (u, v, w)]
            speed = [(a - b) / (2 * h) for a, b in zip(middle[2], middle[0])]
            turn = [((w[1][k] - w[0][k]) - (u[1][k] - u[0][k])) / (2 * h) for k in (0, 1)]
            sum_ += m * (speed[0] ** 2 + speed[1] ** 2) / 2 + i * (turn[0] ** 2 + turn[1] ** 2) / length**2 / 2 + m * 9.81 * middle[1][1]
        return sum_

    motor = run.probe("motor")
    h, worst, size = 1e-4, 0.0, 0.0
    for at in range(10, len(motor["t"])):
        t = motor["t"][at]
        if abs(t - 0.5) < 0.02 or t > 1.99:  # the law of speed has a kink
            continue
        moment = (energy(t + h) - energy(t - h)) / (2 * h) / (24 * t if t < 0.5 else 12)
        worst, size = max(worst, abs(moment - motor["my"][at])), max(size, abs(moment))
    assert abs(run.stated(r"at most ([\d.]+) N m") - size) < 5e-3, size
    return f"moment within {worst:.1e} of {size:.3f} N m", worst, 2e-3 * size


def robot(run):
    box, ball = 0.4 * 0.04**2, math.pi / 6 * 0.06**3
    shift = 0.2 * ball / (box + ball)
    m1, m2, arm, to1, to2, g = 3.0, 1.5, 0.4, 0.2, 0.2, 9.81
    i1 = m1 * (0.4**2 + 0.05**2) / 12
    density = m2 / (box + ball)
    i2 = density * (box * ((0.4**2 + 0.04**2) / 12 + shift**2) + ball * (0.06**2 / 10 + (0.2 - shift) ** 2))

    def drive(t, q, rate, total, target, gains):
        k, d, i, most = gains
        error, speed = min(t, 1) * target - q, (target if t < 1 else 0.0) - rate
        return max(-most, min(most, k * error + d * speed + i * total)), error

    def rate(t, s):
        a, b, va, vb, total, _ = s
        shoulder, error = drive(t, a, va, total, math.radians(60), (600, 40, 300, 60))
        elbow, _ = drive(t, b - a, vb - va, 0.0, math.radians(40), (300, 15, 0, 30))
        c, n = m2 * arm * to2 * math.cos(a - b), m2 * arm * to2 * math.sin(a - b)
        m11, m22 = i1 + m1 * to1**2 + m2 * arm**2, i2 + m2 * to2**2
        p = shoulder - elbow + g * math.cos(a) * (m1 * to1 + m2 * arm) - n * vb * vb
        q = elbow + g * math.cos(b) * m2 * to2 + n * va * va
        det = m11 * m22 - c * c
        return [va, vb, (m22 * p - c * q) / det, (m11 * q - c * p) / det, error, 0.0]

    shoulder, elbow = run.probe("shoulder"), run.probe("elbow")
    count = sum(t <= 0.3 + 1e-9 for t in shoulder["t"])  # before the hand meets the crate
    exact = integrated(rate, [0.0] * 6, shoulder["t"][:count], 1e-3)
    error = largest([[a, b] for a, b in zip(shoulder["angle"][:count], elbow["angle"][:count])], [[s[0], s[1] - s[0]] for s in exact])
    stated = run.stated(r"shoulder at ([\d.]+)°")
    assert abs(stated - math.degrees(exact[-1][0])) < 6e-3, math.degrees(exact[-1][0])
    return f"angles within {error:.1e} rad, the shoulder at {math.degrees(exact[-1][0]):.3f}° after 0.3 s", error, 1e-4


def tissue(run):
    pad, band = run.probe("pad"), run.probe("band")
    load = {"fx": 40.0, "fy": 0.0, "fz": 60.0, "mx": 0.0, "my": 0.0, "mz": 0.0}
    error = max(abs(pad[key][-1] + band[key][-1] - value) for key, value in load.items())
    assert abs(run.stated(r"The pad carries ([\d.]+) N upwards") - pad["fz"][-1]) < 6e-2, pad["fz"][-1]
    return f"forces and moments balance to {error:.1e} N, the pad carries {pad['fz'][-1]:.2f} N", error, 1e-8


def main():
    faults = 0
    for check in (classroom, spacecraft, mechanism, robot, tissue):
        with tempfile.TemporaryDirectory() as folder:
            try:
                text, error, allowed = check(Run(check.__name__, pathlib.Path(folder)))
            except Exception as fault:  # noqa: BLE001 - the other pages are checked, too
                text, error, allowed = repr(fault), 1.0, 0.0
        faults += error > allowed
        print(f"{check.__name__}: {text}" + ("" if error <= allowed else f"  FAILED, at most {allowed:.1e}"))
    return faults > 0


if __name__ == "__main__":
    sys.exit(main())
