#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks, writes benchmarks/results/NAME.json, prints tables and whether targets are met.

Build first:

    cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_BUILD_BENCHMARKS=ON
    ninja -C build/release

Short by default, a minute or two; --full takes some ten minutes and wants a quiet machine.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys

import report

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
QUESTIONS = ["elimination", "large", "work_precision", "startup"]


def commands(build, full):
    """The programs that answer each question."""
    elimination = [build / "benchmarks/benchmark_elimination"]
    precision = [build / "benchmarks/benchmark_work_precision"]
    startup = [[sys.executable, HERE / "startup.py", build / "apps/polhode/polhode"]]
    # Its target lies between two steps whose ratio is 2: finer ones.
    four_bar = precision + ["--most-seconds", "0.3", "--refinement", "1.19", "--case", "n_four_bar_40"]
    trees = ["--model", "chain_revolute", "--model", "chain_spherical", "--model", "binary_tree"]
    if full:
        return {"elimination": [elimination + ["--repetitions", "15"]],
                "large": [elimination + trees + ["--repetitions", "3", "--size", size]
                          for size in ("10000", "100000", "1000000")],
                "work_precision": [precision + ["--most-seconds", "6", "--refinement", "1.4142135623730951"]],
                "startup": startup}
    cases = ["pendulum", "andrews_squeezer", "bricard", "heavy_top", "chain_10", "chain_80"]
    return {"elimination": [elimination + ["--repetitions", "3"]],
            "large": [elimination + trees + ["--repetitions", "1", "--size", "10000"]],
            "work_precision": [precision + ["--most-seconds", "0.3"]
                               + [word for case in cases for word in ("--case", case)], four_bar],
            "startup": startup}


def measure(command):
    """The JSON lines that a program prints."""
    command = [str(word) for word in command]
    print("+", " ".join(pathlib.Path(command[0]).name if i == 0 else word for i, word in enumerate(command)),
          file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{command[0]}: exit code {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def output_of(command):
    try:
        return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True).stdout.strip()
    except OSError:
        return ""


def machine(build):
    """What the figures depend on beside the code."""
    cache = (build / "CMakeCache.txt").read_text()
    entry = lambda key: next(iter(re.findall(rf"^{key}:\w+=(.*)$", cache, re.M)), "")
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    text = cpuinfo.read_text() if cpuinfo.exists() else ""
    field = lambda key: next(iter(re.findall(rf"^{key}\s*: (.*)$", text, re.M)), "")
    flags = set(field("flags").split())
    return {"cpu": field("model name") or platform.processor() or platform.machine(),
            "cpu_family_model": f"{field('cpu family')}/{field('model')}",
            "cores": os.cpu_count(),
            "vector_flags": sorted(flags & {"avx2", "fma", "avx512f", "avx512dq", "avx512vl"}),
            "system": f"{platform.system()} {platform.machine()}",
            "compiler": (output_of([entry("CMAKE_CXX_COMPILER"), "--version"]).splitlines() or ["?"])[0],
            "build_type": entry("CMAKE_BUILD_TYPE"),
            "commit": output_of(["git", "describe", "--always", "--dirty"]),
            "date": datetime.date.today().isoformat()}


def find_build(given):
    candidates = [given] if given else [ROOT / "build" / name for name in ("release", "bench", "quickstart")]
    for build in candidates:
        if (build / "benchmarks/benchmark_elimination").exists():
            return build.resolve()
    sys.exit("No build with benchmarks found. Build one:\n" + __doc__.split("\n\n")[2])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, help="build folder; left out: build/release and the like")
    parser.add_argument("--full", action="store_true", help="all sizes, cases and instruction sets, many repetitions")
    parser.add_argument("--only", action="append", choices=QUESTIONS, help="only this question")
    parser.add_argument("--name", help="of the results; left out: after the processor")
    options = parser.parse_args()
    build = find_build(options.build)
    facts = machine(build)
    facts["load_before"] = os.getloadavg()[0]
    lines = []
    for question, calls in commands(build, options.full).items():
        if not options.only or question in options.only:
            for call in calls:
                lines += measure(call)
    facts["load_after"] = os.getloadavg()[0]
    facts["full"] = options.full

    name = options.name or re.sub(r"[^a-z0-9]+", "-", re.sub(r"\(.*?\)", "", facts["cpu"]).lower()).strip("-")
    path = HERE / "results" / f"{name}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text('{"machine": ' + json.dumps(facts) + ',\n"lines": [\n'
                    + ",\n".join(json.dumps(line) for line in lines) + "\n]}\n")

    results = report.Results(path)
    print(report.machine_line(results))
    if results.of("elimination"):
        print("\nA body in a Newton iteration, whole steps counted\n\n" + report.elimination_table(results))
    for case, (title, compared) in report.CASES.items():
        if results.of("work_precision", case=case):
            print(f"\n{title}: CPU milliseconds to an error of the {compared}\n{report.reference_line(results, case)}\n")
            print(report.work_table(results, case))
            print("\n" + report.peer_table(results, case) if report.peers(case) else "")
    print("\nTargets\n\n" + report.target_table(results))
    print(f"\nWritten: {path.relative_to(ROOT)}. Pictures and docs/benchmarks.md: python3 benchmarks/plot.py {path.name}")


if __name__ == "__main__":
    main()
