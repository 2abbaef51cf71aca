# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in notebooks."""

import html
import pathlib

import pytest

import polhode
from conftest import make_pendulum


def test_results_and_models_show_in_a_cell(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = polhode.run(make_pendulum(), output="run").show(height=400)
    cell = page._repr_html_()
    assert cell.startswith('<iframe srcdoc="&lt;!doctype html') and 'height="400"' in cell
    assert html.unescape(cell.split('"')[1]) == page.text
    page.save("page.html")
    assert (tmp_path / "page.html").read_text() == page.text
    # The same page from the file; a model shows before it runs and leaves nothing behind.
    assert polhode.open("run").show().text == page.text
    model = make_pendulum().show()
    assert model.text != page.text and len(model.text) > 100_000
    assert sorted(p.name for p in pathlib.Path().iterdir()) == ["page.html", "run"]


def test_what_cannot_be_shown_is_told():
    with pytest.raises(ValueError, match='run with output="folder"'):
        polhode.run(make_pendulum()).show()
    m = make_pendulum()
    m.joints["hinge"].bodies = ["ground", "arn"]
    with pytest.raises(polhode.ModelError, match="Did you mean 'arm'"):
        m.show()
