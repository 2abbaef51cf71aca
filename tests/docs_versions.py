#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks scripts/docs.sh: versions of the documentation site in folders side by side, newest first; messages for unknown options;
the site of another commit is built by that commit's own script."""

import os
import pathlib
import shutil
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


def of_another_commit(folder):
    """Runs in a temporary repository, whose older commit has a script that writes a site of one line."""
    environment = {**os.environ, **{f"GIT_{who}_{what}": "tests" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}}

    def git(*words):
        return subprocess.run(["git", *words], cwd=folder, check=True, capture_output=True, text=True, env=environment).stdout.strip()

    def commit(text):
        for name in ("scripts/docs.sh", "docs/site/versions.py"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        if text:
            (folder / "scripts/docs.sh").write_text("#!/bin/sh\ncd $(dirname $0)/..\n" + text)
        git("add", ".")
        git("commit", "--quiet", "--message", "one")
        return git("rev-parse", "HEAD")

    def build(*words):
        return subprocess.run([folder / "scripts/docs.sh", *words], capture_output=True, text=True, env=environment)

    git("init", "--quiet")
    (folder / ".gitignore").write_text("build/\n")
    git("add", ".")
    git("commit", "--quiet", "--message", "no site")
    bare = git("rev-parse", "HEAD")
    old = commit("mkdir -p build/docs/site/$2; echo the old site >build/docs/site/$2/index.html; test -x build/docs/environment/bin/python\n")
    broken = commit("exit 3\n")
    commit(None)
    tools = folder / "build/docs/environment/bin/python"  # which are there; Sphinx is not wanted here
    tools.parent.mkdir(parents=True)
    tools.symlink_to(sys.executable)
    site = folder / "build/docs/site"
    for version in ("0.1", "0.2"):
        (folder / "build/docs/tree").mkdir(parents=True, exist_ok=True)  # of a build that was interrupted
        told = build("--version", version, "--of", old)
        assert told.returncode == 0 and told.stdout.endswith(f"build/docs/site/{version}/index.html\n"), told
        assert (site / version / "index.html").read_text() == "the old site\n"
    assert '"0.2", "0.1"' in (site / "versions.js").read_text()
    assert build("--version", "0.3", "--of", broken).returncode == 3 and not (site / "0.3").exists()
    assert len(git("worktree", "list").splitlines()) == 1 and not (folder / "build/docs/tree").exists() and tools.exists(), "its tree stays"
    for words, text in ((("--of", "nothing"), "--of 'nothing' is no commit of this repository"), (("--of", bare), "has no documentation site with versions. Name a later commit")):
        told = build("--version", "0.3", *words)
        assert told.returncode == 2 and text in told.stderr, told


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
    with tempfile.TemporaryDirectory() as folder:
        of_another_commit(pathlib.Path(folder))
    print("versions are listed, the newest first")


main()
