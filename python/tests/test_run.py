# SPDX-License-Identifier: Apache-2.0
"""Runs and their results."""

import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import h5py
import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

import polhode
from conftest import ROOT, make_pendulum
from polhode import _run

Array = npt.NDArray[np.float64]
CLI = os.path.join(os.path.dirname(polhode.__file__), "bin", "polhode")


def exact_height(times: Array) -> Array:
    """Height of the bar's centre by SciPy: a physical pendulum with its length along x."""
    length, width, g = 1.0, 0.05, 9.81
    inertia = (length**2 + width**2) / 12 + 0.25
    motion = solve_ivp(lambda t, y: [y[1], -0.5 * g / inertia * np.cos(y[0])], (0, times[-1]), [0, 0],
                       method="DOP853", rtol=1e-12, atol=1e-12, t_eval=times)
    angle: Array = motion.y[0]
    return 0.5 * np.sin(angle)


@pytest.mark.parametrize("step", [0.02, 0.005, 0.0005])
def test_a_pendulum_moves_as_its_equation_says(step: float) -> None:
    m = make_pendulum()
    m.analysis.step = step
    r = polhode.run(m)
    # Order 2: c Δt² with one c at all steps. The midpoint rule's phase error, Δt² ω³ t/12 with ω up
    # to 5.4 rad/s, bounds c by 13 rad times the arm, 0.5 m.
    error = np.max(np.abs(r.bodies["arm"].position[:, 2] - exact_height(r.time)))
    assert 2.3 * step**2 < error < 2.5 * step**2
    assert r.frames == round(1 / step) + 1
    assert r.ledger.energy_drift < 1e-13 and r.end == "finished"


def test_angular_velocity_is_also_along_the_axes_of_the_body() -> None:
    # Without moments Euler's equations hold in the body's axes: J dW/dt = -W x J W.
    inertia, start = np.array([1.0, 2.0, 3.0]), [0.01, 5.0, 0.01]
    m = polhode.Model()
    m.add_body("racket", mass=1, inertia=list(inertia), orientation={"axis": [1, 1, 0], "angle": 0.7},
               angular_velocity_body=start)
    m.analysis.duration, m.analysis.step, m.analysis.order = 4.0, 0.01, 8
    r = polhode.run(m)
    motion = solve_ivp(lambda t, w: -np.cross(w, inertia * w) / inertia, (0, 4), start, method="DOP853",
                       rtol=1e-13, atol=1e-13, t_eval=r.time)
    own = r.bodies["racket"].angular_velocity_body
    assert np.abs(own - motion.y.T).max() < 1e-8
    assert own[:, 1].min() < -4.9 and r.bodies["racket"].angular_velocity[:, 1].min() > -4.9
    assert np.array_equal(r["bodies.racket.angular_velocity_body.y"], own[:, 1])
    assert r.unit("bodies.racket.angular_velocity_body") == "rad/s"
    assert "bodies.racket.angular_velocity_body" not in r.channels()
    now = polhode.Simulation(m).bodies["racket"]
    assert now.angular_velocity_body == pytest.approx(start, abs=1e-15)
    with pytest.raises(AttributeError, match="cannot be set"):
        now.angular_velocity_body = [0, 0, 1]


def test_arrays_are_the_memory_of_the_engine(pendulum: polhode.Model) -> None:
    r = polhode.run(pendulum)
    body = r.bodies["arm"]
    assert body.position.shape == (201, 3) and body.orientation.shape == (201, 4)
    assert np.shares_memory(body.position, r["packed.bodies.position"])
    assert np.shares_memory(body.position, r.bodies["arm"].position)
    assert r.joints["hinge"].force.shape == (201, 3)
    assert r.joints["hinge"].coordinates.shape == (201, 1)
    assert r.solver.steps.dtype == np.int64 and r.solver.steps[-1] == 200
    assert np.array_equal(r["bodies.arm.orientation.w"], body.orientation[:, 0])
    assert r.unit("bodies.arm.velocity") == "m/s" and r.energy.unit("total") == "J"
    assert "position" in dir(body) and "bodies" in dir(r) and "arm" in r.bodies
    with pytest.raises(AttributeError, match="Did you mean 'position'"):
        _ = body.positon
    with pytest.raises(KeyError, match="not a channel"):
        _ = r["bodies.leg.position"]


