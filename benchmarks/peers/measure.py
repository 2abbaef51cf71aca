# SPDX-License-Identifier: Apache-2.0
"""All programs on all cases, in turn in several rounds, with one thread each: a file of results."""

from __future__ import annotations

import collections
import concurrent.futures
import datetime
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys
import tempfile
from typing import Any

HERE = pathlib.Path(__file__).resolve().parent
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
Line = dict[str, Any]


def machine() -> Line:
    """What the figures depend on."""
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    found = re.findall(r"^model name\s*: (.*)$", cpuinfo.read_text() if cpuinfo.exists() else "", re.M)
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True, check=False
    ).stdout.strip()
    return {
        "cpu": found[0] if found else platform.machine(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "date": datetime.date.today().isoformat(),
        "commit": commit,
        "load_before": round(os.getloadavg()[0], 1),
    }


def work(program: str, case: str, most: float, points: list[tuple[str, float]] | None, wall: float) -> list[Line]:
    """Lines of one worker; what it has told before it is ended at its wall time stays."""
    command = [sys.executable, "-W", "ignore", str(HERE / "worker.py"), program, case, str(most)]
    if points is not None:
        command.append(json.dumps(points))
    environment = os.environ | dict.fromkeys(ONE_THREAD, "1")
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile("w+") as told:
        try:
            subprocess.run(
                command, cwd=folder, env=environment, stdout=told, stderr=subprocess.DEVNULL, timeout=wall, check=False
            )
        except subprocess.TimeoutExpired:
            print(f"{program}, {case}: ended after {wall:g} s", flush=True)
        told.seek(0)
        return [json.loads(line[7:]) for line in told if line.startswith("RESULT ")]


def measure(
    programs: list[str], cases: list[str], rounds: int, most: float, wall: float, jobs: int, path: pathlib.Path
) -> None:
    """The first round of a case finds the runs, the others repeat them. Results are written after each case."""
    facts = machine() | {"rounds": rounds, "jobs": jobs}
    heads: dict[tuple[str, str], Line] = {}
    first: dict[tuple[str, str, str, float], Line] = {}
    times: dict[tuple[str, str, str, float], list[float]] = collections.defaultdict(list)
    for case in cases:
        for turn in range(rounds):
            plans: dict[str, list[tuple[str, float]] | None] = dict.fromkeys(programs)
            if turn > 0:
                for program in programs:
                    done = [k for k, line in first.items() if k[:2] == (program, case) and "error" in line]
                    plans[program] = [(k[2], k[3]) for k in done]
            with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
                told = pool.map(lambda item: work(item[0], case, most, item[1], wall), plans.items())  # noqa: B023
            for line in (line for lines in told for line in lines):
                if "method" not in line:
                    heads[line["program"], case] = line
                    continue
                key = (line["program"], case, line["method"], line["value"])
                first.setdefault(key, line)
                if "cpu_s" in line:
                    times[key].append(line["cpu_s"])
            print(f"{case}: round {turn + 1} of {rounds}", flush=True)
        facts["load_after"] = round(os.getloadavg()[0], 1)
        runs = [line | summary(times[key]) for key, line in first.items()]
        write({"machine": facts, "programs": list(heads.values()), "runs": runs}, path)


def summary(times: list[float]) -> Line:
    """The median of a run's times, with the least and the most."""
    if not times:
        return {}
    return {"cpu_s": statistics.median(times), "cpu_least_s": min(times), "cpu_most_s": max(times)}


def write(results: Line, path: pathlib.Path) -> None:
    """A run a line, so that differences of two files can be read."""

    def rows(key: str) -> str:
        return ",\n".join(json.dumps(line) for line in results[key])

    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        '{"machine": '
        + json.dumps(results["machine"])
        + ',\n"programs": [\n'
        + rows("programs")
        + '\n],\n"runs": [\n'
        + rows("runs")
        + "\n]}\n"
    )
