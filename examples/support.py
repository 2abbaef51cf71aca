# SPDX-License-Identifier: Apache-2.0
"""Helpers of the examples' checks; only Python's standard library is needed.

The program is that of the environment variable POLHODE, or `polhode` on the PATH, or the one in a build folder here.
"""
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROUND_OFF = 1e-11  # Drift of conserved quantities, over 1e3 to 1e5 steps in 53 bits.


def program():
    if "POLHODE" in os.environ:
        return os.environ["POLHODE"]
    built = [ROOT / "build" / name / "apps/polhode/polhode" for name in ("release", "quickstart", "dev")]
    found = shutil.which("polhode") or next((str(path) for path in built if path.exists()), None)
    if not found:
        sys.exit("polhode is not on the PATH. Build it (scripts/quickstart.sh) or give its path: POLHODE=... python3 check.py")
    return found


def polhode(*arguments):
    """Standard output of a command; exits with its status in case of an error."""
    done = subprocess.run([program(), *map(str, arguments)], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"polhode {' '.join(map(str, arguments))}: exit code {done.returncode}")
    return done.stdout


class Run:
    """A finished run: its summary and the tables of its probes."""

    def __init__(self, model, *settings, folder=None):
        self._temporary = None if folder else tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(folder or self._temporary.name)
        sets = [word for setting in settings for word in ("--set", setting)]
        self.figures = json.loads(polhode("run", model, "-o", self.folder, "--json", "--quiet", *sets))

    def probe(self, name):
        """The columns of a probe by their names without units, as lists: "t", "x", "fz", "rate rz"."""
        with open(self.folder / "probes" / f"{name}.csv", newline="") as file:
            rows = list(csv.reader(file))
        columns = zip(*([float(cell) for cell in row] for row in rows[1:]))
        return {head.split(" [")[0]: list(column) for head, column in zip(rows[0], columns)}

    def points(self, name, columns="x y z"):
        """A vector of a probe at each of its times."""
        table = self.probe(name)
        return list(zip(*(table[column] for column in columns.split())))


class Report:
    """Collects comparisons, prints them as a table, and ends the program with 1 if one of them failed."""

    def __init__(self):
        self._rows, self._failed = [], 0

    def near(self, what, value, reference, tolerance):
        self._row(what, value, reference, abs(value - reference), tolerance)

    def below(self, what, value, bound):
        self._row(what, value, 0, abs(value), bound)

    def _row(self, what, value, reference, error, tolerance):
        good = error <= tolerance  # False for NaN, too.
        self._failed += not good
        self._rows.append((what, f"{value:.12g}", f"{reference:.12g}", f"{error:.1e}", f"{tolerance:.1e}",
                           "" if good else "FAILED"))

    def end(self):
        rows = [("quantity", "polhode", "reference", "error", "tolerance", "")] + self._rows
        widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
        for row in rows:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
        sys.exit(1 if self._failed else 0)


def nearest(times, t):
    """Index of the row nearest to a time."""
    return min(range(len(times)), key=lambda i: abs(times[i] - t))


def integrate(rate, state, times, largest_step):
    """States of the ordinary differential equation state' = rate(t, state) at the given times, the first of which is
    that of the start. Extrapolated midpoint rule with seven columns (order 14), independent of Polhode. Errors are
    at round-off if the steps are well below the shortest time scale of the motion."""
    substeps = (2, 4, 6, 8, 10, 12, 14)

    def midpoint(t, y, h, n):
        d = h / n
        old, new = y, [a + d * b for a, b in zip(y, rate(t, y))]
        for i in range(1, n):
            old, new = new, [a + 2 * d * b for a, b in zip(old, rate(t + i * d, new))]
        return [0.5 * (a + b + d * c) for a, b, c in zip(old, new, rate(t + h, new))]

    def step(t, y, h):
        table = [midpoint(t, y, h, n) for n in substeps]
        for k in range(1, len(substeps)):
            for j in range(len(substeps) - 1, k - 1, -1):
                factor = (substeps[j] / substeps[j - k]) ** 2 - 1
                table[j] = [a + (a - b) / factor for a, b in zip(table[j], table[j - 1])]
        return table[-1]

    states = [list(state)]
    for begin, end in zip(times, times[1:]):
        count = max(1, math.ceil((end - begin) / largest_step - 1e-9))
        y = states[-1]
        for i in range(count):
            h = (end - begin) / count
            y = step(begin + i * h, y, h)
        states.append(y)
    return states


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def solve(matrix, right):
    """Solution of a small linear system, by elimination with pivots."""
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda r: abs(rows[r][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for r in range(n):
            if r != k:
                factor = rows[r][k] / rows[k][k]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[k])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def angular_velocity(run, centre, tips):
    """Angular velocity (world axes) of a body from probes at a point and at one unit along each of its axes:
    ω = ½ Σ e × ė."""
    p, v = run.points(centre), run.points(centre, "vx vy vz")
    omega = [(0.0, 0.0, 0.0)] * len(p)
    for tip in tips:
        e = [subtract(a, b) for a, b in zip(run.points(tip), p)]
        rate = [subtract(a, b) for a, b in zip(run.points(tip, "vx vy vz"), v)]
        omega = [tuple(w + 0.5 * c for w, c in zip(o, cross(a, b))) for o, a, b in zip(omega, e, rate)]
    return omega


def distance(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)))


def largest(a, b):
    """Largest distance of two lists of vectors or of numbers."""
    return max(distance(x, y) if isinstance(x, (tuple, list)) else abs(x - y) for x, y in zip(a, b))


def step_error(coarse, fine, order, floor):
    """Bound on the error of the finer of two runs whose steps are in the ratio two: of a method of order p it is the
    difference of the two over 2^p - 1. Twice that, since steps are finite, plus the floor of rounding."""
    return 2 * largest(coarse, fine) / (2**order - 1) + floor
