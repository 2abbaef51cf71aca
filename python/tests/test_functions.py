# SPDX-License-Identifier: Apache-2.0
"""Forces by Python functions of the motion; probes by name."""

import gc
import pathlib
import pickle
import traceback
import weakref
from collections.abc import Callable
from typing import Optional, Union

import numpy as np
import numpy.typing as npt
import pytest

import polhode
from conftest import make_pendulum

Array = npt.NDArray[np.float64]

MASS, K, C, START = 2.0, 50.0, 3.0, 0.8


def free_body(step: float, force: object, **analysis: object) -> polhode.Model:
    m = polhode.Model(analysis={"duration": 1.5, "step": step, **analysis})
    m.add_body("it", mass=MASS, inertia=[0.1, 0.2, 0.3], position=[START, 0, 0])
    m.add_load("push", "force", body="it", at=[START, 0, 0], force=force)
    return m


def spring(t: float, body: polhode.BodyReading) -> Array:
    return -K * body.position - C * body.velocity


def spring_tangent(t: float, body: polhode.BodyReading) -> "dict[str, Array]":
    return {"position": -K * np.eye(3), "velocity": -C * np.eye(3)}


def closed_form(t: Union[float, Array], c: float = C) -> Union[np.float64, Array]:
    d = c / (2 * MASS)
    w = np.sqrt(K / MASS - d * d)
    x: Union[np.float64, Array] = START * np.exp(-d * t) * (np.cos(w * t) + d / w * np.sin(w * t))
    return x


@pytest.mark.parametrize("force", [spring, polhode.StateFunction(spring, tangent=spring_tangent)])
def test_a_spring_in_python_is_of_second_order(force: "Callable[..., object]") -> None:
    errors = []
    for steps in (30, 300, 3000):  # a hundredth of the first
        r = polhode.run(free_body(1.5 / steps, force))
        errors.append(np.max(np.abs(r.bodies["it"].position[:, 0] - closed_form(r.time))))
        assert r.ledger.energy_drift < 1e-11  # the function's dissipation is in the energy balance
        assert r.ledger.newton_iterations <= 3.1 * steps
    assert np.log10(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)
    assert np.log10(errors[1] / errors[2]) == pytest.approx(2, abs=0.05)


def test_what_reads_no_velocity_goes_with_order_four() -> None:
    force = polhode.StateFunction(lambda t, body: -K * body.position, velocity=False)
    errors = []
    for steps in (50, 100, 200):
        r = polhode.run(free_body(1.5 / steps, force, order=4))
        errors.append(abs(r.bodies["it"].position[-1, 0] - closed_form(1.5, 0)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.2)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4, abs=0.2)
    polhode.run(free_body(0.01, spring, order=4))  # by extrapolation
    with pytest.raises(polhode.ModelError, match="order"):
        polhode.run(free_body(0.01, spring, order=4, method="composition"))


def test_a_linear_spring_keeps_its_energy_at_any_step() -> None:
    for step in (0.1, 0.01, 0.001):
        r = polhode.run(free_body(step, lambda t, body: -K * body.position))
        x = r.bodies["it"].position[:, 0]
        total = r.energy.kinetic + 0.5 * K * x**2
        assert np.ptp(total) < 1e-11 * total[0]


def test_a_force_reads_the_point_that_it_acts_at() -> None:
    seen: "list[tuple[float, Array, Array, Array]]" = []

    def force(t: float, body: polhode.BodyReading) -> "list[float]":
        assert body.position.shape == (3,) and body.orientation.shape == (4,)
        with pytest.raises(ValueError):
            body.position[0] = 1.0
        seen.append((t, body.position.copy(), body.velocity.copy(), body.angular_velocity.copy()))
        return [0, 0, 0]

    m = polhode.Model(analysis={"duration": 0.1, "step": 0.01})
    m.add_body("it", mass=1, inertia=[1, 1, 1], position=[1, 0, 0], angular_velocity=[0, 0, 2])
    m.add_load("push", "force", body="it", at=[1.5, 0, 0], force=force)
    polhode.run(m)
    for t, position, velocity, angular_velocity in seen[::7]:
        assert -0.01 <= t <= 0.1  # the start also evaluates an earlier step
        assert position == pytest.approx([1 + 0.5 * np.cos(2 * t), 0.5 * np.sin(2 * t), 0], abs=2e-4)
        assert velocity == pytest.approx([-np.sin(2 * t), np.cos(2 * t), 0], abs=2e-3)
        assert angular_velocity == pytest.approx([0, 0, 2], abs=1e-4)  # displaced for differences


