# SPDX-License-Identifier: Apache-2.0
"""Results in the text format of FEBio's log file, so that files of both programs can be compared."""

from __future__ import annotations

import os
import re
import warnings
import xml.etree.ElementTree as ElementTree
from typing import TYPE_CHECKING, Any, Optional, Union

if TYPE_CHECKING:
    from ._result import Result, Table

# FEBio's names of values that columns of a probe have under other names.
_COLUMNS = {"omx": "wx", "omy": "wy", "omz": "wz", "alx": "alphax", "aly": "alphay", "alz": "alphaz",
            "thx": "thetax", "thy": "thetay", "thz": "thetaz"}
_DIGITS = 6  # of C's "%lg", which FEBio uses


def _numbers(text: str) -> "list[int]":
    """Whole numbers of a list such as "1, 4:10:2"."""
    numbers: "list[int]" = []
    for part in re.split(r"[\s,]+", text.strip()):
        if part:
            ends = [int(n) for n in part.split(":")]
            step = ends[2] if len(ends) > 2 else 1
            numbers += range(ends[0], ends[1] + 1, step) if len(ends) > 1 else ends
    return numbers


def _tables(result: "Result", wanted: str) -> "list[Table]":
    """The probes that requests became: of its name, or of one with a number if the name was taken; shortest first."""
    names = [name for name in result.probes if name == wanted or re.fullmatch(re.escape(wanted) + r"_\d+", name)]
    return [result.probes[name] for name in sorted(names, key=lambda name: (len(name), name))]


def _items(kind: str, request: Any, root: Any) -> "list[tuple[int, str]]":
    """Number of each item of a request, with the name of its probe."""
    numbers = _numbers(request.text or "")
    if kind == "rigid_body_data":
        rigid = {int(m.get("id")): m.get("name") for m in root.iter("material") if m.get("type") == "rigid body"}
        return [(n, re.sub("[^A-Za-z0-9_-]", "_", rigid.get(n) or "")) for n in numbers or sorted(rigid)]
    name = request.get("node_set")
    for nodes in root.iter("NodeSet"):
        if name and nodes.get("name") == name:
            numbers = _numbers(nodes.text or "") or [int(n.get("id")) for n in nodes]
    return [(n, f"node_{n}") for n in numbers]


def _column(table: "Table", name: str) -> Any:
    column = _COLUMNS.get(name, name)
    if column in table:
        return table[column]
    # The displacement of a node of a rigid body.
    if name in ("ux", "uy", "uz") and name[1] in table:
        return table[name[1]] - table[name[1]][0]
    return None


def _columns(number: int, tables: "list[Table]", names: "list[str]") -> "Optional[tuple[int, Table, list[Any]]]":
    """The columns of the first table that has all of them."""
    for table in tables:
        columns = [_column(table, name) for name in names]
        if all(column is not None for column in columns):
            return number, table, columns
    return None


def write_febio_log(result: "Result", model: "Union[str, os.PathLike[str]]",
                    folder: "Union[str, os.PathLike[str]]" = ".") -> "list[str]":
    """Writes the requests of an FEBio file's <logfile> for rigid_body_data and node_data as FEBio does.

    Each becomes a text file in a folder that exists, with a block of rows for every record after the start. Returns the
    paths. The result is that of a run of this file, whose requests became probes. A request without a file's name is
    called after the model, its kind and its number. What cannot be written, such as stresses of elements, is a warning
    that names it. Raises ValueError for what is no FEBio file, OSError if a file cannot be read or written.
    """
    with open(model, encoding="latin-1") as file:
        text = file.read()
    root = None if "<!" in text.replace("<!--", "") else ElementTree.fromstring(re.sub(r"^\s*<\?xml.*?\?>", "", text))
    if root is None or root.tag != "febio_spec":
        raise ValueError(f"{os.fspath(model)} is no FEBio file, which starts with <febio_spec>")
    stem = os.path.splitext(os.path.basename(os.fspath(model)))[0]
    paths = []
    for number, request in enumerate((r for log in root.iter("logfile") for r in log), 1):
        kind, data = request.tag, request.get("data") or ""
        names = [name.strip() for name in data.split(";")]
        lines = []
        if kind in ("rigid_body_data", "node_data"):
            items = _items(kind, request, root)
            columns = [found for n, probe in items for found in [_columns(n, _tables(result, probe), names)] if found]
            complete = len(columns) == len(items)
            if columns and complete:
                lines = _lines(columns, request.get("name") or data, request.get("delim") or " ")
        if not lines:
            warnings.warn(f"<{kind} data=\"{data}\"> is not written: no probe has it", stacklevel=2)
            continue
        path = os.path.join(os.fspath(folder), os.path.basename(request.get("file") or f"{stem}_{kind}_{number}.txt"))
        with open(path, "w", encoding="ascii", errors="replace") as file:
            file.write("\n".join([*lines, ""]))
        paths.append(path)
    return paths


def _lines(columns: Any, title: str, delimiter: str) -> "list[str]":
    lines = []
    for step, time in enumerate(columns[0][1].t):
        if step == 0:
            continue
        lines += [f"*Step  = {step}", f"*Time  = {time:.9g}", f"*Data  = {title}"]
        lines += [delimiter.join([str(n), *(f"{values[step]:.{_DIGITS}g}" for values in list_)])
                  for n, _, list_ in columns]
    return lines
