# SPDX-License-Identifier: Apache-2.0
"""Tables of the results, in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

Line = dict[str, Any]

ERRORS = tuple(10.0**-k for k in range(2, 10))
# The accuracy at which programs are compared, by case.
WANTED = {
    "pendulum": 1e-6,
    "n_four_bar_40": 1e-4,
    "andrews_squeezer": 1e-6,
    "flyball_governor": 1e-6,
    "heavy_top": 1e-6,
    "chain_10": 1e-6,
    "spatial_slider_crank": 1e-6,
}
# The line of a method in plots and its place in tables.
PROGRAMS = ("Polhode", "MuJoCo", "Exudyn", "Drake", "Pinocchio")


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["| " + " | ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) + " |" for row in cells]
    return "\n".join([lines[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|", *lines[1:]])


def number(x: float) -> str:
    """Three figures, two above a thousand in powers of ten."""
    return f"{x:.3g}" if abs(x) < 1e3 else f"{x:,.0f}"


def of(results: Line, case: str, program: str, method: str | None = None) -> list[Line]:
    return [
        run
        for run in results["runs"]
        if run["case"] == case and run["program"] == program and (method is None or run["method"] == method)
    ]


def methods(results: Line, case: str, program: str) -> list[str]:
    """In the order in which they were run."""
    return list(dict.fromkeys(run["method"] for run in of(results, case, program)))


def cheapest(runs: Sequence[Line], error: float) -> Line | None:
    """The cheapest run of a method with at most this error, of which no finer one is worse.

    A coarse run may be right by luck, and a failed one is worse than any.
    """
    worse = [run["value"] for run in runs if run.get("error", float("inf")) > error]
    good = [run for run in runs if "error" in run and (not worse or run["value"] < min(worse))]
    return min(good, key=lambda run: float(run["cpu_s"]), default=None)


def finest(runs: Sequence[Line]) -> Line:
    """The run of a method that no finer one can contradict."""
    return min(runs, key=lambda run: float(run["value"]))


def best(results: Line, case: str, program: str, error: float) -> Line | None:
    """The cheapest run of any method of a program."""
    found = [cheapest(of(results, case, program, method), error) for method in methods(results, case, program)]
    return min((run for run in found if run), key=lambda run: float(run["cpu_s"]), default=None)


def head(results: Line, case: str, program: str) -> Line:
    return next((line for line in results["programs"] if line["case"] == case and line["program"] == program), {})


def work_table(results: Line, case: str) -> str:
    """Milliseconds to reach each error, by method; what a program cannot do is a row, too."""
    rows = []
    for program in PROGRAMS:
        told = head(results, case, program)
        if not told:
            continue
        if told["absent"]:
            rows.append([program, told["absent"], *("" for _ in ERRORS)])
            continue
        if not methods(results, case, program):
            rows.append([program, "no run ended in its time", *("" for _ in ERRORS)])
        for method in methods(results, case, program):
            runs = of(results, case, program, method)
            found = [cheapest(runs, error) for error in ERRORS]
            cells = [number(1e3 * run["cpu_s"]) if run else "" for run in found]
            if not any(cells):
                least = min((run["error"] for run in runs if "error" in run), default=None)
                cells[0] = f"best error {least:.0e}" if least is not None else "no run succeeded"
            rows.append([program, method, *cells])
    return markdown(["program", "method", *(f"{error:.0e}" for error in ERRORS)], rows)


def remarks(results: Line, case: str) -> str:
    """How the programs express a mechanism."""
    told = [f"{p}: {head(results, case, p)['remarks']}" for p in PROGRAMS if head(results, case, p).get("remarks")]
    return "; ".join(told) + "." if told else ""


def versions(results: Line) -> str:
    found = {line["program"]: line["version"] for line in results["programs"]}
    return ", ".join(f"{program} {found[program]}" for program in PROGRAMS if program in found)


def machine_line(results: Line) -> str:
    m = results["machine"]
    rounds = f"medians of {m['rounds']} rounds" if m["rounds"] > 1 else "one run each"
    if m.get("jobs", 1) > 1:
        rounds += f", {m['jobs']} programs at a time"
    return (
        f"{m['cpu']}, {m['cores']} cores, {m['system']}, {versions(results)}, commit {m['commit']}, {m['date']}; "
        f"load average {m['load_before']} before and {m['load_after']} after, {rounds}."
    )


def overview_table(results: Line, titles: dict[str, str]) -> str:
    """The fastest method of each program at one accuracy for each case, and its ratio to Polhode's."""
    rows = []
    for case, title in titles.items():
        ours = best(results, case, "Polhode", WANTED[case])
        if not ours:
            continue
        cells = [title, f"{WANTED[case]:.0e}", f"**{number(1e3 * ours['cpu_s'])}** ms"]
        for program in PROGRAMS[1:]:
            run = best(results, case, program, WANTED[case])
            if run:
                cells.append(f"{number(1e3 * run['cpu_s'])} ms, {run['cpu_s'] / ours['cpu_s']:.1f} times")
            else:
                reached = [finest(of(results, case, program, method)) for method in methods(results, case, program)]
                least = min((run["error"] for run in reached if "error" in run), default=None)
                cells.append("no run succeeded in its time" if least is None else f"not reached; best {least:.0e}")
        rows.append(cells)
    return markdown(["mechanism", "error", *PROGRAMS], rows)