def test_a_moment_in_a_joint_is_the_spring_of_the_engine() -> None:
    loads: "list[tuple[str, dict[str, object]]]" = [
        ("torsional_spring", {"stiffness": 7, "damping": 0.3}),
        ("rotary_motor", {"moment": lambda t, q, rate: -7 * q - 0.3 * rate}),
        ("rotary_motor", {"moment": polhode.StateFunction(
            lambda t, q, rate: -7 * q - 0.3 * rate, tangent=lambda t, q, rate: (-7, -0.3))}),
    ]
    results = []
    for kind, load in loads:
        m = make_pendulum()
        m.add_load("twist", kind, joint="hinge", **load)
        results.append(polhode.run(m).joints["hinge"].coordinates[:, 0])
    assert np.ptp(results[0]) > 0.5
    for other in results[1:]:
        assert other == pytest.approx(results[0], abs=1e-8)


def test_a_pull_along_a_line_and_a_moment_on_a_body() -> None:
    angles, lengths = [], []
    for pull in (lambda t, length, rate: 40 * (length - 0.4) + 0.5 * rate, None):
        m = polhode.Model(analysis={"duration": 1, "step": 0.005})
        m.add_body("a", mass=2, inertia=[1, 2, 3], angular_velocity=[0, 1, 0])
        m.add_body("b", mass=1, inertia=[1, 1, 1], position=[0.6, 0, 0])
        points = {"bodies": ["a", "b"], "at": [[0, 0, 0], [0.6, 0, 0]]}
        if pull:
            m.add_load("line", "axial_force", **points, pull=pull)
            m.add_load("brake", "moment", body="a", moment=lambda t, body: -0.5 * body.angular_velocity)
        else:
            m.add_load("line", "spring_damper", **points, stiffness=40, damping=0.5, free_length=0.4)
            m.add_load("brake", "drag", body="a", turning=0.5)
        r = polhode.run(m)
        lengths.append(r.loads["line"].length)
        angles.append(r.bodies["a"].angular_velocity[:, 1])
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-9)
    assert angles[0] == pytest.approx(angles[1], abs=1e-9)


def test_the_same_bits_again_and_after_a_restart() -> None:
    m = free_body(0.01, spring)
    first, second = polhode.Simulation(m), polhode.Simulation(m)
    first.run(0.7)
    second.restore(first.state)
    first.run()
    second.run()
    assert first.ledger.result_hash == second.ledger.result_hash == polhode.run(m).ledger.result_hash


def test_an_exception_stops_the_run_and_shows_its_line() -> None:
    trouble = {"on": False}

    def force(t: float, body: polhode.BodyReading) -> Union[float, Array]:
        if trouble["on"] and t > 0.5:
            return 1 / 0  # here
        return -K * body.position

    sim = polhode.Simulation(free_body(0.01, force))
    sim.run(0.8)
    trouble["on"] = True
    state, time = sim.state, sim.time
    with pytest.raises(ZeroDivisionError) as caught:
        sim.step()
    assert any("1 / 0  # here" in line for line in traceback.format_tb(caught.value.__traceback__))
    assert sim.state == state and sim.time == time
    trouble["on"] = False
    sim.run()
    undisturbed = polhode.run(free_body(0.01, force))
    assert sim.ledger.result_hash == undisturbed.ledger.result_hash


