#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reference solution of a rigid impact at one point with Coulomb friction and Stronge's energetic restitution.

    tools/references/eccentric_impact.py --write tests/validation/data/eccentric_impact.csv
    tools/references/eccentric_impact.py --check tests/validation/data/eccentric_impact.csv

The velocity u of one body's point against the other's follows the normal impulse p, which grows as time does while
nothing moves (Routh, Advanced Rigid Dynamics, 1905, art. 182 ff.; Keller, J. Appl. Mech. 53, 1986, 1-4):

    du/dp = K f,   f = (-μ d, 1) while it slips along the unit vector d = u_t/|u_t|
    K = Σ (1/m I - r× J⁻¹ r×)            over the bodies, r from the centre of mass to the point

In polar coordinates u_t = s d(φ), with a = d·c, b = d⊥·c of c = K_tn - μ K_tt d and dp = s dτ,

    d(ln s)/dτ = a(φ),   dφ/dτ = b(φ)

which is smooth down to s = 0. Where slip has ended it stays so if that takes friction within the cone,
|K_tt⁻¹ K_tn| <= μ; else slip begins again along the direction with b = 0, a > 0 and keeps it (Bhatt and Koechling,
J. Appl. Mech. 62, 1995, 893-898; Stronge, Impact Mechanics, 2000, chapter 4). The impact ends

    stronge   when W(p) = ∫ u_n dp, after its least value W_c, has risen by -e² W_c: the energetic coefficient
              (Stronge, Proc. R. Soc. A 431, 1990, 169-181). Energy never rises.
    poisson   when p is 1 + e times what it was when u_n vanished
    newton    when u_n is -e times what it was. Energy may rise.

