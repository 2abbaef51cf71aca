#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Versions of the documentation site lie side by side, the newest first, and scripts/docs.sh says what it does not know."""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "docs/site"))
import versions  # noqa: E402


def refused(*words):
    told = subprocess.run([ROOT / "scripts/docs.sh", *words], capture_output=True, text=True)
    assert told.returncode == 2, told
    return told.stderr


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in ("0.9.0", "0.10.0", "next", "0.2.1"):
            (folder / name).mkdir()
            (folder / name / "index.html").write_text("page")
        (folder / "no version").mkdir()
        names = versions.write(folder)
        assert names == ["next", "0.10.0", "0.9.0", "0.2.1"], names
        page = (folder / "index.html").read_text()
        assert '<a href="0.10.0/index.html">0.10.0</a> (newest release)' in page and page.count("newest") == 1, page
        assert all((folder / part.split('"')[0]).exists() for part in page.split('href="')[1:])
        assert (folder / "versions.js").read_text() == 'window.polhodeVersions = ["next", "0.10.0", "0.9.0", "0.2.1"];\n'
    assert "'--fast' is not known; there are --version NAME and --of COMMIT" in refused("--fast")
    assert "'../x' is no name of a folder" in refused("--version", "../x")
    assert "--of goes with --version" in refused("--of", "main")
    print("versions are listed, the newest first")


main()
