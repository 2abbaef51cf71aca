# SPDX-License-Identifier: Apache-2.0
"""Gradients of runs."""

import math
import pathlib

import numpy as np
import pytest

import polhode
from conftest import make_chain


def test_gradient_of_a_throw_is_its_closed_form() -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": "0.5 s", "step": "10 ms"})
    m.add_body("ball", mass=2, inertia=[1, 1, 1], position=[0, 0, 1], velocity=[3, 0, 4])
    g = polhode.gradient(m, "bodies.ball.position.z", ["bodies.ball.velocity.2", "gravity.2", "bodies.ball.mass"])
    assert g.by == pytest.approx({"bodies.ball.velocity.2": 0.5, "gravity.2": 0.125, "bodies.ball.mass": 0}, abs=1e-11)
    assert max(g.error.values()) < 1e-11 and g.check < 1e-11
    assert g.value == pytest.approx(1 + 4 * 0.5 - 9.81 * 0.125)
    assert g.elasticity["gravity.2"] == pytest.approx(-9.81 * 0.125 / g.value)
    assert "by gravity.2: 0.125" in repr(g)


def test_gradients_of_integrals_and_misfits_are_their_closed_forms(tmp_path: pathlib.Path) -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": "0.5 s", "step": "10 ms"})
    m.add_body("ball", mass=2, inertia=[1, 1, 1], position=[0, 0, 1], velocity=[3, 0, 4])
    table = tmp_path / "table.csv"
    table.write_text("t [s],bodies.ball.position.x [m]\n0.25,0.7\n0.5,1.4\n")
    integral, misfit = polhode.gradient(m, ["bodies.ball.position.x@integral", f"misfit:{table}"],
                                        "bodies.ball.velocity.0")
    assert integral.unit == "m s" and integral.by["bodies.ball.velocity.0"] == pytest.approx(0.125, abs=1e-11)
    assert misfit.value == pytest.approx(0.05**2 + 0.1**2)
    assert misfit.by["bodies.ball.velocity.0"] == pytest.approx(2 * (0.05 * 0.25 + 0.1 * 0.5), abs=1e-11)


def test_gradient_is_that_of_differences_of_runs(pendulum: polhode.Model) -> None:
    outcomes = ["bodies.arm.position.z@end", "joints.hinge.rz@0.5"]
    z, angle = polhode.gradient(pendulum, outcomes, "gravity.2", error_bars=False)
    assert z.error == {} and angle.time == pytest.approx(0.5)

    def height(gravity: float) -> float:
        run = polhode.run(pendulum, overrides={"gravity.2": gravity}, progress=False)
        return float(run.bodies["arm"].position[-1, 2])

    d = 1e-2
    slope = sum(w * (height(-9.81 + k * d) - height(-9.81 - k * d)) for k, w in ((1, 45), (2, -9), (3, 1))) / (60 * d)
    assert z.by["gravity.2"] == pytest.approx(slope, rel=1e-8)
    forward = polhode.gradient(pendulum, outcomes, "gravity.2", error_bars=False, forward=True)
    assert math.isclose(forward[0].by["gravity.2"], z.by["gravity.2"], rel_tol=1e-11)


def test_what_has_no_gradient_is_refused_by_name(pendulum: polhode.Model) -> None:
    with pytest.raises(polhode.ModelError, match="gravity.7.*is not in the model"):
        polhode.gradient(pendulum, "bodies.arm.position.z", "gravity.7")
    pendulum.add_load("push", "force", body="arm", at=[1, 0, 0], force=lambda t: [0, 0, t])
    with pytest.raises(polhode.ModelError, match="loads.push.*has no known derivative"):
        polhode.gradient(pendulum, "bodies.arm.position.z", "gravity.2")


def test_a_chaotic_gradient_warns() -> None:
    m = make_chain()
    with pytest.warns(UserWarning, match="no property of the motion"):
        polhode.gradient(m, "bodies.b2.position.z", "gravity.2")


TOLERANCES = (1e-4, 1e-6, 1e-8)