@pytest.mark.parametrize("give, message", [
    (lambda t, body: [1, 2], "three numbers"),
    (lambda t, body: 1.0, "three numbers"),
    (lambda t: [1, 2, 3, 4], "three numbers"),
    (lambda t, body: ["a", 0, 0], "real number"),
    (polhode.StateFunction(spring, tangent=lambda t, body: {"speed": 0}), "Use position"),
    (polhode.StateFunction(spring, tangent=lambda t, body: [1]), "must return a map"),
])
def test_what_is_no_force_is_told(give: "Callable[..., object]", message: str) -> None:
    with pytest.raises(TypeError, match=message):
        polhode.run(free_body(0.01, give))


def test_a_wrong_number_of_arguments_is_told_before_the_run() -> None:
    for force, key in ((lambda t, q, rate: [0, 0, 0], "f\\(t, body\\)"), ([spring, 0, 0], "Complete forces")):
        with pytest.raises(polhode.ModelError, match=key):
            free_body(0.01, force).check()
    m = make_pendulum()
    m.add_load("motor", "rotary_motor", joint="hinge", moment=lambda t, q: 0)
    with pytest.raises(polhode.ModelError, match="f\\(t, q, rate\\)"):
        m.check()
    m.loads["motor"] = {"type": "rotary_motor", "joint": "hinge", "angle": lambda t, q, rate: 0}
    with pytest.raises(polhode.ModelError, match="cannot depend on the motion"):
        m.check()


@pytest.mark.parametrize("mirror", [None, "y"])
def test_functions_of_a_part_count_in_its_axes(mirror: Optional[str]) -> None:
    """Motion of a rotated and mirrored part: in its own axes it is that of the part alone."""

    class Steer:
        calls = 0

        def __call__(self, t: float, body: polhode.BodyReading) -> "list[float]":
            self.calls += 1
            return [1 - 5 * body.position[0], 2 * body.velocity[2], 3 * np.cos(t) - body.orientation[1]]

    steer = Steer()
    part = polhode.Model(analysis={"duration": 1, "step": 0.01})
    part.add_body("b", mass=1, inertia=[1, 2, 3], position=[0.3, 0.1, 0.2], angular_velocity=[1, 0.5, 0])
    part.add_load("steer", "force", body="b", at=[0.3, 0.1, 0.2], force=steer)
    part.add_load("time", "force", body="b", at=[0.3, 0.1, 0.2], force=lambda t: [np.sin(t), 2, t])
    part.add_load("one", "force", body="b", at=[0.3, 0.1, 0.2], force=["2*t", lambda t: 3 * t, 0])
    part.add_load("turn", "moment", body="b", moment=lambda t, body: [0.2, -body.angular_velocity[0], t])
    part.add_joint("slide", "prismatic", ["ground", "b"], at=[0.3, 0.1, 0.2], axis="x")
    part.joints.pop("slide")
    alone = polhode.run(part).bodies["b"]
    inner, whole = polhode.Model(), polhode.Model(analysis={"duration": 1, "step": 0.01})
    inner.attach(part, prefix="in_", at=[0, 1, 0])
    whole.attach(inner, prefix="out_", at=[1, 2, 3], orientation={"axis": "z", "angle": "90 deg"}, mirror=mirror)
    before = steer.calls
    seen = polhode.run(whole).bodies["out_in_b"]
    assert steer.calls > before  # the user's own object, not a copy
    sign = np.array([1, -1 if mirror else 1, 1])
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    expected = ((alone.position + [0, 1, 0]) * sign) @ turn.T + [1, 2, 3]
    assert seen.position == pytest.approx(expected, abs=1e-9)
    assert seen.velocity == pytest.approx((alone.velocity * sign) @ turn.T, abs=1e-9)


def test_a_mirrored_joint_counts_as_in_the_part() -> None:
    part = make_pendulum()
    part.add_load("drive", "rotary_motor", joint="hinge", moment=lambda t, q, rate: 3 - 2 * rate)
    part.add_load("time", "rotary_motor", joint="hinge", moment=lambda t: np.sin(t))
    alone = polhode.run(part).bodies["arm"].position
    for mirror in "xyz":
        whole = polhode.Model(analysis=dict(part.analysis), gravity=part.gravity)
        sign = np.where(np.array(list("xyz")) == mirror, -1, 1)
        whole.gravity = list(np.array(part.gravity) * sign)
        whole.attach(part, prefix="it_", mirror=mirror)
        assert polhode.run(whole).bodies["it_arm"].position == pytest.approx(alone * sign, abs=1e-9)


