# SPDX-License-Identifier: Apache-2.0
"""Sections of docs/benchmarks.md and docs/how_fast.md from the results, and their pictures."""

from __future__ import annotations

import json
import pathlib
import re

import references
import table
from cases import all_cases


def replaced(text: str, name: str, content: str) -> str:
    """A page with new text between the comments that enclose a section."""
    pattern = rf"(<!-- {name}: written by benchmarks/peers -->\n).*?(<!-- end of {name} -->)"
    new, count = re.subn(pattern, lambda m: m[1] + "\n" + content + "\n\n" + m[2], text, flags=re.S)
    if not count:
        raise ValueError(f"the page has no section '{name}'")
    return new


def sections(results: table.Line, known: dict[str, references.Reference]) -> str:
    """A picture and a table for each case that was run."""
    text = []
    for name, mechanism in all_cases().items():
        if not any(run["case"] == name for run in results["runs"]):
            continue
        told = table.remarks(results, name)
        text += [
            f"### {mechanism.title}",
            f"![Error against processor time](images/peers_{name}.svg)",
            f"Processor time in ms until the error of the {mechanism.compared} is at most:",
            table.work_table(results, name),
            f"Reference: {known[name].source}, right to {known[name].uncertainty:.0e}." + (f" {told}" if told else ""),
        ]
    return "\n\n".join(text)


def update(path: pathlib.Path, root: pathlib.Path) -> None:
    import plot

    results = json.loads(path.read_text())
    mechanisms = all_cases()
    for name, mechanism in mechanisms.items():
        if any(run["case"] == name for run in results["runs"]):
            plot.draw(results, name, mechanism.title, mechanism.compared, root / f"docs/images/peers_{name}.svg")
    titles = {name: mechanism.title for name, mechanism in mechanisms.items()}
    for page, content in (
        ("docs/benchmarks.md", {"peers": table.machine_line(results) + "\n\n" + sections(results, references.load())}),
        (
            "docs/how_fast.md",
            {"overview": table.overview_table(results, titles) + "\n\n" + table.machine_line(results)},
        ),
    ):
        place = root / page
        text = place.read_text()
        for name, section in content.items():
            text = replaced(text, name, section)
        place.write_text(text)
    print("docs/benchmarks.md, docs/how_fast.md and docs/images/peers_*.svg are updated.")
