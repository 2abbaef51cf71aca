# SPDX-License-Identifier: Apache-2.0
"""Sticks where tan(tilt) is below the coefficient of friction, without creep; slides with g (sin - mu cos) where not."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run, distance, nearest  # noqa: E402

G, TILT = 9.81, math.radians(30)


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    t, x = run.probe("holds")["t"], run.points("holds")
    from_half_a_second = x[nearest(t, 0.5)]
    report.below("mu 0.6: largest motion from 0.5 s to 10 s [m]", max(distance(p, from_half_a_second) for p in x[50:]), 1e-6)
    x = run.points("slides")
    slid = distance(x[nearest(t, 2.0)], x[0])
    report.near("mu 0.5: displacement in 2 s [m]", slid, 0.5 * 2 + 0.5 * G * (math.sin(TILT) - 0.5 * math.cos(TILT)) * 4, 1e-3 * slid)
    rough, smooth = run.probe("rough"), run.probe("smooth")
    report.near("mu 0.6: normal force [N]", rough["normal"][-1], G * math.cos(TILT), 1e-6)
    report.near("mu 0.6: friction [N]", distance((rough["ftx"][-1], rough["fty"][-1], rough["ftz"][-1]), (0, 0, 0)), G * math.sin(TILT), 1e-6)
    report.near("mu 0.6: status, 1 sticks", rough["status"][-1], 1, 0)
    report.near("mu 0.5: friction over normal force", distance((smooth["ftx"][-1], smooth["fty"][-1], smooth["ftz"][-1]), (0, 0, 0)) / smooth["normal"][-1], 0.5, 1e-6)
    report.near("mu 0.5: status, 2 slips", smooth["status"][-1], 2, 0)
    # Energy lost by friction: that of the fall less the kinetic energy.
    v = distance(run.points("slides", "vx vy vz")[-1], (0, 0, 0))
    fell = run.points("slides")[0][2] - run.points("slides")[-1][2]
    report.near("mu 0.5: energy lost by friction [J]", smooth["lost"][-1], G * fell - 0.5 * v * v + 0.5 * 0.25, 1e-3 * G * fell)
    report.below("energy balance with losses of friction", run.figures["energy_drift"], 1e-10)
    report.end()


main()
