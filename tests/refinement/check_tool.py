#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks tools/refine.py itself: its verdicts on runs of known convergence, its options, its messages."""
import json
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import refine  # noqa: E402
from case import Case  # noqa: E402


class Made:
    """A fictitious run: x = sin t with an error of a given size, v its derivative."""

    def __init__(self, step, error):
        self.step, self.span = step, 1.0
        times = [i / 100 for i in range(101)]
        self.table = {"t": times, "x": [math.sin(t) + error for t in times], "vx": [math.cos(t) + error * t for t in times]}

    def names(self):
        return ["made"]

    def probe(self, name):
        return self.table


def verdicts(error, **more):
    steps = (1, 0.5, 0.2, 0.05, 0.01)
    case = Case("made", "", {}, 1, 1, **more)
    rows = refine.compare(case, [Made(h, error(h)) for h in steps], steps, case.order, case.floor, case.skip)
    return [row[3] for row in rows]


def called(*words):
    done = subprocess.run([sys.executable, str(ROOT / "tools/refine.py"), *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return done.returncode, done.stdout, done.stderr


def strict(text):
    def refuse(word):
        raise ValueError(f"{word} is no JSON")
    return json.loads(text, parse_constant=refuse)


# Convergence with the expected order is accepted; slower or no convergence and divergence are not.
assert verdicts(lambda h: 0.05 * h) == [True, True]
assert verdicts(lambda h: 0.05 * h * h, order=2) == [True, True]
assert verdicts(lambda h: 0.05 * h, order=2) == [False, False]
assert verdicts(lambda h: 0.05 * math.sqrt(h)) == [False, False]
assert verdicts(lambda h: 0.05 * h * (0.2 if h == 1 else 1)) == [True, True]  # A coarsest run with a small error by chance.
assert verdicts(lambda h: 0.05 * (h > 0.02)) == [False, False]
assert verdicts(lambda h: 0.01 / h) == [False, False]
assert verdicts(lambda h: 1e-4 / h if h > 0.01 else 0) == [False, False]  # Divergence up to the finest run, which is the reference.
assert verdicts(lambda h: 0) == [True, True]

# A user's model: results as strict JSON, and the exit code.
model = str(ROOT / "examples/incline/model.yaml")
code, out, err = called("--model", model, "--step", "10 ms", "--span", "0.1 s", "--steps", "1,1/2,1/5,1/20", "--json", "--order", "0")
found = strict(out)
assert code == 0 and found["failures"] == 0, (code, out, err)
assert found["steps"] == [0.01, 0.005, 0.002, 0.0005]
rows = {row["what"]: row for row in found["variants"][0]["probes"]}
assert len(rows["slides places"]["differences"]) == 3 and rows["slides places"]["order"] > 0.7, rows["slides places"]

# A single step has nothing to compare with, and no order.
code, out, err = called("--model", model, "--step", "10 ms", "--span", "0.02 s", "--steps", "1", "--json")
assert code == 0 and strict(out)["variants"][0]["probes"] == [], (code, out, err)

# A model without probes is refused.
code, out, err = called("--model", str(ROOT / "tests/validation/data/trolley.yaml"), "--step", "1 ms", "--span", "2 ms", "--steps", "1,1/2")
assert code == 1 and "output.probes" in out, (code, out, err)

# Runs that cannot start fail with the program's message.
code, out, err = called("--model", "no such model.yaml", "--steps", "1,1/2")
assert code == 1 and "cannot be opened" in out, (code, out, err)
for words in (["--step", "5 m"], ["--span", "long"], ["--steps", "1/2,1"], ["--steps", "1,0"]):
    code, out, err = called("--model", model, *words)
    assert code == 1 and "such as" in err and "Traceback" not in err, (words, code, err)
code, out, err = called("no_case_has_this_name")
assert code == 2 and "--list names them" in err, (code, err)

# --list writes each name once.
code, out, err = called("--list")
names = out.split()
assert code == 0 and "ball_on_floor" in names and len(set(names)) == len(names)
print("tools/refine.py passes.")
