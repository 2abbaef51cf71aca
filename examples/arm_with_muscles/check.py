# SPDX-License-Identifier: Apache-2.0
"""An arm with two muscles against the equation of its one angle, with separate expressions of the muscles' curves."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from muscle_curves import VMAX, active, passive, speed_factor  # noqa: E402
from support import Report, Run, integrate  # noqa: E402

G = 9.81
INERTIA = 0.01 + 1.5 * 0.15**2 + 0.003 + 2 * 0.33**2          # about the elbow
WEIGHT = (1.5 * 0.15 + 2 * 0.33) * G
DAMPING = 0.05
# Points of the upper arm as x + i z, the last one on the forearm; then the numbers of the muscle.
MUSCLES = {
    "biceps": ((0.02 + 0.3j,), 0.045 + 0.01j, 900, 0.13, 0.155, math.radians(5), lambda t: 0.27 + 0.25 * math.sin(math.pi * t) ** 2),
    "triceps": ((-0.02 + 0.28j, -0.025 + 0.02j), -0.03 - 0.005j, 700, 0.12, 0.16, math.radians(12), lambda t: 0.05 + 0.1 * math.cos(math.pi * t) ** 2),
}


def muscle(name, angle, rate, t):
    """Length, tension, length of the fibres, moment about the elbow."""
    fixed, end, force, optimal, tendon, pennation, activation = MUSCLES[name]
    turned = end * complex(math.cos(angle), math.sin(angle))
    length = sum(abs(b - a) for a, b in zip(fixed, fixed[1:])) + abs(turned - fixed[-1])
    u = (turned - fixed[-1]) / abs(turned - fixed[-1])
    arm = (u.conjugate() * 1j * turned).real                  # change of the length by the angle
    along, height = (length - tendon) / optimal, math.sin(pennation)
    fibre = math.hypot(along, height)
    cosine = along / fibre
    v = cosine * arm * rate / (optimal * VMAX)
    tension = force * cosine * (activation(t) * active(fibre) * speed_factor(v) + passive(fibre) + DAMPING * v)
    return length, tension, fibre * optimal, -tension * arm


def rate(t, y):
    moment = sum(muscle(name, *y, t)[3] for name in MUSCLES) - WEIGHT * math.cos(y[0])
    return [y[1], moment / INERTIA]


def main():
    report = Report()
    times = (0.0, 0.5, 1.0, 1.5, 2.0)
    exact = integrate(rate, [0.0, 0.0], times, 0.02)
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        elbow = run.probe("elbow")
        for t, (angle, speed) in zip(times[1:], exact[1:]):
            k, bound = round(t / 0.01), 6e-5 * (ms / 2) ** 2 + 1e-8
            report.near(f"angle at {t} s, {ms} ms [rad]", elbow["rz"][k], angle, bound)
            for name in MUSCLES:
                length, tension, fibre, _ = muscle(name, angle, speed, t)
                table = run.probe(name)
                report.near(f"length of the {name} at {t} s, {ms} ms [m]", table["length"][k], length, bound)
                report.near("its tension [N]", table["tension"][k], tension, 100 * bound)
                report.near("its fibres [m]", table["fibre_length"][k], fibre, bound)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], 1e-10)
    report.end()


if __name__ == "__main__":
    main()
