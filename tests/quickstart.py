#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the results of scripts/quickstart.sh: a page of the N-four-bar mechanism, and the files that it names.

POLHODE names the program, which replaces the one that the script would build; compiler and packages are not used.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
POLHODE = os.environ.get("POLHODE", str(ROOT / "build/release/apps/polhode/polhode"))


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "scripts").mkdir()
        shutil.copy(ROOT / "scripts/quickstart.sh", folder / "scripts")
        for name, text in (("scripts/packages.sh", "exit 0\n"), ("tools/cmake", "#!/bin/sh\nexit 0\n")):
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text)
        (folder / "tools/cmake").chmod(0o755)
        program = folder / "build/quickstart/apps/polhode/polhode"
        program.parent.mkdir(parents=True)
        program.symlink_to(POLHODE)
        environment = {**os.environ, "PATH": f"{folder}/tools:{os.environ['PATH']}"}
        told = subprocess.run(["bash", folder / "scripts/quickstart.sh"], capture_output=True, text=True, env=environment)
        assert told.returncode == 0, told.stderr
        named = re.findall(r"^  (build/first_run/\S+) +\S", told.stdout, re.M)
        assert len(named) >= 4, told.stdout
        for name in named:
            assert (folder / name).stat().st_size > 0, name
        page = (folder / "build/first_run/n_four_bar.results/view.html").read_text()
        assert "build/first_run/n_four_bar.results/view.html" in named and "Content-Security-Policy" in page
        found = json.loads(re.search(r'id="polhode-scene">(.*?)</script>', page, re.S).group(1))
        bodies, joints = ([thing["name"] for thing in found[group]] for group in ("bodies", "joints"))
        assert len(bodies) == 81 and len(joints) == 121 and found["frames"] > 400, (len(bodies), len(joints), found["frames"])
        print(f"the quick start ends with {', '.join(named)}")


main()
