# SPDX-License-Identifier: Apache-2.0
"""Exudyn: redundant coordinates with joints as constraints, and trees in joint coordinates for explicit methods."""

from __future__ import annotations

import math
import sys
from typing import Any

sys.exudynFast = True  # type: ignore[attr-defined]  # without checks of ranges, as recommended for speed
import exudyn as exu  # noqa: E402
import numpy as np  # noqa: E402
from exudyn.utilities import (  # noqa: E402
    MarkerBodyPosition,
    MarkerBodyRigid,
    ObjectGround,
    ObjectJointGeneric,
    ObjectJointRevolute2D,
    RigidBodyInertia,
)
from exudyn_tree import build_tree, read_tree  # noqa: E402
from mechanism import GROUND, Joint, Mechanism, Vector, cross, frame_with_x, minus, transposed  # noqa: E402
from program import Method, Outcome, explicit_steps, halved, steps_of, timed  # noqa: E402

ALPHA, TRAPEZOIDAL = "generalised-alpha, rho_inf = 0.9", "trapezoidal, index 2"
RK = "RK67 on a kinematic tree"
# Locked rotations of each joint about its own axes, whose first is the axis of the joint.
LOCKED = {"revolute": (1, 1, 1, 0, 1, 1), "prismatic": (0, 1, 1, 1, 1, 1), "spherical": (1, 1, 1, 0, 0, 0)}


def as_tree(mechanism: Mechanism) -> bool:
    """Whether a kinematic tree can express a mechanism for explicit methods."""
    return not any(joint.closes or joint.kind == "spherical" for joint in mechanism.joints)


class Exudyn:
    name = "Exudyn"

    def version(self) -> str:
        return str(exu.__version__)

    def absent(self, mechanism: Mechanism) -> str:
        return ""

    def remarks(self, mechanism: Mechanism) -> str:
        told = "planar bodies and joints" if mechanism.planar else "Euler parameters"
        if mechanism.loops():
            return told + "; explicit methods have no loops"
        if not as_tree(mechanism):
            return (
                told + "; a kinematic tree has no ball joint, and the top passes the singular position of three hinges"
            )
        return told

    def methods(self, mechanism: Mechanism) -> tuple[Method, ...]:
        first = mechanism.duration / (100.0 if mechanism.duration < 0.1 else 400.0)
        found = [Method(name, "step", halved(first, 14)) for name in (ALPHA, TRAPEZOIDAL)]
        if as_tree(mechanism):
            found.append(Method(RK, "step", explicit_steps(mechanism.duration, mechanism.dissipates(), 10)))
        return tuple(found)

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome:
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        explicit = method.name == RK
        bodies = build_tree(mbs, mechanism) if explicit else build(mbs, mechanism)
        mbs.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = mechanism.duration
        steps = steps_of(mechanism.duration, value)
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.minimumStepSize = mechanism.duration / steps / 64.0
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.newton.useModifiedNewton = True
        settings.solutionSettings.writeSolutionToFile = False
        settings.displayStatistics = settings.displayComputationTime = False
        settings.parallel.numberOfThreads = 1
        large = len(mechanism.bodies) > 8
        settings.linearSolver.solverType = (
            exu.LinearSolverType.EigenSparse if large else exu.LinearSolverType.EigenDense
        )
        alpha = settings.timeIntegration.generalizedAlpha
        if method.name == TRAPEZOIDAL:
            alpha.useIndex2Constraints = alpha.useNewmark = True
            alpha.spectralRadius = 1.0
        else:
            alpha.spectralRadius = 0.9
        solver = exu.MainSolverExplicit() if explicit else exu.MainSolverImplicitSecondOrder()
        if explicit:
            settings.timeIntegration.solverType = exu.DynamicSolverType.RK67
            settings.timeIntegration.automaticStepSize = False
        failed: list[str] = []

        def solve() -> None:
            try:
                if not solver.SolveSystem(mbs, settings):
                    failed.append("the solver gave up")
            except Exception as error:  # Exudyn raises exceptions of many kinds
                failed.append(str(error).strip().splitlines()[-1][:200])

        cpu = timed(solve)
        if failed:
            raise RuntimeError(failed[0])
        end = read_tree(mbs, mechanism, bodies) if explicit else read(mbs, mechanism, bodies)
        if not all(math.isfinite(x) for x in end):
            raise RuntimeError("the motion became unstable")
        return Outcome(end, cpu, steps)


