# SPDX-License-Identifier: Apache-2.0
"""Derivatives of results, fits that use them, and design."""

import math
import pathlib
import pickle
import warnings
from typing import Any

import numpy as np
import pytest

import polhode
from conftest import make_chain, make_pendulum

STEPS = ["50 ms", "10 ms", "1 ms"]


def throw(step: str = "10 ms") -> polhode.Model:
    """A free ball in the field of gravity."""
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": "0.5 s", "step": step})
    m.add_body("ball", mass=2, inertia=[1, 1, 1], position=[0, 0, 1], velocity=[3, 0, 4])
    return m


@pytest.mark.parametrize("step", STEPS)
def test_tangents_of_a_throw_are_its_closed_form(step: str) -> None:
    r = polhode.run(throw(step), progress=False)
    t = r.time
    change = r.push_forward({"gravity.2": 2.0, "bodies.ball.velocity.0": 0.5}, ["bodies.ball.position",
                                                                             "bodies.ball.velocity.z"])
    assert change["bodies.ball.position"] == pytest.approx(np.stack([0.5 * t, 0 * t, t * t], axis=1), abs=1e-11)
    assert change["bodies.ball.velocity.z"] == pytest.approx(2 * t, abs=1e-11)


@pytest.mark.parametrize("step", STEPS)
def test_the_adjoint_of_a_cost_is_the_transpose_of_its_tangents(step: str) -> None:
    m = make_pendulum(variables={"L": 1.0})
    m.add_load("push", "force", body="arm", at=["L", 0, 0], force=[0, 0, "3*sin(5*t)"])
    r = polhode.run(m, overrides={"analysis.step": step}, progress=False)
    random = np.random.default_rng(4)
    weights = {"bodies.arm.position": random.normal(size=(r.frames, 3)),
               "joints.hinge.coordinates": random.normal(size=(r.frames, 1)),
               "bodies.arm.angular_velocity.y": random.normal(size=r.frames)}
    wrt = ["bodies.arm.density", "gravity.2", "variables.L"]
    pulled = r.pull_back(weights, wrt)
    pushed = {p: sum(float(np.sum(weights[c] * by)) for c, by in r.push_forward({p: 1.0}, list(weights)).items())
              for p in wrt}
    size = max(abs(v) for v in pushed.values())
    assert [pulled[p] / size for p in wrt] == pytest.approx([pushed[p] / size for p in wrt], abs=1e-11)
    assert pulled["variables.L"] != 0


def test_a_cost_is_differentiated_as_by_differences_of_runs() -> None:
    m = make_pendulum()
    target = np.linspace(0, -1, 201)

    def cost(gravity: float) -> float:
        z = polhode.run(m, overrides={"gravity.2": gravity}, progress=False)["bodies.arm.position.z"]
        return 0.5 * float(np.sum((z - target) ** 2))

    r = polhode.run(m, progress=False)
    found = r.pull_back({"bodies.arm.position.z": r["bodies.arm.position.z"] - target}, "gravity.2")
    d = 1e-2
    slope = sum(w * (cost(-9.81 + k * d) - cost(-9.81 - k * d)) for k, w in ((1, 45), (2, -9), (3, 1))) / (60 * d)
    assert found["gravity.2"] == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize("step", STEPS)
def test_deviations_follow_from_those_of_parameters(step: str) -> None:
    r = polhode.run(throw(step), progress=False)
    sizes = {"gravity.2": 0.1, "bodies.ball.velocity.2": 0.2}
    u = r.uncertainty(sizes, ["bodies.ball.position"])
    t = r.time
    own = [0.05 * t * t, 0.2 * t]
    z = u.deviation["bodies.ball.position"][:, 2]
    assert z == pytest.approx(np.hypot(*own), abs=1e-11)
    assert u.parts["bodies.ball.position"]["gravity.2"][:, 2] == pytest.approx(own[0], abs=1e-11)
    assert u.values["bodies.ball.position"] == pytest.approx(r["bodies.ball.position"], abs=1e-12)
    together = r.uncertainty(sizes, ["bodies.ball.position"], correlation=[[1, 1], [1, 1]])
    assert together.deviation["bodies.ball.position"][:, 2] == pytest.approx(sum(own), abs=1e-8)
    assert "bodies.ball.position" in repr(u) and u.units == {"bodies.ball.position": "m"}
    for wrong in ([[1, 2], [2, 1]], [[1, 0.5], [0, 1]], [[1]]):
        with pytest.raises(ValueError, match="correlation must be a correlation matrix of 2"):
            r.uncertainty(sizes, ["bodies.ball.position"], correlation=wrong)


