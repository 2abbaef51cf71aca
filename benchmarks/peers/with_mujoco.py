# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: joint coordinates, and loops as its soft constraints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

import mujoco
from mechanism import GROUND, Body, Joint, Mechanism, Vector, minus
from program import Method, Outcome, halved, steps_of, timed

RK4, IMPLICIT, DISCRETE = "RK4", "implicitfast", "discrete"


def numbers(values: Iterable[float]) -> str:
    return quoteattr(" ".join(repr(float(v)) for v in values))


class MuJoCo:
    name = "MuJoCo"

    def version(self) -> str:
        return str(mujoco.__version__)

    def absent(self, mechanism: Mechanism) -> str:
        return ""

    def remarks(self, mechanism: Mechanism) -> str:
        return (
            "loops are soft constraints, here as stiff as a step allows" if mechanism.loops() else "joint coordinates"
        )

    def methods(self, mechanism: Mechanism) -> tuple[Method, ...]:
        first = mechanism.duration / (100.0 if mechanism.duration < 0.1 else 400.0)
        return tuple(Method(name, "step", halved(first, 14)) for name in (RK4, IMPLICIT, DISCRETE))

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome:
        steps = steps_of(mechanism.duration, value)
        model = mujoco.MjModel.from_xml_string(mjcf(mechanism, method.name, mechanism.duration / steps))
        data = mujoco.MjData(model)
        for joint in mechanism.joints:
            if not joint.closes:
                for k, rate in enumerate(mechanism.rates(joint)):
                    first = model.joint(f"{joint.name}_{k if joint.kind == 'universal' else 0}").dofadr[0]
                    data.qvel[first + (0 if joint.kind == "universal" else k)] = rate
        for moment in mechanism.moments:
            data.xfrc_applied[model.body(moment.body).id, 3:] = moment.moment
        cpu = timed(lambda: mujoco.mj_step(model, data, nstep=steps))
        mujoco.mj_kinematics(model, data)
        end: list[float] = []
        for i, seen in enumerate(mechanism.observed):
            if seen.joint:
                end.append(float(data.joint(f"{seen.joint}_0").qpos[0]) + seen.offset)
            else:
                point = data.site(f"seen_{i}").xpos
                end += [float(point[k]) for k in seen.components]
        if not all(math.isfinite(x) for x in end) or data.time < 0.5 * mechanism.duration:
            raise RuntimeError("the motion became unstable")
        return Outcome(tuple(end), cpu, steps)


def mjcf(mechanism: Mechanism, integrator: str, step: float) -> str:
    """The model in MuJoCo's format; frames of bodies lie at their joints, parallel to the world's at the start."""
    sites: dict[str, list[str]] = {}

    def site(name: str, body: str, point: Vector) -> None:
        at = numbers(minus(point, mechanism.origin(body)))
        sites.setdefault(body, []).append(f'<site name="{name}" pos={at}/>')

    tendons = []
    for spring in mechanism.springs:
        for end in (0, 1):
            site(f"{spring.name}_{end}", spring.bodies[end], spring.at[end])
        tendons.append(
            f'<spatial stiffness="{spring.stiffness!r}" damping="{spring.damping!r}" '
            f'springlength="{spring.free_length!r}"><site site="{spring.name}_0"/>'
            f'<site site="{spring.name}_1"/></spatial>'
        )
    for i, seen in enumerate(mechanism.observed):
        if seen.body:
            site(f"seen_{i}", seen.body, seen.point)

    def element(body: Body) -> str:
        joint = mechanism.joint_of(body.name)
        m = body.inertia_in_world()
        inside = "".join(element(b) for b in mechanism.bodies if mechanism.joint_of(b.name).parent == body.name)
        return (
            f'<body name="{body.name}" pos={numbers(minus(joint.at, mechanism.origin(joint.parent)))}>'
            f"{joint_elements(joint)}"
            f'<inertial pos={numbers(minus(body.position, joint.at))} mass="{body.mass!r}" '
            f"fullinertia={numbers((m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]))}/>"
            f"{''.join(sites.get(body.name, []))}{inside}</body>"
        )

    roots = "".join(element(b) for b in mechanism.bodies if mechanism.joint_of(b.name).parent == GROUND)
    # The stiffest constraint that MuJoCo accepts has a time constant of two steps.
    soft = f'solref="{2.0 * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"'
    loops = "".join(
        f'<connect body1="{j.parent}" body2="{j.child}" {soft} '
        f"anchor={numbers(minus(j.at, mechanism.origin(j.parent)))}/>"
        for j in mechanism.loops()
    )
    return (
        f'<mujoco><compiler angle="radian"/><option timestep="{step!r}" integrator="{integrator}" '
        f'gravity={numbers(mechanism.gravity)} tolerance="1e-14" iterations="200"><flag contact="disable"/></option>'
        f"<worldbody>{''.join(sites.get(GROUND, []))}{roots}</worldbody><tendon>{''.join(tendons)}</tendon>"
        f"<equality>{loops}</equality></mujoco>"
    )


def joint_elements(joint: Joint) -> str:
    kind = {"revolute": "hinge", "universal": "hinge", "prismatic": "slide", "spherical": "ball"}[joint.kind]
    axes = ("",) if kind == "ball" else tuple(f" axis={numbers(axis)}" for axis in joint.axes)
    return "".join(f'<joint name="{joint.name}_{k}" type="{kind}"{axis}/>' for k, axis in enumerate(axes))
