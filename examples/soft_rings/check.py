# SPDX-License-Identifier: Apache-2.0
"""Balance of forces between hand, face and foot, the symmetry of two equal rings, and Coulomb's law at the face."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, nearest  # noqa: E402

MU, DEPTH = 0.3, 0.04


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    face, hand, foot = run.probe("face"), run.probe("hand"), run.probe("foot")
    t = face["t"]
    even = [k for k in range(len(t)) if 0.2 < t[k] < 0.39]
    size = sum(face["normal"][k] for k in even)
    # At a constant rate each ring is in equilibrium, apart from its vibrations.
    for name, at, sign in (("hand", hand, 1), ("foot", foot, -1)):
        rest = sum(at["fy"][nearest(at["t"], t[k])] + sign * face["fy"][k] for k in even)
        report.below(f"{name} and face along y over normal force", abs(rest) / size, 0.05)
    # Equal rings: the face stays half way between the middles of foot and hand.
    end = len(t) - 1
    middle = 0.5 * (60.5e-3 - DEPTH)
    report.near("height of the face at the end [m]", face["py"][end], middle, 1.5e-3)
    friction = [math.hypot(x, y, z) for x, y, z in zip(face["ftx"], face["fty"], face["ftz"])]
    report.below("friction above mu N, relative to it",
                 max(0.0, max(f / (MU * n) - 1 for f, n in zip(friction, face["normal"]) if n > 0)), 1e-9)
    report.below("decrease of the energy lost at the face", max(0.0, max(a - b for a, b in zip(face["lost"], face["lost"][1:]))), 0)
    report.below("smallest gap is above zero", max(0.0, -min(g for g in face["gap"] if g == g)), 0)
    report.below("energy + losses - work, drift", run.figures["energy_drift"], ROUND_OFF)
    report.below("momentum - impulses, drift", run.figures["linear_momentum_drift"], ROUND_OFF)
    report.end()


main()
