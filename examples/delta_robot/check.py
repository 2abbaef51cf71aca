# SPDX-License-Identifier: Apache-2.0
"""A delta robot from an SDFormat file: the platform against the desired path, and the moments of the motors against the principle of
virtual power along that path."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, polhode, solve  # noqa: E402

R, r, ARM, ROD, HALF, W = 0.2, 0.06, 0.25, 0.5, 0.05, 2 * math.pi
PLATFORM, UPPER, LOWER = (0.6, (5e-4, 5e-4, 1e-3)), (0.4, (1e-4, 2.1e-3, 2.1e-3)), (0.1, (1e-5, 2.1e-3, 2.1e-3))
GRAVITY = (0.0, 0.0, -9.81)
STEP = 1e-3                                                   # of the differences [s, m]


def add(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def slope(f, at):
    """Derivative of a list of numbers, errors of the sixth order."""
    total = [0.0] * len(f(at))
    for k, weight in ((1, 45.0), (2, -9.0), (3, 1.0)):
        total = add(total, add(f(at + k * STEP), f(at - k * STEP), -1.0), weight / (60 * STEP))
    return total


def path(t):
    return [0.08 * (1 - math.cos(W * t)), 0.08 * math.sin(W * t), -0.45 - 0.03 * (1 - math.cos(2 * W * t))]


def sides(k):
    """Direction from the axis of the robot to a hinge, and that of the hinge."""
    a = 2 * math.pi * k / 3
    return [math.cos(a), math.sin(a), 0.0], [-math.sin(a), math.cos(a), 0.0]


def angle(k, p):
    """Angle of an arm below the horizontal: law of cosines in its plane."""
    out, along = sides(k)
    a, b, c = dot(p, out) + r - R, dot(p, along), p[2]
    reach = math.hypot(a, c)
    return math.atan2(-c, a) - math.acos((a * a + b * b + c * c + ARM ** 2 - ROD ** 2) / (2 * ARM * reach))


def bodies(p):
    """Mass, principal moments, centre of mass and axes of all moving bodies with the platform at p."""
    found = [(*PLATFORM, p, [[1, 0, 0], [0, 1, 0], [0, 0, 1]])]
    for k in range(3):
        out, along = sides(k)
        th = angle(k, p)
        x = add([math.cos(th) * c for c in out], [0, 0, 1], -math.sin(th))
        hinge = [R * c for c in out]
        found.append((*UPPER, add(hinge, x, ARM / 2), [x, along, cross(x, along)]))
        elbow, wrist = add(hinge, x, ARM), add(p, out, r)
        u = unit(add(wrist, elbow, -1.0))
        z = unit(cross(u, along))                             # second axis of the universal joint
        for side in (HALF, -HALF):
            found.append((*LOWER, add(add(elbow, u, ROD / 2), along, side), [u, cross(z, u), z]))
    return found


def spin(axes, rates):
    """Angular velocity of axes whose unit vectors have these rates."""
    total = [0.0, 0.0, 0.0]
    for a, rate in zip(axes, rates):
        total = add(total, cross(a, rate), 0.5)
    return total


def moving(at, s):
    """Velocities and angular velocities of all bodies, as the parameter s of their places at(s) goes on."""
    def flat(s):
        return [c for b in bodies(at(s)) for v in (b[2], *b[3]) for c in v]
    rates = slope(flat, s)
    vectors = [rates[3 * i:3 * i + 3] for i in range(len(rates) // 3)]
    return [(vectors[4 * i], spin(b[3], vectors[4 * i + 1:4 * i + 4])) for i, b in enumerate(bodies(at(s)))]


def momenta(t):
    """Momentum and angular momentum of all bodies, one after the other."""
    found = []
    for (mass, moments, _, axes), (v, w) in zip(bodies(path(t)), moving(path, t)):
        found += [mass * c for c in v]
        spun = [0.0, 0.0, 0.0]
        for J, a in zip(moments, axes):
            spun = add(spun, a, J * dot(a, w))
        found += spun
    return found


def motor_moments(t):
    """For each direction of the platform: power of the motors = that of the rates of momenta less the weights."""
    p, rates = path(t), slope(momenta, t)
    rows, right = [], []
    for j in range(3):
        line = lambda s, j=j: [c + (s if i == j else 0.0) for i, c in enumerate(p)]  # noqa: E731
        power = 0.0
        for i, ((mass, *_), (v, w)) in enumerate(zip(bodies(p), moving(line, 0.0))):
            force = add(rates[6 * i:6 * i + 3], GRAVITY, -mass)
            power += dot(force, v) + dot(rates[6 * i + 3:6 * i + 6], w)
        rows.append(slope(lambda s, line=line: [angle(k, line(s)) for k in range(3)], 0.0))
        right.append(power)
    return solve(rows, right)


def main():
    report = Report()
    polhode("check", HERE / "delta.sdf")
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        for t in (0.13, 0.5, 0.81):
            row = round(t / 0.01)
            place, mark, side = (run.points(name)[row] for name in ("platform", "mark", "side"))
            off = add(place, path(t), -1.0)
            report.below(f"platform from its path at {t} s, {ms} ms [m]", math.sqrt(dot(off, off)), 1e-11)
            turn = add(add(mark, place, -1.0), (0.05, 0, 0), -1.0) + add(add(side, place, -1.0), (0, 0.05, 0), -1.0)
            report.below(f"its rotation at {t} s, {ms} ms [rad]", math.sqrt(dot(turn, turn)) / 0.05, 1e-10)
            for k, wanted in enumerate(motor_moments(t)):     # their differences have 2^-53 / STEP^2 of rounding
                moment = dot(run.points(f"motor_{k + 1}", "mx my mz")[row], sides(k)[1])
                report.near(f"moment of motor {k + 1} at {t} s, {ms} ms [N m]", moment, wanted, 1e-9)
        work = sum(run.probe(f"motor_{k}")["work"][-1] for k in (1, 2, 3))
        report.near(f"work of the motors in one round, {ms} ms [J]", work, 0.0, 1e-6)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
