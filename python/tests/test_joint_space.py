# SPDX-License-Identifier: Apache-2.0
"""Joint coordinates: positions, forces, matrices and kinematics, against closed forms and each other."""

import math
from typing import Any

import numpy as np
import pytest

import polhode
from conftest import make_chain

G = 9.81
SKEWED = {"xx": 0.02, "yy": 0.03, "zz": 0.02, "xy": 0.003, "xz": 0.001, "yz": -0.002}
#: Of the double pendulum: masses, lengths, distances of the centres, inertias about these.
MASS, LENGTH, CENTRE, INERTIA = (1.3, 0.7), (0.8, 0.5), (0.35, 0.2), (0.05, 0.02)


def double_pendulum(**keys: Any) -> polhode.Model:
    """Two rods in the plane x, z, along x at zero; angles about y from x downwards."""
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 10, "step": "1 ms"}, **keys)
    m.add_body("upper", mass=MASS[0], inertia=[0.01, INERTIA[0], 0.05], position=[CENTRE[0], 0, 0])
    m.add_body("lower", mass=MASS[1], inertia=[0.004, INERTIA[1], 0.02], position=[LENGTH[0] + CENTRE[1], 0, 0])
    m.add_joint("shoulder", "revolute", ["ground", "upper"], at=[0, 0, 0], axis="y")
    m.add_joint("elbow", "revolute", ["upper", "lower"], at=[LENGTH[0], 0, 0], axis="y")
    return m


def closed_form(q: Any, qd: Any) -> "tuple[Any, Any, Any]":
    """M, c and g of the double pendulum in relative angles (Craig, Introduction to Robotics, chapter 6)."""
    (m1, m2), (l1, _), (c1, c2), (i1, i2) = MASS, LENGTH, CENTRE, INERTIA
    cos, sin = math.cos(q[1]), math.sin(q[1])
    m22 = i2 + m2 * c2**2
    m12 = m22 + m2 * l1 * c2 * cos
    m11 = i1 + m1 * c1**2 + i2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * cos)
    h = m2 * l1 * c2 * sin
    c = [-h * (2 * qd[0] * qd[1] + qd[1] ** 2), h * qd[0] ** 2]
    g2 = -m2 * G * c2 * math.cos(q[0] + q[1])  # positive angles turn x downwards: gravity helps
    g1 = -(m1 * c1 + m2 * l1) * G * math.cos(q[0]) + g2
    return np.array([[m11, m12], [m12, m22]]), np.array(c), np.array([g1, g2])


def arm(n: int = 7) -> polhode.Model:
    """Links with skewed inertias on hinges about z, y, z, ..."""
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 10, "step": "1 ms"})
    before: Any = "ground"
    z = 0.0
    for i in range(n):
        link = m.add_body(f"link{i}", mass=2.0 - 0.2 * i, position=[0.02 * i, 0.01, z + 0.15], inertia=SKEWED)
        m.add_joint(f"j{i}", "revolute", [before, link], at=[0.02 * i, 0, z], axis="y" if i % 2 else "z")
        before, z = link, z + 0.3
    return m


def mixed() -> polhode.Model:
    """Joints of several freedoms, one with its sides exchanged, and a free body."""
    m = polhode.Model(gravity=[0.3, -0.2, -G], analysis={"duration": 10, "step": "1 ms"})
    types = ["cylindrical", "universal", "spherical", "planar", "prismatic"]
    before: Any = "ground"
    for i, kind in enumerate(types):
        body = m.add_body(kind[:4], mass=1 + 0.1 * i, inertia=SKEWED, position=[0.3 * i + 0.15, 0.02, 0.01])
        sides = [body, before] if kind == "planar" else [before, body]
        axes: "dict[str, Any]" = {} if kind == "spherical" else {"axis": "z"}
        if kind == "universal":
            axes = {"axes": ["y", "z"]}
        m.add_joint(f"{kind[:4]}_joint", kind, sides, at=[0.3 * i, 0, 0], **axes)
        before = body
    m.add_body("free", mass=2, inertia=SKEWED, position=[0, 2, 0])
    return m


