# SPDX-License-Identifier: Apache-2.0
"""Trees of a model as YAML text, which is read back to the same tree."""

from __future__ import annotations

import json
import re
from typing import Any

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_./*^ +-]*[A-Za-z0-9_)]|[A-Za-z_]")
_NUMBER_WITH_UNIT = re.compile(r"[+-]?[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)? [A-Za-z%][A-Za-z0-9/*^ -]*[A-Za-z0-9]?")
_KEY = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*")
_WORDS = {"true", "false", "null", "inf", "nan"}
_WIDTH = 100


class Written(str):
    """A value as it stands on the command line: a number, a text, or a map or list in YAML."""

    __slots__ = ()


def scalar(value: Any) -> str:
    """A number, text or boolean as in a model file."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if callable(value):
        return repr(value)
    text = str(value)
    plain = _PLAIN.fullmatch(text) or _NUMBER_WITH_UNIT.fullmatch(text)
    return text if plain and text.lower() not in _WORDS else json.dumps(text, ensure_ascii=False)


def key(name: str) -> str:
    return name if _KEY.fullmatch(name) and name.lower() not in _WORDS else json.dumps(name, ensure_ascii=False)


def flow(tree: Any) -> str:
    """A tree on one line: {position: [0, 0, 1], mass: 2}."""
    if isinstance(tree, dict):
        return "{" + ", ".join(f"{key(k)}: {flow(v)}" for k, v in tree.items()) + "}"
    if isinstance(tree, list):
        return "[" + ", ".join(flow(v) for v in tree) + "]"
    if isinstance(tree, Written):
        return str(tree)
    return scalar(tree)


def block(tree: "dict[str, Any]", indent: str = "") -> str:
    """A map as lines; short values are on one line."""
    text = ""
    for name, value in tree.items():
        line = f"{indent}{key(name)}: {flow(value)}"
        nested = isinstance(value, dict) and value and (not indent or len(line) > _WIDTH)
        if nested and (len(line) > _WIDTH or any(isinstance(v, dict) for v in value.values())):
            text += f"{indent}{key(name)}:\n" + block(value, indent + "  ")
        else:
            text += line + "\n"
    return text
