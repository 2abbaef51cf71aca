# SPDX-License-Identifier: Apache-2.0
"""Runs examples and writes a page of each, to play in the site."""

import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRAMES = "240"


def main(polhode, target, names):
    target, work = pathlib.Path(target).resolve(), pathlib.Path(target).resolve().parent / "runs"
    shutil.rmtree(target, ignore_errors=True)
    for folder in (target, work):
        folder.mkdir(parents=True, exist_ok=True)
    polhode = str(pathlib.Path(polhode).resolve())
    for name in names:
        results = work / f"{name}.results"
        subprocess.run([polhode, "run", str(ROOT / f"examples/{name}/model.yaml"), "-o", str(results), "--quiet"], check=True)
        subprocess.run([polhode, "view", str(results), "--html", str(target / f"{name}.html"), "--frames", FRAMES, "--quiet"], check=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
