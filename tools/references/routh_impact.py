# SPDX-License-Identifier: Apache-2.0
"""Reference solution of a rigid impact at one point with Coulomb friction and Stronge's energetic restitution.

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
import math

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
