# SPDX-License-Identifier: Apache-2.0
"""Handles on the tree of a model, such as `m.bodies["upper"]`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from typing import Any, Optional

from . import _native, _schema, _text
from ._errors import fault


def plain(value: Any) -> Any:
    """A value in the form of the tree: numbers, texts, lists and dicts.

    NumPy arrays become lists, a body, joint or material its name, a shape its map. Callables are
    unchanged: they may be functions of a load.
    """
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, Section):
        return value.name if value.name is not None else plain(dict(value))
    if hasattr(value, "tree"):
        return value.tree()
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (int, float)):
        return int(value) if isinstance(value, int) else float(value)
    if hasattr(value, "tolist"):  # NumPy arrays and scalars
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if callable(value):
        return value
    raise TypeError(f"A model contains numbers, texts, lists and maps, not {type(value).__name__}. Convert the value.")


def counted(count: int, things: str) -> str:
    """ "1 body", "2 bodies"."""
    one = things[:-3] + "y" if things.endswith("ies") else things[:-1]
    return f"{count} {one if count == 1 and things.endswith('s') else things}"


class Section(MutableMapping):  # type: ignore[type-arg]
    """A map of the model with known keys: read and set them as attributes or items.

    A missing key is None; setting None removes a key. Keys are those of the model file;
    `help_keys()` returns their meaning. Unknown keys raise ModelError.
    """

    __slots__ = ("_parent", "_key", "_table", "name")

    def __init__(self, parent: Any, key: str, table: Optional[str], name: Optional[str] = None) -> None:
        for slot, value in (("_parent", parent), ("_key", key), ("_table", table), ("name", name)):
            object.__setattr__(self, slot, value)

    # The tree itself

    def _tree(self, create: bool = False) -> "dict[str, Any]":
        above = self._parent._tree(create)
        if create and not isinstance(above.get(self._key), dict):
            above[self._key] = {}
        found = above.get(self._key)
        return found if isinstance(found, dict) else {}

    def _path(self) -> str:
        above = self._parent._path()
        return f"{above}.{self._key}" if above else self._key

    def _kind(self) -> Optional[str]:
        return self._table and _schema.kind_table(self._table, self._tree())

    def _known(self) -> "dict[str, str]":
        kind = self._kind()
        return _schema.keys(kind) if kind else {}

    def _check(self, key: str) -> None:
        known = self._known()
        if not known or key in known:
            return
        near = _native.closest(key, list(known))
        hint = (f"Did you mean '{near}'? " if near else "") + "Keys: " + ", ".join(known)
        raise fault(f"{self._path()}.{key}".lstrip("."), f"unknown key '{key}'", hint)

    def _wrap(self, key: str, value: Any) -> Any:
        kind = self._kind()
        item = kind is not None and _schema.named_of(kind, key)
        if item:
            return Named(self, key, item)
        section = kind is not None and _schema.section_of(kind, key)
        if section:
            return Section(self, key, section)
        return Section(self, key, None) if isinstance(value, dict) else value

    # Mapping

    def __getitem__(self, key: str) -> Any:
        return self._wrap(key, self._tree()[key])

    def __setitem__(self, key: str, value: Any) -> None:
        self._check(key)
        if value is None:
            self._tree().pop(key, None)
        else:
            self._tree(create=True)[key] = plain(value)

    def __delitem__(self, key: str) -> None:
        del self._tree()[key]

    def __iter__(self) -> "Iterator[str]":
        return iter(self._tree())

    def __len__(self) -> int:
        return len(self._tree())

    # Attributes

    def __getattr__(self, key: str) -> Any:
        if key.startswith("__"):
            raise AttributeError(key)
        tree = self._tree()
        if key in tree or self._known():
            self._check(key)
            return self._wrap(key, tree.get(key))
        raise AttributeError(key)

    def __setattr__(self, key: str, value: Any) -> None:
        self[key] = value

    def __delattr__(self, key: str) -> None:
        del self[key]

    def __dir__(self) -> "list[str]":
        return sorted({*self._known(), *self._tree(), "keys", "items", "update", "help_keys"})

    def _ipython_key_completions_(self) -> "list[str]":
        return list(self._tree())

    def help_keys(self) -> str:
        """Keys and their meanings, one per line."""
        return "\n".join(f"{key}: {meaning}" for key, meaning in self._known().items())

    def __repr__(self) -> str:
        what = (self._table or "map").replace("_", " ")
        called = f" '{self.name}'" if self.name is not None else ""
        return f"<{what}{called} {_text.flow(self._tree())}>"


class Named(Section):
    """Objects of a model by name: bodies, joints, loads."""

    __slots__ = ()

    def _known(self) -> "dict[str, str]":
        return {}

    def _wrap(self, key: str, value: Any) -> Any:
        return Section(self, key, self._table, key)

    def __getitem__(self, key: str) -> Section:
        if key not in self._tree():
            near = _native.closest(str(key), list(self._tree()))
            names = ", ".join(list(self._tree())[:20]) or "none"
            hint = f" Did you mean '{near}'?" if near else f" There are: {names}."
            raise KeyError(f"{self._path()}: unknown name '{key}'.{hint}")
        return Section(self, key, self._table, key)

    def __setitem__(self, key: str, value: Any) -> None:
        if isinstance(value, Section):
            value = dict(value)
        self._tree(create=True)[key] = plain(value)

    def add(self, name: str, **fields: Any) -> Section:
        """Adds an object under a new name and returns it; fields are the keys of the model file. Raises
        ModelError for an unknown key or a name that exists already."""
        if name in self._tree():
            raise fault(f"{self._path()}.{name}", f"the name '{name}' is taken", "Choose another name")
        entry = Section(self, name, self._table, name)
        kept = {key: plain(value) for key, value in fields.items() if value is not None}
        self._tree(create=True)[name] = kept
        try:
            for key in kept:
                entry._check(key)
        except ValueError:
            del self._tree()[name]
            raise
        return entry

    def __getattr__(self, key: str) -> Any:
        raise AttributeError(f"{key}: use names as items, {self._key}[\"{key}\"]")

    def __setattr__(self, key: str, value: Any) -> None:
        raise AttributeError(f"{key}: use names as items, {self._key}[\"{key}\"]")

    def __dir__(self) -> "list[str]":
        return ["add", "keys", "values", "items"]

    def __repr__(self) -> str:
        return f"<{self._key}: {', '.join(self._tree()) or 'none'}>"
