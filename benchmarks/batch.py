#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures polhode.batch: tolerances of the spatial slider-crank, 0.5 s, as a table of thousands of runs.

    benchmarks/batch.py [RUNS]

Prints the error of the step against a run with a hundredth of it, the throughput of runs alone and side by side on one
thread, in one run and in turn, and the time of all RUNS (100,000) on all processors. Run it with the interpreter that the
package is installed for.
"""
import os
import pathlib
import sys
import time

import numpy as np

import polhode
from polhode import _batch

MODEL = pathlib.Path(__file__).resolve().parent.parent / "examples/spatial_slider_crank/model.yaml"
CHANNELS = ["bodies.slider.position.x"]
SETTINGS = {"analysis.duration": "0.5 s", "analysis.step": "10 ms", "analysis.order": 4, "output.every": "50 ms"}
ROUNDS = 3


def samples(runs):
    """Masses, inertias, speeds with standard deviations of one per cent."""
    draw = np.random.default_rng(1).normal
    return {"variables.speed": draw(6, 0.06, runs), "bodies.crank.mass": draw(0.12, 0.0012, runs),
            "bodies.rod.mass": draw(0.5, 0.005, runs), "bodies.slider.mass": draw(2, 0.02, runs),
            "bodies.rod.inertia": draw([4e-4, 4e-3, 4e-3], [4e-6, 4e-5, 4e-5], (runs, 3))}


def timed(runs, together, threads=1):
    _batch._TOGETHER = together
    begin, cpu = time.perf_counter(), time.process_time()
    b = polhode.batch(MODEL, samples(runs), CHANNELS, overrides=SETTINGS, threads=threads)
    assert b.finished.all()
    return b, time.perf_counter() - begin, time.process_time() - cpu


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 100000
    fine = polhode.batch(MODEL, samples(32), CHANNELS, overrides={**SETTINGS, "analysis.step": "0.1 ms"})
    b, _, _ = timed(32, 32)
    print(f"error of steps of {SETTINGS['analysis.step']}: {np.abs(b[CHANNELS[0]] - fine[CHANNELS[0]]).max():.1e} m")
    sizes = (1, 8, 16, 32, 64, 128)
    best = {size: min(timed(512, size)[2] for _ in range(ROUNDS)) / 512 for size in sizes}
    for size in sizes:
        print(f"{size:4} side by side: {1e6 * best[size]:7.0f} us of CPU a run, {best[1] / best[size]:.2f} times alone")
    _, wall, cpu = timed(runs, 32, os.cpu_count())
    print(f"{runs} runs on {os.cpu_count()} processors: {wall:.1f} s, {cpu:.1f} s of CPU")


main()
