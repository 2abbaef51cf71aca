# SPDX-License-Identifier: Apache-2.0
"""A crate on a prescribed table against Coulomb's law in one dimension; the drive's force and work."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402

G, A, OMEGA = 9.81, 0.05, 4 * math.pi
TABLE, CRATE = 50.0, 10.0


def slipped(mu, times):
    """Position and velocity of a crate that starts at rest, by steps of 10 microseconds: sticking ends where the table's
    acceleration exceeds that of friction."""
    h, x, v, t, found = 1e-5, 0.0, 0.0, 0.0, []
    for until in times:
        while t < until - 0.5 * h:
            middle = t + 0.5 * h
            table = A * OMEGA * math.cos(OMEGA * (t + h))
            push = mu * G * h
            # The force that would end the slip in this step, at most friction.
            change = max(-push, min(push, table - v))
            x += h * (v + 0.5 * change)
            v += change
            t = middle + 0.5 * h
        found.append((x, v))
    return found


def main():
    report, run = Report(), Run(HERE / "model.yaml")
    table, slips, rides, drive = (run.probe(name) for name in ("table", "slips", "rides", "drive"))
    t = table["t"]
    report.below("table: x - a sin(2 pi f t) [m]", max(abs(x - A * math.sin(OMEGA * s)) for x, s in zip(table["x"], t)), 1e-12)
    report.below("table: error of its velocity [m/s]", max(abs(v - A * OMEGA * math.cos(OMEGA * s)) for v, s in zip(table["vx"], t)), 1e-9)
    reference = slipped(0.4, t)
    report.below("mu 0.4: x, difference from Coulomb's law [m]", max(abs(x - r[0]) for x, r in zip(slips["x"], reference)), 2e-4)
    report.below("mu 0.4: velocity, difference [m/s]", max(abs(v - r[1]) for v, r in zip(slips["vx"], reference)), 5e-3)
    report.below("mu 0.9: x, difference from the table's [m]", max(abs(x - p) for x, p in zip(rides["x"], table["x"])), 1e-5)
    # The drive accelerates the table and the crate that sticks, and overcomes the friction of the one that slips.
    whole = [(k, s) for k, s in enumerate(t) if k > 0 and abs(slips["vx"][k] - table["vx"][k]) > 0.05]
    law = [-(TABLE + CRATE) * A * OMEGA**2 * math.sin(OMEGA * s) + math.copysign(0.4 * CRATE * G, table["vx"][k] - slips["vx"][k]) for k, s in whole]
    report.below("drive: force, difference [N]", max(abs(drive["fx"][k] - f) for (k, _), f in zip(whole, law)), 1.0)
    kinetic = 0.5 * (TABLE + CRATE) * table["vx"][-1] ** 2 + 0.5 * CRATE * slips["vx"][-1] ** 2
    start = 0.5 * (TABLE + CRATE) * (A * OMEGA) ** 2
    lost = run.figures["contacts"]["lost_by_friction"] + run.figures["contacts"]["lost_in_impacts"]
    report.near("drive: work, of energies and friction [J]", drive["work"][-1], kinetic - start + lost, 1e-2)
    report.below("energy balance with losses of friction", run.figures["energy_drift"], 1e-9)
    report.end()


main()
