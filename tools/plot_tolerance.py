"""Draws docs/images/error_against_tolerance.png from the tables of docs/validation.md.

Needs matplotlib. The tables contain the measurements of tests/validation/tolerance_test.cpp.
"""
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent


def tables(text):
    """Tables whose first column is the tolerance: [(case names, {tolerance: errors})]."""
    found = []
    for block in re.findall(r"(?:^\|.*\n)+", text, re.M):
        rows = [[cell.strip() for cell in line.strip("|\n ").split("|")] for line in block.splitlines()]
        if rows[0][0] != "tolerance":
            continue
        values = {}
        for row in rows[2:]:
            values[float(row[0])] = [float(re.match(r"[\d.e+-]+", cell)[0]) for cell in row[1:]]
        found.append((rows[0][1:], values))
    return found


def main():
    text = (ROOT / "docs/validation.md").read_text()
    figure, axes = plt.subplots(1, 2, figsize=(9, 4), sharey=True)
    for axis, (names, values), title in zip(axes, tables(text), ("order 6 (A03, A05: 4 to 12)", "order 8")):
        tolerances = sorted(values)
        for i, name in enumerate(names):
            axis.loglog(tolerances, [values[t][i] for t in tolerances], "o-", ms=3, lw=1, label=name)
        axis.loglog(tolerances, tolerances, color="0.4", lw=1)
        axis.loglog(tolerances, [200 * t for t in tolerances], color="0.4", lw=1, ls="--")
        axis.set_title(title, fontsize=10)
        axis.set_xlabel("tolerance")
        axis.grid(True, which="major", color="0.9")
        axis.legend(fontsize=7)
    axes[0].set_ylabel("error at the end [m or rad]")
    figure.tight_layout()
    figure.savefig(ROOT / "docs/images/error_against_tolerance.png", dpi=110)


main()
