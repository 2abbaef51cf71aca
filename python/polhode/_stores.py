# SPDX-License-Identifier: Apache-2.0
"""Where the numbers of a result are: in memory or in a file."""

from __future__ import annotations

from typing import Any, Union

from . import _native


class MemoryStore:
    """Channels that the engine has handed over; views of them share the memory."""

    def __init__(self, channels: "dict[str, Any]", views: "dict[str, Any]", fixed: "dict[str, Any]") -> None:
        self.channels, self.views, self.fixed = channels, views, fixed

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

    def title(self) -> str:
        return ""


class FileStore:
    """Data sets of a results file, read when they are first wanted and kept."""

    def __init__(self, file: str) -> None:
        self.file = file
        self._reader = _native.ResultsReader(file)
        self._paths = self._reader.paths()
        self._known = set(self._paths)
        self._kept: "dict[str, Any]" = {}

    def paths(self) -> "list[str]":
        return self._paths

    def read(self, path: str) -> Any:
        if path not in self._known:
            raise KeyError(path)
        if path not in self._kept:
            self._kept[path] = self._reader.read(path)
        return self._kept[path]

    def unit(self, path: str) -> str:
        return str(self._reader.attribute(path, "unit") or "")

    def title(self) -> str:
        return str(self._reader.attribute("/", "title") or "")

    def __reduce__(self) -> "tuple[Any, ...]":
        return (FileStore, (self.file,))


Store = Union[MemoryStore, FileStore]
