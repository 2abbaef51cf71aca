# SPDX-License-Identifier: Apache-2.0
"""The angles at 30 ms against the reference solution of the IVP test set (PSIDE at 1e-14)."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

NAMES = ("beta", "theta", "gamma", "phi", "delta", "omega", "epsilon")
START = (-0.06171389001427645, 0.0, 0.45527981916307037, 0.22266839016588588, 0.48736497954384256,
         -0.22266839016588588, 1.2305474445498212)
ANGLES = (15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948, 0.5244099658805303,
          0.5347301163226948, 1.048080741042263)
RATES = (1139.920302151208, -1424.379294994111, 11.03291221937134, 19.29337464421385, 0.5735699284790808,
         -19.29337464421385, 0.3231791658026955)


def at_end(run):
    """Angles and rates at 30 ms."""
    last = [{name: column[-1] for name, column in run.probe(joint).items()} for joint in NAMES]
    return [row["rz"] + start for row, start in zip(last, START)], [row["rate rz"] for row in last]


def main():
    # The reference and another independent solution differ by 1.5e-9 rad; the rates are 1e3 times the angles.
    report = Report()
    run, coarse = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "analysis.step=100 us")
    for what, unit, fine, rough, references, rounding in zip(
            ("angle", "rate of"), ("rad", "rad/s"), at_end(run), at_end(coarse), (ANGLES, RATES), (3e-9, 3e-6)):
        for name, value, other, reference in zip(NAMES, fine, rough, references):
            # A step of order six leaves 1/63 of the difference; twice that, since steps are finite.
            report.near(f"{what} {name} [{unit}]", value, reference, 2 * abs(value - other) / 63 + rounding)
    for figure in ("energy_drift", "constraint_residual_max"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    report.end()


main()
