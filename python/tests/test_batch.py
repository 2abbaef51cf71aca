# SPDX-License-Identifier: Apache-2.0
"""Batches: many runs of one mechanism side by side."""

import pathlib
from typing import Any

import numpy as np
import pytest

import polhode


def pendulum(**analysis: Any) -> polhode.Model:
    """A thin rod on a hinge, released from an angle."""
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 1, "step": "5 ms", "order": 4, **analysis})
    m.variables = {"L": 1}
    m.add_body("rod", mass=1, inertia=["L^2/12", "L^2/12", 1e-6], position=["L/2*sin(0.3)", 0, "-L/2*cos(0.3)"],
               orientation={"axis": [0, 1, 0], "angle": -0.3})
    m.add_joint("hinge", "revolute", ["ground", "rod"], at=[0, 0, 0], axis="y")
    m.output = {"every": 0.05, "probes": {"end": {"body": "rod", "point": [0, 0, "-L/2"]}}}
    return m


def test_energy_of_each_run_is_conserved() -> None:
    lengths = np.linspace(0.5, 2, 70)
    channels = ["bodies.rod.position", "bodies.rod.velocity", "bodies.rod.angular_velocity", "probes.end.z"]
    for step in ("25 ms", "5 ms", "0.5 ms"):
        b = polhode.batch(pendulum(step=step), {"variables.L": lengths}, channels)
        assert len(b) == 70 and b.finished.all() and not b.alone.any() and b.why_alone == ""
        assert b["bodies.rod.position"].shape == (70, 21, 3) and b["probes.end.z"].shape == (70, 21)
        assert np.allclose(b.time, np.arange(21) * 0.05)
        v, w = b["bodies.rod.velocity.size"], b["bodies.rod.angular_velocity.y"]
        energy = 0.5 * v**2 + lengths[:, None]**2 / 24 * w**2 + 9.81 * b["bodies.rod.position.z"]
        # Velocities are projected onto the hinge: an error of the order of the step.
        tolerance = {"25 ms": 1e-3, "5 ms": 1e-5, "0.5 ms": 1e-9}[step]
        assert np.abs(energy / energy[:, :1] - 1).max() < tolerance
        assert np.allclose(b["probes.end.z"], 2 * b["bodies.rod.position.z"], atol=1e-12)


def test_rows_are_those_of_a_sweep() -> None:
    m = pendulum()
    measures = ["bodies.rod.position", "max(joints.hinge.force.size)", "at(bodies.rod.velocity.x, 0.33)",
                "first(bodies.rod.position.x < 0)"]
    lengths = [0.5, 0.9, 1.7]
    channels = ["bodies.rod.position", "joints.hinge.force", "bodies.rod.velocity.x"]
    b = polhode.batch(m, {"variables.L": lengths}, channels)
    rows = b.to_pandas(*measures)
    # The frames of a batch: output.every, where a sweep without it has all steps.
    table = polhode.sweep(m, {"variables.L": lengths}, outputs=measures, processes=1)
    assert list(rows["variables.L"]) == lengths and list(rows["message"]) == [""] * 3
    for name in rows.columns.drop(["variables.L", "message"]):
        assert np.allclose(rows[name], table[name], atol=1e-10), name


def test_a_sweep_takes_batches(tmp_path: pathlib.Path) -> None:
    m = pendulum()
    lengths, stored = [0.5, 0.9, 1.7], tmp_path / "rows.jsonl"
    outputs = ["bodies.rod.position", "max(bodies.rod.velocity.size)", "first(probes.end.x < 0)"]
    rows = polhode.sweep(m, {"variables.L": lengths}, outputs=outputs, batch=True, resume=stored)
    table = polhode.sweep(m, {"variables.L": lengths}, outputs=outputs, processes=1)
    assert len(stored.read_text().splitlines()) == 3
    for name in rows.columns.drop("message"):
        assert np.allclose(rows[name], table[name], atol=1e-10), name
    gradient = {"outputs": outputs, "gradients": ["bodies.rod.position.x@end"]}
    refused: "list[dict[str, Any]]" = [{"outputs": ()}, gradient]
    for wrong in refused:
        with pytest.raises(ValueError, match="a batch takes outputs as texts"):
            polhode.sweep(m, {"variables.L": lengths}, batch=True, **wrong)


def test_numbers_do_not_depend_on_threads() -> None:
    masses = np.linspace(1, 2, 100)
    runs = [polhode.batch(pendulum(), {"bodies.rod.mass": masses}, threads=n) for n in (1, 2, 5)]
    for b in runs[1:]:
        assert np.array_equal(b["probes.end"], runs[0]["probes.end"])


def test_lists_vary_as_well() -> None:
    gravity = np.array([[0, 0, -9.81], [0, 0, -1.62], [1.0, 0, -9.81], [0, 0, -9.81]])
    channels = ["bodies.rod.position", "joints.hinge.rates"]
    b = polhode.batch(pendulum(), {"gravity": gravity, "bodies.rod.mass": 2}, channels)
    assert b.alone.tolist() == [False, True, True, False]  # gravity is one for all that are side by side
    for k in range(4):
        r = polhode.run(pendulum(), overrides={"gravity": gravity[k].tolist(), "bodies.rod.mass": 2})
        assert np.allclose(b["bodies.rod.position"][k], r.bodies["rod"].position, atol=1e-12)
        assert np.allclose(b["joints.hinge.rates.0"][k], r["joints.hinge.rates"][:, 0], atol=1e-9)


def test_a_run_that_fails_says_why() -> None:
    b = polhode.batch(pendulum(), {"bodies.rod.mass": [1, -1, 2]})
    assert b.finished.tolist() == [True, False, True] and "bodies.rod.mass" in b.messages[1]
    assert np.isnan(b["probes.end"][1]).all() and np.isfinite(b["probes.end"][[0, 2]]).all()
    assert "1 failed" in repr(b) and "bodies.rod.mass" in repr(b.run(1)) and "finished" in repr(b.run(-1))


def test_what_does_not_fit_is_refused() -> None:
    m = pendulum()
    with pytest.raises(ValueError, match="different numbers of values"):
        polhode.batch(m, {"variables.L": [1, 2], "bodies.rod.mass": [1, 2, 3]})
    with pytest.raises(ValueError, match="no parameter varies"):
        polhode.batch(m, {"variables.L": 1})
    with pytest.raises(ValueError, match="not finite"):
        polhode.batch(m, {"variables.L": [1, np.nan]})
    with pytest.raises(polhode.ModelError, match="Did you mean 'rod'"):
        polhode.batch(m, {"variables.L": [1, 2]}, ["bodies.rood.position"])
    b = polhode.batch(m, {"variables.L": [1, 2]}, ["bodies.rod.position"])
    for name in ("bodies.rod.velocity", "bodies.rod.position.w", "bodies.rod.position.7", ""):
        with pytest.raises(KeyError):
            b[name]
    with pytest.raises(IndexError):
        b.run(2)
    assert b.unit("bodies.rod.position.x") == "m"


def test_functions_in_python_are_refused() -> None:
    m = pendulum()
    m.add_load("push", "force", body="rod", at=[0, 0, 0], force=[lambda t: t, 0, 0])
    with pytest.raises(polhode.ModelError, match="loads.push"):
        polhode.batch(m, {"variables.L": [1, 2]})