def four_bar() -> polhode.Model:
    """A parallelogram with unequal rocker, from docs/python."""
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 2, "step": "1 ms"})
    m.add_body("crank", mass=1.2, inertia=[0.01, 0.03, 0.03], position=[0, 0, 0.25])
    m.add_body("coupler", mass=2.0, inertia=[0.01, 0.2, 0.2], position=[0.5, 0, 0.5])
    m.add_body("rocker", mass=1.5, inertia=[0.01, 0.05, 0.05], position=[1.0, 0, 0.25])
    m.add_joint("A", "revolute", ["ground", "crank"], at=[0, 0, 0], axis="y")
    m.add_joint("B", "revolute", ["crank", "coupler"], at=[0, 0, 0.5], axis="y")
    m.add_joint("C", "revolute", ["coupler", "rocker"], at=[1, 0, 0.5], axis="y")
    m.add_joint("D", "revolute", ["rocker", "ground"], at=[1, 0, 0], axis="y")
    return m


def some(n: int, seed: int, size: float = 0.6) -> Any:
    return np.random.default_rng(seed).uniform(-size, size, n)


def test_a_double_pendulum_has_the_matrices_of_the_textbook() -> None:
    sim = polhode.Simulation(double_pendulum())
    assert sim.coordinates == ["shoulder", "elbow"]
    for seed in range(5):
        q, qd, qdd = some(2, seed, 3.0), some(2, seed + 10, 4.0), some(2, seed + 20, 5.0)
        M, c, g = closed_form(q, qd)
        assert sim.mass_matrix(q) == pytest.approx(M, abs=1e-13)
        assert sim.coriolis(q, qd) == pytest.approx(c, abs=1e-13)
        assert sim.gravity_moments(q) == pytest.approx(g, abs=1e-13)
        assert sim.inverse_dynamics(qdd, q, qd) == pytest.approx(M @ qdd + c + g, abs=1e-12)
    several, rates = np.array([some(2, k, 3.0) for k in range(9)]), np.array([some(2, k, 4.0) for k in range(9, 18)])
    for one, rate, g, c in zip(several, rates, sim.gravity_moments(several), sim.coriolis(several, rates)):
        assert g == pytest.approx(closed_form(one, rate)[2], abs=1e-12)
        assert c == pytest.approx(closed_form(one, rate)[1], abs=1e-12)
    assert sim.coriolis(qd=rates).shape == (9, 2)
    assert sim.time == 0 and np.array_equal(sim.q, [0, 0]) and np.array_equal(sim.qd, [0, 0])


def test_accelerations_of_the_engine_are_those_of_the_textbook() -> None:
    sim = polhode.Simulation(double_pendulum(), tau=True)
    assert sim.driven == ["shoulder", "elbow"] and np.array_equal(sim.tau, [0, 0])
    q, qd, tau = np.array([0.7, -1.9]), np.array([2.0, -3.0]), np.array([1.5, -0.4])
    sim.q, sim.qd, sim.tau = q, qd, tau
    M, c, g = closed_form(q, qd)
    assert sim.qdd == pytest.approx(np.linalg.solve(M, tau - c - g), rel=1e-11)
    sim.tau = 2 * tau  # the report follows without a step
    assert sim.qdd == pytest.approx(np.linalg.solve(M, 2 * tau - c - g), rel=1e-11)


def test_an_arm_of_two_links_moves_as_the_textbook_says() -> None:
    """Against a Runge-Kutta integration of the closed form with the same moments; the step is of second order."""
    errors = []
    for step in (2e-3, 1e-3):
        model = double_pendulum()
        model.analysis.step = step
        sim = polhode.Simulation(model, tau=["shoulder", "elbow"])
        y = np.array([0.3, -0.5, 0.0, 0.0])
        sim.q = y[:2]
        tau = np.array([-3.0, 0.8])

        def rate(y: Any, tau: Any = tau) -> Any:
            M, c, g = closed_form(y[:2], y[2:])
            return np.concatenate([y[2:], np.linalg.solve(M, tau - c - g)])

        sim.tau = tau
        for _ in range(round(0.5 / step)):
            sim.step()
        h = 5e-4
        for _ in range(1000):
            k1 = rate(y)
            k2 = rate(y + h / 2 * k1)
            k3 = rate(y + h / 2 * k2)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(y + h * k3))
        errors.append(np.abs(np.concatenate([sim.q, sim.qd]) - y).max())
    assert errors[1] < 1e-4 and errors[0] / errors[1] == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize("make", [arm, mixed, four_bar, make_chain])
