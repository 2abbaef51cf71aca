#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares Polhode with MuJoCo, Exudyn, Drake and Pinocchio: error against processor time on the same mechanisms.

    python3 benchmarks/peers                  # installs the programs, runs all, writes tables and pictures
    python3 benchmarks/peers --page           # tables and pictures of docs/ from the last results

The programs are installed from the package registry into a virtual environment (`--environment`). Half an hour on two
cores with the default rounds; `--case pendulum --rounds 1 --most-seconds 0.2` takes a minute.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import subprocess
import sys
import venv

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAMS = ["Polhode", "MuJoCo", "Exudyn", "Drake", "Pinocchio"]


def install(environment: pathlib.Path) -> pathlib.Path:
    """The interpreter of a virtual environment with the programs."""
    python = environment / "bin/python"
    if not python.exists():
        venv.create(environment, with_pip=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
    return python


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--polhode",
        type=pathlib.Path,
        default=ROOT / "build/release/apps/polhode/polhode",
        help="program of a release build",
    )
    parser.add_argument("--environment", type=pathlib.Path, default=ROOT / "build/peers")
    parser.add_argument("--results", type=pathlib.Path, default=HERE / "results.json")
    parser.add_argument("--case", action="append", help="only this one; may be repeated")
    parser.add_argument("--program", action="append", choices=PROGRAMS, help="only this one; may be repeated")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument(
        "--most-seconds", type=float, default=0.5, help="processor time of the longest run that is tried"
    )
    parser.add_argument("--wall", type=float, default=90.0, help="seconds after which a program's runs of a case end")
    parser.add_argument("--jobs", type=int, default=1, help="programs that run at the same time; 1 on a quiet machine")
    parser.add_argument("--page", action="store_true", help="do not run: tables and pictures from the results")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def main() -> int:
    told = options()
    if not told.inside:
        python = install(told.environment)
        return subprocess.run([python, HERE, *sys.argv[1:], "--inside"], check=False).returncode
    import measure
    import page
    from cases import all_cases

    os.environ["POLHODE"] = str(told.polhode.resolve())
    if not told.page:
        measure.measure(
            told.program or PROGRAMS,
            told.case or list(all_cases()),
            told.rounds,
            told.most_seconds,
            told.wall,
            told.jobs,
            told.results,
        )
    page.update(told.results, ROOT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
