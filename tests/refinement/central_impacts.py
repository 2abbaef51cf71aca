# SPDX-License-Identifier: Apache-2.0
"""Central impacts of a ball of 1 kg and 0.1 m at 2 m/s on the floor, a free ball, a plate on a hinge, a chain of hinged links.

Without gravity all motion is straight before and after. A ball's inertia is 2/5 m r², so that an impulse J at its surface
changes the speed of the contact point by 7/2 J/m. With p = (1 + e) w m* the friction impulse is μp while slip lasts
(Routh: the direction of slip cannot change in a central impact), or the impulse that ends the slip, if that is less.
"""
from case import FLOOR, Case, Known, Variant, body, fall, largest, last, model, spin_y
from support import solve

R, M, W = 0.1, 1.0, 2.0  # m, kg, m/s of approach
EXACT = 1e-4 * W  # Required accuracy of a central impact at every step.
ABSOLUTE = (1, 0.5, 0.1, 0.01, 0.001)  # 10, 5, 1, 0.1, 0.01 ms
RESTITUTIONS, FRICTIONS = (0, 0.3, 0.7, 1), (0, 0.1, 0.5)
GAP = W * 0.0137  # An impact after 13.7 ms: within a step of 10, 5 and 1 ms.


def matrix(slip, m_star, read):
    """Variants of all restitutions and frictions; read(e, friction impulse) returns their known numbers."""
    for e in RESTITUTIONS:
        for mu in FRICTIONS:
            # 7/2 J/m* ends the slip of a ball on the floor and also of two balls.
            impulse = min(mu * (1 + e) * W * m_star, slip * m_star / 3.5)
            yield Variant(f"e {e}, mu {mu}", {"e": e, "mu": mu}, tuple(read(e, impulse)))


def on_floor(slip=3.0):
    def known(e, impulse):
        return (Known("vz after", last("ball", "vz"), e * W, EXACT), Known("vx after", last("ball", "vx"), slip - impulse / M, EXACT),
                Known("spin after", spin_y("ball", "ball_x"), 2.5 * impulse / (M * R), EXACT / R))

    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [0, 0, R + GAP], "velocity": [slip, 0, -W]}}
    return Case("ball_on_floor", "Leaves with e w; slides: vx - μ(1 + e) w; sticks: 5/7 vx and the spin of rolling, 21.43 rad/s.",
                model("Ball on the floor", bodies, gravity=(0, 0, 0), variables={"e": 0, "mu": 0},
                      contacts={"default": {"restitution": "e", "friction": "mu"}}, probes=body("ball")),
                1e-2, 0.06, tuple(matrix(slip, M, known)), ABSOLUTE, compare=False, because="Closed forms give all results.")


def on_floor_with_gravity():
    """The same with weight: the ball falls from the height that gives 2 m/s at the surface."""
    g, tolerance = 9.81, 1e-3 * R

    def flight(run):
        table = run.probe("ball")
        return (2 * g * max(0, table["z"][-1] - R) + table["vz"][-1] ** 2) ** 0.5

    # Forces begin within the gap's tolerance above the surface: the approach there differs by g tolerance/w, and so does
    # the flight's speed at the surface, by (1 - e²) of that over e.
    variants = [Variant(f"e {e}", {"e": e}, (Known("speed of the flight after", flight, e * W,
                                                   EXACT + g * tolerance * (1 - e * e) / (e * W)),)) for e in (0.3, 0.7, 1)]
    # By its weight it settles into a twentieth of the band, with long steps within one or two steps.
    rest = (Known("greatest speed after it landed, e = 0", largest("ball", "vz", 0.05), 0, lambda h: EXACT + 4 * min(0.05 * tolerance / h, 5e-4)),
            Known("sinks below the surface", lambda run: R - run.probe("ball")["z"][-1], 0, tolerance, below=True))
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [0, 0, R + GAP], "velocity": [0, 0, -(W * W - 2 * g * GAP) ** 0.5]}}
    return Case("ball_falls_on_floor", "2 m/s at the surface; leaves with e 2 m/s there; with e = 0, the default, it stays.",
                model("Ball falls on the floor", bodies, variables={"e": 0}, contacts={"default": {"restitution": "e"}}, probes=body("ball")),
                1e-2, 0.09, tuple([Variant("e 0", {"e": 0}, rest)] + variants), ABSOLUTE, compare=False, because="Closed forms give all results.")