def test_moments_of_the_equations_give_the_accelerations_of_the_engine(make: Any) -> None:
    sim = polhode.Simulation(make(), tau=True)
    n = len(sim.coordinates)
    sim.q, sim.qd = some(n, 1, 0.4), some(n, 2, 1.5)
    sim.tau = some(len(sim.driven), 3, 2.0)
    expected = np.zeros(n)
    expected[[sim.coordinates.index(name) for name in sim.driven]] = sim.tau
    assert sim.inverse_dynamics(sim.qdd) == pytest.approx(expected, abs=1e-10)
    for _ in range(20):
        sim.step()
    assert sim.inverse_dynamics(sim.qdd) == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize("make", [arm, mixed, four_bar, make_chain])
def test_what_is_set_is_read(make: Any) -> None:
    sim = polhode.Simulation(make())
    n = len(sim.coordinates)
    q, qd = some(n, 4, 0.5), some(n, 5, 2.0)
    sim.q, sim.qd = q, qd
    assert sim.q == pytest.approx(q, abs=1e-14)
    assert sim.qd == pytest.approx(qd, abs=1e-11)  # the method's start has a part normal to the rates, of order Δt²
    assert max(joint.residual for joint in sim.joints.values()) < 1e-12
    assert sim.ledger.constraint_residual_max < 1e-12
    # The kinetic energy is that of M.
    assert sim.energy.kinetic == pytest.approx(0.5 * qd @ sim.mass_matrix() @ qd, rel=1e-5)
    assert np.allclose(sim.mass_matrix(), sim.mass_matrix().T, rtol=0, atol=1e-15)
    before = sim.time
    sim.step()
    assert sim.time > before and np.abs(sim.q - q).max() < 0.1


def test_reports_of_joints_are_the_coordinates() -> None:
    sim = polhode.Simulation(mixed())
    sim.qd = some(len(sim.coordinates), 6, 2.0)
    for _ in range(50):
        sim.step()
    joints = [np.concatenate([joint[key] for joint in sim.joints.values()]) for key in ("coordinates", "rates")]
    count = len(joints[0])
    assert sim.q[:count] == pytest.approx(joints[0], abs=1e-13)
    assert sim.qd[:count] == pytest.approx(joints[1], abs=1e-12)
    assert sim.coordinates[:3] == ["cyli_joint.z", "cyli_joint.rz", "univ_joint.rx"]
    assert sim.coordinates[count:] == [f"free.{c}" for c in ("x", "y", "z", "rx", "ry", "rz")]
    assert sim.q[count : count + 3] == pytest.approx(sim.bodies["free"].position, abs=0)
    assert sim.qd[-3:] == pytest.approx(sim.bodies["free"].angular_velocity, abs=1e-13)


def test_turns_are_counted_and_set() -> None:
    sim = polhode.Simulation(double_pendulum(), tau=["elbow"])
    sim.reset([7.0, -20.0], [0.5, 0.25])
    assert sim.q == pytest.approx([7, -20], abs=1e-13)
    assert sim.joints["elbow"].coordinates == pytest.approx([-20], abs=1e-13)
    state = sim.state
    for _ in range(3):
        sim.step()
    assert sim.q[1] == pytest.approx(-20, abs=0.1) and sim.loads["tau.elbow"].angle % math.tau == pytest.approx(
        sim.q[1] % math.tau, abs=1e-12)
    sim.restore(state)
    assert sim.q == pytest.approx([7, -20], abs=1e-13)
    sim.reset(qd=[30.0, -70.0])
    for _ in range(300):  # joints count turns now and then
        sim.step()
        assert sim.q == pytest.approx([sim.joints[name].coordinates[0] for name in sim.coordinates], abs=1e-12)
    assert np.abs(sim.q).max() > 6