def test_linearize_sees_the_derivatives_of_a_function() -> None:
    m = polhode.Model(analysis={"duration": 1, "step": 0.01})
    m.add_body("it", mass=MASS, inertia=[1, 1, 1])
    m.add_joint("rail", "prismatic", ["ground", "it"], at=[0, 0, 0], axis="x")
    m.add_load("push", "force", body="it", at=[0, 0, 0], force=spring)
    s = polhode.linearize(m, inputs=["push.x"], outputs=["bodies.it.position.x"])
    assert np.sort_complex(np.linalg.eigvals(s.A)) == pytest.approx(
        np.sort_complex(np.roots([MASS, C, K])), abs=1e-4)
    assert s.C @ np.linalg.solve(-s.A, s.B) == pytest.approx(1 / K, rel=1e-5)


def test_models_with_named_functions_are_pickled() -> None:
    m = pickle.loads(pickle.dumps(free_body(0.01, polhode.StateFunction(spring, tangent=spring_tangent))))
    assert polhode.run(m).ledger.result_hash == polhode.run(
        free_body(0.01, polhode.StateFunction(spring, tangent=spring_tangent))).ledger.result_hash
    assert "StateFunction" in repr(m.loads["push"].force)


def test_a_force_that_knows_the_simulation_is_collected_with_it() -> None:
    class Force:
        simulation: Optional[polhode.Simulation] = None

        def __call__(self, t: float, body: polhode.BodyReading) -> "list[float]":
            return [0, 0, 0 if self.simulation is None else self.simulation.time]

    force = Force()
    force.simulation = polhode.Simulation(free_body(0.01, force))
    force.simulation.copy().run(0.1)
    force.simulation.step()
    gone = weakref.ref(force)
    del force
    gc.collect()
    assert gone() is None


def test_names_that_do_not_exist_are_told_with_near_ones(pendulum: polhode.Model) -> None:
    with pytest.raises(AttributeError, match="Did you mean 'Box'"):
        _ = polhode.Boxx
    with pytest.raises(KeyError, match="There are: arm"):
        _ = pendulum.bodies["wheel"]
    with pytest.raises(AttributeError, match="Did you mean 'force'"):
        _ = polhode.Simulation(pendulum).joints["hinge"].forc
    assert polhode.ModelError.__module__ == "polhode"


def test_probes_by_name(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    pendulum.add_probe("tip", body="arm", point=[0.5, 0, 0], every="50 ms")
    pendulum.add_probe("hinge", joint="hinge")
    r = polhode.run(pendulum, output=tmp_path / "run")
    tip = r.probes["tip"]
    assert tip.t == pytest.approx(np.arange(0, 1.01, 0.05)) and tip.unit("vz") == "m/s"
    assert np.hypot(tip.x, tip.z) == pytest.approx(1.0)
    opened = polhode.open(tmp_path / "run").probes
    assert list(opened) == ["hinge", "tip"] and set(r.probes) == set(opened)
    for name in opened:
        assert list(opened[name]) == list(r.probes[name])
        for column in opened[name]:
            assert np.array_equal(opened[name][column], r.probes[name][column])
    sim = polhode.Simulation(pendulum)
    stepped = sim.run()
    assert sim.probes["tip"].z == tip.z[-1] and np.array_equal(stepped.probes["tip"].z, tip.z)
    assert "m/s" in repr(sim.probes["tip"]) and "21 rows" in repr(tip)
    with pytest.raises(KeyError, match="Did you mean 'tip'"):
        sim.probes["tpi"]
    with pytest.raises(AttributeError, match="There are: t, x"):
        _ = tip.height
    assert pickle.loads(pickle.dumps(r)).probes["tip"].z == pytest.approx(tip.z, abs=0)
