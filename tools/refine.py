#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs models at their step and at fractions of it, and checks that results converge, and that they converge to known numbers.

    tools/refine.py                       every case of tests/refinement
    tools/refine.py ball_on_floor stops   that case, or all cases whose names begin with it
    tools/refine.py --open                cases that do not pass yet, each with its actual result
    tools/refine.py --model my.yaml --step "2 ms" --span "0.5 s" --steps 1,1/2,1/5
                                          a user's model: its differences and observed orders

Needs only Python; POLHODE=path/to/polhode is the program. The exit code is 1 if a case fails.
"""
import argparse
import bisect
import concurrent.futures
import csv
import dataclasses
import fractions
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "examples"), str(ROOT / "tests" / "refinement")]
sys.dont_write_bytecode = True
from case import Case  # noqa: E402
from support import program  # noqa: E402

SAMPLES = 2000  # Samples of the mean over time of a speed that jumps.
# A difference may be this times the extrapolation of the two coarsest runs with the order. The phase of an impact within its step is
# random, so one of these may be accurate by chance.
ALLOWANCE = 2
# Kinds of columns, which are compared differently. Accelerations, points and numbers of points jump with an impact and are not compared.
PLACES = ("x", "y", "z", "rx", "ry", "rz", "ux", "uy", "uz", "length", "angle", "impulse", "lost", "energy")
SPEEDS = ("vx", "vy", "vz", "rate x", "rate y", "rate z", "rate rx", "rate ry", "rate rz", "rate")
FORCES = ("fx", "fy", "fz", "mx", "my", "mz", "normal", "ftx", "fty", "ftz", "tension")


class Run:
    """One run: its end, its summary, the tables of its probes."""

    def __init__(self, model, settings, step, span, probes=None, load_steps=None):
        self.step, self.span, self._tables = step, span, {}
        self.units = {}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            if isinstance(model, dict):
                path = folder / "model.json"
                path.write_text(json.dumps(model))
            else:
                path = ROOT / model
            sets = {**settings, "output.hdf5": "false"}
            if load_steps:
                sets["analysis.load_steps"] = str(load_steps)
            else:
                sets.update({"analysis.step": f"{step!r} s", "analysis.duration": f"{span!r} s", "output.every": f"{step!r} s"})
                sets.update({f"output.probes.{name}.every": f"{step!r} s" for name in probes or ()})
            words = [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]
            begin = time.perf_counter()
            done = subprocess.run([program(), "run", str(path), "-o", str(folder / "out"), "--json", "--quiet", *words],
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.seconds = time.perf_counter() - begin
            try:
                self.figures = json.loads(done.stdout)
            except json.JSONDecodeError:
                self.figures = {}
            self.trouble = "" if done.returncode == 0 else \
                f"exit code {done.returncode}: {self.figures.get('message') or done.stderr.strip()[:300]}"
            for file in sorted((folder / "out" / "probes").glob("*.csv")):
                with open(file, newline="") as lines:
                    rows = list(csv.reader(lines))
                columns = zip(*([float(cell) for cell in row] for row in rows[1:]))
                self.units[file.stem] = {head.split(" [")[0]: head.split(" [")[1][:-1] for head in rows[0]}
                self._tables[file.stem] = {head.split(" [")[0]: list(column) for head, column in zip(rows[0], columns)}

    def names(self):
        return sorted(self._tables)

    def probe(self, name):
        return self._tables[name]

    def value(self, name, column, t):
        table = self._tables[name]
        return sampled(table["t"], table[column], [t])[0]


def sampled(times, values, wanted):
    """Values at given times, interpolated linearly between the rows."""
    found, i = [], 0
    for t in wanted:
        while i + 2 < len(times) and times[i + 1] < t:
            i += 1
        width = times[i + 1] - times[i] if i + 1 < len(times) else 0
        part = min(1, max(0, (t - times[i]) / width)) if width > 0 else 0
        found.append(values[i] + part * (values[i + 1] - values[i]) if width > 0 else values[i])
    return found


def impulse(times, forces):
    """Sum of force times step: a row has the force of the step that ends there."""
    total, sums = 0.0, [0.0]
    for t0, t1, f in zip(times, times[1:], forces[1:]):
        total += f * (t1 - t0)
        sums.append(total)
    return sums


def smooth_channels(run, skip, until, apart):
    """The same for a motion without jumps: columns of one unit together, at multiples of a time at which all runs have rows."""
    found = {}
    for name in run.names():
        table = run.probe(name)
        wanted = [i * apart for i in range(1, round(min(until, run.span) / apart) + 1)] if apart else table["t"][-1:]
        rows = [min(bisect.bisect_left(table["t"], t - 1e-6 * apart), len(table["t"]) - 1) for t in wanted]
        units = {}
        for column, unit in run.units[name].items():
            if column != "t" and not {name, f"{name}.{column}", f"{name}.[{unit}]", f"[{unit}]"} & set(skip):
                units.setdefault(unit, []).append([table[column][row] for row in rows])
        found.update({(name, f"[{unit}]"): columns for unit, columns in units.items()})
    return found


def channels(run, skip, until):
    """Compared columns of a run: (probe, kind) to columns sampled at common times. Positions by their largest difference,
    speeds by the mean over time, since they jump; forces by their impulse."""
    found = {}
    for name in run.names():
        table = run.probe(name)
        end = min(until, run.span)
        wanted = [end * i / SAMPLES for i in range(SAMPLES + 1)]
        for kind, columns in (("places", PLACES), ("speeds", SPEEDS), ("impulses", FORCES)):
            if name in skip or f"{name}.{kind}" in skip:
                continue
            of_kind = []
            for column in columns:
                if column in table and len(table["t"]) > 1:
                    values = impulse(table["t"], table[column]) if kind == "impulses" else table[column]
                    of_kind.append(sampled(table["t"], values, wanted))
            if of_kind:
                found[name, kind] = of_kind
    return found


def extent(kind, columns):
    """Scale by which differences are divided: the range of columns, or the largest speed."""
    if kind == "speeds" or kind.startswith("["):
        return max(max(map(abs, column)) for column in columns)
    return max(max(column) - min(column) for column in columns)


def difference(kind, coarse, fine):
    """Difference of two lists of columns, over the range of the finer ones."""
    scale = extent(kind, fine)
    gaps = [[abs(a - b) for a, b in zip(c, f)] for c, f in zip(coarse, fine)]
    size = max(sum(g) / len(g) for g in gaps) if kind == "speeds" else max(max(g) for g in gaps)
    return (0.0 if size == 0 else math.inf) if scale == 0 else size / scale


def compare(case, runs, parts, order, floor, skip, what=""):
    """A row for each channel: differences from the finest run, observed order, and whether the expected order is reached."""
    shortest = min([case.until] + [run.span for run in runs])
    apart = 0.0 if case.statics else case.step
    tables = [smooth_channels(run, skip, shortest, apart) if case.smooth or case.statics else channels(run, skip, shortest) for run in runs]
    finest = tables[-1]
    sizes = {}
    for (_, kind), columns in finest.items():
        sizes[kind] = max(sizes.get(kind, 0.0), extent(kind, columns))
    rows = []
    for key, fine in finest.items():
        kind = key[1]
        own = extent(kind, fine)
        if own < floor * sizes[kind] or own == 0:
            continue  # A channel at rest has no range to compare with; other channels and known numbers detect if it moves.
        gaps = [difference(kind, table[key], fine) for table in tables[:-1]]
        ratio = parts[-2] / parts[0]
        observed = math.log(gaps[-1] / gaps[0]) / math.log(ratio) if len(gaps) > 1 and min(gaps[0], gaps[-1]) > 0 else math.nan
        size = ALLOWANCE * max(gap / part**order for gap, part in list(zip(gaps, parts))[:2 if len(gaps) > 2 else 1])
        good = all(gap <= max(floor, size) for gap in gaps) and gaps[-1] <= max(floor, size * ratio**order)
        if case.statics and not what:
            good = all(gap <= floor for gap in gaps)
        rows.append((f"{what}{key[0]} {key[1]}", gaps, observed, good))
    return rows


def run_variant(case, variant, steps, workers):
    """All runs of one variant, coarse to fine; then those of its meshes."""
    settings = {key: value for key, value in variant.settings.items()}
    names = list(case.model["output"]["probes"]) if isinstance(case.model, dict) else None
    if names is None:
        names = Run(case.model, settings, case.step, case.step).names()
    jobs = [(settings, case.step * part, case.spans.get(part, case.span), round(1 / part)) for part in steps]
    jobs += [({**settings, **mesh}, case.step, case.span, 1) for mesh in case.meshes]
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        runs = list(pool.map(lambda job: Run(case.model, *job[:3], probes=names, load_steps=job[3] if case.statics else None), jobs))
    return runs[:len(steps)], runs[:1] + runs[len(steps):]


def measured(item, runs, sizes):
    """A known number, its values in the runs, and whether they are within the tolerance of their step or mesh."""
    values = []
    for run in runs:
        try:
            values.append(math.nan if run.trouble else item.read(run))
        except (KeyError, IndexError, ValueError, ZeroDivisionError):
            values.append(math.nan)
    allowed = [item.allowed(size) for size in sizes]
    good = [(v - item.value if item.below else abs(v - item.value)) <= bound for v, bound in zip(values, allowed)]
    return {"what": item.what, "value": item.value, "ours": values, "good": good, "allowed": allowed}


def judge(case, steps, workers=1):
    """Runs a case. Returns the number of failures and all results as plain data."""
    whole = case
    found = {"case": case.name, "steps": [case.step * part for part in steps], "variants": []}
    failures = 0
    for variant in case.variants() if callable(case.variants) else case.variants:
        case = dataclasses.replace(whole, step=whole.step * variant.longer)
        runs, meshes = run_variant(case, variant, steps, workers)
        sizes = [0.5**i for i in range(len(meshes))]
        troubles = [f"step {run.step:g} s: {run.trouble}" for run in runs + meshes[1:] if run.trouble]  # Each is a failure.
        known = [measured(item, runs, [run.step for run in runs]) for item in variant.known]
        known += [measured(item, meshes, sizes) for item in case.mesh_known]
        drifts = [math.nan if run.trouble else run.figures.get("energy_drift", math.nan) for run in runs]
        if not troubles and not case.statics:
            known.append({"what": "error of the energy balance, relative", "value": 0.0, "ours": drifts, "good": [drift <= case.drift for drift in drifts],
                          "allowed": [case.drift] * len(drifts)})
        rows, asked = [], case.order if variant.order is None else variant.order
        if case.compare and len(runs) > 1 and not troubles:
            rows = compare(case, runs, steps, asked, case.floor, case.skip)
        if len(meshes) > 1 and not troubles:
            rows += compare(case, meshes, sizes, case.mesh_order, case.mesh_floor, case.skip + case.mesh_skip, "mesh: ")
        if not rows and not variant.known and len(runs) > 1 and not troubles:
            troubles.append("nothing to compare: give the model probes of moving objects (output.probes)")
        failures += len(troubles) + sum(not all(k["good"]) for k in known) + sum(not row[3] for row in rows)
        found["variants"].append({"label": variant.label, "troubles": troubles, "known": known,
                                  "seconds": sum(run.seconds for run in runs + meshes[1:]), "asked": asked, "longer": variant.longer,
                                  "probes": [dict(zip(("what", "differences", "order", "good"), row)) for row in rows]})
    found["failures"] = failures
    return found


def show(case, found, quiet=False):
    verdict = "ok" if not found["failures"] else f"FAILED ({found['failures']})"
    seconds = sum(v["seconds"] for v in found["variants"])
    print(f"\n{case.name}: {verdict}, {seconds:.1f} s. {case.about}")
    if case.because:
        print("  " + (f"Until {case.until:g} s: " if math.isfinite(case.until) else "") + case.because)
    if case.open:
        print("  Does not pass yet: " + case.open)
    print("  " + "step [s]".ljust(44) + "  ".join(f"{step:10.3g}" for step in found["steps"]))
    for variant in found["variants"]:
        if variant["label"]:
            print(f"  -- {variant['label']}" + (f", steps {variant['longer']:g} times as long" if variant["longer"] != 1 else ""))
        for trouble in variant["troubles"]:
            print(f"  {trouble}  FAILED")
        for k in variant["known"]:
            if quiet and all(k["good"]):
                continue
            cells = "  ".join(f"{v:10.6g}" for v in k["ours"])
            print(f"  {k['what'][:42].ljust(44)}{cells}  known {k['value']:.6g} within {k['allowed'][0]:.1g} to {k['allowed'][-1]:.1g}"
                  + ("" if all(k["good"]) else "  FAILED at " + ", ".join(f"{s:g}" for s, g in zip(found["steps"], k["good"]) if not g)))
        for row in variant["probes"]:
            if quiet and row["good"]:
                continue
            cells = "  ".join(f"{gap:10.2e}" for gap in row["differences"])
            print(f"  {row['what'][:42].ljust(44)}{cells}  {'order':>10} {row['order']:.1f}" + ("" if row["good"] else f"  FAILED, expected {variant['asked']:g}"))
    sys.stdout.flush()


def strict(value):
    """A value for JSON, which has no NaN and no infinity: they become null."""
    if isinstance(value, dict):
        return {key: strict(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [strict(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def seconds_of(text):
    value, _, unit = text.strip().partition(" ")
    units = {"": 1, "s": 1, "ms": 1e-3, "us": 1e-6}
    try:
        return float(value) * units[unit]
    except (KeyError, ValueError):
        raise SystemExit(f"'{text}' is no time. Write a number and s, ms or us, such as '2 ms'.") from None


def parts_of(text):
    try:
        parts = tuple(float(fractions.Fraction(part)) for part in text.split(","))
    except (ValueError, ZeroDivisionError):
        parts = ()
    if not parts or min(parts) <= 0 or list(parts) != sorted(set(parts), reverse=True):
        raise SystemExit(f"'{text}' are no parts of a step. Write them from large to small, such as 1,1/2,1/5.")
    return parts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="beginnings of names; default: all")
    parser.add_argument("--model", help="a model file instead of the cases")
    parser.add_argument("--step", default="1 ms", help="with --model: its step, such as '2 ms'")
    parser.add_argument("--span", help="its duration, such as '0.5 s'")
    parser.add_argument("--order", type=float, default=1, help="with --model: expected order")
    parser.add_argument("--steps", help="parts of the step, such as 1,1/2,1/5,1/20,1/100")
    parser.add_argument("--list", action="store_true", help="names of the cases, one per line")
    parser.add_argument("--open", action="store_true", help="cases that do not pass yet")
    parser.add_argument("--write", metavar="CASE", help="prints the model of a case")
    parser.add_argument("--json", action="store_true", help="one line with a JSON object per case")
    parser.add_argument("--failed", action="store_true", help="shows only failures")
    parser.add_argument("--jobs", type=int, default=1, help="number of parallel runs")
    options = parser.parse_args()
    if options.model:
        cases = [Case(pathlib.Path(options.model).stem, "A user's model.", str(pathlib.Path(options.model).resolve()),
                      seconds_of(options.step), seconds_of(options.span or "1 s"), order=options.order)]
    else:
        from catalogue import ALL, CASES, OPEN  # noqa: E402
        cases = OPEN if options.open else ALL if options.cases or options.write else CASES
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    if options.write:
        print(json.dumps(next(case.model for case in cases if case.name == options.write), indent=1))
        return 0
    names = {case.name for case in cases}
    chosen = [case for case in cases if not options.cases or
              any(case.name == word if word in names else case.name.startswith(word) for word in options.cases)]
    if not chosen:
        parser.error(f"no case begins with {' or '.join(options.cases)}; --list names them")
    failed = []
    for case in chosen:
        steps = parts_of(options.steps) if options.steps else case.fractions
        if options.span and not options.model:
            case = Case(**{**vars(case), "span": seconds_of(options.span), "spans": {}})
        found = judge(case, steps, options.jobs)
        failed += [case.name] if found["failures"] else []
        if options.json:
            print(json.dumps(strict(found), allow_nan=False))
        else:
            show(case, found, options.failed)
    if len(chosen) > 1 and not options.json:
        print(f"\n{len(chosen) - len(failed)} of {len(chosen)} cases pass." + (f" Failed: {', '.join(failed)}." if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
