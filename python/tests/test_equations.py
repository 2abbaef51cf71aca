# SPDX-License-Identifier: Apache-2.0
"""Residual and tangent of a step."""

import numpy as np
import pytest
import scipy.sparse.linalg

import polhode

H = 0.02


def mechanism() -> polhode.Model:
    """A spatial double pendulum with a spring, and a free body."""
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 1, "step": H, "solver": "block_lu"})
    m.add_body("upper", shape=polhode.Box(1, 0.1, 0.2), density=1000, position=[0.5, 0, 0])
    m.add_body("lower", shape=polhode.Box(1, 0.2, 0.1), density=800, position=[1.5, 0, 0])
    m.add_body("free", mass=2, inertia=[0.1, 0.2, 0.3], position=[1, 1, 1], angular_velocity=[5, 1, 2])
    m.add_joint("shoulder", "revolute", ["ground", "upper"], at=[0, 0, 0], axis="y")
    m.add_joint("elbow", "spherical", ["upper", "lower"], at=[1, 0, 0])
    m.add_load("spring", "spring_damper", bodies=["lower", "free"], at=[[2, 0, 0], [1, 1, 1.2]], stiffness=300,
               damping=4)
    return m


def test_newton_by_scipy_takes_the_step_of_the_engine() -> None:
    sim = polhode.Simulation(mechanism())
    for _ in range(5):
        sim.step()
    e = polhode.step_equations(sim, H)
    x, sizes = e.x, []
    for _ in range(8):
        e = polhode.step_equations(sim, H, x)
        increment = -scipy.sparse.linalg.spsolve(e.tangent.tocsc(), e.residual)
        sizes.append(np.abs(increment[:18]).max())
        x = e.moved(increment)
    assert sizes[-1] < 1e-13
    ratios = [sizes[k + 1] / sizes[k] ** 2 for k in range(6) if sizes[k + 1] > 1e-11]
    assert len(ratios) >= 1 and max(ratios) < 10  # quadratic
    before = {name: sim.bodies[name].position for name in e.bodies}
    state = sim.state
    e = polhode.step_equations(sim, H, x)
    assert sim.state == state
    sim.step()
    assert e.bodies == ["upper", "lower", "free"]
    for k, name in enumerate(e.bodies):
        assert before[name] + x[6 * k : 6 * k + 3] == pytest.approx(sim.bodies[name].position, abs=1e-12)
    assert np.abs(e.residual[:18]).max() < 1e-8 and np.abs(e.residual[18:]).max() < 1e-13


def test_the_tangent_is_that_of_differences() -> None:
    sim = polhode.Simulation(mechanism())
    for _ in range(5):
        sim.step()
    e = polhode.step_equations(sim, H)
    assert e.residual.shape == (18 + 8,) and e.tangent.shape == (26, 26)
    size = np.abs(e.tangent.toarray()).max(axis=1)
    for k in range(26):
        d = 1e-5 * np.eye(26)[k]
        ahead, behind = (polhode.step_equations(sim, H, e.moved(sign * d)).residual for sign in (1, -1))
        assert (ahead - behind) / 2e-5 / size == pytest.approx(e.tangent.toarray()[:, k] / size, abs=1e-6)


def test_what_has_no_such_equations_is_told() -> None:
    m = mechanism()
    with pytest.raises(polhode.ModelError, match="has 3 numbers, not 26"):
        polhode.step_equations(m, H, [1, 2, 3])
    m.analysis = {"type": "statics"}
    m.bodies["free"].angular_velocity = None
    with pytest.raises(polhode.ModelError, match="in dynamics"):
        polhode.step_equations(m, H)
