# SPDX-License-Identifier: Apache-2.0
"""Tables and targets from the results of the benchmarks; used by run.py and plot.py."""
import json
import pathlib

HERE = pathlib.Path(__file__).resolve().parent

ERRORS = [10.0 ** -n for n in range(3, 10)]
ORDERS = ["2", "4", "6", "8", "automatic"]
CASES = {  # name: title, what is compared
    "pendulum": ("Planar pendulum (IFToMM A01), 10 s", "position of the mass [m]"),
    "n_four_bar_1": ("N-four-bar (IFToMM A02), N = 1, 10 s", "position of B0 [m]"),
    "n_four_bar_40": ("N-four-bar (IFToMM A02), N = 40, 10 s", "position of B0 [m]"),
    "andrews_squeezer": ("Andrews' squeezer (IFToMM A03), 30 ms", "seven angles [rad]"),
    "bricard": ("Bricard's mechanism (IFToMM A04), 10 s", "position of P3 [m]"),
    "heavy_top": ("Heavy top, 2 s", "centre of mass [m]"),
    "chain_10": ("Chain of 10 hinges, 1 s", "end of the first body [m]"),
    "chain_80": ("Chain of 80 hinges, 1 s", "end of the first body [m]"),
    "chain_100": ("Chain of 100 hinges, 1 s", "end of the first body [m]"),
    "chain_1000": ("Chain of 1000 hinges, 1 s", "end of the first body [m]"),
}


class Results:
    """What one call of run.py measured, on one machine."""

    def __init__(self, path):
        content = json.loads(pathlib.Path(path).read_text())
        self.machine = content["machine"]
        self.lines = content["lines"]

    def of(self, benchmark, **fields):
        """The lines of a benchmark whose fields have these values."""
        return [line for line in self.lines if line["benchmark"] == benchmark
                and all(line.get(key) == value for key, value in fields.items())]

    def good_runs(self, case, order, error):
        """Runs at least that accurate, of which every finer one is so too: a coarse run may be right by luck."""
        runs = self.of("work_precision", case=case, order=order)
        fineness = lambda run: run.get("step", run.get("tolerance"))
        worse = [fineness(run) for run in runs if run["error"] > error]
        return [run for run in runs if not worse or fineness(run) < min(worse)]

    def least_cpu(self, case, error, order=None):
        """The cheapest of the good runs of an order, or of all of them; None if there is none."""
        good = [run for o in ([order] if order else ORDERS) for run in self.good_runs(case, o, error)]
        return min(good, key=lambda run: run["cpu_s"], default=None)

    def widest(self):
        """The widest instruction set that was measured: the one that is taken by itself."""
        sets = [line["instruction_set"] for line in self.of("elimination", solver="tree")]
        return sets[0] if sets else None


def peers(case):
    """Figures of other programs for a case."""
    return [p for p in json.loads((HERE / "peers.json").read_text())["figures"] if p["case"] == case]


def number(x):
    """Two or three figures that matter."""
    return "" if x is None else f"{x:.3g}" if abs(x) >= 1e-3 or x == 0 else f"{x:.1e}"


def markdown(header, rows):
    """A table, its columns as wide as they must be."""
    cells = [[str(c) for c in row] for row in [header] + rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["| " + " | ".join(c.ljust(w) for c, w in zip(row, widths)) + " |" for row in cells]
    return "\n".join([lines[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|"] + lines[1:])


def targets(results):
    """Rows (what, measured, at most, unit) of everything that has a target and was measured."""
    rows = []
    for line in results.of("elimination", solver="tree", instruction_set=results.widest()):
        tree = not line["model"].startswith("n_four_bar")
        limit = (0.25 if line["bodies"] <= 1000 else 0.5) if tree else 0.6 if line["size"] == 40 else None
        name = f"{line['model']} {line['size']}"
        if limit:
            rows.append((f"{name}: body and iteration", line["us_per_body_iteration"], limit, "us"))
        if tree and line["bodies"] >= 1000 and "bytes_per_body" in line:
            rows.append((f"{name}: memory of a body", line["bytes_per_body"] / 1024, 4, "KiB"))
    for line in results.of("work_precision", case="n_four_bar_40", order="2", step=0.01):
        rows.append(("N-four-bar, N = 40, 10 s, steps of 10 ms", line["cpu_s"], 0.15, "s CPU"))
    best = results.least_cpu("n_four_bar_40", 2.5e-4)
    if best:
        rows.append((f"N-four-bar, N = 40, B0 right to 2.5e-4 (order {best['order']})", best["cpu_s"],
                     0.1, "s CPU"))
    for line in results.of("startup"):
        rows.append(("polhode run, two steps of a small model", 1e3 * line["median_s"], 50, "ms"))
    return rows


def target_table(results):
    rows = [(what, number(x), f"{limit:g} {unit}", "met" if x <= limit else "MISSED")
            for what, x, limit, unit in targets(results)]
    return markdown(["what", "measured", "at most", ""], rows)


def elimination_table(results):
    rows = []
    for line in results.of("elimination"):
        rows.append((line["model"], line["bodies"], line["solver"], line["instruction_set"] or "",
                     f"{line['us_per_body_iteration']:.3f}", f"{line['iterations_per_step']:.2f}",
                     f"{line['block_lu_ratio']:.1f}" if "block_lu_ratio" in line else "",
                     f"{line['bytes_per_body']:.0f}" if "bytes_per_body" in line else ""))
    return markdown(["model", "bodies", "solver", "instruction set", "µs", "iterations a step",
                     "block LU : this", "bytes a body"], rows)


def work_table(results, case):
    """CPU milliseconds to reach each error, by order."""
    rows = []
    for order in ORDERS:
        best = [results.least_cpu(case, error, order=order) for error in ERRORS]
        if any(best):
            rows.append([order] + [number(1e3 * run["cpu_s"]) if run else "" for run in best])
    return markdown(["order"] + [f"{error:.0e}" for error in ERRORS], rows)


def peer_table(results, case):
    """Each figure of another program beside ours at the same error; empty if there is none."""
    rows = []
    for peer in peers(case):
        ours = results.least_cpu(case, peer["error"]) if peer["error"] else None
        rows.append((peer["program"], peer["method"], number(peer.get("step")), number(peer["error"]),
                     number(1e3 * peer["cpu_s"]), number(1e3 * ours["cpu_s"]) if ours else "",
                     ours["order"] if ours else "",
                     f"{peer['cpu_s'] / ours['cpu_s']:.1f}" if ours else ""))
    return markdown(["program", "method", "step [s]", "error", "CPU ms", "ours, CPU ms", "order",
                     "ratio"], rows) if rows else ""


def reference_line(results, case):
    """Where the reference of a case comes from, and how good it is."""
    for line in results.of("reference", case=case):
        text = f"Reference: {line['source']}, right to {number(line['uncertainty'])}"
        if "difference_from_published" in line:
            text += f"; published data differ by {number(line['difference_from_published'])}"
        return text + "."
    return ""


def machine_line(results):
    m = results.machine
    return (f"{m['cpu']}, {results.widest() or 'widest'} kernels, {m['compiler']}, {m['build_type']} build of "
            f"{m['commit']}, {m['date']}, load average {m['load_before']:.1f} before and {m['load_after']:.1f} after.")
