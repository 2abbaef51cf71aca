# SPDX-License-Identifier: Apache-2.0
"""Pinocchio: accelerations in joint coordinates, in the classical Runge-Kutta method of this file.

Pinocchio has no integrator of its own. Its functions are called from Python, four times a step: for small mechanisms
most of the time is that of the calls.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pinocchio as pin
from mechanism import GROUND, Joint, Mechanism, Vector, minus
from program import Method, Outcome, explicit_steps, steps_of, timed

RK4 = "RK4 in Python"


class Pinocchio:
    name = "Pinocchio"

    def version(self) -> str:
        return str(pin.__version__)

    def absent(self, mechanism: Mechanism) -> str:
        return ""

    def remarks(self, mechanism: Mechanism) -> str:
        return (
            "loops by its constraint dynamics with feedback" if mechanism.loops() else "its articulated-body algorithm"
        )

    def methods(self, mechanism: Mechanism) -> tuple[Method, ...]:
        return (Method(RK4, "step", explicit_steps(mechanism.duration, mechanism.dissipates(), 10)),)

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome:
        steps = steps_of(mechanism.duration, value)
        h = mechanism.duration / steps
        motion = Motion(mechanism, h)
        q, v = motion.start()

        def work() -> None:
            nonlocal q, v
            for _ in range(steps):
                q, v = motion.step(q, v, h)

        cpu = timed(work)
        end = motion.observe(q)
        if not all(math.isfinite(x) for x in end):
            raise RuntimeError("the motion became unstable")
        return Outcome(end, cpu, steps)


class Motion:
    """A mechanism in Pinocchio's terms. Frames of joints are parallel to the world's at the start."""

    def __init__(self, mechanism: Mechanism, step: float) -> None:
        self.mechanism = mechanism
        self.model = pin.Model()
        self.model.gravity.linear = np.array(mechanism.gravity)
        self.ids: dict[str, int] = {GROUND: 0}
        self.origins: dict[str, Vector] = {GROUND: (0.0, 0.0, 0.0)}
        for body in mechanism.bodies:
            joint = mechanism.joint_of(body.name)
            place = pin.SE3(np.eye(3), np.array(minus(joint.at, self.origins[joint.parent])))
            self.ids[body.name] = self.model.addJoint(self.ids[joint.parent], joint_model(joint), place, joint.name)
            self.origins[body.name] = joint.at
            self.model.appendBodyToJoint(
                self.ids[body.name],
                pin.Inertia(body.mass, np.array(minus(body.position, joint.at)), np.array(body.inertia_in_world())),
                pin.SE3.Identity(),
            )
        self.data = self.model.createData()
        self.flat = self.model.nq == self.model.nv
        self.forces = pin.StdVec_Force()
        self.forced = bool(mechanism.springs or mechanism.moments)
        for _ in range(self.model.njoints):
            self.forces.append(pin.Force.Zero())
        self.constraints = pin.StdVec_RigidConstraintModel()
        for joint in mechanism.loops():
            a, b = joint.parent, joint.child
            constraint = pin.RigidConstraintModel(
                pin.ContactType.CONTACT_3D,
                self.model,
                self.ids[a],
                pin.SE3(np.eye(3), np.array(minus(joint.at, self.origins[a]))),
                self.ids[b],
                pin.SE3(np.eye(3), np.array(minus(joint.at, self.origins[b]))),
                pin.ReferenceFrame.LOCAL,
            )
            # Feedback whose time constant is ten steps: drift is removed at the order of the method.
            feedback = pin.BaumgarteCorrectorParameters((0.1 / step) ** 2, 2.0 * 0.1 / step)
            constraint.setBaumgarteCorrectorParameters(feedback)
            self.constraints.append(constraint)
        self.looped = len(self.constraints) > 0
        if self.looped:
            self.constraint_data = pin.StdVec_RigidConstraintData()
            for constraint in self.constraints:
                self.constraint_data.append(constraint.createData())
            pin.initConstraintDynamics(self.model, self.data, self.constraints, self.constraint_data)
            self.proximal = pin.ProximalSettings(1e-12, 1e-10, 10)
        self.no_moment = np.zeros(self.model.nv)

    def start(self) -> tuple[Any, Any]:
        v = np.zeros(self.model.nv)
        for joint in self.mechanism.joints:
            if not joint.closes:
                rates = self.mechanism.rates(joint)
                first = self.model.joints[self.ids[joint.child]].idx_v
                v[first : first + len(rates)] = rates
        return pin.neutral(self.model), v

    def acceleration(self, q: Any, v: Any) -> Any:
        if self.forced:
            self.apply(q, v)
        if self.looped:
            if self.forced:
                tau = pin.rnea(self.model, self.data, q, v, self.no_moment)
                tau = tau - pin.rnea(self.model, self.data, q, v, self.no_moment, self.forces)
            else:
                tau = self.no_moment
            return pin.constraintDynamics(
                self.model, self.data, q, v, tau, self.constraints, self.constraint_data, self.proximal
            ).copy()
        if self.forced:
            return pin.aba(self.model, self.data, q, v, self.no_moment, self.forces).copy()
        return pin.aba(self.model, self.data, q, v, self.no_moment).copy()

    def step(self, q: Any, v: Any, h: float) -> tuple[Any, Any]:
        """The classical method, for rotations in coordinates about the start of the step."""
        go, rates = pin.integrate, self.rates
        a1 = self.acceleration(q, v)
        u1 = 0.5 * h * v
        v2 = v + 0.5 * h * a1
        a2 = self.acceleration(go(self.model, q, u1), v2)
        r2 = rates(q, u1, v2)
        u2 = 0.5 * h * r2
        v3 = v + 0.5 * h * a2
        a3 = self.acceleration(go(self.model, q, u2), v3)
        r3 = rates(q, u2, v3)
        u3 = h * r3
        v4 = v + h * a3
        a4 = self.acceleration(go(self.model, q, u3), v4)
        way = h / 6.0 * (v + 2.0 * r2 + 2.0 * r3 + rates(q, u3, v4))
        return go(self.model, q, way), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)

    def rates(self, q: Any, way: Any, v: Any) -> Any:
        """Rates of the way from the start of a step; velocities themselves where all joints have one coordinate."""
        if self.flat:
            return v
        return np.linalg.solve(pin.dIntegrate(self.model, q, way, pin.ArgumentPosition.ARG1), v)

    def apply(self, q: Any, v: Any) -> None:
        """Forces of springs, dampers and moments on the joints' frames."""
        pin.forwardKinematics(self.model, self.data, q, v)
        total = np.zeros((self.model.njoints, 6))
        for spring in self.mechanism.springs:
            ends = [self.point(b, p) for b, p in zip(spring.bodies, spring.at, strict=True)]
            line = ends[1][0] - ends[0][0]
            length = math.sqrt(float(line @ line))
            n = line / length
            size = spring.stiffness * (length - spring.free_length) + spring.damping * float(
                n @ (ends[1][1] - ends[0][1])
            )
            for sign, name, (place, _) in zip((1.0, -1.0), spring.bodies, ends, strict=True):
                force = sign * size * n
                total[self.ids[name]] += np.concatenate((force, np.cross(place, force)))
        for moment in self.mechanism.moments:
            total[self.ids[moment.body]][3:] += moment.moment
        for i in range(1, self.model.njoints):
            self.forces[i] = self.data.oMi[i].actInv(pin.Force(total[i]))

    def point(self, body: str, point: Vector) -> tuple[Any, Any]:
        """Place and velocity of a point, after the kinematics."""
        arm = np.array(minus(point, self.origins[body]))
        if body == GROUND:
            return arm, np.zeros(3)
        frame = self.data.oMi[self.ids[body]]
        spatial = self.data.v[self.ids[body]]
        velocity = frame.rotation @ (spatial.linear + np.cross(spatial.angular, arm))
        return frame.translation + frame.rotation @ arm, velocity

    def observe(self, q: Any) -> tuple[float, ...]:
        pin.forwardKinematics(self.model, self.data, q)
        end: list[float] = []
        for seen in self.mechanism.observed:
            if seen.joint:
                child = next(j.child for j in self.mechanism.joints if j.name == seen.joint)
                end.append(float(q[self.model.joints[self.ids[child]].idx_q]) + seen.offset)
            else:
                arm = np.array(minus(seen.point, self.origins[seen.body]))
                frame = self.data.oMi[self.ids[seen.body]]
                place = frame.translation + frame.rotation @ arm
                end += [float(place[k]) for k in seen.components]
        return tuple(end)


def joint_model(joint: Joint) -> Any:
    if joint.kind == "spherical":
        return pin.JointModelSpherical()
    if joint.kind == "universal":
        return pin.JointModelUniversal(np.array(joint.axes[0]), np.array(joint.axes[1]))
    made = pin.JointModelPrismaticUnaligned if joint.kind == "prismatic" else pin.JointModelRevoluteUnaligned
    return made(np.array(joint.axes[0]))
