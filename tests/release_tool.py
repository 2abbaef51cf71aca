#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what tools/check_docs.py asks of a release, and stages of scripts/release.sh, in small repositories made for it."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import check_docs  # noqa: E402

GOOD = {
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(polhode VERSION 0.3.0 LANGUAGES C CXX)\n",
    "CHANGELOG.md": "# Changelog\n\n## 0.3.0 (2027-02-01)\n\n## 0.2.0 (2026-11-30)\n",
    "docs/how_to/install.md": "`polhode_0.3.0_amd64.deb`, `polhode-0.3.0.tar.gz` and `libpolhode-dev_0.3.0_amd64.deb`\n",
    "changes/README.md": "Notes.\n",
    "changes/20270201-gears.md": "# Gears\n\nThey turn.\n",
}


def made(folder, **changed):
    for name, text in {**GOOD, **{key.replace("__", "/"): value for key, value in changed.items()}}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def problems(**changed):
    with tempfile.TemporaryDirectory() as folder:
        found = []
        check_docs.check_release(found, made(pathlib.Path(folder), **changed))
        return found


def one(part, **changed):
    found = problems(**changed)
    assert len(found) == 1 and part in found[0], found


assert problems() == []
one("newest section", **{"CHANGELOG.md": "## 0.2.0 (2026-11-30)\n"})
one("newest section", **{"CHANGELOG.md": "## 0.3.0 (unreleased)\n\n"})
one("names files of version 0.2.0", **{"docs/how_to/install.md": "`libpolhode-dev_0.2.0_amd64.deb`"})
one("a title", **{"changes/20270202-lists.md": "* Lists\n"})
one("YYYYMMDD-words.md", **{"changes/gears.md": "# Gears\n"})
one("is older than version 0.3.0", **{"changes/20270131-late.md": "# Late\n"})


def release(folder, *words):
    done = subprocess.run(["bash", "scripts/release.sh", *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def git(folder, *words):
    subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


with tempfile.TemporaryDirectory() as folder:
    folder = made(pathlib.Path(folder))
    (folder / "scripts").mkdir()
    (folder / ".gitignore").write_text("build/\n")
    shutil.copy(ROOT / "scripts/release.sh", folder / "scripts")
    (folder / "scripts/format.sh").write_text("exit 0\n")
    for tool in ("docs", "equations"):
        (folder / f"tools/check_{tool}.py").parent.mkdir(exist_ok=True)
        (folder / f"tools/check_{tool}.py").write_text("")
    git(folder, "init", "-q")
    git(folder, "add", "-A")
    git(folder, "commit", "-qm", "all")
    code, text = release(folder, "uplaod")
    assert code == 1 and "'uplaod' is no stage" in text, text
    code, text = release(folder, "check")
    assert code == 1 and "Begin with the stage clone" in text, text
    code, text = release(folder, "clone", "check")
    assert code == 1 and "version 0.3.0" in text and "changes/ has 1 notes" in text, text
    (folder / "changes/20270201-gears.md").unlink()
    code, text = release(folder, "clone")
    assert code == 1 and "Commit them first" in text, text
    git(folder, "commit", "-qam", "notes taken in")
    code, text = release(folder, "clone", "check")
    assert code == 0, text
    code, text = release(folder, "sums")
    assert code == 1 and "polhode-0.3.0.tar.gz is missing" in text, text
    git(folder, "tag", "v0.3.0")
    code, text = release(folder, "clone", "check")
    assert code == 1 and "the tag v0.3.0 is there already" in text, text

    # Checksums of what the other stages would leave.
    files = folder / "build/release-files"
    names = ["polhode-0.3.0.tar.gz", "polhode-0.3.0-Linux-x86_64.tar.gz", "polhode_0.3.0_amd64.deb", "libpolhode-dev_0.3.0_amd64.deb", "polhode-0.3.0-cp311-cp311-linux.whl"]
    for name in names:
        (files / name).write_text(name)
    (files / "polhode_0.2.0_amd64.deb").write_text("old")
    code, text = release(folder, "sums")
    assert code == 1 and "polhode_0.2.0_amd64.deb is no file of version 0.3.0" in text, text
    (files / "polhode_0.2.0_amd64.deb").unlink()
    code, text = release(folder, "sums")
    assert code == 0 and "git tag -a v0.3.0" in text, text
    listed = [line.split()[1] for line in (files / "SHA256SUMS").read_text().splitlines()]
    assert sorted(listed) == sorted(names), listed
    assert release(folder, "sums")[0] == 0  # again, over those that are there
print("a release is asked for what it should be")