@pytest.mark.parametrize("make", [arm, mixed, four_bar])
def test_jacobians_are_derivatives_of_positions(make: Any) -> None:
    sim = polhode.Simulation(make())
    n = len(sim.coordinates)
    q = some(n, 7, 0.4)
    if make is mixed:  # rates of three free rotations are no derivatives, except at zero
        q[[i for i, name in enumerate(sim.coordinates) if name.startswith(("sphe", "free.r"))]] = 0
    sim.q = q
    point = np.array([0.1, -0.05, 0.2])
    for body in sim.bodies:
        J, h = sim.jacobian(body, point), 1e-5
        assert J.shape == (6, n)
        poses = sim.forward_kinematics(np.concatenate([q + h * np.eye(n), q - h * np.eye(n)]))[body]
        R = polhode.rotations.matrix_from_quaternion(poses.orientation)
        x = poses.position + R @ point
        assert (x[:n] - x[n:]).T / (2 * h) == pytest.approx(J[:3], abs=1e-8)
        spin = R[:n] @ np.swapaxes(R[n:], 1, 2) / (2 * h)
        spin = 0.5 * (spin - np.swapaxes(spin, 1, 2))
        assert np.array([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]]) == pytest.approx(J[3:], abs=1e-8)
    assert sim.forward_kinematics(q)[list(sim.bodies)[0]].position.shape == (3,)


def test_points_are_in_the_coordinates_of_the_model() -> None:
    """The shape's origin is at one end, 0.5 m from the centre of mass."""
    m = polhode.Model(analysis={"step": "1 ms"})
    rod = m.add_body("rod", shape={"box": [1, 0.1, 0.1], "position": [0.5, 0, 0]}, density=1000,
                     position=[0.5, 0, 0])
    m.add_joint("hinge", "revolute", ["ground", rod], at=[0, 0, 0], axis="z")
    sim = polhode.Simulation(m)
    assert sim.jacobian("rod")[:2, 0] == pytest.approx([0, 0], abs=1e-14)
    assert sim.jacobian("rod", [1, 0, 0])[:2, 0] == pytest.approx([0, 1], abs=1e-14)
    assert sim.solve("rod", [0, 1, 0], point=[1, 0, 0]) == pytest.approx([math.pi / 2], abs=1e-10)


@pytest.mark.parametrize("make", [arm, mixed, four_bar])
def test_work_of_the_velocity_forces_is_that_of_the_changing_masses(make: Any) -> None:
    """q̇ᵀ(Ṁ − 2C)q̇ = 0: along a motion with constant rates, dT/dt = q̇·c."""
    sim = polhode.Simulation(make())
    n = len(sim.coordinates)
    q, qd, h = some(n, 8, 0.4), some(n, 9, 1.5), 1e-5
    if make is mixed:
        turning = [i for i, name in enumerate(sim.coordinates) if name.startswith(("sphe", "free.r"))]
        q[turning] = 0
    energies = [0.5 * qd @ sim.mass_matrix(q + s * h * qd) @ qd for s in (1, -1)]
    assert (energies[0] - energies[1]) / (2 * h) == pytest.approx(qd @ sim.coriolis(q, qd), abs=1e-7)


def test_a_parallelogram_has_the_inertia_of_its_closed_form() -> None:
    """Crank and rocker turn alike, the coupler does not turn: J + J + m L² for the crank's angle."""
    sim = polhode.Simulation(four_bar())
    assert sim.coordinates == ["A"]
    crank, coupler, rocker = 0.03 + 1.2 * 0.25**2, 2.0 * 0.5**2, 0.05 + 1.5 * 0.25**2
    for q in ([0.0], [0.4], [-0.9]):
        assert sim.mass_matrix(q) == pytest.approx(np.array([[crank + coupler + rocker]]), rel=1e-11)
        assert sim.coriolis(q, [2.0]) == pytest.approx([0], abs=1e-10)
        weight = (1.2 * 0.25 + 2.0 * 0.5 + 1.5 * 0.25) * G  # a positive angle leans to +x and lowers all centres
        assert sim.gravity_moments(q) == pytest.approx([-weight * math.sin(q[0])], abs=1e-10)
    assert sim.solve("rocker", sim.forward_kinematics([0.6])["rocker"].position) == pytest.approx([0.6], abs=1e-10)
    driven = polhode.Simulation(four_bar(), tau=["D"])
    assert driven.coordinates == ["D"] and driven.driven == ["D"]
    both = polhode.Simulation(four_bar(), tau=["D", "A"])  # A depends on D; its motor acts all the same
    assert both.coordinates == ["D"] and both.driven == ["D", "A"]
    both.tau = [1.0, 2.0]
    assert both.inverse_dynamics(both.qdd) == pytest.approx([-1.0], abs=1e-10)  # D turns against A


