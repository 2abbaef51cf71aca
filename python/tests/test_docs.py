# SPDX-License-Identifier: Apache-2.0
"""Every snippet of the documentation runs."""

import importlib
import math
import pathlib
import re
import shlex
import statistics
from collections.abc import Iterable
from typing import Any

import pytest

from conftest import ROOT
from polhode import _sweep_command

PAGES = sorted((ROOT / "docs/python").glob("*.md"))
SNIPPET = re.compile(r"^```python\n(.*?)^```", re.M | re.S)


def execute(snippets: "Iterable[str]", page: pathlib.Path) -> "dict[str, Any]":
    import matplotlib

    matplotlib.use("Agg")
    names: "dict[str, Any]" = {}
    for code in snippets:
        exec(compile(code, str(page), "exec"), names)
    return names


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_snippets_of_a_page_run(page: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch,
                                capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    snippets = SNIPPET.findall(page.read_text())
    assert len(snippets) > 5
    names = execute(snippets, page)
    assert len(names["figure"].axes) == 2


def sweeps_of(page: pathlib.Path, folder: pathlib.Path) -> "dict[str, list[dict[str, float]]]":
    """Tables of the sweeps of a tutorial, by file: its models are saved and its commands run as they stand."""
    import pandas

    text = page.read_text().replace("\\\n", " ")
    for name, model in re.findall(r"Save this as `(\w+\.yaml)`.*?```yaml\n(.*?)```", text, re.S):
        (folder / name).write_text(model)
    tables = {}
    for line in re.findall(r"^polhode sweep (.*)$", text, re.M):
        words = shlex.split(line)
        assert _sweep_command.main([*words, "--jobs", "1"]) == 0
        name = words[words.index("-o") + 1]
        table = pandas.read_csv(folder / name)
        assert not table["message"].any() if table["message"].dtype == object else table["message"].isna().all()
        tables[name] = table.select_dtypes("number").to_dict("records")
    return tables


@pytest.fixture
def tutorials(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Independent solutions of the tutorials, those of the test docs_tutorials."""
    monkeypatch.syspath_prepend(str(ROOT / "tests"))
    return importlib.import_module("docs_tutorials")


def test_the_sweeps_of_the_pump_are_those_of_its_equations(tutorials: Any, tmp_path: pathlib.Path,
                                                           monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = ROOT / "docs/tutorials/machine_designer.md"
    tables = sweeps_of(page, tmp_path)
    shown = re.search(r"^\| largest moment \[N m\] \| (.*) \|$", page.read_text(), re.M)
    full, column, times = 10 * math.pi, "max(loads.motor.moment.size)", [k / 1000 for k in range(2001)]
    assert shown and len(tables["wheel.csv"]) == 7
    for row, text in zip(tables["wheel.csv"], shown[1].split("|")):
        exact = max(10 * (full - rate) for _, rate in tutorials.Pump(wheel=row["variables.wheel"]).driven(times))
        assert row[column] == pytest.approx(exact, abs=1e-3) and float(text) == pytest.approx(exact, abs=0.051)
    peaks = []
    for row in tables["scatter.csv"]:
        pump = tutorials.Pump(crank=row["variables.crank"], water=row["variables.water"])
        peaks.append(max(pump.at_speed(full * k / 1000, full)[0] for k in range(1, 400)))
        assert row[column] == pytest.approx(peaks[-1], abs=1e-9)
    assert len(peaks) == 40 and 0.015 < statistics.stdev(peaks) / statistics.mean(peaks) < 0.025  # the page says 2 %
    assert (tmp_path / "wheel.svg").stat().st_size > 5000


def test_script_and_sweep_of_the_book(tutorials: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import numpy as np

    monkeypatch.chdir(tmp_path)
    page = ROOT / "docs/tutorials/lecturer.md"
    rows = sweeps_of(page, tmp_path)["delays.csv"]
    delays = [tutorials.book(row["variables.nudge"]).first for row in rows]
    assert len(rows) == 4
    assert [row["first(probes.book.wy < 0)"] for row in rows] == pytest.approx(delays, abs=1e-4)
    scripts = SNIPPET.findall(page.read_text())
    names = execute(scripts, page)
    assert len(scripts) == 1 and (tmp_path / "polhodes.png").stat().st_size > 10000
    lines = [np.array(line.get_xdata()) for line in names["left"].lines]
    exact = np.array([tutorials.book().at(t) for t in lines[0]])
    shown = np.array([line.get_ydata() for line in names["left"].lines]).T
    assert np.abs(shown - exact).max() < 1e-6
    assert len(names["right"].lines) == 28
    points = np.hstack([line.get_data_3d() for line in names["right"].lines])
    points = points[:, np.isfinite(points[0])]
    energies = names["inertia"] @ np.square(points) / 2  # on the ellipsoid
    assert len(energies) > 10000 and np.abs(energies - 0.07).max() < 1e-12


def test_the_four_bar_of_the_readme_prints_what_it_shows(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch,
                                                         capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    own = [s for s in SNIPPET.findall((ROOT / "README.md").read_text()) if "import polhode" in s]
    assert len(own) == 1 and len(own[0].splitlines()) <= 10
    shown = re.search(r"^print.*# (.*)$", own[0], re.M)
    assert shown
    names = execute(own, ROOT / "README.md")
    number = re.compile(r"\d+\.(?:\d+)?(?:e-\d+)?")
    *place, drift = map(float, number.findall(shown[1]))
    *printed, round_off = map(float, number.findall(capsys.readouterr().out))
    assert place == printed and len(place) == 3
    assert drift < 1e-14 and round_off < 1e-13
    assert (tmp_path / "four_bar.png").stat().st_size > 10000
    # At a hundredth of the step the coupler ends within a millimetre of it.
    import polhode

    fine = polhode.run(names["m"], overrides={"analysis.step": "50 us"}, progress=False)
    assert fine.bodies["coupler"].position[-1] == pytest.approx(place, abs=1e-3)
    assert fine.ledger.energy_drift < 1e-12
