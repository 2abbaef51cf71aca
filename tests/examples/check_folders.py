# SPDX-License-Identifier: Apache-2.0
"""Checks that every folder of examples/ is complete and that `polhode examples` writes the models of these folders."""
import os
import pathlib
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
FILES = ("README.md", "model.yaml", "check.py", "picture.png")
LARGEST_PICTURE = 150_000  # bytes


def polhode(*arguments):
    program = os.environ.get("POLHODE", "polhode")
    if os.sep in program:
        program = os.path.abspath(program)
    with tempfile.TemporaryDirectory() as folder:  # Meshes that a model needs are written beside it.
        return subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, cwd=folder).stdout


def main():
    problems = []
    listing = polhode("examples").decode()
    generated = listing.partition("Models of any size:")[2]
    folders = sorted(path for path in EXAMPLES.iterdir() if path.is_dir() and not path.name.startswith((".", "__")))
    for folder in folders:
        problems += [f"{folder.name}: {file} is missing" for file in FILES if not (folder / file).exists()]
        picture = folder / "picture.png"
        if picture.exists() and picture.stat().st_size > LARGEST_PICTURE:
            problems.append(f"{folder.name}: picture.png has more than {LARGEST_PICTURE} bytes")
        if f"  {folder.name} " not in listing:
            problems.append(f"{folder.name}: not listed by 'polhode examples'")
        elif f"  {folder.name} " not in generated:
            if polhode("examples", folder.name) != (folder / "model.yaml").read_bytes():
                problems.append(f"{folder.name}: 'polhode examples {folder.name}' writes a different text")
        if f"[{folder.name}]({folder.name})" not in (EXAMPLES / "README.md").read_text():
            problems.append(f"{folder.name}: no row in examples/README.md")
    if not folders:
        problems.append("there are no examples")
    print("\n".join(problems) or f"{len(folders)} examples are complete")
    sys.exit(1 if problems else 0)


main()
