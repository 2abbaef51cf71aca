# SPDX-License-Identifier: Apache-2.0
"""An elbow whose muscles run around a cylinder, against the equation of its one angle with closed forms of tangents and arc."""
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
RADIUS = 0.018
START = math.radians(-85)
# Point of the upper arm as x + i z, that on the forearm, sense of the way around; then the numbers of the muscle.
MUSCLES = {
    "biceps": (0.022 + 0.3j, 0.045 + 0.012j, -1, 1000, 0.15, 0.185, math.radians(5), lambda t: 0.12 + 0.45 * math.sin(math.pi * t / 2) ** 2),
    "triceps": (-0.022 + 0.28j, 0.01 - 0.022j, 1, 700, 0.12, 0.19, math.radians(12), lambda t: 0.04 + 0.06 * math.cos(math.pi * t / 2) ** 2),
}


def path(fixed, end, sense, angle):
    """Length of the shortest line around the circle on one side, its derivative by the angle, angle of the arc or 0."""
    turned = end * complex(math.cos(angle), math.sin(angle))
    way = turned / fixed
    between = math.atan2(sense * way.imag, way.real) % (2 * math.pi)
    arc = between - math.acos(RADIUS / abs(fixed)) - math.acos(RADIUS / abs(turned))
    if arc > 0 and between < math.radians(300):               # nearly a whole turn: on the other side, not in the way
        return math.sqrt(abs(fixed)**2 - RADIUS**2) + math.sqrt(abs(turned)**2 - RADIUS**2) + RADIUS * arc, sense * RADIUS, arc
    u = (turned - fixed) / abs(turned - fixed)
    return abs(turned - fixed), (u.conjugate() * 1j * turned).real, 0.0


def muscle(name, angle, rate, t):
    """Length, tension, length of the fibres, moment about the elbow, arc."""
    fixed, end, sense, force, optimal, tendon, pennation, activation = MUSCLES[name]
    length, arm, arc = path(fixed, end, sense, angle)
    along, height = (length - tendon) / optimal, math.sin(pennation)
    fibre = math.hypot(along, height)
    cosine = along / fibre
    v = cosine * arm * rate / (optimal * VMAX)
    tension = force * cosine * (activation(t) * active(fibre) * speed_factor(v) + passive(fibre) + DAMPING * v)
    return length, tension, fibre * optimal, -tension * arm, arc


def rate(t, y):
    moment = sum(muscle(name, *y, t)[3] for name in MUSCLES) - WEIGHT * math.cos(y[0])
    return [y[1], moment / INERTIA]


def main():
    report = Report()
    times = (0.0, 0.5, 1.0, 1.5, 2.0)
    exact = integrate(rate, [START, 0.0], times, 0.002)
    touching = {name: [muscle(name, *y, t)[4] > 0 for t, y in zip(times, exact)] for name in MUSCLES}
    for name, touches in touching.items():
        report.near(f"the {name} touches and lifts off", any(touches) and not all(touches), True, 0)
    for ms in (10, 2, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        elbow = run.probe("elbow")
        for t, (angle, speed) in zip(times[1:], exact[1:]):
            k, bound = round(t / 0.01), 1e-4 * (ms / 2) ** 2 + 1e-7
            report.near(f"angle at {t} s, {ms} ms [rad]", elbow["rz"][k], angle, bound)
            for name in MUSCLES:
                length, tension, fibre, _, _ = muscle(name, angle, speed, t)
                table = run.probe(name)
                report.near(f"length of the {name} at {t} s, {ms} ms [m]", table["length"][k], length, bound)
                report.near("its tension [N]", table["tension"][k], tension, 300 * bound)
                report.near("its fibres [m]", table["fibre_length"][k], fibre, bound)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], 1e-10)
    report.end()


if __name__ == "__main__":
    main()