def test_deviations_are_those_of_many_runs() -> None:
    m = make_pendulum(output={"every": "0.1 s"})
    sizes = {"gravity.2": 0.02, "bodies.arm.position.0": 1e-4}
    random = np.random.default_rng(1)
    angles = [polhode.run(m, overrides={"gravity.2": -9.81 + 0.02 * random.normal()}, progress=False)
              ["joints.hinge.coordinates"][:, 0] for _ in range(300)]
    u = polhode.run(m, progress=False).uncertainty({"gravity.2": sizes["gravity.2"]}, ["joints.hinge.coordinates"])
    first = u.deviation["joints.hinge.coordinates"][1:, 0]
    assert np.std(angles, axis=0)[1:] / first == pytest.approx(np.ones(len(first)), abs=0.13)  # 3 of 1/sqrt(600)
    import matplotlib

    matplotlib.use("Agg")
    (panel,) = u.plot().axes
    assert panel.get_ylabel() == "joints.hinge.coordinates [rad or m]" and panel.get_legend() is None
    assert len(panel.lines) == 1 and len(panel.collections) == 1


def test_what_a_result_cannot_differentiate_is_refused(tmp_path: pathlib.Path) -> None:
    m = throw()
    r = polhode.run(m, output=tmp_path / "r", progress=False)
    with pytest.raises(ValueError, match=r"the weights of 'bodies.ball.position' have the shape \(3,\)"):
        r.pull_back({"bodies.ball.position": [1, 2, 3]}, "gravity.2")
    with pytest.raises(polhode.ModelError, match="opened results have no derivatives"):
        polhode.open(tmp_path / "r").push_forward({"gravity.2": 1}, ["bodies.ball.position"])
    with pytest.raises(polhode.ModelError, match="is not a position or velocity"):
        r.push_forward({"gravity.2": 1}, ["bodies.ball.orientation"])
    m.bodies["ball"].velocity = [0, 0, 0]  # what ran counts, not the model as it is later
    assert r.gradient("bodies.ball.position.z", "gravity.2").value == pytest.approx(1 + 2 - 9.81 / 8)
    copy = pickle.loads(pickle.dumps(r))
    assert copy.gradient("bodies.ball.position.z", "gravity.2").by["gravity.2"] == pytest.approx(0.125)
    m.add_load("push", "force", body="ball", at=[0, 0, 1], force=lambda t: [0, 0, t])
    with pytest.raises(polhode.ModelError, match="loads.push.*has no known derivative"):
        polhode.run(m, progress=False).pull_back({"bodies.ball.position.z": np.ones(51)}, "gravity.2")


def spring(**variables: float) -> polhode.Model:
    """A damped mass on a spring along z."""
    m = polhode.Model(variables={"k": 40, "c": 0.8, "m": 1.0, **variables}, analysis={"duration": 2, "step": 0.01})
    m.add_body("b", mass="m", inertia=[1, 1, 1], position=[0, 0, 1.5])
    m.add_joint("slide", "prismatic", ["ground", "b"], at=[0, 0, 0], axis="z")
    m.add_load("s", "spring_damper", bodies=["ground", "b"], at=[[0, 0, 0], [0, 0, 1.5]], stiffness="k", damping="c",
               free_length=1)
    return m


