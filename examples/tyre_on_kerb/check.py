# SPDX-License-Identifier: Apache-2.0
"""Free fall between kerb and floor, impulses against momentum, Coulomb's law, energy that never rises."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run  # noqa: E402

MU, G, RADIUS, KERB, TOLERANCE = 0.8, 9.81, 0.2, 0.03, 5e-4


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    hub, floor, kerb = run.probe("hub"), run.probe("floor"), run.probe("kerb")
    t = hub["t"]
    # The longest flight: no force from floor or kerb.
    flights, begin = [], None
    for k in range(len(t)):
        free = floor["normal"][k] == 0 and kerb["normal"][k] == 0
        if free and begin is None:
            begin = k
        if begin is not None and (not free or k == len(t) - 1):
            flights.append((k - begin, begin, k - 1))
            begin = None
    _, a, b = max(flights)
    fall = (hub["vz"][b] - hub["vz"][a]) / (t[b] - t[a])
    report.near("in flight: acceleration of the hub [m/s2]", fall, -G, 0.02 * G)
    report.below("in flight: change of speed along x over the speed", hub["vx"][b] / hub["vx"][a] - 1, 0.02)
    for name, probe in (("floor", floor), ("kerb", kerb)):
        most = max((math.sqrt(x * x + y * y + z * z) / (MU * n) for x, y, z, n in
                    zip(probe["ftx"], probe["fty"], probe["ftz"], probe["normal"]) if n > 0), default=0)
        report.below(f"{name}: friction above mu N, relative to it", max(0.0, most - 1), 1e-9)
        report.below(f"{name}: smallest gap over the tolerance", max(0.0, max(-g for g in probe["gap"]) / TOLERANCE - 1), 0)
    # Impulses of floor, kerb and weight against momentum; in flight the hub moves like the centre of mass, apart from
    # vibrations of the ring.
    mass = math.pi * 0.06 * (2000 * 0.12**2 + 1100 * (RADIUS**2 - 0.12**2))
    impulse = {c: sum((floor[f"f{c}"][k] + kerb[f"f{c}"][k]) * (t[k] - t[k - 1]) for k in range(1, b + 1)) for c in "xz"}
    report.near("impulse along x [N s]", impulse["x"], mass * (hub["vx"][b] - hub["vx"][0]), 0.02 * mass * hub["vx"][0])
    report.near("impulse along z [N s]", impulse["z"], mass * (hub["vz"][b] + G * t[b]), 0.02 * mass * G * t[b])
    report.near("height of the hub over the kerb's top, over the radius", (max(hub["z"]) - KERB) / RADIUS, 1.2, 0.2)
    report.near("position behind the kerb's edge", float(hub["x"][-1] > 0.8 + 0.1), 1, 0)
    report.below("energy + losses, drift", run.figures["energy_drift"], ROUND_OFF)
    report.below("momentum less impulses, drift", run.figures["linear_momentum_drift"], ROUND_OFF)
    report.below("angular momentum less impulses, drift", run.figures["angular_momentum_drift"], ROUND_OFF)
    report.end()


main()
