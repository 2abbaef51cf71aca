# SPDX-License-Identifier: Apache-2.0
"""Energy and both momenta at round-off; with the midpoint stress the energy drifts and the momenta are conserved."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402


def main():
    report = Report()
    exact, midpoint = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", "solids.bar.stress=midpoint", "analysis.duration=10 s")
    for figure in ("energy_drift", "angular_momentum_drift"):
        report.below(figure.replace("_", " "), exact.figures[figure], ROUND_OFF)
    report.near("rejected steps", exact.figures["rejected_steps"], 0, 0)
    report.below("midpoint stress: angular momentum drift", midpoint.figures["angular_momentum_drift"], ROUND_OFF)
    # The drift is about 1e-3 of the energy, at least a million times round-off.
    report.below("midpoint stress: 1e-5 over its energy drift", 1e-5 / midpoint.figures["energy_drift"], 1)
    # The bar stretches under the spin, less than by half: m ω² L²/2 over E A L is some percent.
    tip = exact.points("tip")
    hub = exact.points("hub")
    stretch = max(sum((a - b) ** 2 for a, b in zip(x, y)) ** 0.5 for x, y in zip(tip, hub)) / 6.5
    report.near("largest distance of tip and hub over that at rest", stretch, 1.05, 0.05)
    report.end()


main()
