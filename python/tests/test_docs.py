# SPDX-License-Identifier: Apache-2.0
"""Every snippet of the documentation runs."""

import pathlib
import re
from collections.abc import Iterable
from typing import Any

import pytest

from conftest import ROOT

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


def test_the_four_bar_of_the_readme_runs(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    own = [s for s in SNIPPET.findall((ROOT / "README.md").read_text()) if "import polhode" in s]
    assert len(own) == 1 and len(own[0].splitlines()) <= 14
    names = execute(own, ROOT / "README.md")
    assert (tmp_path / "four_bar.png").stat().st_size > 10000
    assert names["r"].ledger.energy_drift < 1e-12
