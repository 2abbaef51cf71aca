# SPDX-License-Identifier: Apache-2.0
"""Coulomb's law at the face, balance of forces between face and base, work of sliding against the energy lost by
friction."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, nearest  # noqa: E402

MU, WAY, TOLERANCE = 0.3, 0.06, 1e-4


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    face, base = run.probe("face"), run.probe("base")
    t = face["t"]
    friction = [math.sqrt(x * x + y * y + z * z) for x, y, z in zip(face["ftx"], face["fty"], face["ftz"])]
    pressed, sliding, end = nearest(t, 0.1), nearest(t, 0.2), len(t) - 1
    report.below("friction above mu N, relative to it", max(0.0, max(f / (MU * n) - 1 for f, n in zip(friction, face["normal"]) if n > 0)),
                 1e-9)
    # The tangents of the nodes in contact differ by the curvature of the iron, so their sum is slightly shorter.
    report.near("sliding: friction over mu N", friction[end] / (MU * face["normal"][end]), 1, 0.03)
    report.below("pressed only: friction along x over normal force", face["ftx"][pressed] / face["normal"][pressed], 0.01)
    report.near("sliding: slips as a whole", face["status"][end], 2, 0)
    # At constant speed the block is in equilibrium.
    even = [k for k in range(len(t)) if 0.2 < t[k] < 0.29]
    size = sum(face["fz"][k] for k in even)
    for axis in "xz":
        report.below(f"base + face along {axis} over normal force",
                     sum(base[f"f{axis}"][nearest(base["t"], t[k])] + face[f"f{axis}"][k] for k in even) / size, 0.02)
    # Work of friction: its force times the displacement of the block, once all of it slips.
    work = sum(-0.5 * (face["fx"][k] + face["fx"][k + 1]) * -WAY / 0.2 * (t[k + 1] - t[k]) for k in range(sliding, end))
    took = face["lost"][end] - face["lost"][sliding]
    report.near("sliding: energy lost over work of the pulling force", took / work, 1, 0.1)
    report.below("smallest gap over the tolerance", max(0.0, max(-g for g in face["gap"]) / TOLERANCE - 1), 0)
    report.below("energy + losses - work, drift", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
