# SPDX-License-Identifier: Apache-2.0
"""MJCF files with keyframes and tendons, read here and by MuJoCo, which is independent of Polhode."""

import pathlib
from typing import Any

import numpy
import pytest

import polhode

DURATION = 0.25
# Two links and a body that moves freely; the sites' tendons have one point on each.
MODEL = """<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <site name="post" pos="-0.3 0.02 0.5"/><site name="left" pos="-0.4 0.02 0.95"/>
    <body name="arm" pos="0 0 1">
      <joint name="shoulder" axis="0 1 0.2" ref="0.1" {shoulder}/>
      <inertial pos="0.1 0.05 0" mass="2" diaginertia="0.03 0.02 0.015"/>
      <geom name="knob" size="0.04" pos="0.25 0 0.08"/>
      <geom name="pulley" type="cylinder" size="0.05 0.1" pos="0 0 0" euler="1.5707963267948966 0 0.2"/>
      <site name="elbow" pos="0.2 0 0.1"/><site name="over" pos="0.25 0 0.2"/><site name="above" pos="0 0 0.3"/>
      <body name="hand" pos="0.4 0 0" {compensated}>
        <joint name="wrist" axis="1 0.3 0"/><joint name="turn" axis="0 0 1" damping="0.02"/>
        <inertial pos="0.1 0.05 0" mass="1" diaginertia="0.03 0.02 0.015"/>
        <site name="tip" pos="0.2 0.03 0.05"/>
      </body>
    </body>
    <body name="free" pos="1 1 1">{free}<inertial pos="0.1 0.05 0" mass="1" diaginertia="0.03 0.02 0.015"/>
      <body name="ball" pos="0 0 -0.3"><joint name="b" type="ball" pos="0 0 0.1"/>
        <inertial pos="0.1 0.05 0" mass="0.5" diaginertia="0.03 0.02 0.015"/></body>
    </body>
  </worldbody>
  {more}
  <keyframe>
    <key name="start" qpos="0.4 -0.2 0.3 0.9 1.1 1.2 0.8 0.1 -0.2 0.3 0.9 0.2 0.3 -0.1"
         qvel="0.5 -1 0.7 0.2 0.1 -0.3 1 -2 0.5 0.3 0.2 -0.4" {controls}/>
  </keyframe>
</mujoco>"""
SPATIAL = '<tendon><spatial name="t" {}>{}</spatial></tendon>'
FROM, LEFT, TO, BY = '<site site="post"/>', '<site site="left"/>', '<site site="tip"/>', '<site site="elbow"/>'
ROLLER = '<geom geom="pulley" sidesite="above"/>'
KNOB = '<geom geom="knob" sidesite="over"/>'
SUMS = ('<tendon><fixed name="s" stiffness="3" damping="0.1"><joint joint="wrist" coef="1.5"/></fixed>'
        '<fixed name="d"><joint joint="wrist" coef="2"/><joint joint="turn" coef="-1"/></fixed></tendon>'
        '<actuator><motor tendon="d"/></actuator>')
BELT = ('<tendon><fixed name="s" {}><joint joint="wrist" coef="1.5"/><joint joint="turn" coef="-0.8"/></fixed>'
        '</tendon><actuator>{}</actuator>')


def acts(*tags: str) -> str:
    """Actuators of kind, what they act on, and attributes."""
    return "<actuator>" + "".join(f"<{tag}/>" for tag in tags) + "</actuator>"