def test_rows_of_times_are_those_one_by_one() -> None:
    for make in (arm, four_bar):
        sim = polhode.Simulation(make())
        n = len(sim.coordinates)
        t = np.linspace(0, 1, 11)[:, None]
        q, qd, qdd = 0.5 * np.sin(t + np.arange(n)), 0.5 * np.cos(t + np.arange(n)), -0.5 * np.sin(t + np.arange(n))
        tau = sim.inverse_dynamics(qdd, q, qd)
        assert tau.shape == (11, n)
        assert tau == pytest.approx(np.array([sim.inverse_dynamics(*rows) for rows in zip(qdd, q, qd)]), abs=1e-11)
        assert sim.inverse_dynamics(qdd, q[0], qd[0])[4] == pytest.approx(
            sim.inverse_dynamics(qdd[4], q[0], qd[0]), abs=1e-12)
        poses = sim.forward_kinematics(q)
        last = list(sim.bodies)[-1]
        assert poses[last].position.shape == (11, 3) and poses[last].orientation.shape == (11, 4)
        sim.q = q[7]
        assert sim.bodies[last].position == pytest.approx(poses[last].position[7], abs=1e-13)
        assert sim.bodies[last].orientation == pytest.approx(poses[last].orientation[7], abs=1e-13)


def test_inverse_kinematics_finds_what_is_within_reach() -> None:
    sim = polhode.Simulation(arm())
    for seed in range(20):
        wanted = some(7, seed, 2.0)
        target = sim.forward_kinematics(wanted)["link6"]
        q = sim.solve("link6", target.position, target.orientation)
        found = sim.forward_kinematics(q)["link6"]
        assert found.position == pytest.approx(target.position, abs=1e-11)
        assert abs(found.orientation @ target.orientation) == pytest.approx(1, abs=1e-12)
    assert np.array_equal(sim.q, np.zeros(7))
    near = sim.solve("link6", target.position, target.orientation, q=wanted + 1e-3)
    assert near == pytest.approx(wanted, abs=0.05)
    only = sim.solve("link6", orientation=target.orientation)
    assert abs(sim.forward_kinematics(only)["link6"].orientation @ target.orientation) == pytest.approx(1, abs=1e-12)


def test_two_links_reach_by_the_law_of_cosines() -> None:
    sim = polhode.Simulation(double_pendulum())
    tip = [LENGTH[1] - CENTRE[1], 0, 0]  # from the centre of mass, which is the origin of a body with a given mass
    distance = 1.1
    q = sim.solve("lower", [0.6 * distance, 0, -0.8 * distance], point=tip)
    between = (LENGTH[0] ** 2 + LENGTH[1] ** 2 - distance**2) / (2 * LENGTH[0] * LENGTH[1])
    assert abs(q[1]) == pytest.approx(math.pi - math.acos(between), abs=1e-9)
    with pytest.raises(polhode.NotReached, match="0.7 m remain") as error:
        sim.solve("lower", [0, 0, -2.0], point=tip)
    assert error.value.distance == pytest.approx(0.7, abs=1e-9) and error.value.q.shape == (2,)
    model = double_pendulum()
    model.joints["elbow"].limits = {"lower": "10 deg", "upper": "150 deg"}
    bounded = polhode.Simulation(model.copy(), {"joints.elbow.start": "20 deg"})
    assert bounded.coordinate_limits[1] == pytest.approx([math.pi / 18, 15 * math.pi / 18])
    assert np.isinf(bounded.coordinate_limits[0]).all()
    found = bounded.solve("lower", [0.6 * distance, 0, -0.8 * distance], point=tip)
    assert found[1] == pytest.approx(abs(q[1]), abs=1e-9)
    with pytest.raises(polhode.ModelError, match="elbow: is outside its limits at -1"):
        bounded.q = [0, -1]


