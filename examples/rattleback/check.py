# SPDX-License-Identifier: Apache-2.0
"""In one direction of spin the stone reverses, in the other one it continues."""
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
    # Its final speed depends on the times at which contact opens and closes: only the sign is compared.
    report.below("reversal: 1 rad/s over its largest spin in the other direction", 1 / max(max(dislikes), 1e-9), 1)
    report.near("stable direction: smallest spin in 10 s [rad/s]", min(likes), 5, 0.5)
    report.below("energy balance with losses of friction", run.figures["energy_drift"], 1e-6)
    report.end()


main()
