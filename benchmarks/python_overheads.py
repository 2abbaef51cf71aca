#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the Python package costs beside the engine: import, a run, a force in Python.

Run it with the interpreter that the package is installed for.
"""
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

import polhode

COMMAND = os.path.join(os.path.dirname(polhode.__file__), "bin", "polhode")


def wall_time(code, runs=10):
    def once():
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        return time.perf_counter() - start

    return min(once() for _ in range(runs))


def import_time():
    """Of polhode, without the interpreter's own start [s]."""
    return wall_time("import polhode") - wall_time("pass")


def run_times(folder):
    """CPU time of N-four-bar N = 40, 10 s in steps of 1 ms: from Python, and by the command [s]."""
    path = os.path.join(folder, "model.yaml")
    subprocess.run([COMMAND, "examples", "n_four_bar", "--set", "N=40", "-o", path], check=True)
    changes = {"output.every": "1 s", "analysis.step": "1 ms"}
    options = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    own, commands = [], []
    for _ in range(4):
        start = time.process_time()
        result = polhode.run(polhode.load(path), overrides=changes, progress=False)
        own.append(time.process_time() - start)
        words = [COMMAND, "run", path, *options, "--json", "--quiet"]
        figures = json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)
        commands.append(figures["cpu_time_s"])
        assert figures["result_hash"] == result.ledger.result_hash
    return min(own), min(commands)


def callback_time():
    """Of a force in Python beside one that is an expression of t, for each call [s]."""

    def model(force):
        m = polhode.Model(analysis={"duration": 100, "step": 0.001}, output={"every": 100})
        m.add_body("b", mass=1, inertia=[1, 1, 1])
        m.add_load("p", "force", body="b", at=[0, 0, 0], force=force)
        return m

    def cpu_time(force):
        return min(polhode.run(model(force), progress=False).ledger.cpu_time_s for _ in range(3))

    calls = 0
    value = (0.0, 0.0, 1.0)

    def force(t):
        nonlocal calls
        calls += 1
        return value

    return (cpu_time(force) - cpu_time(["0*t", "0*t", "1+0*t"])) / (calls / 3)


def motion_callback_times():
    """Of a force in Python that depends on the motion, for each call, the solver's own time taken off [s]: of
    f(t, body) with a tangent, without it (differences), and of f(t, q, rate) with one."""
    value = (0.0, 0.0, 1.0)
    calls = 0

    def count(result):
        def function(*_):
            nonlocal calls
            calls += 1
            return result
        return function

    def cpu_time(load):
        nonlocal calls
        m = polhode.Model(analysis={"duration": 50, "step": 0.001}, output={"every": 50})
        m.add_body("b", mass=1, inertia=[1, 1, 1])
        m.add_joint("j", "prismatic", ["ground", "b"], at=[0, 0, 0], axis="z")
        m.add_load("p", **load)
        times = []
        for _ in range(3):
            calls = 0
            times.append(polhode.run(m, progress=False).ledger.cpu_time_s)
        return min(times)

    body = {"type": "force", "body": "b", "at": [0, 0, 0]}
    joint = {"type": "linear_motor", "joint": "j"}
    result = []
    for place, key, given, plain, tangent in (
        (body, "force", value, ["0*t", "0*t", "1+0*t"], {}), (body, "force", value, ["0*t", "0*t", "1+0*t"], None),
        (joint, "force", 1.0, "1+0*t", (0.0, 0.0)),
    ):
        of_tangent = count(tangent) if tangent is not None else None
        function = polhode.StateFunction(count(given), tangent=of_tangent)
        time_used, of_run = cpu_time({**place, key: function}), calls
        result.append((time_used - cpu_time({**place, key: plain})) / of_run)
    return result


def reading_time():
    """Of the positions of a million frames in memory, the first time and without a copy [s]."""
    m = polhode.Model(analysis={"duration": 1000, "step": 0.001})
    m.add_body("b", mass=1, inertia=[1, 1, 1], velocity=[1, 0, 0])
    result = polhode.run(m, progress=False)
    start = time.perf_counter()
    position = result.bodies["b"].position
    elapsed = time.perf_counter() - start
    assert position.shape == (1000001, 3) and np.shares_memory(position, result.bodies["b"].position)
    return elapsed


if __name__ == "__main__":
    print(f"import               {1e3 * import_time():.0f} ms")
    with tempfile.TemporaryDirectory() as place:
        python, command = run_times(place)
    print(f"N-four-bar, N = 40   {python:.3f} s from Python, {command:.3f} s by the command")
    print(f"force in Python      {1e6 * callback_time():.2f} µs a call more than an expression")
    given, differences, joint = motion_callback_times()
    print(f"force of the motion  {1e6 * given:.2f} µs a call with a tangent, {1e6 * differences:.2f} µs by differences")
    print(f"force in a joint     {1e6 * joint:.2f} µs a call with a tangent")
    print(f"a million positions  {1e6 * reading_time():.0f} µs to read")
