# SPDX-License-Identifier: Apache-2.0
"""The notebooks run, and are stored without outputs."""

import json
import pathlib

import pytest

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "docs/python/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_notebook_runs(path: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    monkeypatch.delenv("MPLBACKEND", raising=False)
    book = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") and cell.get("execution_count") is None for cell in book.cells)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3",
                            resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [o for cell in book.cells for o in cell.get("outputs", ()) if "image/png" in o.get("data", {})]
    assert pictures or path.stem == "rubber_bushing"


def test_there_is_a_notebook_for_each_topic() -> None:
    assert len(NOTEBOOKS) == 10
    for path in NOTEBOOKS:
        assert json.loads(path.read_text())["nbformat"] == 4
