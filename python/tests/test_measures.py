# SPDX-License-Identifier: Apache-2.0
"""Measures of results, and the commands that use them."""

import json
import math
import pathlib
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from test_derivatives import measured, spring, throw

import polhode
from polhode import _fit_command, _sweep_command
from polhode._measure import measure


@pytest.mark.parametrize(("step", "order"), [("50 ms", 1e-2), ("10 ms", 4e-4), ("1 ms", 4e-6)])
def test_measures_of_a_throw_are_its_closed_forms(step: str, order: float) -> None:
    m = throw(step)
    m.output = {"probes": {"ball": {"body": "ball", "point": [0, 0, 0]}}}
    r = polhode.run(m, progress=False)
    g, v, T = 9.81, 4.0, 0.5
    top = 1 + v * v / (2 * g)

    def of(text: str) -> float:
        ((_, value),) = measure(r, text).items()
        return value

    z = "bodies.ball.position.z"
    assert of(f"max({z})") == pytest.approx(top, abs=g / 8 * 0.05 ** 2)  # half a step beside the top
    assert of(f"final({z})") == of(z) == pytest.approx(1 + v * T - g * T * T / 2, abs=1e-12)
    assert of(f"mean({z})") == pytest.approx(1 + v * T / 2 - g * T * T / 6, abs=order)
    assert of("rms(bodies.ball.velocity.z)") == pytest.approx(
        math.sqrt(v * v - v * g * T + g * g * T * T / 3), abs=order)
    assert of("range(bodies.ball.velocity.z)") == pytest.approx(g * T, abs=1e-12)
    assert of("min(bodies.ball.velocity.z)") == pytest.approx(v - g * T, abs=1e-12)
    assert of("max(bodies.ball.velocity.size)") == pytest.approx(5, abs=1e-12)
    assert of(f"at({z}, 0.25)") == pytest.approx(1 + v / 4 - g / 32, abs=g / 8 * 0.05 ** 2)
    assert of(f"first({z} > 1.5)") == pytest.approx((v - math.sqrt(v * v - g)) / g, abs=order)
    assert of("first(bodies.ball.velocity.z < 0)") == pytest.approx(v / g, abs=1e-12)
    assert math.isnan(of(f"first({z} > 3)")) and math.isnan(of(f"at({z}, 0.6)")) and math.isnan(of(f"at({z}, -1)"))
    assert of(f"first({z} > 0.5)") == 0
    speed = r["bodies.ball.velocity.size"]
    assert of("final(probes.ball.v.size)") == pytest.approx(speed[-1], abs=1e-12)
    assert of("final(bodies.ball.velocity.size)") == speed[-1]
    assert r["probes.ball.v.size"] == pytest.approx(np.hypot(r["probes.ball.vx"], r["probes.ball.vz"]), abs=1e-12)
    assert r.unit("probes.ball.v.size") == r.unit("bodies.ball.velocity.size") == "m/s"
    assert r.probes["ball"]["distance"][0] == pytest.approx(1) and r.unit("probes.ball.distance") == "m"
    assert np.array_equal(r.times("probes.ball.z"), r.probes["ball"].t)
    assert np.array_equal(r.times("energy.total"), r.time)
    figure = r.plot("probes.ball.v.size", "bodies.ball.velocity.size")
    assert [panel.get_ylabel() for panel in figure.axes] == [
        "probes.ball.v.size [m/s]", "bodies.ball.velocity.size [m/s]"]
    for text, message in (("max(probes.ball)", "is a probe: name one of its columns: t, x, y"),
                          ("max(probes.ball.q.size)", "has no 'q.size'")):
        with pytest.raises(KeyError, match=message):
            of(text)
    assert of("mean(probes.ball.z)") == pytest.approx(of(f"mean({z})"), abs=1e-12)
    assert measure(r, "max(bodies.ball.position)").keys() == {f"max(bodies.ball.position.{c})" for c in "xyz"}


@pytest.mark.parametrize(("text", "message"), [
    ("rsm(bodies.ball.position.z)", "there is no function 'rsm'. Did you mean 'rms'"),
    ("max(bodies.ball.place)", "has no 'place'"),
    ("max(bodies.ball)", "is a group: name one of its channels: position"),
    ("max(bodies.ball.position.z.size)", "is no vector"),
    ("at(bodies.ball.position.z)", "write at\\(CHANNEL, TIME\\)"),
    ("at(bodies.ball.position.z, late)", "'late' is not a number"),
    ("first(bodies.ball.position > 1)", "name a component"),
    ("first(bodies.ball.position.z)", "write first\\(CHANNEL > VALUE\\)"),
    ("max(probes.tip.z)", "there is no probe 'tip'"),
])
def test_what_is_no_measure_is_said(text: str, message: str) -> None:
    with pytest.raises((KeyError, ValueError), match=message):
        measure(polhode.run(throw(), progress=False), text)


