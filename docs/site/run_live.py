# SPDX-License-Identifier: Apache-2.0
"""Runs examples and writes a page of each, to play in the site; they share the player."""

import pathlib
import shutil
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRAMES = "240"


def main(polhode, target, names):
    target, work = pathlib.Path(target).resolve(), pathlib.Path(target).resolve().parent / "runs"
    shutil.rmtree(target, ignore_errors=True)
    work.mkdir(parents=True, exist_ok=True)
    polhode = str(pathlib.Path(polhode).resolve())
    for name in names:
        # Results are named after the example, and lie beside the files that its model names.
        shutil.rmtree(work / name, ignore_errors=True)
        shutil.copytree(ROOT / "examples" / name, work / name, ignore=shutil.ignore_patterns("*.results"))
        subprocess.run([polhode, "run", str(work / name / "model.yaml"), "-o", str(work / name / f"{name}.results"), "--quiet"], check=True)
    archive = work / "live.zip"
    subprocess.run([polhode, "view", *[str(work / name / f"{name}.results") for name in names], "--zip", str(archive), "--frames", FRAMES, "--quiet"], check=True)
    with zipfile.ZipFile(archive) as pages:
        pages.extractall(target)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
