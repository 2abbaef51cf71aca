# SPDX-License-Identifier: Apache-2.0
"""Stepping, setting, copying; loads from Python; modes and matrices."""

import pathlib
from typing import Any

import numpy as np
import pytest
import scipy.linalg

import polhode
from conftest import make_pendulum


def test_steps_are_those_of_a_run(pendulum: polhode.Model) -> None:
    sim = polhode.Simulation(pendulum)
    heights = [sim.bodies["arm"].position[2]]
    for step in sim:  # noqa: B007
        heights.append(sim.bodies["arm"].position[2])
    r = polhode.run(pendulum)
    assert np.array_equal(heights, r.bodies["arm"].position[:, 2])
    assert sim.ledger.result_hash == r.ledger.result_hash
    assert step.time == sim.time == pytest.approx(1) and step.dt == pytest.approx(0.005) and step.iterations > 0
    assert sim.joints["hinge"].coordinates == pytest.approx(r.joints["hinge"].coordinates[-1], abs=0)
    assert sim.energy.total == pytest.approx(r.energy.total[-1], abs=0)
    with pytest.raises(KeyError, match="Did you mean 'arm'"):
        _ = sim.bodies["amr"]


def test_a_state_is_restored_bit_for_bit(pendulum: polhode.Model) -> None:
    sim = polhode.Simulation(pendulum)
    sim.run(0.3)
    state, other = sim.state, sim.copy()
    first = sim.run(0.8).bodies["arm"].position
    assert other.time == pytest.approx(0.3) and other.state == state
    sim.restore(state)
    assert np.array_equal(sim.run(0.8).bodies["arm"].position, first)
    assert np.array_equal(other.run(0.8).bodies["arm"].position, first)
    assert other.state == sim.state != state
    with pytest.raises(polhode.ModelError):
        sim.restore(state[:-8])


def test_stop_conditions_and_observers(pendulum: polhode.Model) -> None:
    seen = []
    r = polhode.Simulation(pendulum).run(
        stop=lambda s: s.bodies["arm"].position[2] < -0.4, observe=lambda s: seen.append(s.time))
    assert r.end == "stopped" and r.bodies["arm"].position[-1, 2] < -0.4 <= r.bodies["arm"].position[-2, 2]
    assert np.array_equal(seen, r.time)


def test_a_body_set_in_motion_keeps_its_joints(pendulum: polhode.Model) -> None:
    sim = polhode.Simulation(pendulum)
    sim.run(0.5)
    # About the hinge the bar rotates with 2 rad/s: projection removes the velocity along the bar.
    x, _, z = sim.bodies["arm"].position
    sim.bodies["arm"].set(velocity=[0.3 * x + 2 * z, 0, 0.3 * z - 2 * x], angular_velocity=[0, 2, 0])
    assert sim.time == pytest.approx(0.5)
    assert sim.joints["hinge"].rates == pytest.approx([2], rel=1e-3)
    assert sim.bodies["arm"].velocity @ sim.bodies["arm"].position == pytest.approx(0, abs=1e-12)
    before = sim.energy.total
    sim.run()
    assert sim.energy.total == pytest.approx(before, rel=1e-12) and sim.ledger.energy_drift < 1e-12
    sim.bodies["arm"].position = [0.6, 0, 0]
    assert sim.bodies["arm"].position @ sim.bodies["arm"].position == pytest.approx(0.25, rel=1e-10)
    with pytest.raises(AttributeError, match="cannot be set"):
        sim.bodies["arm"].acceleration = [0, 0, 0]


