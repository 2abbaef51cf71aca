# SPDX-License-Identifier: Apache-2.0
"""The keys of the model file, from the engine's tables."""

from __future__ import annotations

import functools
import json
from typing import Any, Optional

from . import _native


@functools.lru_cache(maxsize=None)
def schema() -> "dict[str, Any]":
    """JSON Schema of the model file."""
    return dict(json.loads(_native.schema_text()))


def definition(name: str) -> "dict[str, Any]":
    """The table of that name: "body", "joint_revolute"; "" is the whole model."""
    return schema() if not name else dict(schema()["$defs"][name])


def _reference(entry: "dict[str, Any]") -> Optional[str]:
    """Name of the table that an entry refers to, if it is a map with keys of its own."""
    reference = str(entry.get("$ref", "")).rsplit("/", 1)[-1]
    return reference if reference not in ("", "#") and "properties" in definition(reference) else None


def section_of(table: str, key: str) -> Optional[str]:
    """Table of the map under a key, e.g. "analysis" of the model."""
    entry = definition(table).get("properties", {}).get(key, {})
    return _reference(entry)


def named_of(table: str, key: str) -> Optional[str]:
    """Table of the named objects under a key, e.g. "body" of the model's bodies."""
    more = definition(table).get("properties", {}).get(key, {}).get("additionalProperties")
    if not isinstance(more, dict):
        return None
    reference = str(more.get("$ref", "")).rsplit("/", 1)[-1]
    known = definition(reference) if reference in schema()["$defs"] else {}
    is_table = "properties" in known or any(k in known for k in ("anyOf", "oneOf", "allOf"))
    return reference if is_table else None


def kind_table(table: str, entry: "dict[str, Any]") -> str:
    """Table of an object with its kind: "joint_revolute" for a joint of type revolute."""
    for choice in definition(table).get("oneOf", []):
        name = str(choice.get("$ref", "")).rsplit("/", 1)[-1]
        fixed = {k: v["enum"][0] for k, v in definition(name)["properties"].items() if len(v.get("enum", ())) == 1}
        if fixed and all(entry.get(k) == v for k, v in fixed.items()):
            return name
    return table


def keys(table: str) -> "dict[str, str]":
    """Keys of a table with their meanings."""
    properties = definition(table).get("properties", {})
    return {key: str(entry.get("description", "")) for key, entry in properties.items()}
