# SPDX-License-Identifier: Apache-2.0
"""The benchmark bicycle against its published linear equations, and its stability at three speeds."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, integrate  # noqa: E402

# The paper's steer is about an axis that points down.
# M q'' + v C q' + (g K0 + v² K2) q = 0, q lean to the right and steer to the right: Meijaard et al. (2007), table 2.
M = ((80.81722, 2.31941332208709), (2.31941332208709, 0.29784188199686))
K0 = ((-80.95, -2.59951685249872), (-2.59951685249872, -0.80329488458618))
K2 = ((0.0, 76.59734589573222), (0.0, 2.65431523794604))
C = ((0.0, 33.86641391492494), (-0.85035641456978, 1.68540397397560))
G, PUSH, RADIUS = 9.81, 1e-4, 0.3  # radius of the smaller wheel


def linear(v):
    det = M[0][0] * M[1][1] - M[0][1] * M[1][0]

    def rate(_, y):
        q, p = y[:2], y[2:]
        f = [-sum(v * C[i][j] * p[j] + (G * K0[i][j] + v * v * K2[i][j]) * q[j] for j in (0, 1)) for i in (0, 1)]
        return [p[0], p[1], (M[1][1] * f[0] - M[0][1] * f[1]) / det, (M[0][0] * f[1] - M[1][0] * f[0]) / det]

    return rate


def main():
    report = Report()
    for v, seconds in ((3.5, 2), (4.6, 2), (6.5, 2)):
        for ms in (5, 1, 0.1) if v == 4.6 else (5,):
            run = Run(HERE / "model.yaml", f"variables.v={v}", f"variables.push={PUSH}", f"variables.h={ms} ms", f"analysis.duration={seconds} s")
            frame, steer = run.probe("frame"), run.probe("steer")
            exact = integrate(linear(v), [0, 0, PUSH, 0], [0, 1, seconds], 0.02)
            # A wheel whose angle is exactly way over radius turns at (2/h) tan(ω h/2): faster by (ω h)²/12, as if v were.
            fast = integrate(linear(v * (1 + (v / RADIUS * ms * 1e-3) ** 2 / 12)), [0, 0, PUSH, 0], [0, 1, seconds], 0.02)
            for k, t in ((1, 1), (2, seconds)):
                row = round(t / 0.02)
                bound = 1e-7 + 5e-4 * (ms / 5) ** 2 * max(1, abs(exact[k][0]) / PUSH / 0.1)  # steps lag by (λ h)²/12
                lean, steering = (abs(fast[k][i] - exact[k][i]) / PUSH for i in (0, 1))
                report.near(f"lean over initial lean rate, {v} m/s, {t} s, {ms} ms [s]", frame["euler2x"][row] / PUSH, exact[k][0] / PUSH, bound + lean)
                report.near(f"steer over initial lean rate, {v} m/s, {t} s, {ms} ms [s]", -steer["rz"][row] / PUSH, exact[k][1] / PUSH, 3 * bound + steering)
            report.below(f"energy drift, {v} m/s, {ms} ms", run.figures["energy_drift"], ROUND_OFF)
    upright = Run(HERE / "model.yaml", "analysis.duration=20 s").probe("frame")
    report.below("lean 20 s after the gust, 4.6 m/s [rad]", upright["euler2x"][-1], 5e-3)
    report.end()


main()
