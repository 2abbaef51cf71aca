# SPDX-License-Identifier: Apache-2.0
"""The speeds are in the ratio of the numbers of teeth; the teeth transmit the torque of the brake."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    pinion, wheel = run.probe("pinion"), run.probe("wheel")
    half = len(pinion["t"]) // 2
    turned = [abs(p["rz"][-1] - p["rz"][half]) for p in (pinion, wheel)]
    # Over some teeth the ratio is that of the numbers of teeth, apart from the backlash, 0.1 mm at 54 mm.
    report.near("turns of pinion over turns of wheel", turned[0] / turned[1], 27 / 18, 1.5 * 2 * 0.1 / 54 / turned[1])
    rates = [abs(w) for w in wheel["rate rz"][half:]]
    mean = sum(rates) / len(rates)
    teeth = run.probe("teeth")
    # Moment of the forces on the wheel about its axle, 135 mm from the pinion's: its mean is the torque of the brake.
    moments = [-((px - 0.135) * fy - py * fx) for px, py, fx, fy in
               zip(*(teeth[c][half:] for c in ("px", "py", "fx", "fy")))]
    report.near("mean torque of the teeth on the wheel [N m]", abs(sum(moments) / len(moments)), 0.225 * mean, 0.1 * 3)  # the speed still changes
    report.below("wheel: ripple of its speed", max(abs(w / mean - 1) for w in rates), 0.05)
    report.below("energy balance with impacts, friction and brake", run.figures["energy_drift"], 1e-8)
    report.below("constraint residual [m]", run.figures["constraint_residual_max"], 1e-12)
    report.end()


main()