def test_results_are_those_of_the_command_line_bit_for_bit(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    pendulum.add_load("spring", "spring_damper", bodies=["ground", "arm"], at=[[0, 0, 1], [1, 0, 0]], stiffness=5)
    pendulum.save(tmp_path / "m.yaml")
    figures = json.loads(subprocess.run([CLI, "run", "m.yaml", "--json", "--quiet"], cwd=tmp_path, check=True,
                                        stdout=subprocess.PIPE).stdout)
    memory, file = polhode.run(pendulum), polhode.open(tmp_path / "m.results")
    assert memory.ledger.result_hash == figures["result_hash"]
    assert set(memory.channels()) == set(file.channels())
    with h5py.File(tmp_path / "m.results/results.h5") as h5:
        for name in memory.channels():
            assert np.array_equal(memory[name], file[name]), name
            assert np.array_equal(memory[name], h5[name.replace(".", "/")][:]), name
            assert memory.unit(name) == file.unit(name), name
            assert memory[name].dtype.kind == file[name].dtype.kind, name
    assert file.ledger.energy_drift < 1e-13 and file.ledger.steps == 200


def test_a_folder_of_results_says_where_they_come_from(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    pendulum.save(tmp_path / "m.yaml")
    polhode.run(tmp_path / "m.yaml", output=tmp_path / "out", overrides={"analysis.duration": "20 ms"})
    with h5py.File(tmp_path / "out/results.h5") as h5:
        origin = h5["provenance"]
        assert origin.attrs["version"] == polhode.__version__ and origin.attrs["model_file"] == "m.yaml"
        assert origin.attrs["overrides"] == "analysis.duration=20 ms"
        assert origin["model"].asstr()[0] == (tmp_path / "m.yaml").read_text()


def test_models_of_many_bodies_are_read_by_name_too(tmp_path: pathlib.Path) -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 0.02, "step": 0.01})
    for i in range(150):
        m.add_body(f"b{i}", mass=1, inertia=[1, 1, 1], position=[i, 0, 0], velocity=[0, 0, i])
        m.add_joint(f"j{i}", "prismatic", ["ground", f"b{i}"], at=[i, 0, 0], axis="z")
    for r in (polhode.run(m, output=tmp_path / "out"), polhode.open(tmp_path / "out")):
        assert r.bodies["b7"].position[-1] == pytest.approx([7, 0, 7 * 0.02 - 0.5 * 9.81 * 0.02**2], rel=1e-12)
        assert r.joints["j7"].coordinates.shape == (3, 1)
        assert r.joints["j7"].rates[0] == pytest.approx([7])
        assert len(r.bodies) == 150 and "force" in list(r.joints["j7"])
        assert r.unit("bodies.b7.position") == "m"


def test_overrides_hold_for_one_run(pendulum: polhode.Model) -> None:
    pendulum.variables["g"] = 9.81
    pendulum.gravity = [0, 0, "-g"]
    r = polhode.run(pendulum, overrides={"variables.g": 0, "analysis.duration": "20 ms"})
    assert r.frames == 5 and np.all(r.bodies["arm"].velocity == 0)
    assert pendulum.variables["g"] == 9.81


def test_threads_have_the_same_bits(pendulum: polhode.Model) -> None:
    changes = {"analysis.method": "extrapolation", "analysis.order": 8, "analysis.step": "50 ms"}
    one, two = (polhode.run(pendulum, overrides=changes, threads=n) for n in (1, 2))
    assert "extrapolation" in two.ledger.scheme and two.ledger.result_hash == one.ledger.result_hash
    with pytest.raises(ValueError, match="threads is 0"):
        polhode.run(pendulum, threads=0)


