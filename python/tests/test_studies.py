# SPDX-License-Identifier: Apache-2.0
"""Sweeps and fits."""

import json
import os
import pathlib
import signal
from typing import TYPE_CHECKING, Optional, Union

import numpy as np
import numpy.typing as npt
import pytest

import polhode
from conftest import make_pendulum
from polhode import _sweep, _sweep_command

if TYPE_CHECKING:
    import pandas

Array = npt.NDArray[np.float64]


def oscillator() -> polhode.Model:
    """A damped mass on a spring along z."""
    m = polhode.Model(variables={"k": 40, "c": 0.8}, analysis={"duration": 3, "step": 0.005})
    m.add_body("b", mass=1, inertia=[1, 1, 1], position=[0, 0, 1.5])
    m.add_joint("slide", "prismatic", ["ground", "b"], at=[0, 0, 0], axis="z")
    m.add_load("s", "spring_damper", bodies=["ground", "b"], at=[[0, 0, 0], [0, 0, 1.5]], stiffness="k", damping="c",
               free_length=1)
    return m


def height(t: Union[float, Array], k: float = 40.0, c: float = 0.8) -> Union[np.float64, Array]:
    w = np.sqrt(k - c * c / 4)
    z: Union[np.float64, Array] = 1 + 0.5 * np.exp(-c * t / 2) * (np.cos(w * t) + c / (2 * w) * np.sin(w * t))
    return z


def test_a_grid_is_every_combination_and_failures_are_rows() -> None:
    table = polhode.sweep(oscillator(), {"variables.k": [20, 40, -1], "variables.c": (0.2, 0.4)}, n=2, processes=1,
                          outputs=["bodies.b.position"])
    assert table[["variables.k", "variables.c"]].values.tolist() == [
        [20, 0.2], [20, 0.4], [40, 0.2], [40, 0.4], [-1, 0.2], [-1, 0.4]]
    good = table[table.message == ""]
    assert len(good) == 4
    exact = [height(3.0, k, c) for k, c in zip(good["variables.k"], good["variables.c"])]
    assert good["bodies.b.position.z"].to_numpy() == pytest.approx(exact, abs=2e-3)
    assert all("loads.s.stiffness" in message for message in table.message[4:])


def test_processes_give_the_bits_of_one_and_a_sweep_is_resumed(tmp_path: pathlib.Path) -> None:
    def sweep(n: int, processes: int, resume: Optional[pathlib.Path] = None) -> "pandas.DataFrame":
        return polhode.sweep(oscillator(), {"variables.k": [20, 30, 40][:n]}, outputs=["energy.total"],
                             processes=processes, resume=resume)

    alone, together = sweep(3, processes=1), sweep(3, processes=2)
    assert alone.drop(columns="wall_time_s").equals(together.drop(columns="wall_time_s"))
    log = tmp_path / "rows.jsonl"
    sweep(2, processes=1, resume=log)
    with log.open("a") as file:
        file.write('{"model": "cut sh')
        file.write("\n")
    kept = log.read_text().splitlines()
    again = sweep(3, processes=1, resume=log)
    assert again.drop(columns="wall_time_s").equals(alone.drop(columns="wall_time_s"))
    added = log.read_text().splitlines()[len(kept):]
    assert [json.loads(line)["point"] for line in added] == [{"variables.k": 40}]


def die_once(result: polhode.Result) -> "dict[str, float]":
    """Kills its process the first time, as the system does without free memory."""
    mark = pathlib.Path(os.environ["POLHODE_TEST_MARK"])
    if result.ledger.t > 2.9 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"height": float(result.bodies["b"].position[-1, 2])}


