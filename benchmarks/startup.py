#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How long does `polhode run` take before and after the steps?

Runs two steps of a small model and measures the whole process, files written and all. Prints one JSON object.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time


def measure(polhode, model, folder, repetitions):
    """Seconds from start to exit, one for each run."""
    command = [str(polhode), "run", str(model), "--set", "analysis.duration=0.01", "--output"]
    seconds = []
    for i in range(repetitions + 1):
        begin = time.perf_counter()
        subprocess.run(command + [str(folder / f"{i}.results")], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        seconds.append(time.perf_counter() - begin)
    return seconds[1:]  # the first reads the program from disk


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("polhode", type=pathlib.Path, help="the program")
    parser.add_argument("--repetitions", type=int, default=20)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model = folder / "chain.yaml"
        model.write_bytes(subprocess.run([str(options.polhode), "examples", "chain"], check=True,
                                         stdout=subprocess.PIPE).stdout)
        seconds = measure(options.polhode, model, folder, options.repetitions)
    print(json.dumps({"benchmark": "startup", "model": "chain of 10 rods, two steps",
                      "median_s": statistics.median(seconds), "fastest_s": min(seconds),
                      "slowest_s": max(seconds), "repetitions": len(seconds)}))


if __name__ == "__main__":
    main()
