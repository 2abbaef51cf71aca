#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the book of docs/site/theory_pdf.py out of a small site: its version, and chapters in the order of the menu, with links."""

import os
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "docs/site"))
import theory_pdf  # noqa: E402


def site(folder, names, version="0.7.2"):
    """A site with a menu of these pages, each with a link to the first one."""
    menu = "".join(f'<li><a class="reference internal" href="theory/{name}.html">{name}</a></li>' for name in names)
    (folder / "index.html").write_text(f'<title>Polhode {version}</title><ul>{menu}</ul><p><a class="reference internal" href="theory/{names[-1]}.html">x</a></p>')
    (folder / "theory").mkdir(exist_ok=True)
    (folder / "_static").mkdir(exist_ok=True)
    (folder / "_static/site.css").write_text(".formula { display: flex; }\nbody { color: red; }\n")
    for name in names:
        (folder / f"theory/{name}.html").write_text(f'<nav>menu</nav><article><h1 id="a">On {name} &amp; more</h1><p><a href="{names[0]}.html#a">first</a></p></article>')


def main():
    names = ["motion", "joints", "contact", "beams", "index"]  # no order of the alphabet
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        site(folder, names)
        text, version, titles = theory_pdf.book(folder)
        assert version == "0.7.2" and "<h1>Polhode 0.7.2: theory</h1>" in text and "<title>Polhode 0.7.2: theory</title>" in text, text
        assert re.findall(r'<section class="page" id="page-(\w+)"', text) == names, text
        assert re.findall(r'<li><a href="#page-(\w+)"', text) == names, text
        assert titles == [f"On {name} &amp; more" for name in names], titles
        assert text.count('<a href="#motion--a">') == len(names) and "menu" not in text and "color: red" not in text, text
        site(folder, names, "next")
        assert theory_pdf.book(folder)[1] == "next"
        (folder / "theory/forgotten.html").write_text("<article><h1>Forgotten</h1></article>")
        try:
            theory_pdf.book(folder)
        except SystemExit as told:
            assert "'forgotten'" in str(told), told
        else:
            raise AssertionError("a page that is not in the menu is left out")
    # The version of the site is that of the project, not that of CMake.
    os.environ.pop("POLHODE_DOCS_VERSION", None)
    settings = {"__file__": str(ROOT / "docs/site/conf.py")}
    exec((ROOT / "docs/site/conf.py").read_text(), settings)
    assert settings["version"] == re.search(r"^project\(polhode VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1], settings["version"]
    print("the book of the theory has its version, and its chapters in the order of the menu")


main()