def test_a_force_from_python_is_the_force_of_the_file() -> None:
    results = []
    for force in (["2*sin(3*t)", 0, 0], lambda t: [2 * np.sin(3 * t), 0, 0], [lambda t: 2 * np.sin(3 * t), 0, 0]):
        m = polhode.Model(analysis={"duration": 2, "step": 0.01})
        m.add_body("b", mass=2, inertia=[1, 1, 1])
        m.add_load("push", "force", body="b", at=[0, 0, 0], force=force)
        results.append(polhode.run(m))
    x = results[0].bodies["b"].position[:, 0]
    t = results[0].time
    # ẍ = sin 3t: x = t/3 − sin(3t)/9; the midpoint rule's error is t Δt²/24 times 3² below.
    assert np.max(np.abs(x - (t / 3 - np.sin(3 * t) / 9))) < 2e-4
    for r in results[1:]:
        assert r.bodies["b"].position[:, 0] == pytest.approx(x, abs=1e-14)
        assert r.loads["push"].force[-1, 0] == pytest.approx(2 * np.sin(6))


def test_python_is_called_at_the_times_of_the_method_and_drives_a_motor() -> None:
    times = []

    def speed(t: float) -> float:
        times.append(t)
        return 3.0 * t

    m = make_pendulum()
    m.add_load("motor", "rotary_motor", joint="hinge", speed=speed)
    r = polhode.run(m, overrides={"analysis.duration": 0.1, "analysis.step": 0.01})
    assert r.joints["hinge"].rates[-1, 0] == pytest.approx(0.3, rel=1e-3)
    assert min(times) >= -1e-3 and max(times) <= 0.1 + 1e-3  # differences use times 0.2 ms off
    with pytest.raises(polhode.ModelError, match="cannot be written"):
        m.save("never.yaml")


def test_an_exception_in_a_force_stops_the_run_and_is_raised() -> None:
    m = polhode.Model(analysis={"duration": 1, "step": 0.01})
    m.add_body("b", mass=2, inertia=[1, 1, 1])

    def fail(t: float) -> "list[float]":
        if t > 0.5:
            raise ZeroDivisionError(f"at {t}")
        return [0, 0, 0]

    m.add_load("push", "force", body="b", at=[0, 0, 0], force=fail)
    with pytest.raises(ZeroDivisionError, match="at 0.5"):
        polhode.run(m)
    m.bodies["b"].mass = lambda t: 1
    with pytest.raises(polhode.ModelError, match="callable is not possible here"):
        m.check()


def two_masses() -> polhode.Model:
    """Two masses on springs along z: K = [[300, -100], [-100, 100]], M = diag(2, 1)."""
    m = polhode.Model(analysis={"type": "modes", "about": "start"})
    for name, mass, z in (("a", 2, 1), ("b", 1, 2)):
        m.add_body(name, mass=mass, inertia=[1, 1, 1], position=[0, 0, z])
        m.add_joint(f"slide_{name}", "prismatic", ["ground", name], at=[0, 0, z], axis="z")
    m.add_load("s1", "spring_damper", bodies=["ground", "a"], at=[[0, 0, 0], [0, 0, 1]], stiffness=200, damping=3)
    m.add_load("s2", "spring_damper", bodies=["a", "b"], at=[[0, 0, 1], [0, 0, 2]], stiffness=100)
    return m


def test_modes_are_those_of_two_masses() -> None:
    m = two_masses()
    m.loads["s1"].damping = None
    K, M = np.array([[300, -100], [-100, 100]]), np.diag([2, 1])
    squares, shapes = scipy.linalg.eigh(K, M)
    found = polhode.modes(m)
    assert found.frequencies == pytest.approx(np.sqrt(squares) / (2 * np.pi), rel=1e-10)
    first = np.array([found[0].shape(name)[2] for name in "ab"])
    assert np.abs(first.real) == pytest.approx(np.abs(shapes[:, 0]), rel=1e-9) and not first.imag.any()
    assert found.total_mass == pytest.approx(3) and found[0].kind == "oscillation"
    assert len(polhode.modes(m, 1)) == 1