All three agree where slip does not change direction, and where friction or eccentricity is missing.
Vectors are (tangent, tangent, normal), the normal towards the body that receives the impulse. Needs nothing but Python.
"""
import argparse
import csv
import math
import sys

LAWS = ("stronge", "poisson", "newton")


class Outcome:
    """An impact: impulse and velocities at the point, mode of slip, work of the normal and tangential impulse."""

    def __init__(self, K, u0):
        self.K, self.u0 = K, u0
        self.impulse = [0.0, 0.0, 0.0]
        self.mode = ""
        self.work = 0.0  # Of the normal impulse so far [J].
        self.least = 0.0  # Its minimum so far.
        self.p_turn = 0.0  # Normal impulse when the normal velocity vanished.

    @property
    def velocity(self):
        return [u + dot(row, self.impulse) for u, row in zip(self.u0, self.K)]

    @property
    def energy(self):
        """Change of kinetic energy, ½ P·(u before + u after)."""
        return 0.5 * sum(p * (a + b) for p, a, b in zip(self.impulse, self.u0, self.velocity))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def times(M, v):
    return [dot(row, v) for row in M]


def inverse(M):
    """Of a 3x3 matrix."""
    a, b, c = M
    columns = [cross(b, c), cross(c, a), cross(a, b)]
    det = dot(a, columns[0])
    return [[columns[j][i] / det for j in range(3)] for i in range(3)]


def rotation(axis, degrees):
    """Matrix of a rotation about an axis."""
    n = math.sqrt(dot(axis, axis))
    x, y, z = (v / n for v in axis)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    t = 1 - c
    return [[c + t * x * x, t * x * y - s * z, t * x * z + s * y], [t * x * y + s * z, c + t * y * y, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, c + t * z * z]]


def turned(R, moments):
    """Inertia in space of principal moments under a rotation."""
    return [[sum(R[i][k] * moments[k] * R[j][k] for k in range(3)) for j in range(3)] for i in range(3)]


def mobility(mass, inertia, arm):
    """K of one body: velocity of its point for a unit impulse there. The inertia is about its centre, all axes those of space."""
    J1 = inverse(inertia)
    columns = []
    for k in range(3):
        unit = [float(i == k) for i in range(3)]
        spin = cross(times(J1, cross(arm, unit)), arm)
        columns.append([unit[i] / mass + spin[i] for i in range(3)])
    return [[columns[j][i] for j in range(3)] for i in range(3)]


def impact(K, velocity, mu, e, law="stronge"):
    """An impact with relative velocity `velocity` = (t, t, n), n < 0, through K, coefficients of friction and restitution."""
    if law not in LAWS:
        raise ValueError(f"no law '{law}'; there are {', '.join(LAWS)}")
    if not velocity[2] < 0:
        raise ValueError("the bodies do not approach: the third component of the velocity must be negative")
    found = Outcome([[float(x) for x in row] for row in K], [float(x) for x in velocity])
    slip = math.hypot(velocity[0], velocity[1])
    # Slower slip is the rounding of a velocity and counts as none.
    if mu > 0 and slip > 1e-14 * abs(velocity[2]):
        if slides(found, mu, e, law):
            return found
    elif mu > 0:
        found.mode = "no slip"
    f, mode = resting_force(found.K, mu) if mu > 0 else ([0.0, 0.0], "no friction")
    phase = " in compression" if found.velocity[2] < 0 else " in restitution"
    found.mode = mode if not found.mode else f"{found.mode}; {mode}{phase if found.mode == 'slip ends' else ''}"
    straight(found, [*f, 1.0], e, law, math.inf)
    return found


def slides(found, mu, e, law):
    """Slip until the end of the impact (True) or of slip (False)."""
    K = found.K
    u = found.velocity
    s0, phi = math.hypot(u[0], u[1]), math.atan2(u[1], u[0])
    a, b, d = slip_rates(K, mu, phi)
    found.mode = "slides"
    size = max(abs(x) for row in K for x in row)
    if abs(b) < 1e-14 * size:  # Slip of constant direction, as in the plane.
        q = -s0 / a if a < 0 else math.inf
        if straight(found, [-mu * d[0], -mu * d[1], 1.0], e, law, q):
            return True
    elif curved(found, mu, e, law, s0, phi):
        return True
    found.mode = "slip ends"
    return False


def slip_rates(K, mu, phi):
    d = (math.cos(phi), math.sin(phi))
    c = [K[i][2] - mu * (K[i][0] * d[0] + K[i][1] * d[1]) for i in range(2)]
    return c[0] * d[0] + c[1] * d[1], c[1] * d[0] - c[0] * d[1], d


def target(found, e, law):
    """Excess over the law's condition: positive once the impact has ended, if the normal velocity has changed its sign."""
    p, u_n = found.impulse[2], found.velocity[2]
    if law == "stronge":
        return found.work - (1 - e * e) * found.least
    if law == "poisson":
        return p - (1 + e) * found.p_turn
    return u_n + e * found.u0[2]


def straight(found, f, e, law, length):
    """A piece with constant f = (f_t, 1) until the impact ends (True) or p has grown by `length` (False).
    Normal velocity u + c q and work W + u q + ½ c q² of the further impulse q are known."""
    u, c = found.velocity[2], dot(found.K[2], f)

    def advance(q):
        found.work += u * q + 0.5 * c * q * q
        found.impulse = [P + x * q for P, x in zip(found.impulse, f)]

    if u < 0 or found.least == 0:
        turn = -u / c if c > 0 else math.inf
        if turn > length:
            advance(length)
            found.least = min(found.least, found.work)
            return False
        advance(turn)
        found.least, found.p_turn = min(found.least, found.work), found.impulse[2]
        length, u = length - turn, 0.0
    if law == "stronge":
        rest = (1 - e * e) * found.least - found.work  # Remaining rise.
        q = ends = 2 * rest / (u + math.sqrt(max(u * u + 2 * c * rest, 0.0))) if rest > 0 else 0.0
    elif law == "poisson":
        q = ends = max((1 + e) * found.p_turn - found.impulse[2], 0.0)
    else:
        q = ends = max((-e * found.u0[2] - u) / c, 0.0)
    q = min(ends, length)
    advance(q)
    return ends <= length