def measured(m: polhode.Model, noise: float = 0.0, **overrides: float) -> "dict[str, Any]":
    r = polhode.run(m, overrides={f"variables.{k}": v for k, v in overrides.items()}, progress=False)
    z = np.array(r["bodies.b.position.z"])
    return {"time": np.array(r.time), "bodies.b.position.z": z + np.random.default_rng(7).normal(0, noise, len(z))}


def test_several_experiments_tell_apart_what_one_does_not() -> None:
    m = spring()
    guess = {"variables.k": 30.0, "variables.m": 1.3, "variables.c": 1.0}
    lost = "do not tell these parameters apart, or do not depend on them: variables.k, variables.m, variables.c"
    for jacobian in ("differences", "exact"):
        with pytest.warns(UserWarning, match=lost):
            alone = polhode.fit(m, measured(m), guess, jacobian=jacobian)
        assert list(alone.errors.values()) == [math.inf] * 3 and np.all(np.isnan(alone.correlation))
        with pytest.raises(ValueError, match="do not determine all its parameters"):
            alone.result.uncertainty(alone, ["bodies.b.position.z"])
    one = {"time": [0.5], "bodies.b.position.z": [1.2]}
    with pytest.warns(UserWarning, match="variables.k, variables.c"):
        polhode.fit(m, one, {"variables.k": 30.0, "variables.c": 1.0}, jacobian="exact")
    with pytest.warns(UserWarning, match="depend on them: bodies.b.inertia.0. Fix"):
        still = polhode.fit(m, measured(m, noise=0.01), {"variables.k": 39.0, "bodies.b.inertia.0": 1.0},
                            jacobian="exact")
    assert still.errors["bodies.b.inertia.0"] == math.inf and still.errors["variables.k"] < 0.1
    # A known mass on top: the ratio k/m changes by a known part.
    m.add_body("weight", mass="w", inertia=[1, 1, 1], position=[0, 0, 1.5])
    m.variables["w"] = 1e-6
    m.add_joint("bolt", "fixed", ["b", "weight"], at=[0, 0, 1.5])
    data = [polhode.Experiment(measured(m, w=w), {"variables.w": w}) for w in (1e-6, 0.5)]
    for jacobian in ("differences", "exact", "adjoint"):
        fit = polhode.fit(m, data, guess, jacobian=jacobian)
        accuracy = 1e-4 if jacobian == "adjoint" else 1e-6
        assert fit.parameters == pytest.approx({"variables.k": 40, "variables.m": 1, "variables.c": 0.8}, rel=accuracy)
        assert len(fit.results) == 2 and fit.results[1].frames == 201 and len(fit.residuals) == 402
        assert fit.singular_values[-1] > 1e-4 * fit.singular_values[0]
    assert np.diag(fit.correlation) == pytest.approx(np.ones(3)) and np.all(np.abs(fit.correlation) < 1 + 1e-12)


def test_deviations_and_priors_weigh_as_bayes_says() -> None:
    m, sigma = spring(), 0.01
    data = measured(m, noise=sigma)
    plain = polhode.fit(m, data, {"variables.k": 39.0}, jacobian="exact", deviations={"bodies.b.position.z": sigma})
    own = plain.errors["variables.k"]
    prior = (plain.parameters["variables.k"] + 2 * own, own)
    both = polhode.fit(m, data, {"variables.k": 39.0}, jacobian="exact", deviations={"bodies.b.position.z": sigma},
                       priors={"variables.k": prior})
    # Equal weights: the mean of both, with half the variance.
    middle = 0.5 * (plain.parameters["variables.k"] + prior[0])
    assert both.parameters["variables.k"] == pytest.approx(middle, abs=0.02 * own)
    assert both.errors["variables.k"] == pytest.approx(own / math.sqrt(2), rel=0.02)
    assert len(both.residuals) == len(plain.residuals) == 201
    assert np.mean(plain.residuals ** 2) == pytest.approx(1, abs=0.3)
    with pytest.raises(ValueError, match="has no standard deviation"):
        polhode.fit(m, data, {"variables.k": 39.0}, priors={"variables.k": prior})
    with pytest.raises(ValueError, match="'variables.c' has a prior and is not a parameter"):
        polhode.fit(m, data, {"variables.k": 39.0}, deviations={"bodies.b.position.z": 1},
                    priors={"variables.c": (1, 1)})
    with pytest.raises(ValueError, match="must be positive"):
        polhode.fit(m, data, {"variables.k": 39.0}, deviations={"bodies.b.position.z": 0})
    with pytest.raises(ValueError, match="the data have no 'time'"):
        polhode.fit(m, {"bodies.b.position.z": [1]}, {"variables.k": 39.0})
    with pytest.raises(ValueError, match="the guess 39 of 'variables.k' is outside of its bounds 40 to inf"):
        polhode.fit(m, data, {"variables.k": 39.0}, bounds={"variables.k": (40, None)})
    with pytest.raises(ValueError, match="bounds name 'variables.kk'"):
        polhode.fit(m, data, {"variables.k": 39.0}, bounds={"variables.kk": (40, None)})
    spread = both.result.uncertainty(both, ["bodies.b.position.z"]).deviation["bodies.b.position.z"]
    slope = both.result.push_forward({"variables.k": 1.0}, ["bodies.b.position.z"])["bodies.b.position.z"]
    assert spread == pytest.approx(np.abs(slope) * both.errors["variables.k"], abs=1e-12)


