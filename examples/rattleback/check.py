# SPDX-License-Identifier: Apache-2.0
"""Spun one way the stone turns back; spun the other way it goes on."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, angular_velocity  # noqa: E402


def spins(*settings):
    run = Run(HERE / "model.yaml", *settings)
    return run, [w[2] for w in angular_velocity(run, "origin", ("x_tip", "y_tip", "z_tip"))]


def main():
    report = Report()
    run, dislikes = spins()
    _, likes = spins("spin=5")
    report.near("spin at the start [rad/s]", dislikes[0], -5, 1e-6)
    # How fast it comes back depends on when contact opens and closes while it rattles: the sign is the law.
    report.below("turns back: 1 rad/s over its largest spin the other way", 1 / max(max(dislikes), 1e-9), 1)
    report.near("the other way: least spin in 10 s [rad/s]", min(likes), 5, 0.5)
    report.below("energy balance with what friction took", run.figures["energy_drift"], 1e-6)
    report.end()


main()
