# SPDX-License-Identifier: Apache-2.0
"""Values that FEBio's log file asks for, from the frames of a result: of elements, connectors, nodes and bodies."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

if TYPE_CHECKING:
    from ._result import Result

_STRESSES = ("sx", "sy", "sz", "sxy", "syz", "sxz")
_NEAR = 1e-6  # part of the extent of a mesh within which two points are one


def cleaned(name: str) -> str:
    """A name as a model file has it."""
    return re.sub("[^A-Za-z0-9_-]", "_", name)


def numbers(text: str) -> "list[int]":
    """Whole numbers of a list such as "1, 4:10:2"."""
    result: "list[int]" = []
    for part in re.split(r"[\s,]+", text.strip()):
        if part:
            ends = [int(n) for n in part.split(":")]
            step = ends[2] if len(ends) > 2 else 1
            result += range(ends[0], ends[1] + 1, step) if len(ends) > 1 else ends
    return result


def _vector(name: str, prefix: str) -> int:
    """Component of a name such as "vx" with the prefix "v"; -1 if it is none."""
    return "xyz".index(name[-1]) if name[:-1] == prefix and name[-1:] in tuple("xyz") else -1


class Frames:
    """The frames of a result, by the numbers of an FEBio file."""

    def __init__(self, result: "Result", root: Any) -> None:
        self.result, self.root = result, root
        self.times = result.time
        self._places: "dict[int, Any]" = {}
        self._elements: "dict[int, list[int]]" = {}
        self._carriers: "dict[int, str]" = {}
        self._solids = [] if "solids" not in dir(result) else [result.solids[name] for name in result.solids]

    def columns(self, kind: str, number: int, names: "list[str]") -> "Optional[list[Any]]":
        """Columns of an item over the frames; None if a value is not there."""
        read = {"element_data": self._element, "node_data": self._node, "rigid_body_data": self._body,
                "rigid_connector_data": self._connector}.get(kind)
        columns = read(number, names) if read else None
        return None if columns is None or any(column is None for column in columns) else columns

    def elements(self) -> "dict[int, list[int]]":
        """Nodes of each element."""
        if not self._elements:
            self._elements = {int(e.get("id")): numbers(e.text or "") for e in self.root.iter("elem")}
        return self._elements

    def nodes(self) -> "dict[int, Any]":
        """Position of each node at the start."""
        if not self._places:
            self._places = {int(n.get("id")): np.array([float(x) for x in (n.text or "").split(",")])
                            for n in self.root.iter("node")}
        return self._places

    @staticmethod
    def _nearest(points: Any, place: Any) -> int:
        """Number of the point at a place; -1 if there is none."""
        distances = np.linalg.norm(points - place, axis=1)
        extent = np.linalg.norm(np.ptp(points, axis=0))
        k = int(np.argmin(distances))
        return k if distances[k] <= _NEAR * extent else -1

    def _element(self, number: int, names: "list[str]") -> "Optional[list[Any]]":
        nodes = self.elements().get(number)
        if nodes is None or any(n not in self.nodes() for n in nodes):
            return None
        place = np.mean([self.nodes()[n] for n in nodes], axis=0)
        for solid in self._solids:
            offsets, connectivity = solid["elements"]["offsets"], solid["elements"]["connectivity"]
            reference = solid["nodes"]["reference"]
            sums = np.add.reduceat(reference[connectivity], offsets[:-1], axis=0)
            e = self._nearest(sums / np.diff(offsets)[:, None], place)
            if e < 0:
                continue
            own = connectivity[offsets[e]:offsets[e + 1]]
            middle = (reference + solid["nodes"]["displacement"])[:, own].mean(axis=1)
            values = {name: solid["elements"]["cauchy"][:, e, k] for k, name in enumerate(_STRESSES)}
            values.update({name: middle[:, k] for k, name in enumerate("xyz")})
            values["sed"] = solid["elements"]["strain_energy_density"][:, e]
            return [values.get(name) for name in names]
        return None

    def _node(self, number: int, names: "list[str]") -> "Optional[list[Any]]":
        place = self.nodes().get(number)
        for solid in self._solids if place is not None else ():
            nodes = solid["nodes"]
            k = self._nearest(nodes["reference"], place)
            if k < 0:
                continue
            columns: "list[Any]" = []
            for name in names:
                x, u, v = (_vector(name, prefix) for prefix in ("", "u", "v"))
                shift = nodes["reference"][k, x] if x >= 0 else 0.0
                columns.append(nodes["displacement"][:, k, max(x, u)] + shift if max(x, u) >= 0
                               else nodes["velocity"][:, k, v] if v >= 0 else None)
            return columns
        return None if place is None else self._carried(number, place, names)

    def _carried(self, number: int, place: Any, names: "list[str]") -> "Optional[list[Any]]":
        """Columns of a node of a rigid body."""
        body = self._bodies_of_nodes().get(number)
        if body is None or body not in self.result.bodies:
            return None
        motion = self.result.bodies[body]
        center, turn, spin = motion["position"], motion["orientation"], motion["angular_velocity"]
        arm = np.broadcast_to(place - center[0], center.shape)  # Bodies start along the axes of the world.
        arm = arm + 2 * np.cross(turn[:, 1:], np.cross(turn[:, 1:], arm) + turn[:, :1] * arm)
        columns: "list[Any]" = []
        for name in names:
            x, u, v = (_vector(name, prefix) for prefix in ("", "u", "v"))
            columns.append((center + arm)[:, max(x, u)] - (place[u] if u >= 0 else 0.0) if max(x, u) >= 0
                           else (motion["velocity"] + np.cross(spin, arm))[:, v] if v >= 0 else None)
        return columns

    def _bodies_of_nodes(self) -> "dict[int, str]":
        """Name of the rigid body of each node that has one."""
        if not self._carriers:
            rigid = {m.get("name") for m in self.root.iter("material") if m.get("type") == "rigid body"}
            parts = {d.get("name"): d.get("mat") for d in self.root.iter("SolidDomain") if d.get("mat") in rigid}
            for part in self.root.iter("Elements"):
                for element in part if part.get("name") in parts else ():
                    for n in numbers(element.text or ""):
                        self._carriers.setdefault(n, cleaned(parts[part.get("name")] or ""))
        return self._carriers

    def _body(self, number: int, names: "list[str]") -> "Optional[list[Any]]":
        name = next((m.get("name") for m in self.root.iter("material") if m.get("id") == str(number)), None)
        if name is None or cleaned(name) not in self.result.bodies:
            return None
        body, forces = self.result.bodies[cleaned(name)], self._forces(name, str(number))
        columns: "list[Any]" = []
        for wanted in names:
            x, u, v = (_vector(wanted, prefix) for prefix in ("", "u", "v"))
            force, moment = _vector(wanted, "F"), _vector(wanted, "M")
            if max(x, u) >= 0:
                place = body["position"][:, max(x, u)]
                columns.append(place if x >= 0 else place - place[0])
            elif v >= 0:
                columns.append(body["velocity"][:, v])
            elif max(force, moment) >= 0 and forces is not None:
                columns.append(forces[0][:, force] if force >= 0 else forces[1][:, moment])
            else:
                columns.append(None)
        return columns

    def _forces(self, name: str, number: str) -> "Optional[tuple[Any, Any]]":
        """Force and moment of a body on the solids that are bonded to it; None if something else acts on it, too."""
        ends = [(tag.text or "").strip() for kind in ("body_a", "body_b", "rbA", "rbB") for tag in self.root.iter(kind)]
        if name in ends or number in ends or self.root.find(".//contact") is not None:
            return None
        found = [solid["interfaces"][cleaned(name)] for solid in self._solids
                 if "interfaces" in solid and cleaned(name) in solid["interfaces"]]
        if not found:
            return None
        return sum(f["force"] for f in found), sum(f["moment"] for f in found)

    def _connector(self, number: int, names: "list[str]") -> "Optional[list[Any]]":
        connectors = list(self.root.iter("rigid_connector"))
        name = cleaned(connectors[number - 1].get("name") or "") if 0 < number <= len(connectors) else ""
        if not name or "joints" not in dir(self.result) or name not in self.result.joints:
            return None
        joint = self.result.joints[name]
        columns: "list[Any]" = []
        for wanted in names:
            force, moment = _vector(wanted, "RCF"), _vector(wanted, "RCM")
            # FEBio's act on the first body, those of a result on the second.
            columns.append(-joint["force"][:, force] if force >= 0 else
                           -joint["moment"][:, moment] if moment >= 0 else None)
        return columns
