#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/work_precision_*.png and updates the tables of docs/benchmarks.md from results of run.py.

    python3 benchmarks/plot.py [NAME.json]

Needs matplotlib. Without a name, the newest results are used.
"""
import argparse
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import report

ROOT = report.HERE.parent
PAGE = ROOT / "docs/benchmarks.md"
IMAGES = ROOT / "docs/images"
STYLES = {  # of the curve of each order
    "2": dict(color="#7a7a7a", marker="o"), "4": dict(color="#2f8f5b", marker="s"),
    "6": dict(color="#1f5fa8", marker="^"), "8": dict(color="#b03a2e", marker="D"),
    "automatic": dict(color="#1f5fa8", marker="x", linestyle=":")}
BESIDE_PEERS = {"pendulum", "n_four_bar_40", "andrews_squeezer", "heavy_top", "chain_10"}  # sections by benchmarks/peers
PEER_MARKERS = {"Exudyn 1.11": "P", "MuJoCo": "*", "Simbody": "X", "Chrono": "p"}


def draw(results, case):
    """Draws error against CPU time and returns the path of the picture."""
    title, compared = report.CASES[case]
    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    for order in report.ORDERS:
        runs = results.of("work_precision", case=case, order=order)
        if order != "automatic":  # Runs with rejected steps do not have the given step.
            runs = [r for r in runs if not r["rejected_steps"]]
        if runs:
            label = "automatic steps" if order == "automatic" else f"order {order}"
            axes.loglog([r["cpu_s"] for r in runs], [r["error"] for r in runs], label=label, markersize=4,
                        linewidth=1.2, **STYLES[order])
    for program, marker in PEER_MARKERS.items():
        figures = [p for p in report.peers(case) if p["program"] == program and p["error"]]
        if figures:
            axes.loglog([p["cpu_s"] for p in figures], [p["error"] for p in figures], linestyle="none",
                        marker=marker, color="black", markerfacecolor="#ffd24d", markersize=8, label=program)
    axes.set_xlabel("CPU time [s]")
    axes.set_ylabel("error at the end, " + compared)
    axes.set_title(title, fontsize=11)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.legend(fontsize=8)
    path = IMAGES / f"work_precision_{case}.png"
    IMAGES.mkdir(exist_ok=True)
    figure.savefig(path, dpi=100)
    plt.close(figure)
    return path


def precision_sections(results):
    """A section for each case that was run: picture, table of Polhode, table of other programs."""
    text = []
    for case, (title, compared) in report.CASES.items():
        if case in BESIDE_PEERS or not results.of("work_precision", case=case):
            continue
        picture = draw(results, case)
        text += [f"### {title}", f"![Error against CPU time](images/{picture.name})",
                 f"CPU milliseconds until the error of the {compared} is below:", report.work_table(results, case),
                 report.reference_line(results, case)]
        beside = report.peer_table(results, case)
        if beside:
            text += ["Other programs, and the CPU time of Polhode for the same error:", beside]
    return "\n\n".join(text)


def replace_section(text, name, content):
    """Replaces the text between the comments that enclose a generated section."""
    pattern = rf"(<!-- {name}: written by benchmarks/plot.py -->\n).*?(<!-- end of {name} -->)"
    return re.sub(pattern, lambda m: m[1] + "\n" + content + "\n\n" + m[2], text, flags=re.S)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", help="of a file in benchmarks/results")
    options = parser.parse_args()
    folder = report.HERE / "results"
    path = folder / options.name if options.name else max(folder.glob("*.json"), key=lambda p: p.stat().st_mtime)
    results = report.Results(path)
    text = PAGE.read_text()
    for name, content in (("machine", report.machine_line(results)), ("targets", report.target_table(results)),
                          ("elimination", report.elimination_table(results)),
                          ("work and precision", precision_sections(results))):
        text = replace_section(text, name, content)
    PAGE.write_text(text)
    print(f"{PAGE.relative_to(ROOT)} and docs/images/work_precision_*.png updated from {pathlib.Path(path).name}")


if __name__ == "__main__":
    main()
