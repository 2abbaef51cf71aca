# SPDX-License-Identifier: Apache-2.0
"""All uprights stay parallel, so the mechanism moves like one pendulum, whose equation is solved here."""
import json
import math
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, integrate, largest, polhode, step_error  # noqa: E402

# B0 at 10 s, N = 2, as the author of Exudyn published it at its finest step, 0.125 ms.
PUBLISHED = (0.3284573768, 0.9445187875)


def pendulum(cells, times):
    """Tops of the uprights: phi'' = w2 sin(phi), phi from the upward vertical."""
    w2 = 9.81 * ((3 * cells + 1) / 2) / ((4 * cells + 1) / 3)
    states = integrate(lambda _, s: [s[1], w2 * math.sin(s[0])], [0.0, 1.0], times, 0.02)
    return [(math.sin(phi), math.cos(phi), 0.0) for phi, _ in states]


def compare(report, cells, model, *settings):
    run, coarse = (Run(model, f"analysis.step={ms} ms", "output.every=20 ms", "analysis.order=6", *settings)
                   for ms in (10, 20))
    B0 = run.points("B0")
    # Rounding: at the top the kinetic energy is 1/44 of the largest one, so a change of the energy changes the speed there
    # 22 times as much; over 10 s this is a delay, at a speed of at most 6.7 m/s.
    rounding = 1e-10 + 22 * 10 * 6.7 * run.figures["energy_drift"]
    tolerance = step_error(coarse.points("B0"), B0, 6, rounding)
    report.below(f"N = {cells}: B0, largest distance from the pendulum in 10 s [m]",
                 largest(B0, pendulum(cells, run.probe("B0")["t"])), tolerance)
    report.below(f"N = {cells}: energy drift", run.figures["energy_drift"], ROUND_OFF)
    report.below(f"N = {cells}: constraint residual [m]", run.figures["constraint_residual_max"], 1e-13)
    return B0


def main():
    report = Report()
    B0 = compare(report, 2, HERE / "model.yaml")
    # The published run differs from its own at 1 ms by 4.6e-5 m; an error of order two leaves 1/63 of that.
    for axis, value, reference in zip("xy", B0[-1], PUBLISHED):
        report.near(f"N = 2: {axis} of B0 at 10 s, published [m]", value, reference, 4.6e-5 / 63 * 2)
    with tempfile.TemporaryDirectory() as folder:
        for cells in (1, 5):
            model = pathlib.Path(folder) / f"n_{cells}.yaml"
            polhode("examples", "n_four_bar", "--set", f"N={cells}", "-o", model)
            compare(report, cells, model, "output.probes={B0: {body: b0, point: [0, 0.5, 0]}}")
    found = json.loads(polhode("check", HERE / "model.yaml", "--json"))
    report.near("mobility", found["mobility"], 1, 0)
    # A planar loop of hinges has three redundant rows: two rotations and the displacement out of the plane.
    report.near("redundant rows", found["redundant_rows"], 3 * 2, 0)
    report.end()


main()
