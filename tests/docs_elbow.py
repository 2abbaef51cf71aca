# SPDX-License-Identifier: Apache-2.0
"""The arm of docs/tutorials/biomechanics.md: the equation of its one angle, with muscles on tangents and arcs in closed form."""
import importlib.util
import math

import docs_numbers

GRAVITY, BONE = 9.81, 0.018
INERTIA = 0.01 + 1.5 * 0.15**2 + 0.003 + 2 * 0.33**2  # about the elbow
WEIGHT = (1.5 * 0.15 + 2 * 0.33) * GRAVITY
START = math.radians(-85)
# Points of upper arm and forearm as x + i z, sense of the way around the bone; force, optimal length, tendon.
MUSCLES = {"biceps": (0.022 + 0.3j, 0.045 + 0.012j, -1, 1000, 0.15, 0.185), "triceps": (-0.022 + 0.28j, 0.01 - 0.022j, 1, 700, 0.12, 0.19)}


def curves():
    """The curves of De Groote et al. (2016), as an example has them in Python."""
    spec = importlib.util.spec_from_file_location("curves", docs_numbers.ROOT / "examples/muscle_curves.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def straight(name, angle):
    """Length of the line from point to point, its derivative by the angle."""
    fixed, end = MUSCLES[name][:2]
    turned = end * complex(math.cos(angle), math.sin(angle))
    length = abs(turned - fixed)
    return length, (((turned - fixed) / length).conjugate() * 1j * turned).real


def path(name, angle):
    """The same of the shortest line on the muscle's side of the bone."""
    fixed, end, sense = MUSCLES[name][:3]
    turned = end * complex(math.cos(angle), math.sin(angle))
    between = math.atan2(sense * (turned / fixed).imag, (turned / fixed).real) % (2 * math.pi)
    arc = between - math.acos(BONE / abs(fixed)) - math.acos(BONE / abs(turned))
    if not 0 < arc < 4:
        return straight(name, angle)
    return math.sqrt(abs(fixed)**2 - BONE**2) + math.sqrt(abs(turned)**2 - BONE**2) + BONE * arc, sense * BONE


class Elbow:
    def __init__(self, activation=0.35):
        self.curves = curves()
        self.activation = activation

    def tension(self, name, angle, rate, t):
        force, optimal, tendon = MUSCLES[name][3:]
        length, arm = path(name, angle)
        fibre, v = (length - tendon) / optimal, arm * rate / (optimal * 10)
        s = min(t / 0.3, 1.0)
        a = self.activation * s * s * (3 - 2 * s) if name == "biceps" else 0.05
        return force * (a * self.curves.active(fibre) * self.curves.speed_factor(v) + self.curves.passive(fibre) + 0.05 * v), arm

    def rate(self, t, state):
        moment = -WEIGHT * math.cos(state[0])
        for name in MUSCLES:
            tension, arm = self.tension(name, *state, t)
            moment -= tension * arm
        return [state[1], moment / INERTIA]

    def motion(self, times, step=1e-3):
        return docs_numbers.integrated(self.rate, [START, 0.0], times, step)
