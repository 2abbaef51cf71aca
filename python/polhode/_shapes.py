# SPDX-License-Identifier: Apache-2.0
"""Shapes as objects: polhode.Box(1, 0.05, 0.05), one class for each kind of the model file."""

from __future__ import annotations

import inspect
from typing import Any

from . import _schema, _text
from ._tree import plain

_PLACED = ("position", "orientation", "density", "contact")


class Shape:
    """A shape of a body. `position` and `orientation` place it in body coordinates."""

    kind = ""
    sizes: "tuple[str, ...]" = ()

    def __init__(self, *sizes: Any, **keys: Any) -> None:
        bound = inspect.signature(type(self)).bind(*sizes, **keys)
        self._keys: "dict[str, Any]" = {k: plain(v) for k, v in bound.arguments.items() if v is not None}

    def tree(self) -> "dict[str, Any]":
        """The shape as in the model file."""
        own = {key: self._keys[key] for key in self.sizes if key in self._keys}
        listed = self.kind not in ("mesh", "hull", "height_field", "plane")
        value: Any = list(own.values()) if listed else own["normal"] if self.kind == "plane" else own
        return {self.kind: value, **{key: self._keys[key] for key in _PLACED if key in self._keys}}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{k}={_text.flow(v)}' for k, v in self._keys.items())})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Shape) and self.tree() == other.tree()

    def __reduce__(self) -> "tuple[Any, ...]":
        return (_restore, (type(self).__name__, self._keys))

    __hash__ = None  # type: ignore[assignment]


def _sizes(entry: "dict[str, Any]") -> "list[tuple[str, bool, str]]":
    """Name, whether it is required, and meaning of the sizes of a kind."""
    for choice in entry.get("anyOf", [entry]):
        if "$ref" in choice:
            choice = _schema.definition(str(choice["$ref"]).rsplit("/", 1)[-1])
        if "properties" in choice:
            needed = choice.get("required", [])
            return [(k, k in needed, str(v.get("description", ""))) for k, v in choice["properties"].items()]
    return [("normal", True, "direction")]


def _make(kind: str) -> "type[Shape]":
    entry = _schema.definition("shape")["properties"][kind]
    sizes = _sizes(entry)
    either = inspect.Parameter.POSITIONAL_OR_KEYWORD
    empty = inspect.Parameter.empty
    parameters = [inspect.Parameter(k, either, default=empty if needed else None) for k, needed, _ in sizes]
    parameters += [inspect.Parameter(k, inspect.Parameter.KEYWORD_ONLY, default=None) for k in _PLACED]
    name = "".join(word.capitalize() for word in kind.split("_"))
    doc = str(entry["description"]) + "\n\n" + "\n".join(f"{k}: {meaning}" for k, _, meaning in sizes)
    return type(name, (Shape,), {"kind": kind, "sizes": tuple(k for k, _, _ in sizes), "__doc__": doc,
                                 "__signature__": inspect.Signature(parameters), "__module__": "polhode"})


def kinds() -> "dict[str, str]":
    """Class names of all shapes, with their kinds."""
    names = [k for k in _schema.keys("shape") if k not in _PLACED]
    return {"".join(word.capitalize() for word in k.split("_")): k for k in names}


def shape_class(name: str) -> "type[Shape]":
    """The class of a shape by its name, e.g. "Box"."""
    found = _CLASSES.get(name)
    if found is None:
        found = _CLASSES.setdefault(name, _make(kinds()[name]))
    return found


_CLASSES: "dict[str, type[Shape]]" = {}


def _restore(name: str, keys: "dict[str, Any]") -> Shape:
    return shape_class(name)(**keys)
