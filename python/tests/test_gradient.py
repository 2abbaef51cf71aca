# SPDX-License-Identifier: Apache-2.0
"""Gradients of runs."""

import math

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
    with pytest.raises(polhode.ModelError, match="analysis.step.*is automatic"):
        polhode.gradient(pendulum, "bodies.arm.position.z", "gravity.2", overrides={"analysis.step": "auto"})
    with pytest.raises(polhode.ModelError, match="gravity.7.*is not in the model"):
        polhode.gradient(pendulum, "bodies.arm.position.z", "gravity.7")
    pendulum.add_load("push", "force", body="arm", at=[1, 0, 0], force=lambda t: [0, 0, t])
    with pytest.raises(polhode.ModelError, match="loads.push.*has no known derivative"):
        polhode.gradient(pendulum, "bodies.arm.position.z", "gravity.2")


def test_a_chaotic_gradient_warns() -> None:
    m = make_chain()
    with pytest.warns(UserWarning, match="no property of the motion"):
        polhode.gradient(m, "bodies.b2.position.z", "gravity.2")
