# SPDX-License-Identifier: Apache-2.0
"""Contents of the source package: everything that a build needs."""

import pathlib
import statistics
import subprocess
import sys
import tarfile

import pytest

import polhode
from conftest import ROOT


def test_the_source_package_holds_every_file_of_the_repository(tmp_path: pathlib.Path) -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("this is no clone, so nothing tells what there should be")
    code = f"from scikit_build_core.build import build_sdist; build_sdist({str(tmp_path)!r})"
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True)
    name = f"polhode-{polhode.__version__}"
    with tarfile.open(tmp_path / f"{name}.tar.gz") as package:
        inside = set(package.getnames())
    wanted = [file for file in listed.stdout.splitlines() if not file.startswith("docs/images/")]
    missing = [file for file in wanted if (ROOT / file).exists() and f"{name}/{file}" not in inside]
    assert "viewer/dist/viewer.html" in wanted and not missing, missing


def test_the_import_is_light() -> None:
    """Slow modules are loaded at first use, and the start takes less than 150 ms of processor time."""
    code = ("import resource, sys; before = resource.getrusage(resource.RUSAGE_SELF); import polhode; "
            "after = resource.getrusage(resource.RUSAGE_SELF); "
            "print(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, "
            "*({'numpy', 'scipy', 'pandas', 'matplotlib', 'tqdm'} & set(sys.modules)))")
    starts = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
              for _ in range(7)]
    assert all(len(words) == 1 for words in starts), starts
    assert statistics.median(float(words[0]) for words in starts) < 0.15, starts
