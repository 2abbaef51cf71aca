# SPDX-License-Identifier: Apache-2.0
"""Joint coordinates where events switch joints."""

from pathlib import Path

import numpy as np
import pytest

import polhode


def run_to(sim: polhode.Simulation, time: float) -> None:
    while sim.time < time - 1e-12:
        sim.step(time)


def test_coordinates_are_those_of_the_joints_that_act() -> None:
    """The disc of a Geneva drive holds its wheel, then the pin in a slot turns it, by atan2(sin, sqrt(2) - cos)."""
    sim = polhode.Simulation(Path(__file__).parents[2] / "examples/geneva_drive/model.yaml")
    assert sim.coordinates == ["shaft"]  # at the start both slots are switched off
    run_to(sim, 0.4)
    assert sim.coordinates == ["shaft"] and sim.q == pytest.approx([0.4 * np.pi], abs=1e-6)  # in a slot
    turn = -0.1 * np.pi  # of the crank, from the line of the axes
    slope = np.sqrt(2) - np.cos(turn)
    rate = (np.cos(turn) * slope - np.sin(turn)**2) / (slope**2 + np.sin(turn)**2)
    inertia = sim.mass_matrix()[0, 0]
    crank, wheel = 2e-3, 2e-3
    assert inertia == pytest.approx(crank + wheel * rate**2, rel=1e-6)
    sim.q = sim.q  # the disc stays switched off
    assert sim.mass_matrix()[0, 0] == pytest.approx(inertia, rel=1e-9)
    run_to(sim, 0.8)
    assert sim.mass_matrix() == pytest.approx(np.array([[crank]]), rel=1e-12)  # held again