def on_ball(mass):
    """Impact on a free ball. The upper one spins, so that it slips while the normal keeps its direction.

    Friction moves the balls sideways by up to slip h within the step of the impact, which tilts the normal, and both
    surfaces are off the common point by up to w h: of the impulse of friction these are parts of order h.
    """
    slip, m_star = 3.0, M * mass / (M + mass)

    def known(e, impulse):
        p = (1 + e) * W * m_star
        by = lambda h: EXACT + slip * h / (2 * R) * impulse  # noqa: E731  all masses are 1 kg or more
        turn = lambda h: EXACT / R + (slip + W) * h / (2 * R) * 2.5 * impulse / R  # noqa: E731
        return (Known("vz of the first", last("ball", "vz"), -W + p / M, by), Known("vz of the other", last("other", "vz"), -p / mass, by),
                Known("vx of the first", last("ball", "vx"), -impulse / M, by), Known("vx of the other", last("other", "vx"), impulse / mass, by),
                Known("spin of the first", spin_y("ball", "ball_x"), -slip / R + 2.5 * impulse / (M * R), turn),
                Known("spin of the other", spin_y("other", "other_x"), 2.5 * impulse / (mass * R), turn))

    bodies = {"ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [0, 0, 2 * R + GAP], "velocity": [0, 0, -W],
                       "angular_velocity": [0, -slip / R, 0]},
              "other": {"shape": {"sphere": 2 * R}, "mass": mass}}
    return Case(f"ball_on_ball_of_{mass:g}_kg", "Spinning with a slip of 3 m/s: p = (1 + e) w m*, friction μp or 2/7 of the slip m*.",
                model("Ball on a free ball", bodies, gravity=(0, 0, 0), variables={"e": 0, "mu": 0},
                      contacts={"default": {"restitution": "e", "friction": "mu"}}, probes={**body("ball"), **body("other")}),
                1e-2, 0.06, tuple(matrix(slip, m_star, known)), ABSOLUTE, compare=False, because="Closed forms give all results.")


def turning(step, reach, e):
    """Impact on a hinged body, which turns by up to w h/reach within the step of the impact, so that the contact point moves
    along it by this part of the ball's radius and arm: arm and normal differ in first order of h. With e = 0 ball and
    plate stay in contact for the rest of the run, in which the ball is carried round."""
    return W * (3e-4 + step / reach * W / 2) + EXACT + (6e-3 if e == 0 else 0)


def on_plate():
    length, thick, mass, reach = 1.0, 0.04, 2.0, 0.8
    inertia = mass * (length**2 + thick**2) / 12 + mass * length**2 / 4
    m_star = 1 / (1 / M + reach**2 / inertia)
    variants = [Variant(f"e {e}", {"e": e}, (Known("vz after", last("ball", "vz"), -W + (1 + e) * W * m_star / M, lambda h, e=e: turning(h, reach, e)),))
                for e in RESTITUTIONS]
    bodies = {"ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [reach, 0, thick / 2 + R + GAP], "velocity": [0, 0, -W]},
              "plate": {"shape": {"box": [length, 0.2, thick]}, "mass": mass, "position": [length / 2, 0, 0]}}
    return Case("ball_on_hinged_plate", "Effective mass 1/(1/m + a²/J), J of the plate about its hinge.",
                model("Ball on a hinged plate", bodies, gravity=(0, 0, 0), variables={"e": 0},
                      joints={"hinge": {"type": "revolute", "bodies": ["ground", "plate"], "at": [0, 0, 0], "axis": "y"}},
                      contacts={"default": {"restitution": "e"}}, probes=body("ball")),
                1e-2, 0.04, tuple(variants), ABSOLUTE, compare=False, because="Closed forms give all results.")


