#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the Python package costs beside the engine: import, a run, a force in Python.

Run it with the interpreter that the package is installed for. All times are of processors, so that other programs
disturb little: medians of runs that alternate, with the quarters between which half of them lie.
"""
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import polhode

COMMAND = os.path.join(os.path.dirname(polhode.__file__), "bin", "polhode")


def children():
    """CPU time of all programs that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def differences(ours, other, runs):
    """Of the CPU times of two functions that are called in turn: both medians, and quarters of their differences [s]."""
    pairs = []
    for k in range(runs):
        pair = [one() for one in ((ours, other) if k % 2 else (other, ours))]
        pairs.append(pair if k % 2 else pair[::-1])
    a, b = (statistics.median(column) for column in zip(*pairs))
    return a, b, statistics.quantiles((x - y for x, y in pairs), n=4)


def of_a_program(*words):
    """CPU time of a program [s]."""
    before = children()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    return children() - before


def import_time():
    """Of polhode, without the interpreter's own start [s]."""
    return differences(lambda: of_a_program(sys.executable, "-c", "import polhode"),
                       lambda: of_a_program(sys.executable, "-c", "pass"), 20)


def run_times(folder):
    """N-four-bar N = 40, 10 s in steps of 1 ms: whole programs, from Python and by the command [s]."""
    path = os.path.join(folder, "model.yaml")
    subprocess.run([COMMAND, "examples", "n_four_bar", "--set", "N=40", "-o", path], check=True, stdout=subprocess.DEVNULL)
    changes = {"output.every": "1 s", "analysis.step": "1 ms"}
    options = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]

    def ours():
        before = time.process_time()
        result = polhode.run(polhode.load(path), overrides=changes, progress=False)
        hashes.add(result.ledger.result_hash)
        return time.process_time() - before

    def command():
        before = children()
        words = [COMMAND, "run", path, *options, "-o", os.path.join(folder, "out"), "--json", "--quiet"]
        hashes.add(json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)["result_hash"])
        return children() - before

    hashes = set()
    found = differences(ours, command, 15)
    assert len(hashes) == 1, hashes
    return found


def callback_time():
    """Of a force in Python beside one that is an expression of t, for each call [s]."""

    def model(force):
        m = polhode.Model(analysis={"duration": 100, "step": 0.001}, output={"every": 100})
        m.add_body("b", mass=1, inertia=[1, 1, 1])
        m.add_load("p", "force", body="b", at=[0, 0, 0], force=force)
        return m

    def cpu_time(force):
        return polhode.run(model(force), progress=False).ledger.cpu_time_s

    calls = 0
    value = (0.0, 0.0, 1.0)

    def force(t):
        nonlocal calls
        calls += 1
        return value

    runs = 9
    spent = differences(lambda: cpu_time(force), lambda: cpu_time(["0*t", "0*t", "1+0*t"]), runs)[2]
    return [t / (calls / runs) for t in spent]


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
        m = polhode.Model(analysis={"duration": 20, "step": 0.001}, output={"every": 20})
        m.add_body("b", mass=1, inertia=[1, 1, 1])
        m.add_joint("j", "prismatic", ["ground", "b"], at=[0, 0, 0], axis="z")
        m.add_load("p", **load)
        return polhode.run(m, progress=False).ledger.cpu_time_s

    body = {"type": "force", "body": "b", "at": [0, 0, 0]}
    joint = {"type": "linear_motor", "joint": "j"}
    result = []
    for place, key, given, plain, tangent in (
        (body, "force", value, ["0*t", "0*t", "1+0*t"], {}), (body, "force", value, ["0*t", "0*t", "1+0*t"], None),
        (joint, "force", 1.0, "1+0*t", (0.0, 0.0)),
    ):
        of_tangent = count(tangent) if tangent is not None else None
        function = polhode.StateFunction(count(given), tangent=of_tangent)
        runs, calls = 9, 0
        spent = differences(lambda: cpu_time({**place, key: function}), lambda: cpu_time({**place, key: plain}), runs)[2]  # noqa: B023
        result.append([t / (calls / runs) for t in spent])
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


def spread(quarters, unit, digits):
    low, middle, high = (unit * x for x in quarters)
    return f"{middle:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


if __name__ == "__main__":
    with_it, without, more = import_time()
    print(f"import               {spread(more, 1e3, 0)} ms; {1e3 * with_it:.0f} ms with the interpreter, {1e3 * without:.0f} ms without polhode")
    with tempfile.TemporaryDirectory() as place:
        python, command, more = run_times(place)
    print(f"N-four-bar, N = 40   {python:.3f} s from Python, {command:.3f} s by the command, more by {spread(more, 100 / command, 1)} %")
    print(f"force in Python      {spread(callback_time(), 1e6, 2)} µs a call more than an expression")
    for name, of_one in zip(("of the motion, tangent", "of the motion, differences", "in a joint, tangent"), motion_callback_times()):
        print(f"{name:27} {spread(of_one, 1e6, 2)} µs a call")
    print(f"a million positions  {1e6 * reading_time():.0f} µs to read")