# Dormand and Prince's pair of orders 5 and 4.
STAGES = ((1 / 5,), (3 / 40, 9 / 40), (44 / 45, -56 / 15, 32 / 9), (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
          (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656), (35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84))
FOURTH = (5179 / 57600, 0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40)


def dormand_prince(rates, y, h):
    """A step, and an estimate of its error."""
    ks = [rates(y)]
    for row in STAGES:
        at = [yi + h * sum(w * k[i] for w, k in zip(row, ks)) for i, yi in enumerate(y)]
        ks.append(rates(at))
    other = [yi + h * sum(w * k[i] for w, k in zip(FOURTH, ks)) for i, yi in enumerate(y)]
    return at, [abs(x - z) for x, z in zip(at, other)]


def curved(found, mu, e, law, s0, phi):
    """Slip whose direction turns, integrated over τ. State: ln(s/s0), φ, p, P_t, W."""
    K, u0 = found.K, found.u0

    def rates(y):
        a, b, d = slip_rates(K, mu, y[1])
        s = s0 * math.exp(y[0])
        u_n = u0[2] + K[2][0] * y[3] + K[2][1] * y[4] + K[2][2] * y[2]
        return [a, b, s, -mu * d[0] * s, -mu * d[1] * s, s * u_n]

    def put(y):
        found.impulse, found.work = [y[3], y[4], y[2]], y[5]

    size = max(abs(x) for row in K for x in row)
    scale = [1, 1, abs(u0[2]) / size, abs(u0[2]) / size, abs(u0[2]) / size, u0[2] ** 2 / size]
    y, h = [0.0, phi, 0.0, 0.0, 0.0, 0.0], 1e-3 / size
    turned_back = False
    for _ in range(100000):
        new, errors = dormand_prince(rates, y, h)
        error = max(x / (1e-13 * s) for x, s in zip(errors, scale))
        if error > 1:
            h *= max(0.2, 0.9 * error**-0.2)
            continue

        def event(value):
            """The state at which a quantity vanishes within this step, by bisection of its length."""
            low, high = 0.0, h
            for _ in range(60):
                middle = 0.5 * (low + high)
                at, _ = dormand_prince(rates, y, middle)
                put(at)
                low, high = (middle, high) if value() < 0 else (low, middle)
            return dormand_prince(rates, y, high)[0]

        put(new)
        if not turned_back and found.velocity[2] >= 0:
            at = event(lambda: found.velocity[2])
            put(at)
            found.least, found.p_turn, turned_back = min(found.least, found.work), found.impulse[2], True
            if target(found, e, law) >= 0:
                return True
            y = at
            continue
        if turned_back and target(found, e, law) >= 0:
            put(event(lambda: target(found, e, law)))
            return True
        if turned_back and found.velocity[2] < 0:
            turned_back = False  # Compression again.
        y = new
        if y[0] < -32:  # 1e-14 of the slip remains.
            found.least = min(found.least, found.work)
            return False
        h *= min(5, max(0.2, 0.9 * max(error, 1e-10) ** -0.2))
    raise ArithmeticError("the slip of this impact ends in no number of steps")


def resting_force(K, mu):
    """Tangential force per normal force once slip has ended, and the mode of the point."""
    det = K[0][0] * K[1][1] - K[0][1] * K[1][0]
    stick = [-(K[1][1] * K[0][2] - K[0][1] * K[1][2]) / det, -(K[0][0] * K[1][2] - K[1][0] * K[0][2]) / det]
    if math.hypot(*stick) <= mu * (1 + 1e-12):
        return stick, "sticks"
    count = 720
    for i in range(count):
        low, high = 2 * math.pi * i / count, 2 * math.pi * (i + 1) / count
        at_low = slip_rates(K, mu, low)[1]
        if at_low == 0 and slip_rates(K, mu, low)[0] > 0:
            high = low
        elif at_low * slip_rates(K, mu, high)[1] >= 0:
            continue
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if slip_rates(K, mu, middle)[1] * at_low > 0 else (low, middle)
        a, _, d = slip_rates(K, mu, high)
        if a > 0:
            return [-mu * d[0], -mu * d[1]], "slips again"
    raise ArithmeticError("no direction in which slip can begin")


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
    u, P, W, least, turned_back = list(u0), [0.0] * 3, 0.0, 0.0, False
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