def test_matrices_are_those_of_two_masses() -> None:
    m = two_masses()
    m.analysis = {"type": "dynamics"}
    matrices = polhode.matrices(m)
    z = [2, 8]
    assert matrices.K.toarray()[np.ix_(z, z)] == pytest.approx(np.array([[300, -100], [-100, 100]]), abs=1e-9)
    assert matrices.C.toarray()[np.ix_(z, z)] == pytest.approx(np.diag([3, 0]), abs=1e-9)
    assert matrices.M.toarray() == pytest.approx(np.diag([2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1]), abs=1e-12)
    G = matrices.G.toarray()
    assert G.shape == (10, 12) and np.linalg.matrix_rank(G) == 10
    assert G[:, z] == pytest.approx(np.zeros((10, 2)), abs=1e-14)


def test_handles_follow_the_simulation(pendulum: polhode.Model) -> None:
    pendulum.add_load("spring", "torsional_spring", joint="hinge", stiffness=1.5, damping=0.1)
    pendulum.output.probes = {"tip": {"body": "arm"}}
    sim = polhode.Simulation(pendulum)
    body, joint, load, probe = sim.bodies["arm"], sim.joints["hinge"], sim.loads["spring"], sim.probes["tip"]
    angle = joint.coordinates[0]
    for _ in range(20):
        sim.step()
        # The handles kept from the start are those that are looked up now, bit for bit.
        assert joint.coordinates[0] == sim.joints["hinge"].coordinates[0] != angle
        assert np.array_equal(body.position, sim.bodies["arm"].position)
        assert load.angle == sim.loads["spring"].angle and probe.z == sim.probes["tip"].z == body.position[2]
        assert np.array_equal(np.asarray(load), [load[k] for k in range(len(np.asarray(load)))])
        angle = joint.coordinates[0]
    kept = sim.state
    sim.run(0.5)
    later = joint.coordinates[0]
    sim.restore(kept)
    assert joint.coordinates[0] == angle != later
    assert "coordinates" in joint and dict(joint)["coordinates"][0] == angle and "coordinates" in repr(joint)


def test_what_would_change_nothing_is_refused(pendulum: polhode.Model) -> None:
    sim = polhode.Simulation(pendulum)
    with pytest.raises(AttributeError, match="coordinates cannot be set.*Set position"):
        sim.joints["hinge"].coordinates = [1.0]
    with pytest.raises(TypeError):
        sim.joints["hinge"]["coordinates"] = [1.0]
    for array in (sim.bodies["arm"].position, sim.joints["hinge"].coordinates, sim.energy.linear_momentum):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 9.0
    with pytest.raises(AttributeError, match="Did you mean 'coordinates'"):
        _ = sim.joints["hinge"].cordinates


def test_results_cannot_be_overwritten(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    pendulum.output.probes = {"tip": {"body": "arm"}}
    r = polhode.run(pendulum, output=tmp_path / "out")
    for result in (r, polhode.open(tmp_path / "out")):
        for array in (result.time, result.bodies["arm"].position, result.joints["hinge"].force, result.probes["tip"].z):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 9.0
        own = result.bodies["arm"].position.copy()
        own[0] = 9.0


def test_bodies_in_contact_are_set_apart_and_fall() -> None:
    """A ball set to another height behaves as one that starts there; overlaps are refused."""
    def ball(z: float, **keys: Any) -> polhode.Model:
        m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 1, "step": "1 ms"}, **keys)
        m.add_body("floor", fixed=True, shape={"plane": "z"}, contact={"material": "soft"})
        m.add_body("ball", shape=polhode.Sphere(0.2), density=1000, position=[0, 0, z], contact={"material": "soft"})
        m.add_contact_material("soft", friction=0.5, restitution=0.5)
        return m

    for keys in ({}, {"contacts": {"default": {"law": "nonsmooth"}}}, {"contacts": {"default": {"law": "rigid"}}}):
        there = polhode.Simulation(ball(0.2, **keys))
        sim = polhode.Simulation(ball(0.5, **keys))
        for _ in range(300):
            sim.step()
        sim.reset([0, 0, 0.2, 0, 0, 0])
        heights = []
        for s in (sim, there):
            heights.append([s.step() and s.bodies["ball"].position[2] for _ in range(400)])
        assert heights[0] == pytest.approx(heights[1], abs=1e-12) and min(heights[0]) > 0.09
        assert min(heights[0][200:]) < 0.11 < max(heights[0][200:])
        with pytest.raises(polhode.ModelError, match="shapes overlap there"):
            sim.q = [0, 0, 0.02, 0, 0, 0]
        assert sim.bodies["ball"].position[2] == heights[0][-1]


