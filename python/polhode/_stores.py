# SPDX-License-Identifier: Apache-2.0
"""Stores of the numbers of a result: memory or a file."""

from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np

from . import _native


def read_only(array: Any) -> Any:
    """The same object; a NumPy array can no longer be written: results are what a run computed."""
    if isinstance(array, np.ndarray):
        array.flags.writeable = False
    return array


class MemoryStore:
    """Channels in memory of the engine; views share this memory."""

    cut_text = ""

    def __init__(self, channels: "dict[str, Any]", views: "dict[str, Any]", fixed: "dict[str, Any]",
                 probes: "Optional[dict[str, Any]]" = None) -> None:
        self.channels, self.views, self.fixed, self._probes = channels, views, fixed, probes or {}
        for array in [*(channel[0] for channel in channels.values()), *fixed.values(),
                      *(rows for _, rows in self._probes.values())]:
            read_only(array)

    def probes(self) -> "dict[str, Any]":
        """Names of columns and rows of each probe."""
        return self._probes

    def paths(self) -> "list[str]":
        return [*self.channels, *self.views, *self.fixed]

    def read(self, path: str) -> Any:
        if path in self.channels:
            return self.channels[path][0]
        if path in self.fixed:
            return self.fixed[path]
        channel, first, count, squeeze, _ = self.views[path]
        array = self.channels[channel][0]
        return array[:, first] if squeeze and count == 1 else array[:, first : first + count]

    def unit(self, path: str) -> str:
        if path in self.channels:
            return str(self.channels[path][1])
        return str(self.views[path][4]) if path in self.views else ""

    def attribute(self, path: str, name: str) -> Any:
        """An attribute of a results file; a run in memory has none."""
        return None

    def title(self) -> str:
        return ""


class FileStore:
    """Data sets of a results file, read at first use and kept."""

    def __init__(self, file: str) -> None:
        self.file = file
        self._reader = _native.ResultsReader(file)
        version, known = self._reader.attribute("/", "format_version"), _native.results_format_version
        if not isinstance(version, float):
            raise OSError(f"{file}: holds no results of Polhode. Give the path of a file results.h5 that a run has "
                          "written.")
        if version > known:
            raise OSError(f"{file}: has format version {version:g}, and this program reads versions up to {known}. "
                          "Use the version of Polhode that wrote it, or a later one.")
        self.cut_text = self._reader.cut_text()  # a warning; empty for a whole file
        self._paths = self._reader.paths()
        self._known = set(self._paths)
        self._kept: "dict[str, Any]" = {}

    def paths(self) -> "list[str]":
        return self._paths

    def read(self, path: str) -> Any:
        if path not in self._known:
            raise KeyError(path)
        if path not in self._kept:
            self._kept[path] = read_only(self._reader.read(path))
        return self._kept[path]

    def probes(self) -> "dict[str, Any]":
        """Names of columns and rows of each probe, from the tables beside the file."""
        tables = {}
        folder = os.path.join(os.path.dirname(self.file), "probes")
        for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
            if name.endswith(".csv"):
                with open(os.path.join(folder, name), encoding="utf-8") as file:
                    header = file.readline().rstrip("\n").split(",")
                    lines = [line for line in file if line.endswith("\n")]  # a row that is being written is skipped
                rows = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.empty((0, len(header)))
                tables[name[:-4]] = (header, read_only(rows))
        return tables

    def unit(self, path: str) -> str:
        return str(self._reader.attribute(path, "unit") or "")

    def attribute(self, path: str, name: str) -> Any:
        """An attribute of a group or data set; None if there is none."""
        return self._reader.attribute(path, name) or None

    def title(self) -> str:
        return str(self._reader.attribute("/", "title") or "")

    def __reduce__(self) -> "tuple[Any, ...]":
        return (FileStore, (self.file,))


Store = Union[MemoryStore, FileStore]
