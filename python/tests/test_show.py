# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in notebooks."""

import html
import html.parser
import pathlib
from typing import Optional

import pytest

import polhode
from conftest import make_pendulum


def test_results_and_models_show_in_a_cell(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = polhode.run(make_pendulum(), output="run").show(height=400)
    cell = page._repr_html_()
    assert cell.startswith('<iframe srcdoc="&lt;!doctype html') and 'height="400"' in cell
    assert html.unescape(cell.split('"')[1]) == page.text
    page.save("page.html")
    assert (tmp_path / "page.html").read_text() == page.text
    # The same page from the file; a model is shown before it runs, without remaining files.
    assert polhode.open("run").show().text == page.text
    model = make_pendulum().show()
    assert model.text != page.text and len(model.text) > 100_000
    assert sorted(p.name for p in pathlib.Path().iterdir()) == ["page.html", "run"]


def test_a_notebook_that_is_exported_shows_the_same_pages(tmp_path: pathlib.Path,
                                                          monkeypatch: pytest.MonkeyPatch) -> None:
    nbformat, nbclient, nbconvert = (pytest.importorskip(n) for n in ("nbformat", "nbclient", "nbconvert"))
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in (
        "import polhode\nm = polhode.Model(gravity=[0, 0, -9.81], analysis={'duration': 1, 'step': '5 ms'})\n"
        "arm = m.add_body('arm', shape=polhode.Box(1, 0.05, 0.05), density=1000)\nm.show()",
        "r = polhode.run(m, output='run')\nr.show(height=333)")])
    place = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources=place).execute()
    text = nbconvert.HTMLExporter().from_notebook_node(book)[0]
    frames: "list[dict[str, str]]" = []

    class Frames(html.parser.HTMLParser):
        def handle_starttag(self, tag: str, attrs: "list[tuple[str, Optional[str]]]") -> None:
            if tag == "iframe":
                frames.append({key: value or "" for key, value in attrs})

    Frames().feed(text)
    assert len(frames) == 2 and all(f["srcdoc"].startswith("<!doctype html") for f in frames)
    assert all(f["sandbox"] == "allow-scripts allow-downloads" for f in frames)
    assert frames[1]["height"] == "333" and frames[1]["srcdoc"] == polhode.open(tmp_path / "run").show().text


def test_what_cannot_be_shown_is_told() -> None:
    with pytest.raises(ValueError, match='run with output="folder"'):
        polhode.run(make_pendulum()).show()
    m = make_pendulum()
    m.joints["hinge"].bodies = ["ground", "arn"]
    with pytest.raises(polhode.ModelError, match="Did you mean 'arm'"):
        m.show()
