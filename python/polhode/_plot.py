# SPDX-License-Identifier: Apache-2.0
"""Pictures of results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

if TYPE_CHECKING:
    from ._result import Result


def components_of(shape: "tuple[int, ...]") -> "list[str]":
    if shape in ((3,), (4,)):
        return ["." + c for c in ("xyz" if shape == (3,) else "wxyz")]
    if shape in ((), (1,)):
        return [""]
    return ["".join(f".{i}" for i in index) for index in np.ndindex(*shape)]


def _panels(result: "Result", name: str) -> "list[tuple[str, list[str]]]":
    """Titles of panels, and the channels that each draws."""
    from ._result import Group

    if name.startswith("probes.") and (columns := result.probes.get(name[len("probes."):])) is not None:
        by_unit: "dict[str, list[str]]" = {}
        for column in columns:
            if column != "t":
                by_unit.setdefault(columns.unit(column), []).append(f"{name}.{column}")
        return [(name, parts) for parts in by_unit.values()]
    found = result[name]
    return [(name, [f"{name}.{k}" for k in found] if isinstance(found, Group) else [name])]


def plot(result: "Result", channels: "Sequence[str]", axes: Any) -> Any:
    """The figure of Result.plot."""
    from matplotlib import pyplot

    wanted = [panel for name in channels for panel in _panels(result, name)]
    if axes is None:
        figure, axes = pyplot.subplots(len(wanted), 1, sharex=True, squeeze=False, layout="constrained")
        axes = axes[:, 0]
    panels = np.atleast_1d(np.asarray(axes, dtype=object))
    for panel, (name, parts) in zip(panels, wanted):
        for part in parts:
            array = np.asarray(result[part])
            flat = array.reshape(len(array), -1)
            for k, label in enumerate(components_of(array.shape[1:])):
                panel.plot(result.times(part), flat[:, k], label=(part[len(name) + 1:] + label).lstrip(".") or None)
        panel.set_ylabel(f"{name} [{result.unit(parts[0])}]")
        if panel.get_legend_handles_labels()[0]:
            panel.legend(loc="best", fontsize="small")
    panels[-1].set_xlabel("time [s]")
    return panels[0].figure
