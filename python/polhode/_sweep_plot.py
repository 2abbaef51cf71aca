# SPDX-License-Identifier: Apache-2.0
"""Pictures of the table of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._sweep import _FIGURES


def draw(table: Any, parameters: "list[str]", file: str) -> None:
    """Draws all outputs of a table: over one parameter as points on a line, over two as a map of colours.
    Raises ValueError if there is nothing to draw."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    outputs = [name for name in table.columns if name not in (*parameters, "message", *_FIGURES)
               and np.issubdtype(table[name].dtype, np.number)]
    if not outputs:
        raise ValueError("no run has a number to draw: see the column message")
    figure, panels = pyplot.subplots(len(outputs), 1, squeeze=False, layout="constrained",
                                     figsize=(6.4, 1.0 + 2.6 * len(outputs)))
    for panel, name in zip(panels[:, 0], outputs):
        if len(parameters) == 1:
            rows = table.sort_values(parameters[0])
            panel.plot(rows[parameters[0]], rows[name], ".-")
            panel.set_ylabel(name)
        else:
            _map(panel, table, parameters, name)
            panel.set_ylabel(parameters[1])
    panels[-1, 0].set_xlabel(parameters[0])
    figure.savefig(file)
    pyplot.close(figure)


def _map(panel: Any, table: Any, parameters: "list[str]", name: str) -> None:
    """Colours over two parameters: cells of a grid, or points."""
    x, y = (table[p].to_numpy(dtype=float) for p in parameters)
    values = table[name].to_numpy(dtype=float)
    across, up = np.unique(x), np.unique(y)
    if len(across) * len(up) == len(values) and len(across) > 1 and len(up) > 1:
        cells = np.full((len(up), len(across)), np.nan)
        cells[np.searchsorted(up, y), np.searchsorted(across, x)] = values
        colours = panel.pcolormesh(across, up, cells, shading="nearest")
    else:
        colours = panel.scatter(x, y, c=values)
    panel.figure.colorbar(colours, ax=panel, label=name)
