# SPDX-License-Identifier: Apache-2.0
"""Drake: a continuous plant with error-controlled integrators, and for loops its discrete plant."""

from __future__ import annotations

import importlib.metadata
import math
from typing import Any

import numpy as np
from mechanism import GROUND, Joint, Mechanism, Vector, frame_with_x, minus
from program import Method, Outcome, halved, steps_of, timed
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import DiscreteContactApproximation, ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import (
    BallRpyJoint,
    FixedOffsetFrame,
    LinearSpringDamper,
    PrismaticJoint,
    RevoluteJoint,
    RotationalInertia,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantValueSource

DISCRETE = "discrete, SAP"
TOLERANCES = tuple(10.0**-k for k in range(2, 13, 2))


class Drake:
    name = "Drake"

    def version(self) -> str:
        return importlib.metadata.version("drake")

    def absent(self, mechanism: Mechanism) -> str:
        return ""

    def remarks(self, mechanism: Mechanism) -> str:
        if mechanism.loops():
            return "loops by ball constraints, which only its discrete plant has"
        return (
            "a ball joint by angles, near whose singular position the top passes"
            if any(j.kind == "spherical" for j in mechanism.joints)
            else ""
        )

    def methods(self, mechanism: Mechanism) -> tuple[Method, ...]:
        if mechanism.loops():
            first = mechanism.duration / (100.0 if mechanism.duration < 0.1 else 400.0)
            return (Method(DISCRETE, "step", halved(first, 12)),)
        names = (*(("radau3",) if mechanism.dissipates() else ()), "runge_kutta3", "runge_kutta5")
        return tuple(Method(name, "tolerance", TOLERANCES) for name in names)

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome:
        discrete = method.name == DISCRETE
        step = mechanism.duration / steps_of(mechanism.duration, value) if discrete else 0.0
        motion = Motion(mechanism, step)
        simulator = Simulator(motion.diagram, motion.context)
        if not discrete:
            ResetIntegratorFromFlags(simulator, method.name, mechanism.duration / 10.0)
            integrator = simulator.get_mutable_integrator()
            integrator.set_target_accuracy(value)
            integrator.set_maximum_step_size(mechanism.duration / 10.0)
        simulator.set_target_realtime_rate(0.0)
        simulator.Initialize()
        cpu = timed(lambda: simulator.AdvanceTo(mechanism.duration) and None)
        end = motion.observe()
        if not all(math.isfinite(x) for x in end):
            raise RuntimeError("the motion became unstable")
        taken = round(mechanism.duration / step) if discrete else int(simulator.get_integrator().get_num_steps_taken())
        return Outcome(end, cpu, taken)


class Motion:
    """A mechanism in Drake's terms. Frames of bodies lie at their joints, parallel to the world's at the start."""

    def __init__(self, mechanism: Mechanism, step: float) -> None:
        self.mechanism = mechanism
        builder = DiagramBuilder()
        plant: Any = builder.AddSystem(MultibodyPlant(step))
        self.plant = plant
        if step > 0.0:
            plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        plant.mutable_gravity_field().set_gravity_vector(np.array(mechanism.gravity))
        self.bodies: dict[str, Any] = {GROUND: plant.world_body()}
        self.origins: dict[str, Vector] = {GROUND: (0.0, 0.0, 0.0)}
        self.starts: list[tuple[Any, tuple[float, ...]]] = []
        for body in mechanism.bodies:
            joint = mechanism.joint_of(body.name)
            centre = np.array(minus(body.position, joint.at))
            m = np.array(body.inertia_in_world())
            about_centre = RotationalInertia(m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2])
            spatial = SpatialInertia.MakeFromCentralInertia(body.mass, centre, about_centre)
            self.bodies[body.name] = plant.AddRigidBody(body.name, spatial)
            self.origins[body.name] = joint.at
            self.add(joint)
        for spring in mechanism.springs:
            a, b = spring.bodies
            plant.AddForceElement(
                LinearSpringDamper(
                    self.bodies[a],
                    np.array(minus(spring.at[0], self.origins[a])),
                    self.bodies[b],
                    np.array(minus(spring.at[1], self.origins[b])),
                    spring.free_length,
                    spring.stiffness,
                    spring.damping,
                )
            )
        for joint in mechanism.loops():
            a, b = joint.parent, joint.child
            plant.AddBallConstraint(
                self.bodies[a],
                np.array(minus(joint.at, self.origins[a])),
                self.bodies[b],
                np.array(minus(joint.at, self.origins[b])),
            )
        plant.Finalize()
        if mechanism.moments:
            builder.Connect(
                builder.AddSystem(self.constant_moments()).get_output_port(),
                plant.get_applied_spatial_force_input_port(),
            )
        self.diagram = builder.Build()
        self.context = self.diagram.CreateDefaultContext()
        state = plant.GetMyMutableContextFromRoot(self.context)
        for made, rates in self.starts:
            for one, rate in zip(made, rates, strict=True):
                if isinstance(one, RevoluteJoint):
                    one.set_angular_rate(state, rate)
                elif isinstance(one, PrismaticJoint):
                    one.set_translation_rate(state, rate)
                else:
                    one.set_angular_velocity(state, np.array(rate))

    def constant_moments(self) -> Any:
        applied = []
        for moment in self.mechanism.moments:
            force = ExternallyAppliedSpatialForce()
            force.body_index = self.bodies[moment.body].index()
            force.p_BoBq_B = np.zeros(3)
            force.F_Bq_W = SpatialForce(np.array(moment.moment), np.zeros(3))
            applied.append(force)
        return ConstantValueSource(Value(applied))

    def add(self, joint: Joint) -> None:
        """A joint with frames at its point; a universal joint as two hinges with a light cross in between."""
        parent, child = self.bodies[joint.parent], self.bodies[joint.child]
        at = np.array(minus(joint.at, self.origins[joint.parent]))
        rates = self.mechanism.rates(joint)
        if joint.kind == "spherical":
            axes = RotationMatrix(np.array(frame_with_x(joint.axes[0])))
            outer = self.plant.AddFrame(
                FixedOffsetFrame(f"{joint.name}_outer", parent.body_frame(), RigidTransform(axes, at))
            )
            inner = self.plant.AddFrame(
                FixedOffsetFrame(f"{joint.name}_inner", child.body_frame(), RigidTransform(axes, np.zeros(3)))
            )
            made = self.plant.AddJoint(BallRpyJoint(joint.name, outer, inner))
            self.starts.append(((made,), (tuple(axes.inverse().matrix() @ np.array(rates)),)))  # type: ignore[arg-type]
            return
        outer = self.plant.AddFrame(FixedOffsetFrame(f"{joint.name}_outer", parent.body_frame(), RigidTransform(at)))
        kind = PrismaticJoint if joint.kind == "prismatic" else RevoluteJoint
        if joint.kind == "universal":
            cross = self.plant.AddRigidBody(
                f"{joint.name}_cross", SpatialInertia(0.0, np.zeros(3), UnitInertia(0.0, 0.0, 0.0))
            )
            first = self.plant.AddJoint(
                RevoluteJoint(f"{joint.name}_first", outer, cross.body_frame(), np.array(joint.axes[0]))
            )
            second = self.plant.AddJoint(
                RevoluteJoint(joint.name, cross.body_frame(), child.body_frame(), np.array(joint.axes[1]))
            )
            self.starts.append(((first, second), rates))
            return
        made = self.plant.AddJoint(kind(joint.name, outer, child.body_frame(), np.array(joint.axes[0])))
        self.starts.append(((made,), rates))

    def observe(self) -> tuple[float, ...]:
        state = self.plant.GetMyContextFromRoot(self.context)
        end: list[float] = []
        for seen in self.mechanism.observed:
            if seen.joint:
                end.append(float(self.plant.GetJointByName(seen.joint).get_angle(state)) + seen.offset)
            else:
                pose = self.plant.EvalBodyPoseInWorld(state, self.bodies[seen.body])
                place = pose.multiply(np.array(minus(seen.point, self.origins[seen.body])))
                end += [float(place[k]) for k in seen.components]
        return tuple(end)
