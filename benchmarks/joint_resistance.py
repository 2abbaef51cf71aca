#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What do limits and friction of joints cost?

Runs a swinging chain of hinges with springs, bare and with limits or friction in each hinge, in turn, and prints the
processor time of a step. Friction with `mu` depends on the reactions of its joint.
"""
import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import tempfile

KINDS = {
    "bare": "",
    "limits": ", limits: {lower: -170 deg, upper: 170 deg}",
    "friction, moment": ", friction: {moment: 0.02}",
    "friction, mu": ", friction: {mu: 0.05, radius: 0.01}",
}


def chain(hinges, resistance):
    """Model file of a horizontal chain that is let go."""
    lines = ["format: 1", "gravity: [0, 0, -9.81]", "bodies:"]
    for i in range(hinges):
        lines.append(f"  b{i}: {{mass: 1, inertia: [0.01, 0.02, 0.02], position: [{0.2 * i + 0.1}, 0, 0]}}")
    lines.append("joints:")
    for i in range(hinges):
        first = "ground" if i == 0 else f"b{i - 1}"
        lines.append(f"  j{i}: {{type: revolute, bodies: [{first}, b{i}], at: [{0.2 * i}, 0, 0], "
                     f"axis: {'yz'[i % 2]}{resistance}}}")
    lines.append("loads:")
    for i in range(hinges):
        lines.append(f"  s{i}: {{type: torsional_spring, joint: j{i}, stiffness: 20, damping: 0.2}}")
    lines.append("analysis: {duration: 1, order: 2, tolerance: 1e-5}\noutput: {every: 0.5}")
    return "\n".join(lines) + "\n"


def processor_time(command):
    """Seconds of processor time of a program."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("polhode", type=pathlib.Path, help="the program")
    parser.add_argument("--hinges", type=int, default=20)
    parser.add_argument("--repetitions", type=int, default=5)
    options = parser.parse_args()
    seconds = {kind: [] for kind in KINDS}
    steps = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for _ in range(options.repetitions):
            for kind, resistance in KINDS.items():
                model = folder / "chain.yaml"
                model.write_text(chain(options.hinges, resistance))
                used, summary = processor_time([str(options.polhode), "run", str(model), "--json", "--output",
                                                str(folder / "chain.results")])
                seconds[kind].append(used)
                steps[kind] = summary["steps"]
    for kind, list_of in seconds.items():
        median = statistics.median(list_of)
        print(json.dumps({"benchmark": "joint_resistance", "hinges": options.hinges, "kind": kind, "steps": steps[kind],
                          "median_s": round(median, 4), "us_per_step": round(1e6 * median / steps[kind], 1)}))


if __name__ == "__main__":
    main()
