# SPDX-License-Identifier: Apache-2.0
"""A block on a belt, held by a spring: times of sticking and sliding and its amplitude, against the closed form of dry friction."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import Report, Run  # noqa: E402

M, K, V, G, STATIC, SLIDING = 2.0, 800.0, 0.1, 9.81, 0.5, 0.3
W = math.sqrt(K / M)
HELD, MIDDLE = STATIC * M * G / K, SLIDING * M * G / K        # deflections of the spring where the block slips, and at the middle of its oscillation
D = HELD - MIDDLE
SLIDE = 2 / W * (math.pi - math.atan(D * W / V))              # until it is as fast as the belt again, at MIDDLE - D
STICK = 2 * D / V
PERIOD, AMPLITUDE = SLIDE + STICK, math.hypot(D, V / W)


def place(t):
    """Position and velocity of the block."""
    first = HELD / V
    if t < first:
        return V * t, V
    t = math.fmod(t - first, PERIOD)
    if t > SLIDE:
        return MIDDLE - D + V * (t - SLIDE), V
    return MIDDLE + D * math.cos(W * t) + V / W * math.sin(W * t), V * math.cos(W * t) - D * W * math.sin(W * t)


def main():
    report = Report()
    first, times = HELD / V, 5                                # the block slides when the run ends, in its sixth period
    work = K * HELD**2 / 2 + V * SLIDING * M * G * (2.0 - first)
    for ms in (2, 0.5, 0.1):
        run = Run(HERE / "model.yaml", f"analysis.step={ms} ms")
        block, drive = run.probe("block"), run.probe("drive")
        late = V * ms * 1e-3                                  # the belt's displacement in a step, as each transition is up to a step late,
        early = 1e-3 * HELD                                   # or slip within a thousandth of static friction
        report.below(f"position over six periods, {ms} ms [m]", max(abs(x - place(t)[0]) for t, x in zip(block["t"], block["x"])), 6 * (late + early))
        report.near("largest position [m]", max(block["x"]), MIDDLE + AMPLITUDE, late + early)
        after = [x for t, x in zip(block["t"], block["x"]) if t > first]
        report.near("smallest position [m]", min(after), MIDDLE - AMPLITUDE, late + early)
        rows = list(zip(block["t"], block["x"], block["t"][1:], block["x"][1:]))
        ups = [a + (MIDDLE - x) / (y - x) * (b - a) for a, x, b, y in rows if x < MIDDLE <= y]
        report.near("period [s]", (ups[times] - ups[0]) / times, PERIOD, ms * 1e-3 + 2 * early / V)
        for k in (25, 120, 275):                              # 0.05 s sticks, 0.24 s slides, 0.55 s slides again
            t, sticks = block["t"][k], abs(place(block["t"][k])[1] - V) < 1e-9
            wanted = K * block["x"][k] if sticks else SLIDING * M * G
            within = 2e-4 + 0.52 * K * late                   # the reported force is that in the middle of the step
            report.near(f"friction at {t:g} s, {'sticking' if sticks else 'sliding'} [N]", drive["fx"][k], wanted, within)
        report.near("work of the belt in 2 s [J]", drive["work"][-1], work, 0.3 * ms * 1e-3 + 2e-5)
        report.below("energy drift", run.figures["energy_drift"], 1e-10)
    report.end()


if __name__ == "__main__":
    main()
