# SPDX-License-Identifier: Apache-2.0
"""Stiffness against torsion and its frequency in closed form; the reaction of the sleeve is the load of the pin; under a
sudden load the pin comes to rest at the static solution."""
import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, distance, polhode  # noqa: E402

OUTER, INNER, LENGTH = 0.02, 0.01, 0.04  # radii
SHEAR, DENSITY, PIN = 2 * (0.35e6 + 0.05e6), 1100.0, 6e-5
DYNAMICS = ("analysis.type=dynamics", "analysis.duration=40 ms", "analysis.step=0.5 ms")


def rubber_inertia():
    """Effective moment of inertia of rubber in torsion, at the pin: 2 pi rho L times the integral of r^3 of the
    square of the turn, (1/r^2 - 1/R^2) / (1/r_i^2 - 1/R^2)."""
    def integrand(r):
        return r**3 * ((1 / r**2 - 1 / OUTER**2) / (1 / INNER**2 - 1 / OUTER**2)) ** 2
    n, h = 200, (OUTER - INNER) / 200
    simpson = sum(h / 6 * (integrand(INNER + i * h) + 4 * integrand(INNER + (i + 0.5) * h) + integrand(INNER + (i + 1) * h))
                  for i in range(n))
    return 2 * math.pi * DENSITY * LENGTH * simpson


def main():
    report = Report()
    # Torsion shears every ring by torque / (2 pi r^2 L G): no end effects, no change of volume. Three layers of
    # elements between pin and sleeve: within 0.5 %.
    stiffness = 4 * math.pi * SHEAR * LENGTH / (1 / INNER**2 - 1 / OUTER**2)
    twisted = Run(HERE / "model.yaml", "radial=0", "torque=0.1 N m")
    x, y, _ = twisted.points("arm")[-1]
    report.near("torsion: stiffness of the closed form", 0.1 / math.atan2(y, x) / stiffness, 1, 0.005)
    modes = json.loads(polhode("modes", HERE / "model.yaml", "-o", twisted.folder, "--json", "-n", "5", "--set", "radial=0"))
    torsion = math.sqrt(stiffness / (PIN + rubber_inertia())) / (2 * math.pi)
    # Modes: two tilts of the pin, its axial displacement, torsion; the static shape of the rubber gives Rayleigh's estimate.
    natural = [math.sqrt(mode["omega_squared"]) / (2 * math.pi) for mode in modes["modes"]]  # without the viscosity
    report.near("torsion: natural frequency [Hz]", natural[3], torsion, 0.005 * torsion)
    report.near("torsion: damping ratio, of omega tau / 2", modes["modes"][3]["damping_ratio"] / (math.pi * torsion * 0.2e-3), 1, 0.01)

    still, moving = Run(HERE / "model.yaml"), Run(HERE / "model.yaml", *DYNAMICS)
    report.near("radial: force on the sleeve [N]", still.probe("outer")["fx"][-1], -still.probe("inner")["fx"][-1], 1e-6)
    report.near("radial: force on the pin [N]", still.probe("inner")["fx"][-1], 1500, 1e-6)
    report.near("radial: stable", still.figures["unstable_directions"], 0, 0)
    # Viscosity stops the pin: exp(-omega^2 tau t / 2) with 294 Hz and 0.2 ms leaves 1e-6 after 40 ms.
    way = still.points("pin")[-1][0]
    report.near("sudden load: position of the pin at rest [m]", moving.points("pin")[-1][0], way, 1e-5 * way)
    # Its overshoot is exp(-pi zeta / sqrt(1 - zeta^2)) for constant stiffness of the rubber: within 5 %.
    zeta = math.pi * natural[4] * 0.2e-3
    swing = max(x for x, _, _ in moving.points("pin"))
    report.near("sudden load: largest displacement over that at rest", swing / way,
                1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), 0.05)
    report.below("sudden load: energy + dissipation - work, drift", moving.figures["energy_drift"], ROUND_OFF)
    report.below("sudden load: lateral displacement over displacement",
                 max(distance(p, (p[0], 0, 0)) for p in moving.points("pin")) / way, 1e-8)
    report.end()


main()