Z = "bodies.b.position.z"


@pytest.mark.parametrize(("data", "message"), [
    ({"time": [], Z: []}, "the data have no rows"),
    ({"time": [0, 0.1, 0.2], Z: [1, math.nan, 1]}, f"'{Z}' is not a finite number in row 2"),
    ({"time": [0, math.nan], Z: [1, 1]}, "'time' is not a finite number in row 2"),
    ({"time": [0, 2.5], Z: [1, 1]}, "the data go from 0 to 2.5 s, and 'bodies.b.position.z' from 0 to 2 s"),
    ({"time": [0, 1], "bodies.b.position": [1, 1]}, "name a component"),
    ({"time": [0, 1]}, "no channel beside 'time'"),
    ([{"time": [0, 1], Z: [1, 1]}, polhode.Experiment({"time": [0, 1], Z: [1, 1]}, {"variables.k": 20})],
     "'variables.k' is fitted, so an experiment cannot set it"),
    ([(1, 2)], "data must be a table by channel"),
    ([], "there are no data"),
])
def test_data_that_are_none_are_named(data: Any, message: str) -> None:
    for jacobian in ("differences", "exact", "adjoint"):
        with pytest.raises(ValueError, match=message):
            polhode.fit(spring(), data, {"variables.k": 30.0}, jacobian=jacobian)


@pytest.mark.parametrize("jacobian", ["differences", "exact", "adjoint"])
def test_far_guesses_bounds_and_coarse_frames(jacobian: str) -> None:
    m = spring()
    data = measured(m, noise=0.01)
    far = polhode.fit(m, polhode.Experiment(data), {"variables.k": 100.0, "variables.c": 0.05}, jacobian=jacobian,
                      bounds={"variables.c": (0, None)})
    assert far.converged and abs(far.parameters["variables.k"] - 40) < 5 * far.errors["variables.k"]
    with pytest.warns(UserWarning, match="'variables.k' ends at its bound"):
        polhode.fit(m, data, {"variables.k": 35.0}, bounds={"variables.k": (30, 38)}, jacobian=jacobian)
    m.output = {"every": "0.5 s"}
    with pytest.warns(UserWarning, match="the frames of 'bodies.b.position.z' are too far apart"):
        polhode.fit(m, measured(spring()), {"variables.k": 39.0}, jacobian=jacobian)


def test_an_estimate_at_the_end_of_its_range_has_an_error() -> None:
    m = spring(c=0.0)
    data = measured(m, noise=0.01)
    with pytest.warns(UserWarning, match="'variables.c' ends at its bound"):
        fit = polhode.fit(m, data, {"variables.k": 39.0, "variables.c": 0.0}, bounds={"variables.c": (0.0, 1e-300)})
    assert abs(fit.parameters["variables.k"] - 40) < 4 * fit.errors["variables.k"] < 0.5