def test_a_sweep_has_columns_of_measures_and_exact_gradients() -> None:
    table = polhode.sweep(throw(), {"gravity.2": [-9.81, -1.62]}, outputs=["max(bodies.ball.velocity.size)"],
                          gradients=["bodies.ball.position.z@end"], processes=1)
    assert list(table.message) == ["", ""]
    assert table["max(bodies.ball.velocity.size)"].to_numpy() == pytest.approx([5, 5])
    assert table["d(bodies.ball.position.z@end)/d(gravity.2)"].to_numpy() == pytest.approx([0.125, 0.125], abs=1e-11)


def test_the_sweep_command_draws_curves_and_maps(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    import pandas

    model = tmp_path / "m.yaml"
    spring().save(model)
    table, picture = tmp_path / "t.csv", tmp_path / "t.svg"

    def command(*words: str) -> int:
        return _sweep_command.main([str(model), "-o", str(table), "--jobs", "1", "--plot", str(picture), *words])

    first = "first(bodies.b.position.z < 1)"
    words = ["-n", "3", "--output", first, "--gradient", "bodies.b.position.z@end"]
    assert command("--vary", "k=20..60", *words) == 0
    found = pandas.read_csv(table)
    exact = []
    for k in (20, 40, 60):
        w = math.sqrt(k - 0.16)
        exact.append((math.pi - math.atan(w / 0.4)) / w)  # cos(w t) + (c / 2 w) sin(w t) = 0
    assert found[first].to_numpy() == pytest.approx(exact, abs=3e-4)
    assert "d(bodies.b.position.z@end)/d(variables.k)" in found and "<svg" in picture.read_text()
    picture.unlink()
    assert command("--vary", "k=20..60", "--vary", "c=0.1..1", *words) == 0 and picture.exists()
    capsys.readouterr()
    for wrong, message in ((["--vary", "k=2,3", "--output", "max(bodies.b)"], "is a group"),
                           (["--vary", "k=2,3"], "--plot requires --output"),
                           (["--vary", "k=2,3", "--gradient", "bodies.b.positon.z"], "'bodies.b.position.z'?"),
                           (["--vary", "k=2,3", "--gradient", "bodies.c.position.z@0.5"], "unknown body 'c'"),
                           (["--vary", "k=2,3", "--gradient", "bodies.b.position.z@last"], "unknown time 'last'"),
                           (["--vary", "k=2,3", "--vary", "c=1,2", "--vary", "m=1,2"], "and 3 vary")):
        assert command(*wrong) == 2 and message in capsys.readouterr().err


def write(path: pathlib.Path, data: "dict[str, Any]", header: str = "t [s],bodies.b.position.z [m]") -> None:
    rows = zip(data["time"], data["bodies.b.position.z"])
    path.write_text("\n".join([header, *(f"{t!r},{z!r}" for t, z in np.array(list(rows)).tolist())]) + "\n")


def test_the_fit_command_finds_what_was_measured(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = spring()
    model, table, picture = tmp_path / "m.yaml", tmp_path / "t.csv", tmp_path / "fit.svg"
    m.save(model)
    write(table, measured(m, noise=0.005))
    words = [str(model), str(table), "--with", "k=36,c=1.2"]
    assert _fit_command.main([*words, "--plot", str(picture)]) == 0
    said = capsys.readouterr().out
    assert "largest correlation" in said and "derivatives: exact" in said and "--set variables.k=" in said
    assert "<svg" in picture.read_text()
    assert _fit_command.main([*words, "--json", "--bound", "k=10..100"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert abs(found["parameters"]["variables.k"] - 40) < 4 * found["errors"]["variables.k"] < 0.3
    assert abs(found["parameters"]["variables.c"] - 0.8) < 4 * found["errors"]["variables.c"] < 0.04
    assert found["residuals"]["bodies.b.position.z"] == pytest.approx(0.005, rel=0.2)
    # Steps that are solved to few digits have no exact gradient: differences, and that is said.
    loose = "analysis.jacobian=every_step"
    assert _fit_command.main([*words, "--set", loose]) == 0
    assert "derivatives: differences, because" in capsys.readouterr().out
    assert _fit_command.main([*words, "--set", loose, "--jacobian", "exact"]) == 2
    assert "analysis.jacobian" in capsys.readouterr().err
    write(table, measured(m), "time,bodies.b.position.z")
    assert _fit_command.main([*words[:2], *words[1:], "--jacobian", "adjoint", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["parameters"] == pytest.approx({"variables.k": 40, "variables.c": 0.8}, rel=1e-4)


def test_the_fit_command_says_what_it_does_not_know(tmp_path: pathlib.Path,
                                                    capsys: pytest.CaptureFixture[str]) -> None:
    m = spring()
    model, table = tmp_path / "m.yaml", tmp_path / "t.csv"
    m.save(model)
    data = measured(m)
    table.write_text("t [s],bodies.b.position.z [m],energy.total [J],bodies.b.orientation.w [-]\n"
                     + "".join(f"{t!r},{z!r},7,1\n" for t, z in np.array([*zip(*data.values())]).tolist()))
    words = [str(model), str(table), "--with", "k=36,c=1.2,m=1.3"]
    assert _fit_command.main([*words, "--json"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert set(found["errors"].values()) == {None} and found["covariance"] == [[None] * 3] * 3
    assert "variables.k, variables.c, variables.m" in found["warnings"][0]
    assert "2 columns are no positions or velocities and are left out, such as energy.total" in said.err
    assert _fit_command.main([*words[:2], "--with", "k=36", "--set", "m=1.1", "--set", "gravity=[0, 0, 0]"]) == 0
    assert f"polhode run {model} --set m=1.1 --set 'gravity=[0, 0, 0]' --set variables.k=" in capsys.readouterr().out
    assert _fit_command.main([*words, "--set", "analysis.duration=1"]) == 2
    assert "the data go from 0 to 2 s" in capsys.readouterr().err
    m.analysis = {"type": "statics"}
    m.save(model)
    assert _fit_command.main(words) == 2 and "is of type 'statics'" in capsys.readouterr().err


@pytest.mark.parametrize(("words", "header", "message"), [
    ([], None, "nothing is fitted; write --with"),
    (["--with", "k"], None, "--with k: write --with NAME=GUESS"),
    (["--with", "k=a"], None, "'a' is not a number"),
    (["--with", "kk=1"], None, "there is no variable 'kk'"),
    (["--with", "k=1", "--bound", "k=1"], None, "write two numbers with '..' between them"),
    (["--with", "k=1", "--bound", "c=1..2"], None, "is not among the parameters of --with"),
    (["--with", "k=1", "--prior", "k=1+-2"], None, "give deviations of all channels"),
    (["--with", "k=1", "--channel", "bodies.b.position.y"], None, "Did you mean 'bodies.b.position.z'?"),
    (["--with", "k=1"], "x,bodies.b.position.z", "no column is named 't [s]'"),
    (["--with", "k=1"], "t [ms],bodies.b.position.z", "time is in ms; convert it to s"),
    (["--with", "k=1"], "t [s],bodies.b.position.z [mm]", "is in mm; convert it to m"),
    (["--with", "k=1"], "t [s],bodies.b.place.z", "has no 'place'"),
    (["--with", "k=1"], "t [s],bodies.b.position", "is a vector; name a component"),
    (["--with", "k=1"], "t [s]", "has 2 cells, the header 1"),
])
def test_the_fit_command_tells_what_is_wrong(words: "list[str]", header: str, message: str, tmp_path: pathlib.Path,
                                             capsys: pytest.CaptureFixture[str]) -> None:
    m = spring()
    model, table = tmp_path / "m.yaml", tmp_path / "t.csv"
    m.save(model)
    write(table, measured(m), header or "t [s],bodies.b.position.z [m]")
    assert _fit_command.main([str(model), str(table), *words]) == 2
    assert message in capsys.readouterr().err


def test_a_reader_that_has_enough_is_no_fault(tmp_path: pathlib.Path) -> None:
    m = spring()
    m.save(tmp_path / "m.yaml")
    write(tmp_path / "t.csv", measured(m))
    line = f"{sys.executable} -m polhode fit m.yaml t.csv --with k=36 | true; echo ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", line], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout == "0\n" and done.stderr == ""