def chain_compliance(count, length, mass, inertia, place):
    """Speed of the struck point of the last link by a unit impulse normal to a straight chain: each link is hinged at
    the end of the previous one, the first to the ground. Unknowns v and ω of each link, then the impulses of the hinges."""
    n = 3 * count
    a, b = [[0.0] * n for _ in range(n)], [0.0] * n
    for i in range(count):
        v, w, j = 2 * i, 2 * i + 1, 2 * count + i
        a[v][v], a[w][w] = mass, inertia
        a[v][j], a[w][j] = -1, length / 2  # The impulse of its first hinge, at -length/2.
        a[j][v], a[j][w] = 1, -length / 2
        if i:
            a[v - 2][j], a[w - 2][j] = 1, length / 2
            a[j][v - 2], a[j][w - 2] = -1, -length / 2
    arm = place - (count - 0.5) * length
    b[2 * count - 2], b[2 * count - 1] = 1, arm
    x = solve(a, b)
    return x[2 * count - 2] + arm * x[2 * count - 1]


def on_chain():
    count, length, thick, mass, place = 3, 0.5, 0.04, 1.0, 1.45
    k = 1 / M + chain_compliance(count, length, mass, mass * (length**2 + thick**2) / 12, place)
    variants = [Variant(f"e {e}", {"e": e}, (Known("vz after", last("ball", "vz"), -W + (1 + e) * W / (k * M), lambda h, e=e: turning(h, length, e)),))
                for e in RESTITUTIONS]
    bodies = {"ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [place, 0, thick / 2 + R + GAP], "velocity": [0, 0, -W]}}
    joints = {}
    for i in range(count):
        bodies[f"link_{i}"] = {"shape": {"box": [length, 0.1, thick]}, "mass": mass, "position": [(i + 0.5) * length, 0, 0]}
        joints[f"hinge_{i}"] = {"type": "revolute", "bodies": [f"link_{i - 1}" if i else "ground", f"link_{i}"], "at": [i * length, 0, 0], "axis": "y"}
    return Case("ball_on_chain_end", "Three hinged links in a line, struck near the end: the links' equations of impulse and hinges solved by elimination.",
                model("Ball on the end of a chain", bodies, gravity=(0, 0, 0), variables={"e": 0}, joints=joints,
                      contacts={"default": {"restitution": "e"}, "exclude": [["link_0", "link_2"]]}, probes=body("ball")),
                1e-2, 0.025, tuple(variants), ABSOLUTE, compare=False, because="Closed forms give all results.")


def nearly_touching():
    """Controls without contact: a ball that starts where the band begins, at 2 m/s upwards."""
    bodies = {**FLOOR, "ball": {"shape": {"sphere": 2 * R}, "mass": M, "position": [0, 0, R + 1.1e-3 * R], "velocity": [3, 0, W]}}
    known = (Known("vz", last("ball", "vz"), W, 1e-9), Known("vx", last("ball", "vx"), 3, 1e-9), Known("does not fall", fall("ball", "z"), 0, 1e-12))
    return Case("ball_leaves_floor", "A control: a ball that moves away from the floor has no contact force.",
                model("Ball leaves the floor", bodies, gravity=(0, 0, 0), contacts={"default": {"friction": 0.5}}, probes=body("ball")),
                1e-2, 0.05, (Variant("", {}, known),), ABSOLUTE, compare=False, because="Closed forms give all results.")


assert abs(chain_compliance(1, 1, 3, 0.25, 1) - 1) < 1e-12  # One link: a²/J = 1/(3/12 + 3/4).
CASES = [on_floor(), on_floor_with_gravity(), on_ball(1.0), on_ball(3.0), on_plate(), on_chain(), nearly_touching()]
