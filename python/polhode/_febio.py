# SPDX-License-Identifier: Apache-2.0
"""Results in the text format of FEBio's log file, so that files of both programs can be compared."""

from __future__ import annotations

import os
import re
import warnings
import xml.etree.ElementTree as ElementTree
from typing import TYPE_CHECKING, Any, Optional, Union

from ._febio_frames import Frames, cleaned, numbers

if TYPE_CHECKING:
    from ._result import Result, Table

# FEBio's names of values that columns of a probe have under other names.
_COLUMNS = {"omx": "wx", "omy": "wy", "omz": "wz", "alx": "alphax", "aly": "alphay", "alz": "alphaz",
            "thx": "thetax", "thy": "thetay", "thz": "thetaz"}
_DIGITS = 6  # of C's "%lg", which FEBio uses


def _tables(result: "Result", wanted: str) -> "list[Table]":
    """The probes that requests became: of its name, or of one with a number if the name was taken; shortest first."""
    names = [name for name in result.probes if name == wanted or re.fullmatch(re.escape(wanted) + r"_\d+", name)]
    return [result.probes[name] for name in sorted(names, key=lambda name: (len(name), name))]


def _items(kind: str, request: Any, frames: Frames) -> "list[tuple[int, str]]":
    """Number of each item of a request, with the name of its probe."""
    wanted, root = numbers(request.text or ""), frames.root
    if kind == "rigid_body_data":
        rigid = {int(m.get("id")): m.get("name") for m in root.iter("material") if m.get("type") == "rigid body"}
        return [(n, cleaned(rigid.get(n) or "")) for n in wanted or sorted(rigid)]
    if kind == "rigid_connector_data":
        return [(n, "") for n in wanted or range(1, 1 + len(list(root.iter("rigid_connector"))))]
    if kind == "element_data":
        return [(n, "") for n in wanted or sorted(frames.elements())]
    name = request.get("node_set")
    for nodes in root.iter("NodeSet"):
        if name and nodes.get("name") == name:
            wanted = numbers(nodes.text or "") or [int(n.get("id")) for n in nodes]
    return [(n, f"node_{n}") for n in wanted or sorted(frames.nodes())]


def _column(table: "Table", name: str) -> Any:
    column = _COLUMNS.get(name, name)
    if column in table:
        return table[column]
    # The displacement of a node of a rigid body.
    if name in ("ux", "uy", "uz") and name[1] in table:
        return table[name[1]] - table[name[1]][0]
    return None


def _columns(tables: "list[Table]", names: "list[str]") -> "Optional[tuple[Any, list[Any]]]":
    """Times and columns of the first table that has all of them."""
    for table in tables:
        columns = [_column(table, name) for name in names]
        if all(column is not None for column in columns):
            return table.t, columns
    return None


def _rows(result: "Result", frames: Frames, kind: str, request: Any,
          names: "list[str]") -> "Optional[tuple[Any, list[tuple[int, list[Any]]]]]":
    """Times, and the number and the columns of each item: from probes, else from frames; None if some are missing."""
    items = _items(kind, request, frames)
    probes = [_columns(_tables(result, probe), names) for _, probe in items if probe]
    if items and len(probes) == len(items) and all(found is not None for found in probes):
        return probes[0][0], [(n, found[1]) for (n, _), found in zip(items, probes) if found]  # type: ignore[index]
    rows = []
    for n, _ in items:
        columns = frames.columns(kind, n, names)
        if columns is None:
            return None
        rows.append((n, columns))
    return (frames.times, rows) if rows else None


def write_febio_log(result: "Result", model: "Union[str, os.PathLike[str]]",
                    folder: "Union[str, os.PathLike[str]]" = ".") -> "list[str]":
    """Writes the requests of an FEBio file's <logfile> for bodies, connectors, nodes and elements as FEBio does.

    Each becomes a text file in a folder that exists, with a block of rows for every record after the start. Returns the
    paths. The result is that of a run of this file. What became probes has a record for every step, stresses of
    elements and forces for every frame. A request without a file's name is called after the model, its kind and its
    number. What cannot be written, such as reactions of single nodes, is a warning that names it. Raises ValueError for
    what is no FEBio file, OSError if a file cannot be read or written.
    """
    with open(model, encoding="latin-1") as file:
        text = file.read()
    root = None if "<!" in text.replace("<!--", "") else ElementTree.fromstring(re.sub(r"^\s*<\?xml.*?\?>", "", text))
    if root is None or root.tag != "febio_spec":
        raise ValueError(f"{os.fspath(model)} is no FEBio file, which starts with <febio_spec>")
    stem = os.path.splitext(os.path.basename(os.fspath(model)))[0]
    frames, paths = Frames(result, root), []
    for number, request in enumerate((r for log in root.iter("logfile") for r in log), 1):
        kind, data = request.tag, request.get("data") or ""
        names = [name.strip() for name in data.split(";")]
        known = kind in ("rigid_body_data", "rigid_connector_data", "node_data", "element_data")
        found = _rows(result, frames, kind, request, names) if known else None
        if found is None:
            warnings.warn(f"<{kind} data=\"{data}\"> is not written: the result does not have it", stacklevel=2)
            continue
        lines = _lines(*found, request.get("name") or data, request.get("delim") or " ")
        path = os.path.join(os.fspath(folder), os.path.basename(request.get("file") or f"{stem}_{kind}_{number}.txt"))
        with open(path, "w", encoding="ascii", errors="replace") as file:
            file.write("\n".join([*lines, ""]))
        paths.append(path)
    return paths


def _lines(times: Any, rows: "list[tuple[int, list[Any]]]", title: str, delimiter: str) -> "list[str]":
    lines = []
    for step, time in enumerate(times):
        if step == 0:
            continue
        lines += [f"*Step  = {step}", f"*Time  = {time:.9g}", f"*Data  = {title}"]
        lines += [delimiter.join([str(n), *(f"{values[step]:.{_DIGITS}g}" for values in columns)])
                  for n, columns in rows]
    return lines
