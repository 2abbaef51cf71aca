# SPDX-License-Identifier: Apache-2.0
"""Angular momentum and the balance of energy at round-off; the final spin is about the axis of the largest inertia, with
the minimal energy of the angular momentum; the panel has the frequency of a cantilever."""
import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, angular_velocity, cross, dot, polhode, subtract  # noqa: E402

HUB_MASS, HUB = 40.0, (6.0, 7.0, 2.0)
LENGTH, WIDTH, THICKNESS, OUT = 1.6, 0.5, 0.02, 1.0
YOUNG, POISSON, DENSITY = 15e6, 0.3, 150.0
SPIN = (0.3, 0.0, 2.0)


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    report.below("angular momentum drift", run.figures["angular_momentum_drift"], ROUND_OFF)
    report.below("energy + dissipation, drift", run.figures["energy_drift"], ROUND_OFF)
    report.near("rejected steps", run.figures["rejected_steps"], 0, 0)

    # Hub and panel as one rigid body about their centre of mass.
    mass = DENSITY * LENGTH * WIDTH * THICKNESS
    apart = HUB_MASS * mass / (HUB_MASS + mass) * OUT**2
    inertia = (HUB[0] + mass * (WIDTH**2 + THICKNESS**2) / 12,
               HUB[1] + mass * (LENGTH**2 + THICKNESS**2) / 12 + apart,
               HUB[2] + mass * (LENGTH**2 + WIDTH**2) / 12 + apart)
    momentum = [i * w for i, w in zip(inertia, SPIN)]
    size = math.sqrt(dot(momentum, momentum))
    start, least = 0.5 * dot(momentum, SPIN), 0.5 * size**2 / inertia[1]

    # The energy of the spin at the end, by the angular velocity of the hub in its own axes.
    centre = run.points("centre")[-1]
    axes = [subtract(run.points(tip)[-1], centre) for tip in ("x_tip", "y_tip", "z_tip")]
    omega = angular_velocity(run, "centre", ("x_tip", "y_tip", "z_tip"))[-1]
    spin = [dot(omega, axis) for axis in axes]
    end = 0.5 * sum(i * w**2 for i, w in zip(inertia, spin))
    report.near("axes of the hub: volume they span", dot(axes[0], cross(axes[1], axes[2])), 1, 1e-9)
    # Nine tenths of the available energy are dissipated; the energy is above the minimum, apart from bending.
    report.near("remaining available energy, relative to the start", (end - least) / (start - least), 0.05, 0.05)
    report.near("spin about the axis of largest inertia, relative to the final one", abs(spin[1]) / (size / inertia[1]), 1, 0.06)

    # Clamped: between a beam, free to contract across, and a wide plate; and 1 % for the mesh.
    out = polhode("modes", HERE / "model.yaml", "-o", run.folder, "--json", "-n", "1", "--set",
                  "bodies.hub.angular_velocity=[0, 0, 0]", "--set", "bodies.hub.hold=[x, y, z, rx, ry, rz]",
                  # With the model's own 0.6 s the lowest eigenvalues are those of creep, at -1/(0.6 s).
                  "--set", "materials.laminate.viscosity.relaxation_time=1 us")
    beam = 1.8751040687**2 / (2 * math.pi * LENGTH**2) * math.sqrt(YOUNG * THICKNESS**2 / (12 * DENSITY))
    wide = 0.5 / math.sqrt(1 - POISSON**2) - 0.5
    natural = math.sqrt(json.loads(out)["modes"][0]["omega_squared"]) / (2 * math.pi)  # without the damping
    report.near("first natural frequency of the clamped panel, of a beam's", natural / beam, 1 + wide, wide + 0.01)
    report.end()


main()