def test_channels_of_different_units_count_alike_and_have_their_own_errors() -> None:
    m, random = spring(), np.random.default_rng(2)
    r = polhode.run(m, progress=False)
    found, errors = [], []
    for _ in range(60):
        data = {"time": np.array(r.time)}
        for name, sigma in ((Z, 1e-3), ("joints.slide.coordinates", 0.05), ("bodies.b.position.x", 1e-3)):
            data[name] = np.array(r[name]) + sigma * random.normal(size=r[name].shape)
        fit = polhode.fit(m, data, {"variables.k": 39.0}, jacobian="exact")
        found.append(fit.parameters["variables.k"])
        errors.append(fit.errors["variables.k"])
    assert np.mean(errors) == pytest.approx(np.std(found), rel=0.3)  # 3 of 1/sqrt(120)


def test_probes_are_fitted_too_and_a_stopped_run_stops_the_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    m = spring()
    m.output = {"probes": {"tip": {"body": "b", "point": [0, 0, 0.1]}}}
    r = polhode.run(m, progress=False)
    data = {"time": np.array(r.time)[::3], "probes.tip.z": np.array(r.probes["tip"]["z"])[::3]}
    for jacobian in ("differences", "exact", "adjoint"):
        fit = polhode.fit(m, data, {"variables.k": 37.0}, jacobian=jacobian)
        assert fit.parameters["variables.k"] == pytest.approx(40, rel=1e-5)
    stopped = polhode.run(m, progress=False)
    stopped._ledger = {**(stopped._ledger or {}), "end": "interrupted"}
    monkeypatch.setattr("polhode._run._run", lambda *_, **__: stopped)
    with pytest.raises(KeyboardInterrupt):
        polhode.fit(m, data, {"variables.k": 37.0})


def test_an_exact_fit_takes_fewer_runs_than_one_by_differences() -> None:
    m = spring()
    names = {"variables.k": 30.0, "variables.c": 1.0}
    exact, differences = (polhode.fit(m, measured(m), names, jacobian=j) for j in ("exact", "differences"))
    assert exact.parameters == pytest.approx(differences.parameters, rel=1e-6)
    assert exact.runs <= differences.runs


def test_a_throw_hits_its_target() -> None:
    aim = {"bodies.ball.position.x@end": 2.0, "bodies.ball.position.z@end": 3.0}
    found = polhode.minimize(throw(), aim, {"bodies.ball.velocity.0": 3.0, "bodies.ball.velocity.2": 4.0})
    assert found.converged and found.value < 1e-14
    assert found.parameters == pytest.approx({"bodies.ball.velocity.0": 4, "bodies.ball.velocity.2": 4 + 9.81 / 4},
                                             rel=1e-6)
    assert found.outcomes == pytest.approx(aim, rel=1e-6)
    assert found.result["bodies.ball.position.x"][-1] == pytest.approx(2, rel=1e-6)
    assert "cost" in repr(found)


def test_a_limit_of_an_outcome_is_kept_and_bounds_too() -> None:
    # Highest throw that still lands below x = 1.2, at most with 5 m/s upwards: both are reached.
    speeds = {"bodies.ball.velocity.0": 1.0, "bodies.ball.velocity.2": 4.0}

    def cost(values: "np.ndarray", x: "np.ndarray") -> "tuple[float, list[float], list[float]]":
        return -values[0] - x[0], [-1.0], [-1.0, 0.0]

    found = polhode.minimize(throw(), ["bodies.ball.position.z@end"], speeds, cost=cost,
                             bounds={"bodies.ball.velocity.2": (0, 5)},
                             limits={"bodies.ball.position.x@end": (-math.inf, 1.2)})
    assert found.converged and found.parameters["bodies.ball.velocity.0"] == pytest.approx(2.4, abs=1e-4)
    assert found.parameters["bodies.ball.velocity.2"] == pytest.approx(5, abs=1e-4)
    level = polhode.minimize(throw(), "bodies.ball.position.x@end", {"bodies.ball.velocity.2": 4.0},
                             limits={"bodies.ball.velocity.z@end": (0, math.inf)},
                             bounds={"bodies.ball.velocity.2": (0, 9)})
    assert level.converged and level.outcomes["bodies.ball.velocity.z@end"] > -1e-9
    unmet = polhode.minimize(throw(), "bodies.ball.position.z@end", {"bodies.ball.velocity.2": 4.0},
                             bounds={"bodies.ball.velocity.2": (0, 5)}, max_evaluations=30,
                             limits={"bodies.ball.position.x@end": (5, 6)})
    assert not unmet.converged and "bodies.ball.position.x@end" in unmet.message


