# SPDX-License-Identifier: Apache-2.0
"""Forces that use the whole state at the beginning of the step, by names."""

from collections.abc import Callable
from typing import Any, Optional

import numpy as np
import numpy.typing as npt
import pytest

import polhode

Array = npt.NDArray[np.float64]

K, MASS_A, MASS_B = 300.0, 2.0, 1.0
OMEGA = np.sqrt(K * (1 / MASS_A + 1 / MASS_B))


def pair(step: float, force: "Optional[Callable[[str], Callable[[float], Array]]]" = None) -> polhode.Model:
    """Two bodies on a line that oscillate and drift, with a spring of the engine or two forces."""
    m = polhode.Model(analysis={"duration": 1.0, "step": step})
    for name, mass, x in (("a", MASS_A, 0.0), ("b", MASS_B, 0.5)):
        m.add_body(name, mass=mass, inertia=[1, 1, 1], position=[x, 0, 0], velocity=[0.3, 0, 0])
        if force:
            m.add_load("on_" + name, "force", body=name, at=[x, 0, 0], force=force(name))
    if not force:
        m.add_load("spring", "spring_damper", bodies=["a", "b"], at=[[0, 0, 0], [0.5, 0, 0]], stiffness=K,
                   free_length=0)
    return m


def spring(at: "dict[str, Array]") -> "Callable[[str], Callable[[float], Array]]":
    """Forces on each of the bodies from stored positions."""
    return lambda name: lambda t: K * (at["b" if name == "a" else "a"] - at[name])


def watch(at: "dict[str, Array]") -> "Callable[[polhode.Simulation], None]":
    """Stores the positions after every step."""
    return lambda s: at.update({name: s.bodies[name].position for name in at})


def test_a_spring_between_two_bodies_from_positions_at_the_beginning_of_the_step() -> None:
    errors = []
    for steps in (200, 2000, 20000):  # coarse, default, a hundredth of the coarse step
        h = 1.0 / steps
        at = {"a": np.zeros(3), "b": np.array([0.5, 0, 0])}
        sim = polhode.Simulation(pair(h, spring(at)))
        r = sim.run(observe=watch(at))
        momentum = MASS_A * r.bodies["a"].velocity + MASS_B * r.bodies["b"].velocity
        assert np.abs(momentum - momentum[0]).max() < 1e-12  # opposite forces at the same times
        apart = r.bodies["b"].position[:, 0] - r.bodies["a"].position[:, 0]
        rate = r.bodies["b"].velocity[:, 0] - r.bodies["a"].velocity[:, 0]
        energy = rate**2 + (OMEGA * apart) ** 2
        # x' = x + h v - h^2 w^2 x / 2, v' = v - h w^2 x: the map of a step has the determinant 1 + h^2 w^2 / 2.
        assert energy[-1] / energy[0] == pytest.approx((1 + 0.5 * (h * OMEGA) ** 2) ** steps, rel=2 * h * OMEGA)
        errors.append(np.abs(apart - 0.5 * np.cos(OMEGA * r.time)).max())
        assert r.ledger.newton_iterations <= 2.1 * r.ledger.steps  # the force is explicit
    assert np.log10(errors[1] / errors[2]) == pytest.approx(1, abs=0.05)
    own = polhode.run(pair(1.0 / 2000))  # the same step, of second order
    x = own.bodies["b"].position[:, 0] - own.bodies["a"].position[:, 0]
    assert np.abs(x - 0.5 * np.cos(OMEGA * own.time)).max() < 0.05 * errors[1]


def test_joints_loads_and_probes_are_read_after_each_step() -> None:
    command = [0.0]
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 0.5, "step": 0.005})
    m.add_body("arm", shape=polhode.Box(1, 0.05, 0.05), density=1000, position=[0.5, 0, 0])
    m.add_joint("hinge", "revolute", ["ground", "arm"], at=[0, 0, 0], axis="y")
    m.add_load("brake", "rotary_motor", joint="hinge", moment=lambda t: command[-1])
    m.add_probe("tip", body="arm", point=[0.5, 0, 0])
    sim = polhode.Simulation(m)
    read = []
    for step in sim:
        hinge, tip = sim.joints["hinge"], sim.probes["tip"]
        read.append((step.time, float(tip.z), float(hinge.force[2]), float(sim.loads["brake"][1])))
        command.append(-3.0 * float(hinge.rates[0]))
    times, heights, forces, moments = np.array(read).T
    angle = np.arcsin(-heights / 1.0)
    assert len(times) == 100 and np.all(np.diff(angle) > 0) and np.all(forces != 0)
    # J a'' = m g l cos a - c a', with the moment of the beginning of each step: of first order in it.
    from scipy.integrate import solve_ivp

    mass, inertia = 2.5, 2.5 * (1 + 0.05**2) / 12 + 2.5 * 0.25
    exact = solve_ivp(lambda t, y: [y[1], (mass * 9.81 * 0.5 * np.cos(y[0]) - 3 * y[1]) / inertia], (0, 0.5), [0, 0],
                      t_eval=times, rtol=1e-10, atol=1e-12).y[0]
    assert angle == pytest.approx(exact, abs=0.02) and np.abs(angle - exact).max() > 1e-4
    assert moments == pytest.approx(np.array(command[:-1])[: len(moments)], rel=1e-9)  # the force over the step


@pytest.mark.parametrize("ask", [
    lambda s: s.bodies["it"].position, lambda s: s.joints["rail"].coordinates, lambda s: s.energy, lambda s: s.step(),
    lambda s: s.loads["push"].force, lambda s: s.copy(), lambda s: s.ledger,
])
def test_a_force_that_asks_its_own_simulation_is_told_what_to_do(ask: "Callable[[polhode.Simulation], Any]") -> None:
    known: "list[polhode.Simulation]" = []

    def force(t: float, body: polhode.BodyReading) -> "list[float]":
        if known:
            assert known[0].time <= t  # may be read
            ask(known[0])
        return [1, 0, 0]

    m = polhode.Model(analysis={"duration": 0.1, "step": 0.01})
    m.add_body("it", mass=1, inertia=[1, 1, 1])
    m.add_joint("rail", "prismatic", ["ground", "it"], at=[0, 0, 0], axis="x")
    m.add_load("push", "force", body="it", at=[0, 0, 0], force=force)
    sim = polhode.Simulation(m)
    sim.step()
    state = sim.state
    known.append(sim)
    for act in (sim.step, lambda: sim.joints["rail"].force):
        with pytest.raises(RuntimeError, match="A force cannot use its simulation during its evaluation"):
            act()
        assert sim.state == state
    known.clear()
    sim.run()  # and the run continues as before
    assert sim.ledger.result_hash == polhode.run(m).ledger.result_hash
