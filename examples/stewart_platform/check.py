# SPDX-License-Identifier: Apache-2.0
"""A Stewart platform: the pose by its legs against the desired one, and the forces of its motors against the equations of
momentum of platform and legs along that motion."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, cross, dot, solve, subtract  # noqa: E402

FOOT, HEAD, HEIGHT, W = 0.8, 0.5, 1.0, math.pi
GRAVITY = (0, 0, -9.81)
MASS, INERTIA_Z = 120.0, 12.0                                 # it turns about z only
CYLINDER = dict(m=8.0, J=(0.22, 0.22, 0.01))                  # its centre 0.3 m from the foot
ROD = dict(m=5.0, J=(0.15, 0.15, 0.002))                      # 0.3 m from the head
A = [(FOOT * math.cos(math.radians(d)), FOOT * math.sin(math.radians(d)), 0.0) for d in (-10, 10, 110, 130, 230, 250)]
B = [(HEAD * math.cos(math.radians(d)), HEAD * math.sin(math.radians(d)), 0.0) for d in (-50, 50, 70, 170, 190, 290)]
STEP = 2e-3                                                   # of the differences


def plus(a, b, s=1.0):
    return tuple(x + s * y for x, y in zip(a, b))


def times(s, a):
    return tuple(s * x for x in a)


def unit(a):
    return times(1 / math.sqrt(dot(a, a)), a)


def turned(yaw, b):
    return (b[0] * math.cos(yaw) - b[1] * math.sin(yaw), b[0] * math.sin(yaw) + b[1] * math.cos(yaw), b[2])


def centre(t):
    return (0.1 * (1 - math.cos(W * t)), 0.1 * math.sin(W * t), HEIGHT + 0.1 * math.sin(2 * W * t))


def yaw(t):
    return 0.3 * math.sin(W * t)


def leg(i, t):
    return subtract(plus(centre(t), turned(yaw(t), B[i])), A[i])


def length(i, t):
    return math.sqrt(dot(leg(i, t), leg(i, t)))


def axes(i, t):
    """Axes of a leg: two across, one along; the axes of the cross are that at the floor and the second one."""
    u = unit(leg(i, t))
    second = unit(cross(u, floor_axis(i)))
    return cross(second, u), second, u


def floor_axis(i):
    d = leg(i, 0.0)
    return unit((-d[1], d[0], 0.0))


def rate(f, t):
    """Derivative of a vector function of time, with errors of the sixth order."""
    sides = [subtract(f(t + k * STEP), f(t - k * STEP)) for k in (1, 2, 3)]
    return tuple((45 * a - 9 * b + c) / (60 * STEP) for a, b, c in zip(*sides))


def momentum(i, t):
    """Angular momentum of a leg about its foot."""
    e, de = axes(i, t), [rate(lambda s, k=k: axes(i, s)[k], t) for k in (0, 1, 2)]
    spin = times(0.5, plus(plus(cross(e[0], de[0]), cross(e[1], de[1])), cross(e[2], de[2])))
    total = (0.0, 0.0, 0.0)
    for part, at in ((CYLINDER, lambda s: 0.3), (ROD, lambda s: length(i, s) - 0.3)):
        for k in (0, 1, 2):
            total = plus(total, e[k], part["J"][k] * dot(e[k], spin))
        place = lambda s, at=at: times(at(s), axes(i, s)[2])  # noqa: E731
        total = plus(total, cross(place(t), times(part["m"], rate(place, t))))
    return total


def motor_forces(t):
    """Forces of the motors along the legs, on the rods."""
    acceleration = rate(lambda s: rate(centre, s), t)
    spin_rate = rate(lambda s: rate(lambda q: (yaw(q),), s), t)[0]
    force = times(MASS, subtract(acceleration, GRAVITY))     # required force and moment of the legs on the platform
    moment = (0.0, 0.0, INERTIA_Z * spin_rate)
    columns, own = [], []
    for i in range(6):
        _, second, u = axes(i, t)
        place = lambda s, i=i: times(length(i, s) - 0.3, axes(i, s)[2])  # noqa: E731
        weight = plus(times(0.3 * CYLINDER["m"], u), times(ROD["m"], place(t)))
        need = subtract(rate(lambda s, i=i: momentum(i, s), t), cross(weight, GRAVITY))
        held = cross(floor_axis(i), second)                  # a cross carries a moment along this only
        need = plus(need, held, -dot(need, u) / dot(held, u))
        across = times(-1 / length(i, t), cross(u, need))    # of the platform on the leg
        arm = turned(yaw(t), B[i])
        force, moment = plus(force, across), plus(moment, cross(arm, across))
        columns.append(u + cross(arm, u))
        own.append(ROD["m"] * dot(subtract(rate(lambda s: rate(place, s), t), GRAVITY), u))
    along = solve([[column[r] for column in columns] for r in range(6)], force + moment)
    return [a + b for a, b in zip(along, own)]


def main():
    report = Report()
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        for t in (0.3, 0.77, 1.6):
            row = round(t / 0.01)
            place, mark = run.points("platform")[row], run.points("mark")[row]
            for name, value, wanted in zip("xyz", place, centre(t)):
                report.near(f"platform {name} at {t} s, {ms} ms [m]", value, wanted, 1e-11)
            report.near(f"its rotation at {t} s, {ms} ms [rad]", math.atan2(mark[1] - place[1], mark[0] - place[0]), yaw(t), 1e-11)
            worst = 0.0
            for i, wanted in enumerate(motor_forces(t)):
                found = dot(run.points(f"motor_{i + 1}", "fx fy fz")[row], axes(i, t)[2])
                worst = max(worst, abs(found - wanted))
            report.below(f"forces of the motors at {t} s, {ms} ms, largest error of six [N]", worst, 5e-9)
        work = sum(run.probe(f"motor_{i}")["work"][-1] for i in range(1, 7))
        report.near(f"work of the motors in one round, {ms} ms [J]", work, 0.0, 1e-6)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