def test_reset_returns_to_the_start() -> None:
    sim = polhode.Simulation(double_pendulum(), tau=True)
    start = sim.state
    first = [sim.step() and sim.state for _ in range(5)]
    sim.tau = [1, 2]
    sim.step()
    sim.reset()
    assert sim.state == start and sim.time == 0 and np.array_equal(sim.tau, [0, 0])
    assert [sim.step() and sim.state for _ in range(5)] == first
    sim.reset([0.1, 0.2], [1.0, -1.0])
    assert sim.time == 0 and sim.q == pytest.approx([0.1, 0.2], abs=1e-14)
    assert sim.qd == pytest.approx([1, -1], abs=1e-13)
    sim.reset(qd=[0.5, 0.5])
    assert np.array_equal(sim.q, [0, 0]) and sim.qd == pytest.approx([0.5, 0.5], abs=1e-13)


def test_copies_have_their_own_moments() -> None:
    """With a damped method and automatic steps too, where the past matters."""
    for settings in ({"step": "2 ms"}, {"step": "2 ms", "rho_inf": 0.7}, {"step": None, "tolerance": 1e-6}):
        model = double_pendulum()
        model.analysis.update(settings)
        sim = polhode.Simulation(model, tau=True)
        sim.tau = [1, 0.5]
        for _ in range(5):
            sim.step()
        sim.tau = [-1, 0.25]
        other, kept = sim.copy(), sim.state
        other.tau = [9, 9]
        assert np.array_equal(sim.tau, [-1, 0.25])
        first = [sim.step() and sim.state for _ in range(5)]
        other.restore(kept)
        assert np.array_equal(other.tau, [-1, 0.25])
        assert [other.step() and other.state for _ in range(5)] == first
        with pytest.raises(polhode.ModelError):
            other.restore(kept[:-8])


def test_moments_that_jump_do_not_lower_the_order_of_a_damped_method() -> None:
    """A moment that alternates every 10 ms: the error of halved steps is a quarter."""
    def end(step: float, rho_inf: float) -> Any:
        model = double_pendulum()
        model.analysis.update({"step": step, "rho_inf": rho_inf})
        sim = polhode.Simulation(model, tau=True)
        for k in range(20):
            sim.tau = [10 * (-1) ** k, 2]
            while sim.time < (k + 1) * 0.01 - 1e-9:
                sim.step((k + 1) * 0.01)
        return sim.q

    exact = end(2.5e-5, 1.0)
    errors = [np.abs(end(step, 0.8) - exact).max() for step in (1e-3, 5e-4)]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.15)


