# SPDX-License-Identifier: Apache-2.0
"""Pictures of error against processor time."""

from __future__ import annotations

import pathlib
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import table  # noqa: E402

COLOURS = {"Polhode": "#1f5fa8", "MuJoCo": "#b03a2e", "Exudyn": "#2f8f5b", "Drake": "#8a5bb0", "Pinocchio": "#c77f1a"}
MARKS = ("o", "s", "^", "D", "v", "P", "X")
DASHES = ("-", "--", ":", "-.", (0, (5, 1)), (0, (1, 1)), (0, (3, 1, 1, 1)))


def draw(results: dict[str, Any], case: str, title: str, compared: str, path: pathlib.Path) -> None:
    matplotlib.rcParams["svg.hashsalt"] = "polhode"  # the same picture for the same results
    figure, axes = plt.subplots(figsize=(8.4, 5.0), layout="constrained")
    for program in table.PROGRAMS:
        for i, method in enumerate(table.methods(results, case, program)):
            runs = [r for r in table.of(results, case, program, method) if "error" in r and r["error"] < 1.0]
            if runs:
                axes.loglog(
                    [1e3 * r["cpu_s"] for r in runs],
                    [r["error"] for r in runs],
                    color=COLOURS[program],
                    marker=MARKS[i],
                    linestyle=DASHES[i],
                    markersize=4,
                    linewidth=1.9 if i == 0 else 1.2,
                    label=f"{program}: {method}",
                )
    axes.set_xlabel("processor time [ms]")
    axes.set_ylabel("error at the end, " + compared)
    axes.set_title(title, fontsize=11)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.legend(fontsize=7.5, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
