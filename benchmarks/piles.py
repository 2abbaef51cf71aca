#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Piles of balls and of boxes, alone and with joints or motors among them: cost of a step and of a contact.

    benchmarks/piles.py POLHODE [--only NAME ...] [--duration S]

POLHODE is the command-line program. Bodies fall into a bin for a second in steps of 2 ms (balls of 0.2 m, boxes of
0.18 by 0.16 by 0.14 m, 1 kg, friction 0.5). Processor times of one thread; compare within one run only.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile


def places(n):
    """Where n bodies start, in layers of a bin, a little out of line; and the side of the bin."""
    side = 0.25 * math.ceil(math.sqrt(n / 4))
    row = math.floor((side - 0.21) / 0.22) + 1
    first = -0.11 * (row - 1)
    return side, [(first + 0.22 * (i % row) + 0.005 * math.sin(12.9898 * i),
                   first + 0.22 * (i // row % row) + 0.005 * math.sin(78.233 * i),
                   0.12 + 0.22 * (i // row**2) + 0.005 * math.sin(37.719 * i)) for i in range(n)]


def pile(shape, n, duration):
    side, points = places(n)
    walls = [{"plane": "z"}] + [
        {"plane": axis, "position": [side / 2 * x, side / 2 * y, 0]}
        for axis, x, y in (("x", -1, 0), ("-x", 1, 0), ("y", 0, -1), ("-y", 0, 1))]
    bodies = {"bin": {"fixed": True, "shape": walls}}
    for i, point in enumerate(points):
        bodies[f"b{i}"] = {"shape": shape, "mass": 1, "position": list(point)}
    return {"format": 1, "title": "pile", "gravity": [0, 0, -9.81], "bodies": bodies, "joints": {}, "loads": {},
            "contacts": {"default": {"friction": 0.5}},
            "analysis": {"duration": duration, "step": "2 ms"}, "output": {"every": duration}}


def balls(n, duration):
    return pile({"sphere": 0.2}, n, duration)


def boxes(n, duration):
    return pile({"box": [0.18, 0.16, 0.14]}, n, duration)


def with_pendulum(model):
    """A pendulum above the pile that touches nothing."""
    model["bodies"]["bob"] = {"shape": {"sphere": 0.2}, "mass": 1, "position": [0.4, 0, 9]}
    model["joints"]["pivot"] = {"type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 9], "axis": "y"}
    return model


def with_joints(model, pairs):
    """Neighbours of the lowest layer held together, two by two."""
    for k in range(pairs):
        a, b = f"b{2 * k}", f"b{2 * k + 1}"
        at = [(x + y) / 2 for x, y in zip(model["bodies"][a]["position"], model["bodies"][b]["position"])]
        model["joints"][f"link{k}"] = {"type": "spherical", "bodies": [a, b], "at": at}
    return model


def with_motor(model):
    """A paddle turned by a motor above the floor; everything else falls on it."""
    for name, body in model["bodies"].items():
        if name != "bin":
            body["position"][2] += 0.3
    model["bodies"]["paddle"] = {"shape": {"box": [0.6, 0.06, 0.2]}, "mass": 2, "position": [0, 0, 0.15]}
    model["joints"]["shaft"] = {"type": "revolute", "bodies": ["ground", "paddle"], "at": [0, 0, 0.15], "axis": "z"}
    model["loads"]["drive"] = {"type": "rotary_motor", "joint": "shaft", "speed": "3 rad/s"}
    return model


def mixed(n, every, duration):
    """Balls, with a box in place of the first of every few."""
    model = balls(n, duration)
    for name, body in model["bodies"].items():
        if name != "bin" and int(name[1:]) % every == 0:
            body["shape"] = {"box": [0.18, 0.16, 0.14]}
    return model


def with_one_ball(model):
    model["bodies"]["b0"]["shape"] = {"sphere": 0.2}
    return model


def by_impulses(model):
    model["contacts"]["default"]["law"] = "nonsmooth"
    return model


CASES = {
    "100 balls": lambda t: balls(100, t),
    "300 balls": lambda t: balls(300, t),
    "300 balls, a pendulum beside them": lambda t: with_pendulum(balls(300, t)),
    "300 balls, one joint among them": lambda t: with_joints(balls(300, t), 1),
    "300 balls, 40 joints among them": lambda t: with_joints(balls(300, t), 40),
    "300 balls, a motor among them": lambda t: with_motor(balls(300, t)),
    "100 boxes": lambda t: boxes(100, t),
    "300 boxes": lambda t: boxes(300, t),
    "300 boxes, a pendulum beside them": lambda t: with_pendulum(boxes(300, t)),
    "300 balls by impulses": lambda t: by_impulses(balls(300, t)),
    "299 balls, one box, by impulses": lambda t: by_impulses(mixed(300, 300, t)),
    "150 balls, 150 boxes, by impulses": lambda t: by_impulses(mixed(300, 2, t)),
    "one ball, 299 boxes, by impulses": lambda t: by_impulses(with_one_ball(boxes(300, t))),
    "300 boxes by impulses": lambda t: by_impulses(boxes(300, t)),
}


def run(program, name, duration):
    model = {key: value for key, value in CASES[name](f"{duration} s").items() if value != {}}
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "pile.json"
        file.write_text(json.dumps(model))
        done = subprocess.run([program, "run", file, "-o", pathlib.Path(folder) / "results", "--json", "--quiet"],
                              capture_output=True, text=True)
    if done.returncode:
        return {"name": name, "failed": done.stderr.strip().splitlines()[-1:]}
    report = json.loads(done.stdout)
    return {"name": name, **report}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*", choices=list(CASES), metavar="NAME")
    parser.add_argument("--duration", type=float, default=1.0)
    given = parser.parse_args()
    print("| pile | solver | ms a step | steps | rejected | iterations a step |\n| --- | --- | ---: | ---: | ---: | ---: |")
    for name in given.only or CASES:
        r = run(given.program, name, given.duration)
        if "failed" in r:
            print(f"| {name} | failed: {r['failed']} |", flush=True)
            continue
        tried = r["steps"] + r["rejected_steps"]
        print(f"| {name} | {r['solver']} | {1e3 * r['cpu_time_s'] / r['steps']:.2f} | {r['steps']} | "
              f"{r['rejected_steps']} | {r['newton_iterations'] / tried:.1f} |", flush=True)


if __name__ == "__main__":
    main()