def test_designs_that_cannot_be_assembled_are_passed_over() -> None:
    # A four-bar whose coupler is fitted so that the rocker ends at 60 degrees; far steps break the loop.
    m = polhode.Model(variables={"b": 1.1}, gravity=[0, 0, 0], analysis={"duration": 0.5, "step": 0.01})
    m.add_body("mass", mass=1, inertia=[1, 1, 1], position=[0, 0, "b"])
    m.add_joint("slide", "prismatic", ["ground", "mass"], at=[0, 0, 0], axis="z")
    m.add_load("s", "spring_damper", bodies=["ground", "mass"], at=[[0, 0, 0], [0, 0, "b"]], stiffness=40,
               free_length=1, damping="b > 3 ? -1 : 0")
    found = polhode.minimize(m, {"bodies.mass.position.z@end": 0.0}, {"variables.b": 1.1},
                             bounds={"variables.b": (0.5, 10)})
    assert found.value == pytest.approx(0, abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
def test_a_minimum_that_is_nowhere_asks_for_bounds(step: str) -> None:
    # z(T) = z_0 + v T - g T^2 / 2 falls with the initial speed, without end.
    m = throw(step)
    speed, height = "bodies.ball.velocity.2", "bodies.ball.position.z@end"
    found = polhode.minimize(m, height, {speed: 4.0})
    assert not found.converged
    assert f"the search left for '{speed}' beyond 10000 times its guess. Give bounds={{'{speed}': (" in found.message
    bounded = polhode.minimize(m, height, {speed: 4.0}, bounds={speed: (-6, 6)})
    assert bounded.converged and bounded.parameters[speed] == -6
    assert bounded.value == pytest.approx(1 - 6 * 0.5 - 9.81 * 0.125, abs=1e-9)


def test_what_minimize_does_not_take_is_said() -> None:
    with pytest.raises(ValueError, match="several outcomes require `cost`"):
        polhode.minimize(throw(), ["bodies.ball.position.z@end", "bodies.ball.position.x@end"], {"gravity.2": -9.0})
    with pytest.raises(ValueError, match="targets are a cost already"):
        polhode.minimize(throw(), {"bodies.ball.position.z@end": 1}, {"gravity.2": -9.0},
                         cost=lambda v, x: (0.0, [0.0], None))
    with pytest.raises(polhode.ModelError, match="gravity.9"):
        polhode.minimize(throw(), "bodies.ball.position.z@end", {"gravity.9": 1.0})


def test_points_of_probes_have_deviations_too() -> None:
    m = throw()
    m.output = {"probes": {"edge": {"body": "ball", "point": [0.1, 0, 0]}}}
    u = polhode.run(m, progress=False).uncertainty({"bodies.ball.velocity.0": 0.1}, ["probes.edge.x"])
    assert u.deviation["probes.edge.x"] == pytest.approx(0.1 * u.time, abs=1e-12) and u.units["probes.edge.x"] == "m"


def test_doubts_of_a_design_are_said_once_at_the_end() -> None:
    m = make_chain()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = polhode.minimize(m, "bodies.b2.position.z", {"gravity.2": -9.81}, max_evaluations=4,
                                 bounds={"gravity.2": (-10, -9.5)})
    about = [w for w in caught if "bodies.b2.position.z" in str(w.message) and issubclass(w.category, UserWarning)]
    assert found.evaluations > 3 and len(about) <= 2
