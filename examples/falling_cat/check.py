# SPDX-License-Identifier: Apache-2.0
"""A cat that turns over in its fall without angular momentum: its rotation against the equation of zero angular momentum for its
shape, integrated independently."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, cross, dot, integrate, solve, subtract  # noqa: E402

FRONT = dict(m=1.8, J=(2.6e-3, 8.0e-3, 8.4e-3), at=-0.11)     # kg, kg m^2, m from the joint along the spine
REAR = dict(m=2.2, J=(3.1e-3, 9.5e-3, 9.9e-3), at=0.12)
BEND, T = math.radians(-77.66), 0.6                           # first towards its legs, about -y
REDUCED = FRONT["m"] * REAR["m"] / (FRONT["m"] + REAR["m"])
E = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def bends(t):
    """Angles of the joint about y of the front and z of the rear, and their rates."""
    w = 2 * math.pi / T
    b, db = BEND * (1 - math.cos(w * t)) / 2, BEND * w * math.sin(w * t) / 2
    c, s = math.cos(2 * w * t), math.sin(2 * w * t)
    return b * c, b * s, db * c - 2 * w * b * s, db * s + 2 * w * b * c


def times(matrix, v):
    return tuple(sum(a * b for a, b in zip(row, v)) for row in matrix)


def product(A, B):
    return tuple(tuple(sum(A[i][k] * B[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def transposed(A):
    return tuple(zip(*A))


def spin(t):
    """Angular velocity of the front, along its own axes, at which the total angular momentum is zero, and the rotational energy."""
    y, z, dy, dz = bends(t)
    about_y = ((math.cos(y), 0.0, math.sin(y)), (0.0, 1.0, 0.0), (-math.sin(y), 0.0, math.cos(y)))
    about_z = ((math.cos(z), -math.sin(z), 0.0), (math.sin(z), math.cos(z), 0.0), (0.0, 0.0, 1.0))
    R = product(about_y, about_z)                             # of the rear relative to the front
    relative = tuple(dy * a + dz * b for a, b in zip(E[1], times(about_y, E[2])))
    arm = times(R, (REAR["at"], 0.0, 0.0))
    d = subtract(arm, (FRONT["at"], 0.0, 0.0))                # from centre to centre
    J = product(product(R, tuple(tuple(REAR["J"][i] * E[i][j] for j in range(3)) for i in range(3))), transposed(R))

    def momentum(omega, relative):
        """Angular momentum and twice the kinetic energy, about the centre of both."""
        rear = tuple(a + b for a, b in zip(omega, relative))
        apart = tuple(a + b for a, b in zip(cross(omega, d), cross(relative, arm)))
        orbit, own = cross(d, apart), times(J, rear)
        front = tuple(j * w for j, w in zip(FRONT["J"], omega))
        total = tuple(a + b + REDUCED * c for a, b, c in zip(front, own, orbit))
        return total, dot(front, omega) + dot(own, rear) + REDUCED * dot(apart, apart)

    still = (0.0, 0.0, 0.0)
    locked = transposed([momentum(e, still)[0] for e in E])
    omega = solve(locked, tuple(-h for h in momentum(still, relative)[0]))
    return omega, momentum(omega, relative)[1] / 2


def turning(t, rows):
    """Rows of the front's rotation matrix: the rate of each is the row crossed with the spin."""
    omega, _ = spin(t)
    return [x for i in range(3) for x in cross(rows[3 * i:3 * i + 3], omega)]


def power(t, h=2e-4):
    """Rate of the energy, errors of the sixth order."""
    e = [spin(t + k * h)[1] - spin(t - k * h)[1] for k in (1, 2, 3)]
    return (45 * e[0] - 9 * e[1] + e[2]) / (60 * h)


def main():
    report = Report()
    instants = (0.0, 0.14, 0.27, 0.46, 0.6)
    exact = integrate(turning, [x for e in E for x in e], instants, 5e-3)
    turn = math.degrees(math.atan2(exact[-1][7], exact[-1][8])) % 360
    errors = {}
    for order, ms in ((2, 5), (2, 2), (2, 1), (2, 0.1), (4, 5), (4, 1), (6, 5), (6, 2), (8, 2)):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms", f"analysis.order={order}")
        what, second = f"{ms} ms, order {order}", 1e-3 * (ms / 2) ** 2
        place = {2: second, 4: 4e-8 * (ms / 2) ** 4, 6: 1e-13 * (ms / 2) ** 6 + 1e-12, 8: 1e-12}[order]
        work = second if order < 6 else 2e-9                  # velocities against the motors are of order two up to order four
        centre, marks = run.points("front"), [run.points(f"front_{c}") for c in "xyz"]
        rear, motors = run.points("rear"), [run.probe(name) for name in ("nod", "sway")]
        for t, rows in zip(instants[1:], exact[1:]):
            k = round(t / 0.01)
            axes = transposed([subtract(mark[k], centre[k]) for mark in marks])
            worst = max(abs(axes[i][j] - rows[3 * i + j]) for i in range(3) for j in range(3))
            report.below(f"axes of the front at {t} s, {what}", worst, place)
            fallen = (FRONT["m"] * centre[k][2] + REAR["m"] * rear[k][2]) / (FRONT["m"] + REAR["m"]) - 2
            report.near("fall of both [m]", fallen, -9.81 * t * t / 2, 1e-12)
            report.near("work of the motors [J]", sum(motor["work"][k] for motor in motors), spin(t)[1], work)
            report.near("their power [W]", sum(motor["power"][k] for motor in motors), power(t), 1e-9)
        errors[order, ms] = worst
        report.near(f"turn after the loops, {what} [deg]", math.degrees(math.atan2(axes[2][1], axes[2][2])) % 360, turn, 60 * place)
        report.below("angular momentum", run.figures["angular_momentum_drift"], ROUND_OFF)
        report.below("energy drift", run.figures["energy_drift"], ROUND_OFF)
    report.near("order 2", math.log10(errors[2, 1] / errors[2, 0.1]), 2, 0.01)
    report.near("order 4", math.log(errors[4, 5] / errors[4, 1], 5), 4, 0.03)
    report.end()


if __name__ == "__main__":
    main()