def test_tau_is_asked_for() -> None:
    sim = polhode.Simulation(double_pendulum())
    assert sim.driven == []
    with pytest.raises(AttributeError, match="Simulation\\(model, tau=True\\)"):
        sim.tau = [0, 0]
    with pytest.raises(AttributeError, match="Simulation\\(model, tau=True\\)"):
        _ = sim.tau
    with pytest.raises(polhode.ModelError, match="'elbwo' is not a coordinate.*shoulder, elbow"):
        polhode.Simulation(double_pendulum(), tau=["elbwo"])
    with pytest.raises(TypeError, match="list"):
        polhode.Simulation(double_pendulum(), tau="elbow")
    sim = polhode.Simulation(double_pendulum(), tau=["elbow"])
    for wrong in ([1, 2], [[1]], [math.nan]):
        with pytest.raises(ValueError, match="tau"):
            sim.tau = wrong
    sim.tau = 0.25
    r = sim.run(0.01)
    assert sim.loads["tau.elbow"].moment == pytest.approx([0, 0.25, 0], abs=1e-12)
    assert r["loads.tau.elbow.moment.y"] == pytest.approx(np.full(11, 0.25), abs=1e-12)
    with pytest.raises(KeyError, match="loads/tau.elbow has no 'momnet'"):
        _ = r["loads.tau.elbow.momnet"]
    for other in ([1.0], [[0.0, 0.0]], [0.0, math.inf]):
        with pytest.raises(ValueError, match="^q "):
            sim.q = other
    with pytest.raises(ValueError, match=r"qdd has the shape \(3,\), but there are 2 coordinates"):
        sim.inverse_dynamics([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"q has the shape \(5, 3\), but"):
        sim.forward_kinematics(np.zeros((5, 3)))
    with pytest.raises(KeyError, match="Did you mean 'lower'"):
        sim.jacobian("lowr")
    with pytest.raises(ValueError, match="position, an orientation"):
        sim.solve("lower")


def test_ball_joints_and_free_bodies_have_no_motors() -> None:
    sim = polhode.Simulation(mixed(), tau=True)
    assert [name for name in sim.coordinates if name not in sim.driven] == [
        *(f"sphe_joint.{c}" for c in ("rx", "ry", "rz")), *(f"free.{c}" for c in ("x", "y", "z", "rx", "ry", "rz"))]


def test_a_loop_is_followed_and_not_torn() -> None:
    m = four_bar()
    m.bodies["rocker"].position, m.bodies["rocker"].inertia = [0.9, 0, 0.25], [0.01, 0.05, 0.05]
    m.bodies["coupler"].position = [0.45, 0, 0.5]
    m.joints["C"].at, m.joints["D"].at = [0.9, 0, 0.5], [0.9, 0, 0.2]  # a rocker of 0.3 m, which turns around
    sim = polhode.Simulation(m)
    sim.q = [0.3]
    assert max(joint.residual for joint in sim.joints.values()) < 1e-12
    state = sim.state
    with pytest.raises(polhode.ModelError, match="joint '.': cannot be closed"):
        sim.q = [1.4]  # 0.41 m from D, where coupler and rocker have 0.6 m at least
    assert sim.state == state


def test_models_without_coordinates_say_so() -> None:
    m = polhode.Model(analysis={"step": "1 ms"})
    m.add_material("rubber", "neo_hookean", youngs_modulus=1e6, poisson_ratio=0.3, density=1000)
    m.add_solid("block", material="rubber", mesh={"block": {"size": [1, 1, 1], "cells": [1, 1, 1]}})
    m.add_body("b", mass=1, inertia=[1, 1, 1], position=[5, 0, 0])
    sim = polhode.Simulation(m)
    with pytest.raises(polhode.ModelError, match="solids.block"):
        _ = sim.q
    sim.reset()


def test_a_linearisation_takes_tau_as_inputs() -> None:
    sim = polhode.Simulation(double_pendulum(), tau=True)
    sim.q, sim.qd, sim.tau = [1.2, 0.4], [0, 0], [0.3, -0.2]
    s = polhode.linearize(sim, inputs=["tau.shoulder", "tau.elbow"])
    M, _, _ = closed_form([1.2, 0.4], [0, 0])
    assert s.B[2:] == pytest.approx(np.linalg.inv(M), rel=1e-6)


def test_matrices_agree_with_mujoco() -> None:
    mujoco = pytest.importorskip("mujoco")
    text = """<mujoco><option gravity="0 0 -9.81"/><worldbody>
      <body name="upper" pos="0 0 0"><joint name="shoulder" axis="0 1 0"/>
        <inertial pos="0.35 0 0" mass="1.3" diaginertia="0.01 0.05 0.05"/>
        <body name="lower" pos="0.8 0 0"><joint name="elbow" axis="0 1 0"/>
          <inertial pos="0.2 0 0" mass="0.7" diaginertia="0.004 0.02 0.02"/></body></body>
    </worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    sim = polhode.Simulation(double_pendulum())
    data.qpos[:], data.qvel[:] = q, qd = [0.7, -1.1], [2.0, -0.5]
    mujoco.mj_forward(model, data)
    M = np.zeros((2, 2))
    try:
        mujoco.mj_fullM(model, data, M)
    except TypeError:  # before version 4
        mujoco.mj_fullM(model, M, data.qM)
    assert sim.mass_matrix(q) == pytest.approx(M, abs=1e-12)
    assert sim.coriolis(q, qd) + sim.gravity_moments(q) == pytest.approx(data.qfrc_bias, abs=1e-12)
