# SPDX-License-Identifier: Apache-2.0
"""A planetary gearbox against Willis's equation, its reduced inertia and the balance of power."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

SUN, PLANET, RING = 20, 20, 60
RATIO = 1 + RING / SUN                                          # sun to carrier
SPIN = 1 - RING / PLANET                                        # planet to carrier
R, BRAKE = 0.2, 2.0
# Reduced to the sun: m r² of three planets, their rotation, the carrier.
INERTIA = 0.02 + (0.15 + 3 * 1.0 * R**2 + 3 * SPIN**2 * 0.008) / RATIO**2


def speed(t):
    return 200 * t if t < 0.5 else 100


def main():
    report = Report()
    for ms in (10, 2, 0.5):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        motor, output = run.probe("motor"), run.probe("output")
        one, two = run.probe("teeth_1"), run.probe("teeth_2")
        for t in (0.3, 1.5):
            k = round(t / 0.01)
            moment = INERTIA * (200 if t < 0.5 else 0) + BRAKE * speed(t) / RATIO**2
            report.near(f"moment of the motor at {t} s, {ms} ms [N m]", motor["mz"][k], moment, 1e-7)
            report.near(f"speed of the carrier at {t} s, {ms} ms [rad/s]", output["rate rz"][k], speed(t) / RATIO, 1e-9)
            report.near(f"moment of planet 1 on the sun at {t} s, {ms} ms [N m]", one["effort_1"][k],
                        -(moment - 0.02 * (200 if t < 0.5 else 0)) / 3, 2e-5)
            report.near(f"moment of planet 2, that of planet 1 at {t} s, {ms} ms [N m]", two["effort_1"][k], one["effort_1"][k], 4e-5)
        report.near(f"turns of the carrier, {ms} ms [rad]", output["rz"][-1], 175 / RATIO, 1e-9)
        report.below(f"energy drift at {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    report.end()


main()