SHOULDER, WRIST, TURN = 'joint="shoulder"', 'joint="wrist"', 'joint="turn"'
SUM, LINE, SITE = 'tendon="s"', 'tendon="t"', 'site="tip"'
FILTERED = 'dyntype="filter" dynprm="0.1" gainprm="2" biastype="affine" biasprm="0.1 -1 -0.05"'
BOUNDED = 'dyntype="filter" dynprm="0.1" actrange="-1 0.2"'
ALONG = 'gear="3 -2 1 0.1 0.2 -0.1"'
FREE = '<freejoint name="f"/>'
CASES = {
    "keyframe": {},
    "springdamper": {"shoulder": 'springdamper="0.1 0.6" armature="0.02"'},
    "servos": {"more": '<actuator><position joint="shoulder" kp="30" dampratio="0.7" gear="1.5"/>'
                       '<motor joint="wrist" gear="3" ctrlrange="-1 1"/>'
                       '<general joint="turn" gainprm="2" biastype="affine" biasprm="0 -1 -0.1"/></actuator>',
               "controls": 'ctrl="0.3 -0.2 0.5"'},
    "spring of two sites": {"more": SPATIAL.format('stiffness="40" damping="2"', FROM + TO)},
    "cable of three sites": {"more": SPATIAL.format('stiffness="40" springlength="0.8"', FROM + BY + TO)},
    "around a cylinder": {"more": SPATIAL.format('stiffness="40"', LEFT + ROLLER + TO)},
    "around a sphere": {"more": SPATIAL.format('stiffness="40"', FROM + BY + KNOB + TO)},
    "a motor on a cable": {"more": SPATIAL.format('stiffness="40"', FROM + BY + TO)
                           + '<actuator><motor tendon="t" gear="-2"/></actuator>', "controls": 'ctrl="3"'},
    "sums of coordinates": {"more": SUMS, "controls": 'ctrl="0.4"'},
    "lags": {
        "more": acts(f'position {SHOULDER} kp="30" kv="2" timeconst="0.1" gear="1.5"', f"general {WRIST} {FILTERED}",
                     f'general {TURN} dyntype="filterexact" dynprm="0.05" gainprm="3"'),
        "controls": 'ctrl="0.3 -0.2 0.5" act="-0.1 0.4 0.2"'},
    "a lag within bounds": {"more": acts(f'general {SHOULDER} {BOUNDED} gainprm="20"'),
                            "controls": 'ctrl="0.9" act="-0.5"'},
    "a damped servo whose lag has bounds": {
        "more": acts(f'general {SHOULDER} {BOUNDED} gainprm="9" biastype="affine" biasprm="0 -9 -1"'),
        "controls": 'ctrl="0.9" act="-0.5"'},
    "integrators": {
        "more": acts(f'intvelocity {SHOULDER} kp="30" kv="0.5" actrange="-3 3"',
                     f'cylinder {WRIST} timeconst="0.1" area="2" bias="0.1 -1 -0.1"',
                     f'damper {TURN} kv="0.2" ctrlrange="0 1"'),
        "controls": 'ctrl="1.5 -0.2 0.7" act="0.4 0.1"'},
    "forces within bounds": {
        "more": acts(f'position {SHOULDER} kp="60" kv="1" forcerange="-2 9"',
                     f'velocity {WRIST} kv="2" forcerange="-0.1 0.3"', f'motor {TURN} forcerange="-0.2 0.1"'),
        "controls": 'ctrl="1 2 0.5"'},
    "the bounds of a joint": {"shoulder": 'actuatorfrcrange="-1 3"', "controls": 'ctrl="-1"',
                              "more": acts(f'position {SHOULDER} kp="60" gear="-2"')},
    "a motor at a site": {"more": acts(f"motor {SITE} {ALONG}"), "controls": 'ctrl="0.8"'},
    "a motor along the axes of another site": {"more": acts(f'motor {SITE} refsite="post" {ALONG}'),
                                               "controls": 'ctrl="0.8"'},
    "a servo of a line": {
        "more": SPATIAL.format("", FROM + TO) + acts(f'position {LINE} kp="40" kv="2" gear="1.5"'),
        "controls": 'ctrl="0.9"'},
    "a lagging servo of a cable": {
        "more": SPATIAL.format("", FROM + BY + TO) + acts(f'position {LINE} kp="40" kv="2" timeconst="0.2"'),
        "controls": 'ctrl="0.9" act="1.4"'},
    "a spring of a sum": {"more": BELT.format('stiffness="3" damping="0.1"', "")},
    "a spring of a sum with a gap": {"more": BELT.format('stiffness="9" springlength="-0.9 -0.7"', "")},
    "inertia of a sum": {"more": BELT.format('armature="0.02"', "")},
    "a servo of a sum": {
        "more": BELT.format('armature="0.01" stiffness="1"',
                            f'<position {SUM} kp="4" kv="0.2" forcerange="-0.4 1" gear="1.2"/>'),
        "controls": 'ctrl="0.4"'},
    "a medium": {"more": '<option density="40" viscosity="0.3"/>'},
    "gravity that is held in part": {"shoulder": 'damping="0.1"', "compensated": 'gravcomp="0.6"'},
    "an armature of a free joint": {"free": '<joint type="free" armature="0.3"/>'},
    "a motor of a free joint": {"free": FREE, "more": acts(f'motor joint="f" {ALONG}'), "controls": 'ctrl="0.8"'},
    "a motor of a free joint in the world": {"free": FREE, "more": acts(f'motor jointinparent="f" {ALONG}'),
                                             "controls": 'ctrl="0.8"'},
    "a damping ratio of a sum": {"more": BELT.format("", f'<position {SUM} kp="4" dampratio="0.6" gear="1.2"/>'),
                                 "controls": 'ctrl="0.4"'},
}


def end_in_mujoco(mujoco: Any, model: Any, bodies: list[str], step: float) -> Any:
    """Centres of mass at the end, from the keyframe."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = step
    for _ in range(round(DURATION / step)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return numpy.array([data.body(b).xipos for b in bodies])


@pytest.mark.parametrize("name", CASES)
def test_models_move_as_in_mujoco(name: str, tmp_path: pathlib.Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    parts = {"shoulder": "", "more": "", "controls": "", "compensated": "", "free": "<freejoint/>", **CASES[name]}
    file = tmp_path / "robot.xml"
    file.write_text(MODEL.format(**parts))
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    bodies = ["arm", "hand", "free", "ball"]
    if "around" in name:  # two points on the geom, in addition to the sites
        assert data.ten_wrapnum[0] == 2 + parts["more"].count("<site site")
    start = {b: data.body(b).xipos.copy() for b in bodies}
    at_end = end_in_mujoco(mujoco, model, bodies, 1e-4)
    if "lag" in name:  # Activations are of first order in steps there.
        at_end = 2.0 * end_in_mujoco(mujoco, model, bodies, 5e-5) - at_end
    errors = []
    for step in (2e-3, 1e-3, 2.5e-4):
        m = polhode.load(file)
        m.analysis = {"duration": DURATION, "step": step}
        r = polhode.run(m)
        for b in bodies:
            assert r.bodies[b].position[0] == pytest.approx(start[b], abs=1e-9)
        errors.append(max(abs(r.bodies[b].position[-1] - x).max() for b, x in zip(bodies, at_end)))
    if "bounds" in name:  # Forces have kinks within steps.
        assert errors[2] < errors[0] and errors[2] < 2e-6
        return
    # At second order to a quarter and a sixteenth; the link between the two joints of the hand has 1e-10 of its mass.
    assert errors[1] < 0.3 * errors[0] and errors[2] < 0.075 * errors[1] + 1e-9
    assert errors[2] < 5e-7
