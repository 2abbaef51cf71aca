# SPDX-License-Identifier: Apache-2.0
"""A driven crank-rocker against its geometry, and the motor's moment against the rate of its energy."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

R, L, S, D, G = 0.1, 0.35, 0.25, 0.4, 9.81
RHO = 7800.0
BARS = {"crank": (R, 0.02), "coupler": (L, 0.015), "rocker": (S, 0.02)}  # length, side


def turned(t):
    """Angle of the crank."""
    return 12 * t * t if t < 0.5 else 3 + 12 * (t - 0.5)


def points(t):
    """Ends of the crank and of the rocker: B, and C above the line from B to the second bearing."""
    phi = turned(t)
    bx, bz = R * math.cos(phi), R * math.sin(phi)
    dx, dz = D - bx, -bz
    w = math.hypot(dx, dz)
    a = (L * L - S * S + w * w) / (2 * w)
    h = math.sqrt(L * L - a * a)
    return (bx, bz), (bx + (a * dx - h * dz) / w, bz + (a * dz + h * dx) / w)


def bars(t):
    """Middle and angle of each bar."""
    (bx, bz), (cx, cz) = points(t)
    return [(bx / 2, bz / 2, math.atan2(bz, bx)), ((bx + cx) / 2, (bz + cz) / 2, math.atan2(cz - bz, cx - bx)),
            ((D + cx) / 2, cz / 2, math.atan2(cz, cx - D))]


def energy(t, h=1e-5):
    total = 0.0
    for (length, side), before, now, after in zip(BARS.values(), bars(t - h), bars(t), bars(t + h)):
        m = RHO * length * side * side
        vx, vz = ((after[i] - before[i]) / (2 * h) for i in (0, 1))
        omega = math.remainder(after[2] - before[2], 2 * math.pi) / (2 * h)
        total += 0.5 * m * (vx * vx + vz * vz) + m * (length**2 + side**2) / 24 * omega**2 + m * G * now[1]
    return total


def moment(t, h=1e-4):
    """Moment of the motor: power over speed."""
    speed = 24 * t if t < 0.5 else 12
    return (energy(t + h) - energy(t - h)) / (2 * h) / speed


def main():
    report = Report()
    for ms in (5, 1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        tip, motor = run.points("tip"), run.probe("motor")
        worst = max(math.hypot(x - points(t)[1][0], z - points(t)[1][1]) for t, (x, _, z) in zip(motor["t"], tip))
        report.below(f"place of C, largest distance from the geometry, {ms} ms [m]", worst, 1e-12)
        for t in (0.25, 0.8, 1.47):
            k = round(t / 0.01)
            report.near(f"moment of the motor at {t} s, {ms} ms [N m]", -motor["my"][k], moment(t), 5e-6)
        report.near(f"work of the motor, {ms} ms [J]", motor["work"][-1], energy(2) - energy(0), 50 * (ms * 1e-3)**2)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
