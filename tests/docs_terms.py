#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the pages for users of other programs: what they say is Polhode's is in its reference, files that are not read are refused,
and files that are read have a page."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
POLHODE = os.environ.get("POLHODE", str(ROOT / "build/release/apps/polhode/polhode"))
PROGRAMS = ("Adams", "Chrono", "Gazebo", "MuJoCo", "FEBio", "Exudyn", "Simscape Multibody", "OpenSim", "Drake", "Pinocchio", "Basilisk")


def rows(text):
    """Cells of the rows of tables, without their heads and rules."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    for line, after in zip(lines, [*lines[1:], ""]):
        if not line.startswith("| ---") and not after.startswith("| ---"):
            yield [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]


def check_terms():
    """Names of Polhode that occur in neither the reference nor the Python interface, by program."""
    page = (ROOT / "docs/how_to/coming_from_another_program.md").read_text()
    places = [*sorted((ROOT / "docs/reference").glob("*.md")), ROOT / "docs/python/README.md", *sorted((ROOT / "python/polhode").glob("*.py"))]
    known = set(re.findall(r"\w+", " ".join(path.read_text() for path in places)))
    sections = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", page, re.M | re.S))
    assert sections.keys() == set(PROGRAMS), f"the page is about {', '.join(sections)}"
    count, faults = 0, []
    for program, text in sections.items():
        table = list(rows(text))
        assert len(table) >= 8 or program == "Gazebo", f"{program} has {len(table)} terms"
        for cells in table:
            assert len(cells) == 3 and cells[0] and cells[1], f"{program}: the row {cells} has no term of both programs"
            for name in re.findall(r"`([^`]+)`", cells[1]):
                for word in re.findall(r"[A-Za-z_]\w+", name):
                    count += 1
                    if word not in known:
                        faults.append(f"{program}: '{word}' in `{name}` is not in docs/reference or python")
    assert count > 150, f"only {count} names are found"
    assert not faults, "\n".join(faults)
    return count


def check_files():
    """Kinds of files that the page says are read or not, against the program and the reference."""
    page = (ROOT / "docs/how_to/what_is_not_there.md").read_text()
    read, refused = [], []
    for _, files, answer in rows(page.split("## Files")[1]):
        endings = re.findall(r"`(\.\w+)`", files)
        if answer.startswith("[yes]"):
            target = re.search(r"\((.*?)\)", answer)[1]
            text = (ROOT / "docs/how_to" / target).read_text()
            for ending in endings:
                assert ending in text, f"{target} does not name {ending}"
            read += endings
        else:
            assert answer.startswith("no"), f"'{answer}' is neither yes nor no"
            refused += endings
    assert len(read) >= 10 and len(refused) >= 10, (read, refused)
    with tempfile.TemporaryDirectory() as folder:
        for ending in refused:
            file = pathlib.Path(folder) / f"model{ending}"
            file.write_text("<model/>\n")
            done = subprocess.run([POLHODE, "check", str(file)], capture_output=True, text=True, check=False, timeout=60)
            assert done.returncode != 0 and done.stderr, f"polhode check model{ending} ends with {done.returncode}"
    return len(read), len(refused)


def main():
    names = check_terms()
    read, refused = check_files()
    print(f"{names} names of Polhode are in its reference; {read} kinds of files that are read have a page, {refused} others are refused")


if __name__ == "__main__":
    sys.exit(main())