def test_a_table_goes_to_parquet_with_units(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    r = polhode.run(pendulum)
    r.to_parquet(tmp_path / "out.parquet", "bodies.arm", "energy.total")
    table = parquet.read_table(tmp_path / "out.parquet")
    assert table.column_names[:2] == ["t", "bodies.arm.position.x"] and table.column_names[-1] == "energy.total"
    assert np.array_equal(table["t"].to_numpy(), r.time)
    assert np.array_equal(table["bodies.arm.position.z"].to_numpy(), r.bodies["arm"].position[:, 2])
    assert table.schema.field("bodies.arm.velocity.x").metadata == {b"unit": b"m/s"}
    r.to_parquet(tmp_path / "all.parquet")
    assert "joints.hinge.force.z" in parquet.read_table(tmp_path / "all.parquet").column_names


def test_results_go_to_other_libraries(pendulum: polhode.Model) -> None:
    r = polhode.run(pendulum)
    table = r.to_pandas("bodies.arm", "energy.total")
    assert list(table.columns[:3]) == ["bodies.arm.position.x", "bodies.arm.position.y", "bodies.arm.position.z"]
    assert table.index.name == "time" and table["energy.total"].iloc[-1] == r.energy.total[-1]
    assert "joints.hinge.force.z" in r.to_pandas().columns
    data = r.to_xarray("bodies.arm.position", "energy")
    assert data["bodies.arm.position"].dims == ("time", "axis")
    assert data["bodies.arm.position"].attrs["units"] == "m"
    assert np.shares_memory(data["bodies.arm.position"].values, r.bodies["arm"].position)
    import matplotlib

    matplotlib.use("Agg")
    figure = r.plot("energy", "joints.hinge.force")
    assert [a.get_ylabel() for a in figure.axes] == ["energy [J]", "joints.hinge.force [N]"]
    assert len(figure.axes[1].lines) == 3
    one = r.plot("bodies.arm.position.z").axes[0]  # a component, with the unit of its vector
    assert one.get_ylabel() == "bodies.arm.position.z [m]" and len(one.lines) == 1
    pendulum.add_probe("tip", body="arm")
    tip = polhode.run(pendulum).plot("probes.tip")  # columns of one unit in one panel
    assert [a.get_ylabel() for a in tip.axes] == ["probes.tip [m]", "probes.tip [m/s]", "probes.tip [m/s^2]"]
    assert [line.get_label() for line in tip.axes[1].lines] == ["vx", "vy", "vz"]
    assert r.unit("bodies.arm.orientation.w") == r.unit("bodies.arm.orientation")
    assert np.array_equal(figure.axes[1].lines[2].get_ydata(), r.joints["hinge"].force[:, 2])


def test_results_can_be_pickled(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    for r in (polhode.run(pendulum, output=tmp_path / "o"), polhode.open(tmp_path / "o")):
        again = pickle.loads(pickle.dumps(r))
        assert np.array_equal(again.bodies["arm"].position, r.bodies["arm"].position)
        assert again.ledger.t == r.ledger.t and again.channels() == r.channels()


def test_a_run_says_whether_it_is_trusted(tmp_path: pathlib.Path) -> None:
    m = polhode.Model(analysis={"duration": 0.2, "step": "20 ms", "rho_inf": 0})
    m.add_body("a", mass=1, inertia=[1, 1, 1], position=[1.1, 0, 0])
    m.add_joint("guide", "prismatic", ["ground", "a"], at=[0, 0, 0], axis="x")
    m.add_load("s", "spring_damper", bodies=["ground", "a"], at=[[0, 0, 0], [1.1, 0, 0]], stiffness=1000, free_length=1)
    with pytest.warns(UserWarning, match="not trusted: the balance of energy does not close"):
        coarse = polhode.run(m, output=tmp_path / "coarse")
    # One energy drift: of the run, of the opened file, of the last frame.
    opened = polhode.open(tmp_path / "coarse")
    assert not coarse.ledger.trusted and not opened.ledger.trusted and opened.ledger.distrust == coarse.ledger.distrust
    assert coarse.ledger.energy_drift == opened.ledger.energy_drift == coarse.energy.drift[-1] > 1e-3
    fine = polhode.run(m, overrides={"analysis.step": "0.2 ms"})
    assert fine.ledger.trusted and fine.ledger.distrust == []


def test_a_step_that_does_not_converge_raises_with_what_was_computed(pendulum: polhode.Model) -> None:
    pendulum.add_load("push", "force", body="arm", at=[1, 0, 0], force=["1e300*t", 0, 0])
    pendulum.analysis.step = "0.5 s"
    with pytest.raises(polhode.NotConverged) as error:
        polhode.run(pendulum, overrides={"analysis.min_step": "0.4 s"})
    assert error.value.result.frames >= 1 and error.value.result.end == "not_converged"


@pytest.mark.parametrize("step", ["50 ms", "10 ms", "0.1 ms"])
def test_drives_that_contradict_each_other_raise_by_their_names(step: str) -> None:
    m = polhode.Model(analysis={"duration": 1, "step": step})
    m.add_body("a", mass=1, inertia=[1, 1, 1], motion={"x": "t^2", "y": 0, "z": 0})
    m.add_joint("S", "prismatic", ["ground", "a"], at=[0, 0, 0], axis="x")
    m.add_load("m1", "linear_motor", joint="S", displacement="t^3")
    with pytest.raises(polhode.NotConverged, match="linear_motor 'm1'") as error:
        polhode.run(m)
    assert "a.motion" in str(error.value) and error.value.result.ledger.t == 0


def test_statics_runs_over_the_load_factor() -> None:
    m = polhode.Model(gravity=[0, 0, -10], analysis={"type": "statics", "load_steps": 4})
    m.add_body("b", mass=2, inertia=[1, 1, 1])
    m.add_joint("slide", "prismatic", ["ground", "b"], at=[0, 0, 0], axis="z")
    m.add_load("s", "spring_damper", bodies=["ground", "b"], at=[[0, 0, 1], [0, 0, 0]], stiffness=100)
    r = polhode.run(m)
    assert r.time == pytest.approx([0, 0.25, 0.5, 0.75, 1])
    assert r.bodies["b"].position[:, 2] == pytest.approx(-0.2 * r.time, abs=1e-12)


def test_the_interpreter_goes_on_while_a_run_goes_on(pendulum: polhode.Model) -> None:
    counted = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    polhode.run(pendulum, overrides={"analysis.step": "20 us", "output.every": 1})
    done.set()
    thread.join()
    assert counted[0] > 20


def test_ctrl_c_stops_with_what_was_computed() -> None:
    program = """
import sys, warnings
sys.path.insert(0, sys.argv[1])
import polhode
from conftest import make_pendulum
warnings.simplefilter("ignore")
m = make_pendulum()
run = polhode.run  # now NumPy is there, too
print("begin", flush=True)
r = run(m, overrides={"analysis.duration": "1 h", "analysis.step": "1 ms", "output.every": "1 s"})
print(r.end, 1 < r.ledger.t < 3600, r.frames > 1, flush=True)
"""
    folder = str(ROOT / "python/tests")
    with subprocess.Popen([sys.executable, "-c", program, folder], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout and process.stdout.readline() == "begin\n"
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60)[0] == "interrupted True True\n"


@pytest.mark.parametrize(("duration", "step", "each"), [(1, "20 us", 5), (1.00003, "20 us", 6), (2, "0.0333333 ms", 7),
                                                        ("1000 ms", "30 us", 4)])
def test_long_runs_keep_every_nth_step(pendulum: polhode.Model, duration: object, step: str, each: int,
                                       caplog: pytest.LogCaptureFixture) -> None:
    pendulum.analysis.update(duration=duration, step=step)
    pendulum.add_probe("tip", body="arm", point=[0.5, 0, 0])
    pendulum.add_probe("seldom", body="arm", every="0.1 s")
    with caplog.at_level("INFO", logger="polhode"):
        r = polhode.run(pendulum)
    assert [m for m in caplog.messages if m.startswith("a frame is stored")] == [caplog.messages[0]]
    assert f"each {each} of some" in caplog.messages[0]
    whole = _run.whole_run(pendulum, None)
    assert r.ledger.result_hash == whole.ledger.result_hash and r.ledger.steps == whole.ledger.steps
    assert len(whole.time) == whole.ledger.steps + 1 and 5000 < len(r.time) <= 10001
    kept = np.isin(whole.time, r.time)
    assert kept.sum() == len(r.time) and kept[-1]
    assert (whole.bodies["arm"].position[kept] == r.bodies["arm"].position).all()
    assert (r.probes["tip"].z == whole.probes["tip"].z).all() and len(r.probes["tip"].t) == len(whole.time)
    assert len(r.probes["seldom"].t) == len(whole.probes["seldom"].t) < 25


def test_a_long_run_keeps_what_it_is_asked_for(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    pendulum.analysis.update(duration="0.25 s", step="20 us")
    assert len(polhode.run(pendulum).time) == 6251
    assert len(polhode.run(pendulum, overrides={"output.every": "20 us"}).time) == 12501
    assert len(polhode.run(pendulum, overrides={"analysis.duration": "0.2 s"}).time) == 10001
    r = polhode.run(pendulum, output=tmp_path / "run")
    assert len(r.time) == len(polhode.open(tmp_path / "run").time) == 12501
    pendulum.output.every = "1 ms"
    assert len(polhode.run(pendulum).time) == 251


def test_progress_is_shown_by_tqdm(pendulum: polhode.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    from polhode import _progress

    seen: "list[float]" = []
    monkeypatch.setattr(_progress.Bar, "show", property(lambda self: seen.append))
    polhode.run(pendulum, overrides={"analysis.step": "20 us", "output.every": 1})
    assert seen and seen == sorted(seen) and seen[-1] <= 1


def test_ctrl_c_within_the_progress_stops_too(pendulum: polhode.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    from polhode import _progress

    def interrupt(t: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(_progress.Bar, "show", property(lambda self: interrupt))
    with pytest.warns(UserWarning, match="was stopped"):
        r = polhode.run(pendulum, overrides={"analysis.step": "10 us", "output.every": "1 ms"})
    assert r.end == "interrupted" and 0 < r.time[-1] < 1


def test_an_exception_in_the_progress_stops_the_run(pendulum: polhode.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    from polhode import _progress

    def fail(t: float) -> None:
        raise ZeroDivisionError("in progress")

    monkeypatch.setattr(_progress.Bar, "show", property(lambda self: fail))
    with pytest.raises(ZeroDivisionError):
        polhode.run(pendulum, overrides={"analysis.step": "10 us", "output.every": 1})


def test_the_version_is_that_of_the_build() -> None:
    text = (ROOT / "CMakeLists.txt").read_text()
    assert f"project(polhode VERSION {polhode.__version__} " in text
    import importlib.metadata

    assert importlib.metadata.version("polhode") == polhode.__version__
    program = subprocess.run([CLI, "--version"], check=True, stdout=subprocess.PIPE, text=True)
    assert polhode.__version__ in program.stdout


def test_the_command_is_installed() -> None:
    program = os.path.join(os.path.dirname(sys.executable), "polhode")
    text = subprocess.run([program, "examples"], check=True, stdout=subprocess.PIPE, text=True).stdout
    assert "double_pendulum" in text


def test_what_was_chosen_is_logged_and_what_deserves_a_look_is_warned(pendulum: polhode.Model,
                                                                       caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level("INFO", logger="polhode"):
        polhode.run(pendulum, overrides={"analysis.momentum_rate": "kinematic"})
    assert {r.name for r in caplog.records} == {"polhode"} and all(r.levelname == "INFO" for r in caplog.records)
    assert any("Solver: block LU, as 'tree' does not support this momentum_rate" in r.message for r in caplog.records)
    assert any(r.message.startswith("reached t = 1 in ") for r in caplog.records)
    caplog.clear()
    with caplog.at_level("WARNING", logger="polhode"):
        polhode.run(pendulum)
    assert not caplog.records  # silent by default


def test_results_of_a_later_format_are_refused_with_what_to_do(pendulum: polhode.Model, tmp_path: pathlib.Path) -> None:
    polhode.run(pendulum, output=tmp_path / "run")
    file = tmp_path / "run" / "results.h5"
    with h5py.File(file, "a") as f:
        assert f.attrs["format_version"] == 1
        f.attrs["format_version"] = 99.0
    told = "has format version 99, and this program reads versions up to 1. Use the version of Polhode that wrote it"
    with pytest.raises(OSError, match=told):
        polhode.open(tmp_path / "run")
    for words in (["view", file, "--html", tmp_path / "page.html"], ["plot", file, "energy", "-o", tmp_path / "a.svg"]):
        ended = subprocess.run([CLI, *map(str, words)], capture_output=True, text=True)
        assert ended.returncode != 0 and told in ended.stderr
    with h5py.File(tmp_path / "other.h5", "w") as f:
        f["x"] = [1.0]
    with pytest.raises(OSError, match="holds no results of Polhode"):
        polhode.open(tmp_path / "other.h5")


def test_a_file_that_is_cut_short_says_so_and_has_its_complete_frames(pendulum: polhode.Model,
                                                                      tmp_path: pathlib.Path) -> None:
    pendulum.analysis.step, pendulum.analysis.duration = 1e-3, 2.0
    polhode.run(pendulum, output=tmp_path / "run")
    whole = polhode.open(tmp_path / "run")
    assert not whole.cut_short
    content = (tmp_path / "run" / "results.h5").read_bytes()
    (tmp_path / "cut.h5").write_bytes(content[: len(content) * 9 // 10])
    with pytest.warns(UserWarning, match="cut.h5 is cut short: only [0-9]+ complete frames of it are read"):
        cut = polhode.open(tmp_path / "cut.h5")
    assert cut.cut_short and 0 < cut.frames < whole.frames
    assert np.array_equal(cut.time, whole.time[: cut.frames])
    assert np.array_equal(cut.bodies["arm"].position, whole.bodies["arm"].position[: cut.frames])
    assert cut.ledger.t == cut.time[-1]
    (tmp_path / "cut.h5").write_bytes(content[: len(content) // 10])
    with pytest.raises(OSError, match="is cut short, and has no complete frame"):
        polhode.open(tmp_path / "cut.h5")
