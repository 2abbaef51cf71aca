#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Table of rigid impacts at one point with friction and energetic restitution, by routh_impact.py, and checks of both.

    tools/references/eccentric_impact.py --write tests/validation/data/eccentric_impact.csv
    tools/references/eccentric_impact.py --check tests/validation/data/eccentric_impact.csv

Needs nothing but Python.
"""
import argparse
import csv
import math
import sys

from routh_impact import LAWS, cross, impact, inverse, mobility, rotation, times, turned

# ---------------------------------------------------------------------------------------------------------------------
# Checks of the solution itself.


def planar_by_wang_and_mason(B1, B2, B3, S0, C0, mu, e):
    """Impulses (tangential, normal) of a planar impact by Poisson's hypothesis, case by case: Wang and Mason, J. Appl.
    Mech. 59 (1992), 635-642, table 1. Sliding S = S0 + B1 Px - B3 Py, approach C = C0 - B3 Px + B2 Py."""
    s = 1 if S0 > 0 else -1
    stuck = B3 / B1
    Pd, Pq = (B2 + s * mu * B3) * s * S0, (mu * B1 + s * B3) * -C0
    if Pd > (1 + e) * Pq:
        Py = -(1 + e) * C0 / (B2 + s * mu * B3)
        return "slides", -s * mu * Py, Py
    if mu > abs(stuck):
        if Pd < Pq:
            Py = -(1 + e) * (B1 * C0 + B3 * S0) / (B1 * B2 - B3 * B3)
            return "slip ends; sticks in compression", (B3 * Py - S0) / B1, Py
        Py = -(1 + e) * C0 / (B2 + s * mu * B3)
        return "slip ends; sticks in restitution", (B3 * Py - S0) / B1, Py
    if Pd < Pq:
        Py = -(1 + e) / (B2 - s * mu * B3) * (C0 + 2 * s * mu * B3 * S0 / (B3 + s * mu * B1))
        return "slip ends; slips again in compression", s * mu * (Py - 2 * S0 / (B3 + s * mu * B1)), Py
    Py = -(1 + e) * C0 / (B2 + s * mu * B3)
    return "slip ends; slips again in restitution", s * mu * (Py - 2 * S0 / (B3 + s * mu * B1)), Py


def marched(K, u0, mu, e, count=5000):
    """The same by small increments of p with friction as the nearest force of its cone that ends the slip: a simple method of low accuracy."""
    u, P, W, least = list(u0), [0.0] * 3, 0.0, 0.0
    dp = -u0[2] / K[2][2] / count
    det = K[0][0] * K[1][1] - K[0][1] * K[1][0]
    while True:
        v = [u[i] + K[i][2] * dp for i in range(2)]
        t = [-(K[1][1] * v[0] - K[0][1] * v[1]) / det, -(K[0][0] * v[1] - K[1][0] * v[0]) / det]
        if math.hypot(*t) > mu * dp:
            # Within the last increments of slip the force is that whose end velocity is against it.
            speed = math.hypot(*v)
            t = [-mu * dp * x / speed for x in v]
            for _ in range(30):
                after = [v[i] + K[i][0] * t[0] + K[i][1] * t[1] for i in range(2)]
                size = math.hypot(*after)
                t = [0.5 * (t[i] - mu * dp * after[i] / size) for i in range(2)]
        before = u[2]
        for i in range(3):
            u[i] += K[i][0] * t[0] + K[i][1] * t[1] + K[i][2] * dp
        P = [P[0] + t[0], P[1] + t[1], P[2] + dp]
        W += 0.5 * (before + u[2]) * dp
        least = min(least, W)
        if u[2] >= 0 and W >= (1 - e * e) * least:
            return P


def numbers(seed, count):
    """Pseudo-random numbers between 0 and 1, the same in every run (Park and Miller)."""
    x = seed
    for _ in range(count):
        x = 16807 * x % 2147483647
        yield x / 2147483647


def check_planar():
    """All five modes of Wang and Mason, from random rods and discs, to round-off."""
    seen, worst = {}, 0.0
    for i in range(2000):
        a, b, c, d, m, ee = numbers(i + 1, 6)
        x, y, radius = 4 * a - 2, 2 * b, 0.1 + c  # Arm of the point, radius of gyration; mass 1.
        B1, B2, B3 = 1 + y * y / radius**2, 1 + x * x / radius**2, x * y / radius**2
        S0, C0, mu, e = 6 * d - 3, -1.0, 1.5 * m, ee
        mode, Px, Py = planar_by_wang_and_mason(B1, B2, B3, S0, C0, mu, e)
        # The other tangent has the mobility of an equal mass without coupling.
        K = [[B1, 0, -B3], [0, 1, 0], [-B3, 0, B2]]
        ours = impact(K, [S0, 0, C0], mu, e, "poisson")
        assert ours.mode == mode, (ours.mode, mode)
        seen[mode] = seen.get(mode, 0) + 1
        size = abs(Px) + abs(Py)
        worst = max(worst, abs(ours.impulse[0] - Px) / size, abs(ours.impulse[2] - Py) / size)
    assert len(seen) == 5 and min(seen.values()) > 20, seen
    assert worst < 1e-9, worst
    return f"planar impacts of Wang and Mason, {len(seen)} modes: {worst:.0e} of the impulse"


def random_case(seed):
    values = list(numbers(seed, 12))
    arm = [2 * v - 1 for v in values[:3]]
    J = turned(rotation([values[3] - 0.5, values[4] - 0.5, values[5]], 360 * values[6]), [0.05 + 0.02 * v for v in values[7:10]])
    return mobility(1, J, arm), [4 * values[10] - 2, 4 * values[11] - 2, -1.0]


def check_energy():
    """Checks of impacts in space: normal work by the energetic coefficient, energy never rises, work of friction never positive,
    the impulse within its cone; and agreement of all three laws where friction does not change its direction."""
    worst, modes = 0.0, {}
    for seed in range(1, 51):
        K, u = random_case(seed)
        for mu in (0.1, 0.5, 1.2):
            for e in (0, 0.3, 0.7, 1):
                found = impact(K, u, mu, e)
                modes[found.mode] = modes.get(found.mode, 0) + 1
                normal, friction = found.work, found.energy - found.work
                worst = max(worst, abs(normal - (1 - e * e) * found.least))
                assert found.energy <= 1e-12 and friction <= 1e-11, (seed, mu, e, found.energy, friction)
                assert math.hypot(*found.impulse[:2]) <= mu * found.impulse[2] * (1 + 1e-10)
                if e == 0:
                    worst = max(worst, abs(found.velocity[2]))
        smooth = [impact(K, u, 0, 0.6, law).impulse[2] for law in LAWS]
        worst = max(worst, max(abs(p - 1.6 / K[2][2]) for p in smooth))
    assert len(modes) >= 5, modes
    assert worst < 1e-10, worst
    return f"{sum(modes.values())} impacts in space, {len(modes)} modes: energetic restitution to {worst:.0e}, no energy gained"


def check_march():
    """Integration by small increments of p, to a thousandth of the impulse."""
    worst = 0.0
    for seed in (3, 7, 11, 19):
        K, u = random_case(seed)
        for mu, e in ((0.1, 0.7), (0.5, 0.3), (0.8, 1)):
            ours, rough = impact(K, u, mu, e).impulse, marched(K, u, mu, e)
            worst = max(worst, max(abs(a - b) for a, b in zip(ours, rough)) / ours[2])
    assert worst < 1e-3, worst
    return f"integration in 5,000 increments: {worst:.0e} of the impulse"


def check_ball():
    """A ball at any friction: p = (1 + e) w m, friction μp or 2/7 of the slip."""
    for mu in (0, 0.1, 0.5):
        for e in (0, 0.3, 0.7, 1):
            K = mobility(1, turned(rotation([1, 0, 0], 0), [0.4 * 0.01] * 3), [0, 0, -0.1])
            P = impact(K, [3, 0, -2], mu, e).impulse
            assert abs(P[2] - 2 * (1 + e)) < 1e-13 and abs(P[0] + min(2 * mu * (1 + e), 3 / 3.5)) < 1e-13, (mu, e, P)
    return "a ball, sliding and sticking"


# ---------------------------------------------------------------------------------------------------------------------
# The table.


def rod_shape(length, side, mass):
    """A rod of square section: sizes, principal moments."""
    return [length, side, side], [mass * 2 * side**2 / 12] + [mass * (length**2 + side**2) / 12] * 2


def box_shape(a, b, c, mass):
    return [a, b, c], [mass * (b * b + c * c) / 12, mass * (a * a + c * c) / 12, mass * (a * a + b * b) / 12]


def rows():
    """Rods on an edge and on a corner, boxes on an edge and on a corner: on the fixed floor z = 0, without initial rotation. An edge
    is hit in its middle, which is equivalent to its two corners if the body moves in the plane normal to it."""
    mass, approach = 1.0, 2.0
    bodies = []
    for angle in (20, 45, 70):
        bodies.append((f"rod {angle}", *rod_shape(1.0, 0.1, mass), rotation([0, 1, 0], angle), [0, 1, 0, angle], "edge"))
    for angle in (15, 30, 60):
        bodies.append((f"box {angle}", *box_shape(0.4, 0.3, 0.2, mass), rotation([0, 1, 0], angle), [0, 1, 0, angle], "edge"))
    for axis, angle in (((1, 2, 0), 30), ((2, 1, 1), 50), ((1, 1, 0), 70)):
        bodies.append((f"box on a corner {angle}", *box_shape(0.4, 0.3, 0.2, mass), rotation(axis, angle), [*axis, angle], "corner"))
    bodies.append(("rod on a corner 40", *rod_shape(1.0, 0.1, mass), rotation([1, 3, 0], 40), [1, 3, 0, 40], "corner"))
    for name, sizes, moments, R, turn, kind in bodies:
        corners = [times(R, [0.5 * i * sizes[0], 0.0 if kind == "edge" else 0.5 * j * sizes[1], 0.5 * k * sizes[2]])
                   for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
        arm = min(corners, key=lambda c: c[2])
        J = turned(R, moments)
        K = mobility(mass, J, arm)
        for vx, vy in ((-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)) if kind == "edge" else ((1.0, 0.5), (-0.5, 1.0)):
            for e in (0, 0.3, 0.7, 1):
                for mu in (0, 0.1, 0.5):
                    found = impact(K, [vx, vy, -approach], mu, e)
                    spin = times(inverse(J), cross(arm, found.impulse))
                    after = [v + P / mass for v, P in zip((vx, vy, -approach), found.impulse)]
                    yield {"body": name, "length x [m]": sizes[0], "length y [m]": sizes[1], "length z [m]": sizes[2], "mass [kg]": mass,
                           "axis x": turn[0], "axis y": turn[1], "axis z": turn[2], "angle [deg]": turn[3],
                           "vx [m/s]": vx, "vy [m/s]": vy, "vz [m/s]": -approach, "e": e, "mu": mu,
                           "arm x [m]": arm[0], "arm y [m]": arm[1], "arm z [m]": arm[2],
                           "impulse x [N s]": found.impulse[0], "impulse y [N s]": found.impulse[1], "impulse z [N s]": found.impulse[2],
                           "vx after [m/s]": after[0], "vy after [m/s]": after[1], "vz after [m/s]": after[2],
                           "spin x after [rad/s]": spin[0], "spin y after [rad/s]": spin[1], "spin z after [rad/s]": spin[2],
                           "energy [J]": found.energy, "mode": found.mode}


def written(value):
    return value if isinstance(value, str) else f"{0.0 if abs(value) < 1e-13 else value:.12g}"


def compare(path):
    """Checks the stored table against the present results, and each row against bounds of any impact."""
    with open(path, newline="") as lines:
        stored = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    fresh = list(rows())
    assert len(stored) == len(fresh), f"{path} has {len(stored)} rows instead of {len(fresh)}; write it again with --write"
    for old, new in zip(stored, fresh):
        for key, value in new.items():
            same = old[key] == value if isinstance(value, str) else abs(float(old[key]) - value) < 1e-9
            assert same, f"{path}: {new['body']}, e {new['e']}, mu {new['mu']}: {key} is {old[key]} there, {value} by this program"
        u = [float(old[f"v{c} [m/s]"]) for c in "xyz"]
        P, v, w, r = ([float(old[k.replace("?", c)]) for c in "xyz"] for k in
                      ("impulse ? [N s]", "v? after [m/s]", "spin ? after [rad/s]", "arm ? [m]"))
        energy = float(old["energy [J]"])
        point = [a + b for a, b in zip(v, cross(w, r))]
        assert abs(0.5 * sum(p * (a + b) for p, a, b in zip(P, u, point)) - energy) < 1e-9, "energy is not the work of the impulse"
        assert energy < 1e-9 and point[2] > -1e-9, "energy rises, or the bodies still approach"
        assert math.hypot(P[0], P[1]) <= float(old["mu"]) * P[2] + 1e-9, "the impulse leaves the cone of friction"
        if float(old["e"]) == 1 and float(old["mu"]) == 0:
            assert abs(energy) < 1e-9, "an elastic impact without friction changes the energy"
    return f"{len(stored)} rows of the table, {len({row['mode'] for row in stored})} modes"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", metavar="FILE", help="writes the table")
    parser.add_argument("--check", metavar="FILE", help="checks the solution and a stored table")
    options = parser.parse_args()
    if options.write:
        table = list(rows())
        with open(options.write, "w", newline="") as file:
            file.write("# Rigid impacts with friction and energetic restitution on the floor z = 0: tools/references/eccentric_impact.py\n")
            out = csv.writer(file, lineterminator="\n")
            out.writerow(table[0])
            out.writerows([written(value) for value in row.values()] for row in table)
    if options.check:
        for check in (check_planar, check_energy, check_march, check_ball, lambda: compare(options.check)):
            print(check())
    if not options.write and not options.check:
        parser.error("give --write FILE or --check FILE")
    return 0


if __name__ == "__main__":
    sys.exit(main())
