#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the models and commands of the quick starts unchanged, compares what README and the tour show with what the program prints,
the errors that README states with those of docs/validation.md, and checks every complete model of the other pages.

Each page of docs/quick_start says `Save this as `NAME`` before a model; its blocks of sh are commands of polhode, run one
after the other in one folder, and what its consoles show is what the program prints. docs_tutorials.py runs the pages of docs/tutorials
in this way. POLHODE names the program. With page names as arguments only those are run.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
POLHODE = os.environ.get("POLHODE", str(ROOT / "build/release/apps/polhode/polhode"))
ROUND_OFF = r"(?:\d\.\d+e-(?:1[4-9]|[2-9]\d)|0\.0e\+00)"
BLOCK = re.compile(r"Save this as `(?P<file>[\w.]+)`|^```(?P<language>\w*)\n(?P<text>.*?)^```$", re.M | re.S)


def run_page(page, folder):
    """Faults of a page whose commands run in a folder, and the number of commands that ran. Sweeps and fits are left to
    python/tests/test_docs.py: they need the Python package."""
    count, name, faults = 0, None, []
    for block in BLOCK.finditer(page.read_text()):
        lines = (block["text"] or "").replace("\\\n", " ").splitlines()  # a command may go on in the next line
        if block["file"]:
            name = block["file"]
        elif block["language"] == "yaml":
            if name is None:
                faults.append(f"{page.name}: a model without a name")
                continue
            (folder / name).write_text(block["text"])
            name = None
        elif block["language"] in ("sh", "console"):
            shown = block["language"] == "console"
            for line in [lines[0].removeprefix("$ ")] if shown else lines:
                words = shlex.split(line, comments=True)
                if not words or words[1:2] in (["sweep"], ["fit"]):
                    continue
                if words[0] != "polhode":
                    faults.append(f"{page.name}: '{line}' is not a command of polhode")
                    continue
                done = subprocess.run([POLHODE, *words[1:]], cwd=folder, capture_output=True, text=True, check=False, timeout=240)
                count += 1
                if done.returncode != 0:
                    faults.append(f"{page.name}: '{line}' ends with {done.returncode}\n{done.stderr[-800:]}")
                if shown and not same_output(done.stdout.splitlines(), lines[1:]):
                    faults.append(f"{page.name}: '{line}' prints other lines\n{done.stdout}")
    return count, faults


def same_output(printed, shown):
    """Whether the lines shown are those printed, in order, digit by digit; `...` stands for any lines. What depends on the processor
    are the name of the instruction set, the last word of its line, and round-off: a number below 1e-13 stands for any such number."""
    pattern = []
    for line in shown:
        words = line.split()
        if words == ["..."]:
            pattern.append("(?:.*\n)*")
            continue
        if words[:2] == ["solver", "tree"]:
            pattern.append(r"solver tree(?: \w+)?\n")
            continue
        pattern.append(" ".join(ROUND_OFF if re.fullmatch(ROUND_OFF, word) else re.escape(word) for word in words) + "\n")
    return re.fullmatch("".join(pattern), "".join(" ".join(line.split()) + "\n" for line in printed)) is not None


def compare_consoles(page, count):
    """Faults of a page with a model and `count` consoles: commands that print other lines than those shown."""
    text = (ROOT / page).read_text()
    model = re.search(r"^```yaml\n(format: .*?)^```$", text, re.M | re.S)[1]
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "pendulum.yaml"
        path = f"{pathlib.Path(POLHODE).resolve().parent}:{os.environ['PATH']}"
        consoles = re.findall(r"^```console\n\$ (polhode .*?)\n(.*?)^```$", text, re.M | re.S)
        for command, shown in consoles:
            file.write_text(model.replace("[upper, lower]", "[upper, lover]") if "lover" in shown else model)
            done = subprocess.run(command, shell=True, cwd=folder, env={**os.environ, "PATH": path}, check=False, timeout=240,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if not same_output(done.stdout.splitlines(), shown.splitlines()):
                faults.append(f"{page}: '{command}' prints other lines\n{done.stdout}")
            drift = re.search(r"energy drift +(\S+)", done.stdout)
            if drift and float(drift[1]) > 1e-13:
                faults.append(f"{page}: the drift is not of round-off, and '{command}' prints {drift[1]}")
    return faults + ([] if len(consoles) == count else [f"{page} has {len(consoles)} consoles"])


def compare_errors():
    """Faults of README's table of errors: rows whose step, error and peer are not in one row of the same case of docs/validation.md."""
    measured, case, count = [], "", ""
    for line in (ROOT / "docs/validation.md").read_text().split("## Published cases")[1].split("\n\\*")[0].splitlines():
        cells = [cell.strip().removesuffix(" \\*") for cell in line.split("|")[1:-1]]
        if len(cells) == 9:
            if cells[0] and not cells[0].startswith("N ="):
                case = cells[0]
            count = cells[0] if cells[0].startswith("N =") else count if not cells[0] else ""
            measured.append((f"{case}, {count}", cells[3], cells[5], cells[6]))
    rows = re.findall(r"^\| ([^|]*) \| ([\d.]+ [µm]s) \| (\S+) \w+ \| (\S+) \w+ \| \d[^|]* \|$", (ROOT / "README.md").read_text(), re.M)
    faults = [] if len(rows) >= 6 else [f"README.md: its table of errors has {len(rows)} rows"]
    for name, *numbers in rows:
        words = [part.strip() for part in name.split("(")[0].split(",") if not re.fullmatch(r" *[\d.]+ s *", part)]
        if not any(list(found) == numbers and all(word in of for word in words) for of, *found in measured):
            faults.append(f"README.md: docs/validation.md has no row of '{name}' with {', '.join(numbers)}")
    return faults


def check_models(page):
    """Faults that `polhode check` finds in the complete models of a page, and the number of models. Parts of models are skipped;
    other files that a page names are there for the models that read them."""
    models, files, name = [], [], None
    for block in BLOCK.finditer(page.read_text()):
        if block["file"]:
            name = block["file"]
        elif block["language"] == "yaml" and block["text"].startswith("format:"):
            models.append((name or f"model{len(models)}.yaml", block["text"]))
            name = None
        elif name:
            files.append((name, block["text"]))
            name = None
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in models + files:
            (pathlib.Path(folder) / name).write_text(text)
        for name, text in models:
            done = subprocess.run([POLHODE, "check", name], cwd=folder, capture_output=True, text=True, check=False, timeout=120)
            if done.returncode != 0:
                faults.append(f"{page.relative_to(ROOT)}: a model is refused\n{text[:200]}\n{done.stderr[-800:]}")
    return len(models), faults


def main(wanted):
    pages = [p for p in sorted((ROOT / "docs/quick_start").glob("*.md")) if not wanted or p.stem in wanted]
    problems = []
    for page in pages:
        with tempfile.TemporaryDirectory() as folder:
            count, faults = run_page(page, pathlib.Path(folder))
        print(f"{page.name}: {count} commands, {len(faults)} faults")
        problems += faults + ([f"{page.name} has no commands"] if count == 0 else [])
    for page, count in (("README.md", 1), ("docs/tour.md", 4)):
        if not wanted or pathlib.Path(page).stem in wanted:
            problems += compare_consoles(page, count)
    problems += compare_errors()
    others = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    checked = 0
    for page in others:
        if page.parent.name not in ("quick_start", "tutorials") and (not wanted or page.stem in wanted):
            count, faults = check_models(page)
            checked += count
            problems += faults
    print(f"{checked} models of other pages are checked")
    print("\n".join(problems))
    return bool(problems) or not (pages or checked)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