def test_controllers_act_where_motions_are_set() -> None:
    """A servo sampled every 10 ms: after a reset it acts at once, as at the start of a model there."""
    def servo(angle: float) -> polhode.Model:
        m = polhode.Model(analysis={"duration": 1, "step": "1 ms"})
        disc = m.add_body("disc", mass=1, inertia=[0.1, 0.1, 0.2])
        m.add_joint("axle", "revolute", ["ground", disc], at=[0, 0, 0], axis="z", start=angle)
        m.add_controller("pd", joint="axle", channel="rz", setpoint=1.0, proportional=20, derivative=2, sample=0.01)
        m.add_load("motor", "rotary_motor", joint="axle", moment={"controller": "pd"})
        return m

    there, sim = polhode.Simulation(servo(0.5)), polhode.Simulation(servo(0))
    sim.run(0.3)
    sim.reset([0.5])
    for _ in range(100):
        sim.step()
        there.step()
    assert sim.q == pytest.approx(there.q, abs=1e-12) and abs(sim.q[0] - 1) < 0.4


def test_endless_steps_are_those_of_a_model_with_an_end(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    ended, endless = polhode.Simulation(pendulum), polhode.Simulation(pendulum, {"analysis.duration": "none"})
    for _ in ended:
        endless.step()
    assert endless.state == ended.state and endless.end == float("inf") and repr(endless).endswith("at t = 1 s>")
    with pytest.raises(polhode.ModelError, match="beyond the end of the analysis, a longer duration, or none"):
        ended.step()
    for step in endless:
        if step.time > 2:
            break
    longer = polhode.run(pendulum, overrides={"analysis.duration": endless.time})
    assert endless.q == pytest.approx(longer.joints["hinge"].coordinates[-1], abs=1e-12)
    assert endless.copy().run(2.5).time[-1] == pytest.approx(2.5)
    assert endless.run(stop=lambda s: s.time > 2.1).end == "stopped"
    with pytest.raises(ValueError, match="the model has the duration none: give `until`"):
        endless.run()
    pendulum.analysis.duration = "none"
    pendulum.check()
    for output in (None, tmp_path / "out"):
        with pytest.raises(polhode.ModelError, match="is none, but a run needs an end"):
            polhode.run(pendulum, output=output)
    assert not (tmp_path / "out").exists()
    pendulum.analysis.step = None
    with pytest.raises(polhode.ModelError, match="none requires a fixed step"):
        pendulum.check()


def test_a_function_along_a_joint_is_a_joint_moment() -> None:
    """Against the same moment of a motor, over time and over the motion."""
    laws: "list[Any]" = [lambda t: 3 * t, lambda t, angle, rate: 2 - 5 * angle - 0.1 * rate]
    for law in laws:
        ends = []
        for kind in ("joint_moment", "rotary_motor"):
            m = polhode.Model(analysis={"duration": 1, "step": "5 ms"})
            disc = m.add_body("disc", mass=1, inertia=[0.1, 0.1, 0.2])
            m.add_joint("axle", "revolute", ["ground", disc], at=[0, 0, 0], axis="z")
            m.add_load("drive", kind, joint="axle", moment=law)
            ends.append(polhode.run(m).joints["axle"].coordinates[-1, 0])
        assert ends[0] == ends[1] != 0
