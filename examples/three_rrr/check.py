# SPDX-License-Identifier: Apache-2.0
"""A planar 3-RRR manipulator: the pose by its motors against the desired one, and their moments against the equations of
momentum of plate and links along that motion."""
import cmath
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, solve  # noqa: E402

R, r, L, W = 0.6, 0.15, 0.4, math.pi                          # points of the plane x + i y
G = -9.81j
PLATE, UPPER, LOWER = (2.0, 0.02), (1.2, 0.016), (0.8, 0.011)  # mass, moment of inertia
BASE = [cmath.rect(R, math.radians(d)) for d in (90, 210, 330)]
PIN = [cmath.rect(r, math.radians(d)) for d in (90, 210, 330)]
STEP = 2e-3                                                   # of the differences


def cross(a, b):
    return (a.conjugate() * b).imag


def centre(t):
    return complex(0.05 * (1 - math.cos(W * t)), 0.05 * math.sin(W * t))


def turn(t):
    return 0.2 * math.sin(W * t)


def pin(i, t):
    return centre(t) + PIN[i] * cmath.exp(1j * turn(t))


def elbow(i, t):
    u = pin(i, t) - BASE[i]
    return BASE[i] + L * u / abs(u) * cmath.exp(1j * math.acos(abs(u) / (2 * L)))


def second(f, t):
    """Second derivative by time, errors of the sixth order."""
    sides = [f(t + k * STEP) - 2 * f(t) + f(t - k * STEP) for k in (1, 2, 3)]
    return (270 * sides[0] - 27 * sides[1] + 2 * sides[2]) / (180 * STEP * STEP)


def spin_rate(f, t):
    """Angular acceleration of a link along f."""
    u, here = (lambda s: f(s) / L), f(t) / L
    return cross(here, second(u, t))                          # of a unit vector: along it is -w^2


def need(mass, place, about, spin, t):
    """Moment about a point for a body's motion: mass and inertia, position, angular acceleration."""
    return mass[1] * spin + cross(place(t) - about, mass[0] * (second(place, t) - G))


def motor_moments(t):
    """Moments of the motors on the first links."""
    rows, right = [], []
    for i in range(3):                                        # moments of a lower link about its elbow
        e, p = elbow(i, t), pin(i, t)
        lower = lambda s, i=i: (elbow(i, s) + pin(i, s)) / 2  # noqa: E731
        spin = spin_rate(lambda s, i=i: pin(i, s) - elbow(i, s), t)
        row = [0.0] * 6                                       # forces of the links on the plate
        row[2 * i], row[2 * i + 1] = (p - e).imag, -(p - e).real  # the plate's on the link are opposite
        rows.append(row)
        right.append(need(LOWER, lower, e, spin, t))
    force = PLATE[0] * (second(centre, t) - G)
    rows += [[1.0, 0.0] * 3, [0.0, 1.0] * 3,
             [c for i in range(3) for c in (-(pin(i, t) - centre(t)).imag, (pin(i, t) - centre(t)).real)]]
    right += [force.real, force.imag, PLATE[1] * second(turn, t)]
    f = solve(rows, right)
    moments = []
    for i in range(3):                                        # of both links about the base
        on_plate = complex(f[2 * i], f[2 * i + 1])
        upper = lambda s, i=i: (BASE[i] + elbow(i, s)) / 2    # noqa: E731
        lower = lambda s, i=i: (elbow(i, s) + pin(i, s)) / 2  # noqa: E731
        moment = need(UPPER, upper, BASE[i], spin_rate(lambda s, i=i: elbow(i, s) - BASE[i], t), t)
        moment += need(LOWER, lower, BASE[i], spin_rate(lambda s, i=i: pin(i, s) - elbow(i, s), t), t)
        moments.append(moment + cross(pin(i, t) - BASE[i], on_plate))
    return moments


def main():
    report = Report()
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        for t in (0.3, 0.77, 1.6):
            row = round(t / 0.01)
            place, mark = run.points("plate", "x y")[row], run.points("mark", "x y")[row]
            report.near(f"plate x at {t} s, {ms} ms [m]", place[0], centre(t).real, 1e-11)
            report.near(f"plate y at {t} s, {ms} ms [m]", place[1], centre(t).imag, 1e-11)
            report.near(f"its rotation at {t} s, {ms} ms [rad]", math.atan2(mark[1] - place[1], mark[0] - place[0]), turn(t), 1e-11)
            for i, wanted in enumerate(motor_moments(t)):
                report.near(f"moment of motor {i + 1} at {t} s, {ms} ms [N m]", run.probe(f"motor_{i + 1}")["mz"][row], wanted, 5e-9)
        work = sum(run.probe(f"motor_{i}")["work"][-1] for i in (1, 2, 3))
        report.near(f"work of the motors in one round, {ms} ms [J]", work, 0.0, 1e-6)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
