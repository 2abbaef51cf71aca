# SPDX-License-Identifier: Apache-2.0
"""Mechanisms without loops as a kinematic tree of Exudyn, in joint coordinates, for its explicit methods."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import (
    MarkerBodyPosition,
    MarkerKinematicTreeRigid,
    NodeGenericODE2,
    ObjectConnectorSpringDamper,
    ObjectGround,
    ObjectKinematicTree,
    SensorKinematicTree,
)
from mechanism import GROUND, Link, Mechanism, Vector, frame_with_x, minus


def turn(link: Link) -> Any:
    """Axes of the frame of a link in those of the world, at the start: its z is the axis of its joint."""
    x, y, z = np.array(frame_with_x(link.axis)).T
    return np.array([y, z, x]).T


def build_tree(mbs: Any, mechanism: Mechanism) -> dict[str, Any]:
    """Adds the tree, and returns the object and the number of the link of every body."""
    links = mechanism.links()
    frames = [turn(link) for link in links]
    count = len(links)
    node = mbs.AddNode(
        NodeGenericODE2(
            referenceCoordinates=[0.0] * count,
            initialCoordinates=[0.0] * count,
            initialCoordinates_t=[link.rate for link in links],
            numberOfODE2Coordinates=count,
        )
    )
    offsets, turns, centres, inertias, masses = [], [], [], [], []
    for link, frame in zip(links, frames, strict=True):
        parent = np.eye(3) if link.parent < 0 else frames[link.parent]
        origin = np.zeros(3) if link.parent < 0 else np.array(links[link.parent].at)
        offsets.append(parent.T @ (np.array(link.at) - origin))
        turns.append(parent.T @ frame)
        body = link.body
        masses.append(body.mass if body else 0.0)
        centres.append(frame.T @ (np.array(body.position) - np.array(link.at)) if body else np.zeros(3))
        inertias.append(frame.T @ np.array(body.inertia_in_world()) @ frame if body else np.zeros((3, 3)))
    kinds = [exu.JointType.PrismaticZ if link.slides else exu.JointType.RevoluteZ for link in links]
    tree = mbs.AddObject(
        ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=kinds,
            linkParents=[link.parent for link in links],
            jointTransformations=exu.Matrix3DList(turns),
            jointOffsets=exu.Vector3DList(offsets),
            linkInertiasCOM=exu.Matrix3DList(inertias),
            linkCOMs=exu.Vector3DList(centres),
            linkMasses=masses,
            gravity=list(mechanism.gravity),
        )
    )
    objects: dict[str, Any] = {"tree": tree, GROUND: mbs.AddObject(ObjectGround())}

    def marker(name: str, point: Vector) -> Any:
        if name == GROUND:
            return mbs.AddMarker(MarkerBodyPosition(bodyNumber=objects[GROUND], localPosition=list(point)))
        number, local = place(mechanism, name, point)
        return mbs.AddMarker(MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=number, localPosition=local))

    for spring in mechanism.springs:
        ends = [marker(name, point) for name, point in zip(spring.bodies, spring.at, strict=True)]
        mbs.AddObject(
            ObjectConnectorSpringDamper(
                markerNumbers=ends,
                referenceLength=spring.free_length,
                stiffness=spring.stiffness,
                damping=spring.damping,
            )
        )
    for i, seen in enumerate(mechanism.observed):
        number, local = place(mechanism, seen.body, seen.point)
        objects[f"seen_{i}"] = mbs.AddSensor(
            SensorKinematicTree(
                objectNumber=tree,
                linkNumber=number,
                localPosition=local,
                writeToFile=False,
                outputVariableType=exu.OutputVariableType.Position,
            )
        )
    return objects


def place(mechanism: Mechanism, body: str, point: Vector) -> tuple[int, Any]:
    """Number of a body's link, and a point in the frame of that link."""
    links = mechanism.links()
    number = next(i for i, link in enumerate(links) if link.body is not None and link.body.name == body)
    return number, turn(links[number]).T @ np.array(minus(point, links[number].at))


def read_tree(mbs: Any, mechanism: Mechanism, objects: dict[str, Any]) -> tuple[float, ...]:
    end: list[float] = []
    for i, seen in enumerate(mechanism.observed):
        found = mbs.GetSensorValues(objects[f"seen_{i}"], configuration=exu.ConfigurationType.Current)
        end += [float(found[k]) for k in seen.components]
    return tuple(end)
