#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every package that the examples, the notebooks, the pages and the Python package import is installed by `pip install '.[all]'`; large ones
have an extra of their own, `[jax]`, which the page of the package names."""

import ast
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
OWN = {"polhode", *(path.stem for path in (ROOT / "examples").glob("*.py"))}
for tutorial in (ROOT / "docs/tutorials").glob("*.md"):  # a script may import one that the page has saved before
    OWN.update(re.findall(r"^.*Save this as `(\w+)\.py`", tutorial.read_text(), re.M))


def programs():
    """Place and text of every program that a reader can copy or run."""
    for path in sorted([*(ROOT / "examples").rglob("*.py"), *(ROOT / "python/polhode").rglob("*.py")]):
        yield path, path.read_text()
    for path in sorted((ROOT / "docs").rglob("*.ipynb")):
        for cell in json.loads(path.read_text())["cells"]:
            if cell["cell_type"] == "code":
                yield path, "\n".join(line for line in "".join(cell["source"]).split("\n") if not line.startswith(("%", "!")))
    for path in sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]):
        for block in re.findall(r"^```python\n(.*?)^```", path.read_text(), re.M | re.S):
            yield path, block


def imported(text):
    """Packages that a program imports, without those of Python."""
    for node in ast.walk(ast.parse(text)):
        names = [name.name for name in node.names] if isinstance(node, ast.Import) else [node.module] if isinstance(node, ast.ImportFrom) and node.level == 0 else []
        yield from {name.split(".")[0] for name in names} - set(sys.stdlib_module_names) - OWN


def main():
    settings = (ROOT / "pyproject.toml").read_text()
    lists = re.search(r"^dependencies = \[(.*?)\]", settings, re.M | re.S)[1] + re.search(r"^all = \[(.*?)\]", settings, re.M | re.S)[1]
    installed = {re.match(r"[\w-]+", name)[0].replace("-", "_") for name in re.findall(r'"([^"]+)"', lists)}
    shown = (ROOT / "docs/python/README.md").read_text()
    groups = re.search(r"^\[project.optional-dependencies\]\n(.*?)\n\n", settings, re.M | re.S)[1]
    single = dict(re.findall(r'^(\w+) = \["(\w+)"\]', groups, re.M))
    extras = set(single.values())
    for name in single:
        assert f"polhode[{name}]" in shown, f"docs/python/README.md does not name the extra [{name}]"
    found = {}
    for path, text in programs():
        for name in imported(text):
            found.setdefault(name, set()).add(str(path.relative_to(ROOT)))
    assert {"numpy", "h5py", "matplotlib"} <= found.keys(), f"only {sorted(found)} are found: are the programs read?"
    lost = [f"'{name}', which {sorted(places)[0]} imports" for name, places in sorted(found.items()) if name not in installed | extras]
    assert not lost, f"pyproject.toml: [all] lacks {', '.join(lost)}. Add it."
    unnamed = [name for name in installed - {"numpy"} if not re.search(rf"\[all\]'.*\b{name}\b", shown, re.I)]
    assert not unnamed, f"docs/python/README.md does not say that [all] installs {', '.join(unnamed)}"
    print(f"[all] installs {', '.join(sorted(found.keys() - extras))}; apart: {', '.join(sorted(extras))}")


main()
