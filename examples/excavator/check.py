# SPDX-License-Identifier: Apache-2.0
"""An excavator's arm: its pose by the law of cosines, the forces of its cylinders at rest by virtual work, and the balance of power
while it moves."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

# Pins at the start as points of the plane x + i z.
O, E, B, TIP = 0.2 + 1.6j, 3.7 + 3.6j, 5.0 + 1.4j, 4.6 + 0.2j
CYLINDERS = {"boom": (0.8 + 1.0j, 1.9 + 2.9j), "stick": (2.0 + 3.3j, 3.4 + 4.2j), "bucket": (3.95 + 3.9j, 5.45 + 1.75j)}
STROKES = {"boom": 0.35, "stick": 0.5, "bucket": 0.3}
PINS = {"boom": O, "stick": E, "bucket": B}
MASSES = {"boom": (900, 1300, (O + E) / 2), "stick": (450, 260, (E + B) / 2), "bucket": (350, 70, (B + TIP) / 2)}
BARREL, ROD = (60, 4, 0.3), (35, 3, 0.3)                     # mass, inertia, centre from its pin over the length at the start
G, SOIL, TIME = 9.81, 15e3, 5.0


def stroke(name, t):
    return STROKES[name] * (1 - math.cos(math.pi * min(t, TIME) / TIME)) / 2


def turn(name, out):
    """Rotation of a link relative to the previous one by its cylinder's stroke: the law of cosines."""
    a, b = (p - PINS[name] for p in CYLINDERS[name])
    angle = lambda l: math.acos((abs(a) ** 2 + abs(b) ** 2 - l * l) / (2 * abs(a) * abs(b)))  # noqa: E731
    side = math.copysign(1, (a.conjugate() * b).imag)
    start = abs(b - a)
    return side * (angle(start + out) - angle(start))


def pose(out):
    """Positions of pins: functions from points at the start, by link, including the ground."""
    links, before = {"ground": lambda p: p}, "ground"
    for name, pin in PINS.items():
        spin, carry = complex(math.cos(turn(name, out[name])), math.sin(turn(name, out[name]))), links[before]
        lead = carry(pin + 1) - carry(pin)
        links[name] = lambda p, pin=pin, spin=spin, lead=lead, at=carry(pin): at + lead * spin * (p - pin)
        before = name
    return links


def masses(out):
    """Mass, inertia, centre and direction of all bodies."""
    links, before, bodies = pose(out), "ground", []
    for name, (a, b) in CYLINDERS.items():
        m, J, centre = MASSES[name]
        bodies.append((m, J, links[name](centre), links[name](centre + 1) - links[name](centre)))
        foot, head = links[before](a), links[name](b)
        u, start = (head - foot) / abs(head - foot), abs(b - a)
        for (m, J, part), end, sign in ((BARREL, foot, 1), (ROD, head, -1)):
            bodies.append((m, J, end + sign * part * start * u, u))
        before = name
    return bodies


def potential(out, soil):
    return sum(m * G * centre.imag for m, _, centre, _ in masses(out)) - soil * pose(out)["bucket"](TIP).real


def kinetic(t, h=1e-3):
    out = lambda s: {name: stroke(name, s) for name in STROKES}  # noqa: E731
    total = 0.0
    for now, *others in zip(masses(out(t)), *(masses(out(t + k * h)) for k in (-2, -1, 1, 2))):
        v, d = ((8 * (others[2][k] - others[1][k]) - (others[3][k] - others[0][k])) / (12 * h) for k in (2, 3))
        total += 0.5 * now[0] * abs(v) ** 2 + 0.5 * now[1] * (d / now[3]).imag ** 2
    return total


def along(run, name, out, k):
    """Axial force of a cylinder, positive in compression."""
    links, before = pose(out), {"boom": "ground", "stick": "boom", "bucket": "stick"}[name]
    a, b = CYLINDERS[name]
    u = links[name](b) - links[before](a)
    fx, _, fz = run.points(f"{name}_motor", "fx fy fz")[k]
    return (complex(fx, fz) * u.conjugate()).real / abs(u)


def main():
    report = Report()
    for ms in (25, 5, 0.5):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        for t in (2.5, 6.0):
            k, out = round(t / 0.05), {name: stroke(name, t) for name in STROKES}
            for name, joint in (("boom", "boom_foot"), ("stick", "elbow"), ("bucket", "wrist")):
                report.near(f"turn of the {name} at {t} s, {ms} ms [rad]", -run.probe(joint)["rz"][k], turn(name, out[name]), 1e-11)
        for name in STROKES:                                 # at rest: the derivative of the potential by the stroke
            e = 1e-3
            V = [potential({**STROKES, name: STROKES[name] + j * e}, SOIL) for j in (-2, -1, 1, 2)]
            wanted = (8 * (V[2] - V[1]) - (V[3] - V[0])) / (12 * e)
            report.near(f"force of the {name} cylinder at rest, {ms} ms [N]", along(run, name, STROKES, -1), wanted, 1e-5)
        for t in (1.75, 3.1):                                # d/dt (T + V) while it moves
            k, e = round(t / 0.05), 2e-3
            total = [kinetic(s) + potential({name: stroke(name, s) for name in STROKES}, SOIL) for s in (t - 2 * e, t - e, t + e, t + 2 * e)]
            wanted = (8 * (total[2] - total[1]) - (total[3] - total[0])) / (12 * e)
            power = sum(run.probe(f"{name}_motor")["power"][k] for name in STROKES)
            report.near(f"power of all cylinders at {t} s, {ms} ms [W]", power, wanted, 1e-5)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