def swing(tolerance: float, **output: float) -> polhode.Model:
    """A cart on a spring and a damper along x."""
    m = polhode.Model(variables={"k": 50, "c": 1.5}, analysis={"duration": 1, "tolerance": tolerance}, output=output)
    m.add_body("cart", mass=2, inertia=[1, 1, 1], position=[0.1, 0, 0])
    m.add_joint("guide", "prismatic", bodies=["ground", "cart"], at=[0, 0, 0], axis="x")
    m.add_load("spring", "translational_spring", joint="guide", stiffness="k", damping="c", free_displacement=-0.1)
    return m


def swung(t: float, k: float = 50, c: float = 1.5) -> float:
    """Its place in closed form."""
    decay = c / 4
    rate = math.sqrt(k / 2 - decay**2)
    return 0.1 * math.exp(-decay * t) * (math.cos(rate * t) + decay / rate * math.sin(rate * t))


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_gradients_of_automatic_steps_tend_to_the_closed_form(tolerance: float) -> None:
    m = swing(tolerance)
    by_k = (swung(0.7, 50 + 1e-4) - swung(0.7, 50 - 1e-4)) / 2e-4
    by_c = (swung(0.7, 50, 1.5 + 1e-5) - swung(0.7, 50, 1.5 - 1e-5)) / 2e-5
    g = polhode.gradient(m, "bodies.cart.position.x@0.7", ["variables.k", "variables.c"])
    assert g.time == pytest.approx(0.7, abs=1e-14) and g.check < 1e-11
    assert g.by["variables.k"] == pytest.approx(by_k, rel=10 * tolerance, abs=2 * g.error["variables.k"])
    assert g.by["variables.c"] == pytest.approx(by_c, rel=10 * tolerance, abs=2 * g.error["variables.c"])


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_adjoints_of_automatic_steps_are_the_transpose_of_their_tangents(tolerance: float) -> None:
    r = polhode.run(swing(tolerance), progress=False)
    channel = "bodies.cart.position"
    change = r.push_forward({"variables.k": 2.0, "variables.c": -0.1}, [channel])[channel]
    weights = np.cos(np.arange(change.size)).reshape(change.shape)
    slopes = r.pull_back({channel: weights}, ["variables.k", "variables.c"])
    along = 2.0 * slopes["variables.k"] - 0.1 * slopes["variables.c"]
    assert along == pytest.approx(float(np.sum(weights * change)), rel=1e-10)
    assert np.max(np.abs(change)) > 1e-4


def test_fits_with_automatic_steps_find_what_the_data_were_made_with() -> None:
    t = np.linspace(0, 1, 60)
    data = {"time": t, "bodies.cart.position.x": np.array([swung(x, 42, 1.1) for x in t])}
    for jacobian in ("exact", "adjoint"):
        found = polhode.fit(swing(1e-9, every=0.01), data, {"variables.k": 50, "variables.c": 1.5}, jacobian=jacobian)
        assert found.parameters["variables.k"] == pytest.approx(42, rel=1e-5)
        assert found.parameters["variables.c"] == pytest.approx(1.1, rel=1e-4)


def test_designs_with_automatic_steps_meet_their_target() -> None:
    best = polhode.minimize(swing(1e-8), {"bodies.cart.position.x@0.5": swung(0.5, 44)}, {"variables.k": 50})
    assert best.parameters["variables.k"] == pytest.approx(44, rel=1e-6)


def test_fits_through_impacts_say_that_runs_do_not_locate_them() -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], variables={"e": 0.6},
                      contacts={"default": {"law": "rigid", "restitution": "e"}},
                      analysis={"duration": "0.7 s", "step": "5 ms"})
    m.add_body("floor", fixed=True, shape={"plane": "z"})
    m.add_body("ball", mass=1, shape={"sphere": 0.1}, position=[0, 0, 1.05])
    t = np.linspace(0, 0.7, 50)
    meets = math.sqrt(2 / 9.81)
    back = np.maximum(t - meets, 0.0)
    height = np.where(t < meets, 1.05 - 9.81 / 2 * t**2, 0.05 + 0.8 * 9.81 * meets * back - 9.81 / 2 * back**2)
    data = {"time": t, "bodies.ball.position.z": height}
    with pytest.warns(UserWarning, match="impacts and events end steps in the gradient"):
        found = polhode.fit(m, data, {"variables.e": 0.6}, jacobian="exact")
    assert found.parameters["variables.e"] == pytest.approx(0.8, abs=0.02)