def test_the_runs_of_a_killed_process_are_run_again(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POLHODE_TEST_MARK", str(tmp_path / "mark"))
    table = polhode.sweep(oscillator(), {"variables.k": [20, 30, 40, 50]}, outputs=die_once, processes=2)
    assert (tmp_path / "mark").exists() and list(table.message) == [""] * 4
    assert table.height.to_numpy() == pytest.approx([height(3.0, k) for k in (20, 30, 40, 50)], abs=2e-3)


def test_points_fill_their_ranges() -> None:
    pairs = {"a": (0, 1), "b": (10, 20)}
    for method in ("sobol", "lhs"):
        points = _sweep._points(pairs, 16, method, 1)
        for name, (low, high) in pairs.items():
            cells = np.floor([(p[name] - low) / (high - low) * 16 for p in points])
            assert sorted(cells) == list(range(16)), method  # one point in each sixteenth
    normal = [p["a"] for p in _sweep._points({"a": (5, 2)}, 4000, "normal", 1)]
    assert np.mean(normal) == pytest.approx(5, abs=0.15) and np.std(normal) == pytest.approx(2, abs=0.1)
    with pytest.raises(ValueError, match="unknown method"):
        _sweep._points(pairs, 4, "halton", 0)


def test_a_fit_finds_stiffness_and_damper_in_noisy_data() -> None:
    times = np.linspace(0, 3, 200)
    noise = np.random.default_rng(3).normal(0, 0.005, 200)
    fit = polhode.fit(oscillator(), {"time": times, "bodies.b.position.z": height(times) + noise},
                      {"variables.k": 36, "variables.c": 1.2})
    assert fit.errors["variables.k"] < 0.1 and fit.errors["variables.c"] < 0.05
    assert abs(fit.parameters["variables.k"] - 40) < 4 * fit.errors["variables.k"]
    assert abs(fit.parameters["variables.c"] - 0.8) < 4 * fit.errors["variables.c"]
    assert np.std(fit.residuals) == pytest.approx(0.005, rel=0.15)
    assert fit.covariance.shape == (2, 2) and np.all(np.linalg.eigvalsh(fit.covariance) > 0)
    assert fit.errors["variables.k"] == pytest.approx(np.sqrt(fit.covariance[0, 0]))
    assert fit.covariance == pytest.approx(fit.covariance.T)
    import matplotlib

    matplotlib.use("Agg")
    (panel,) = fit.plot().axes
    run, measured = panel.lines
    assert panel.get_ylabel() == "bodies.b.position.z [m]" and len(run.get_xdata()) == len(fit.result.time)
    assert np.array_equal(measured.get_xdata(), times) and measured.get_linestyle() == "None"
    assert np.array_equal(measured.get_ydata(), fit.data["bodies.b.position.z"])
    with pytest.raises(ValueError, match="values at"):
        polhode.fit(make_pendulum(), {"time": times, "energy.total": [1]}, {"gravity.2": 9})


def test_a_fit_with_exact_tangents_finds_the_same() -> None:
    times = np.linspace(0, 3, 40)
    data = {"time": times, "bodies.b.position.z": height(times)}
    guess = {"variables.k": 36, "variables.c": 1.2}
    differences = polhode.fit(oscillator(), data, guess)
    exact = polhode.fit(oscillator(), data, guess, jacobian="exact")
    assert exact.parameters == pytest.approx(differences.parameters, rel=1e-6)
    assert exact.covariance == pytest.approx(differences.covariance, rel=1e-3)
    m = make_pendulum()
    measured = polhode.run(m, progress=False)
    angles = {"time": measured.time, "joints.hinge.coordinates": measured["joints.hinge.coordinates"],
              "bodies.arm.velocity": measured["bodies.arm.velocity"]}
    fit = polhode.fit(m, angles, {"gravity.2": -9.0}, jacobian="exact")
    assert fit.parameters["gravity.2"] == pytest.approx(-9.81, rel=1e-9)
    with pytest.raises(ValueError, match="jacobian is 'best'"):
        polhode.fit(m, angles, {"gravity.2": -9.0}, jacobian="best")


def test_workers_of_a_dask_cluster_give_the_bits_of_this_process_and_may_die(tmp_path: pathlib.Path,
                                                                             monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("POLHODE_TEST_MARK", str(tmp_path / "mark"))
    points = {"variables.k": [20, 30, 40, 50, 60]}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                                  host="127.0.0.1") as cluster, distributed.Client(cluster) as client:
        table = polhode.sweep(oscillator(), points, outputs=die_once, client=client)
        assert (tmp_path / "mark").exists()  # a worker was killed during a run
        address = cluster.scheduler_address
        file = tmp_path / "model.yaml"
        oscillator().save(file)
        command = ["-o", str(tmp_path / "d.csv"), "--dask", address, "--vary", "k=20,40", "--output", "energy.total"]
        assert _sweep_command.main([str(file), *command]) == 0
    alone = polhode.sweep(oscillator(), points, outputs=die_once, processes=1)
    assert table.drop(columns="wall_time_s").equals(alone.drop(columns="wall_time_s"))
    assert len((tmp_path / "d.csv").read_text().splitlines()) == 3


def test_the_command_makes_a_table_and_goes_on_where_it_was(tmp_path: pathlib.Path,
                                                            capsys: pytest.CaptureFixture[str]) -> None:
    import pandas

    file, csv = tmp_path / "model.yaml", tmp_path / "t.csv"
    oscillator().save(file)

    def command(*words: str) -> "tuple[int, str]":
        status = _sweep_command.main([str(file), "-o", str(csv), "--jobs", "1", *words])
        return status, capsys.readouterr().out

    words = ["--vary", "k=20,40", "--vary", "variables.c=0.2..0.4", "-n", "2", "--output", "bodies.b.position"]
    assert command(*words)[0] == 0
    table = pandas.read_csv(csv)
    assert table[["variables.k", "variables.c"]].values.tolist() == [[20, 0.2], [20, 0.4], [40, 0.2], [40, 0.4]]
    exact = [height(3.0, k, c) for k, c in zip(table["variables.k"], table["variables.c"])]
    assert table["bodies.b.position.z"].to_numpy() == pytest.approx(exact, abs=2e-3)
    first = csv.read_text()
    csv.unlink()
    assert command(*words)[0] == 0 and csv.read_text() == first  # wall times, too: no run was repeated
    status, said = command("--method", "normal", "-n", "4", "--vary", "k=40+-2", "--seed", "3")
    assert status == 0 and "4 runs" in said and pandas.read_csv(csv)["variables.k"].std() > 0.5
    status, said = command("--vary", "k=40,-1")
    assert status == 1 and "2 runs, 1 of them failed" in said


def test_what_is_set_holds_in_all_runs(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    import pandas

    file, csv = tmp_path / "model.yaml", tmp_path / "t.csv"
    oscillator().save(file)
    words = [str(file), "-o", str(csv), "--jobs", "1", "--vary", "k=20..40", "-n", "2"]
    words += ["--output", "bodies.b.position.z"]
    assert _sweep_command.main(words) == 0
    short = ["--set", "analysis.duration=1 s", "--set", "c=0.25", "--set", "gravity=[0, 0, 0]"]
    assert _sweep_command.main([*words, *short]) == 0  # other runs than those of t.csv.rows
    table = pandas.read_csv(csv)
    m = oscillator()
    m.variables["c"], m.gravity = 0.25, [0, 0, 0]
    alone = [polhode.run(m, overrides={"variables.k": k, "analysis.duration": "1 s"}) for k in (20, 40)]
    assert table["t"].tolist() == [1, 1]
    assert table["bodies.b.position.z"].tolist() == [r.bodies["b"].position[-1, 2] for r in alone]
    given = {"analysis.duration": "1 s", "variables.c": 0.25, "gravity": [0, 0, 0]}
    again = polhode.sweep(oscillator(), {"variables.k": (20, 40)}, n=2, overrides=given, processes=1,
                          outputs=["bodies.b.position.z"])
    assert again["result_hash"].tolist() == table["result_hash"].tolist()


def test_values_of_a_grid_are_those_that_one_would_write() -> None:
    points = _sweep._points({"a": (0.2, 0.5)}, 7, "grid", 0)
    assert [p["a"] for p in points] == [0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]


@pytest.mark.parametrize(("words", "message"), [
    (["--vary", "k=1,2", "--set", "k=3"], "'variables.k' is set and varies"),
    (["--vary", "k=1,2", "--set", "k"], "--set k: write --set PATH=VALUE"),
    ([], "nothing varies; write --vary"),
    (["--vary", "k"], "--vary k: write --vary NAME=VALUES"),
    (["--vary", "k=a,b"], "'a' is not a number"),
    (["--vary", "k=1..2", "--method", "lhs"], "the method lhs requires -n"),
    (["--vary", "k=1,2", "--method", "lhs", "-n", "2"], "the method lhs requires FROM..TO"),
    (["--vary", "k=1..2", "--method", "normal", "-n", "2"], "MEAN+-DEVIATION requires --method normal"),
    (["--vary", "kk=1,2"], "there is no variable 'kk'"),
])
def test_the_command_tells_what_is_wrong(words: "list[str]", message: str, tmp_path: pathlib.Path,
                                         capsys: pytest.CaptureFixture[str]) -> None:
    oscillator().save(tmp_path / "m.yaml")
    assert _sweep_command.main([str(tmp_path / "m.yaml"), "-o", str(tmp_path / "t.csv"), *words]) == 2
    assert message in capsys.readouterr().err