def build(mbs: Any, mechanism: Mechanism) -> dict[str, Any]:
    """Adds bodies, joints and loads; bodies have the axes of the world at the start."""
    objects: dict[str, Any] = {GROUND: mbs.AddObject(ObjectGround())}
    for body in mechanism.bodies:
        objects[body.name] = mbs.CreateRigidBody(
            name=body.name,
            inertia=RigidBodyInertia(body.mass, np.array(body.inertia_in_world())),
            referencePosition=list(body.position),
            initialVelocity=list(body.velocity),
            initialAngularVelocity=list(body.angular_velocity),
            gravity=list(mechanism.gravity),
            nodeType=exu.NodeType.RotationEulerParameters,
            create2D=mechanism.planar,
        )

    def local(body: str, point: Vector) -> list[float]:
        return list(point if body == GROUND else minus(point, mechanism.body(body).position))

    for joint in mechanism.joints:
        ends = (joint.parent, joint.child)
        if mechanism.planar:
            markers = [
                mbs.AddMarker(MarkerBodyPosition(bodyNumber=objects[b], localPosition=local(b, joint.at))) for b in ends
            ]
            mbs.AddObject(ObjectJointRevolute2D(markerNumbers=markers))
        else:
            markers = [
                mbs.AddMarker(MarkerBodyRigid(bodyNumber=objects[b], localPosition=local(b, joint.at))) for b in ends
            ]
            add_joint(mbs, joint, markers)
    for spring in mechanism.springs:
        mbs.CreateSpringDamper(
            itemNumbers=[objects[b] for b in spring.bodies],
            localPosition0=local(spring.bodies[0], spring.at[0]),
            localPosition1=local(spring.bodies[1], spring.at[1]),
            referenceLength=spring.free_length,
            stiffness=spring.stiffness,
            damping=spring.damping,
        )
    for moment in mechanism.moments:
        mbs.CreateTorque(bodyNumber=objects[moment.body], loadVector=list(moment.moment), bodyFixed=False)
    return objects


def add_joint(mbs: Any, joint: Joint, markers: list[Any]) -> None:
    """A generic joint with its first axis along that of the joint."""
    if joint.kind == "universal":
        # The axes of a cross: x of the first body stays at a right angle to y of the second.
        first, second = joint.axes
        axes = np.array(transposed((first, second, cross(first, second))))
        locked = (1, 1, 1, 0, 0, 1)
    else:
        axes = np.array(frame_with_x(joint.axes[0] if joint.axes else (1.0, 0.0, 0.0)))
        locked = LOCKED[joint.kind]
    mbs.AddObject(
        ObjectJointGeneric(
            markerNumbers=markers, constrainedAxes=list(locked), rotationMarker0=axes, rotationMarker1=axes
        )
    )


def read(mbs: Any, mechanism: Mechanism, objects: dict[str, Any]) -> tuple[float, ...]:
    end: list[float] = []

    def angle(body: str) -> float:
        if body == GROUND:
            return 0.0
        node = mbs.GetObject(objects[body])["nodeNumber"]
        return float(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates)[2])

    for seen in mechanism.observed:
        if seen.joint:
            joint = next(j for j in mechanism.joints if j.name == seen.joint)
            end.append(angle(joint.child) - angle(joint.parent) + seen.offset)
        else:
            place = mbs.GetObjectOutputBody(
                objects[seen.body],
                exu.OutputVariableType.Position,
                localPosition=list(minus(seen.point, mechanism.body(seen.body).position)),
            )
            end += [float(place[k]) for k in seen.components]
    return tuple(end)
