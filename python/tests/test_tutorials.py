# SPDX-License-Identifier: Apache-2.0
"""Scripts and sweeps of the tutorials about the arm and the satellite, against equations of their own."""

import math
import pathlib
import re
import runpy
import sys
from typing import Any

import numpy as np
import pytest
from test_docs import sweeps_of, tutorials  # noqa: F401 - a fixture

from conftest import ROOT

ROBOTICS = ROOT / "docs/tutorials/robotics.md"


@pytest.fixture
def scripts(tutorials: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Any:  # noqa: F811
    """Runs a script of the page as a user does, beside the files that the page saves."""
    import matplotlib

    matplotlib.use("Agg")
    saved = re.findall(r"Save this as `(\w+\.\w+)`.*?```\w+\n(.*?)```", ROBOTICS.read_text(), re.S)
    assert [name for name, _ in saved] == ["arm.yaml", "circle.py", "control.py", "reach.py"]
    for name, text in saved:
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield lambda name: runpy.run_path(str(tmp_path / name), run_name="__main__")
    sys.modules.pop("circle", None)


def test_moments_around_the_circle_are_those_of_newton_and_euler(tutorials: Any, scripts: Any,  # noqa: F811
                                                                 tmp_path: pathlib.Path) -> None:
    names = scripts("circle.py")
    arm, course = tutorials.docs_arm.Arm(), names["course"]
    for t, point, tau in zip(names["t"], names["points"], names["tau"]):
        place, along = arm.place(list(course(t)))
        assert place == pytest.approx(point, abs=1e-8) and along == pytest.approx([1, 0, 0], abs=1e-8)
        assert tau == pytest.approx(arm.moments(*(list(course(t, k)) for k in range(3))), abs=1e-9)
    text = ROBOTICS.read_text()
    largest = np.abs(names["tau"]).max(axis=0)
    assert tutorials.row_of_table(text, "largest on the way [N m]") == pytest.approx(largest, abs=6e-3)
    drift = math.degrees(names["q"][-1][2] - names["q"][0][2])
    assert f"a3 ends {abs(drift):.1f}° from" in text
    assert (tmp_path / "moments.png").stat().st_size > 10000


def test_a_controller_follows_its_equation_and_sags_by_a_weight_that_it_does_not_know(
        tutorials: Any, scripts: Any) -> None:  # noqa: F811
    names = scripts("control.py")
    right, heavy, w = names["errors"][2], names["errors"][3], names["w"]
    closed = 0.05 * (1 + w * 0.1) * math.exp(-w * 0.1)
    text = ROBOTICS.read_text()
    assert f"0.1 s\n{closed:.4f} rad" in text
    low, high = re.search(r"The run has ([\d.]+) to ([\d.]+) rad", text).groups()  # type: ignore[union-attr]
    assert right[99] == pytest.approx(closed, rel=2e-2)  # it acts once in 1 ms
    assert f"{right[99].min():.4f}" == low and f"{right[99].max():.4f}" == high
    assert np.abs(right[-1]).max() < 2e-5
    # Nearly at rest the controller's moments hold the arm with the weight that is there.
    q, rest = names["arm"].q, [0.0] * 7
    given = tutorials.docs_arm.Arm(2.0).moments(list(q), rest, list(-w**2 * heavy[-1]))
    assert given == pytest.approx(tutorials.docs_arm.Arm(3.0).moments(list(q), rest, rest), abs=0.15)
    sag = np.abs(np.degrees(heavy[-1]))
    assert f"a6 sag by {sag[5]:.2f}°, and a5 by {sag[4]:.2f}°" in text


def test_generations_learn_to_reach(scripts: Any) -> None:
    pytest.importorskip("gymnasium")
    means = scripts("reach.py")["returns"].mean(axis=1)
    first, last = re.search(r"rises from (-[\d.]+) to (-[\d.]+) m s", ROBOTICS.read_text()).groups()  # type: ignore
    assert means[0] == pytest.approx(float(first), abs=6e-3)
    assert means[-3:] == pytest.approx([float(last)] * 3, abs=0.03)  # what is chosen depends on the last digits


def test_turns_of_the_satellite_are_in_proportion_to_the_push(tutorials: Any, tmp_path: pathlib.Path,  # noqa: F811
                                                              monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = ROOT / "docs/tutorials/spacecraft.md"
    rows = sweeps_of(page, tmp_path)["turns.csv"]
    turns = [row["final(probes.sat.thetaz)"] for row in rows]
    assert tutorials.row_of_table(page.read_text(), "turn [rad]") == pytest.approx(turns, abs=6e-5)
    inertia = 80 + 2 * 5.4 * (1.8**2 + (9 + 0.01**2) / 12)
    assert turns == pytest.approx([row["variables.push"] * 17.6833**2 / inertia for row in rows], rel=1e-3)
