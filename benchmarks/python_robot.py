#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the joint coordinates of a simulation in Python: an arm with seven hinges, its moments set as an array.

Run it with the interpreter that the package is installed for. Where MuJoCo is installed, the same arm is measured with
it in turn. Times are smallest ones of many rounds, in microseconds: other programs lengthen some rounds.
"""
import os
import time

import numpy as np

import polhode

ROUNDS, CALLS = 200, 50
LINKS = 7
LYING = [0, 1.4, 0, 0.2, 0, 0, 0]  # just above the table


def arm_on_a_table(**contact):
    """The arm with links of 30 cm by 8 cm, fallen onto a table that does not slip."""
    m = arm()
    m.contacts = {"default": {"friction": 0.5, **contact}}
    m.add_body("table", fixed=True, position=[0, 0, -0.06], shape={"box": [6, 6, 0.02]}, contact={})
    for i in range(LINKS):
        m.bodies[f"link{i}"].shape = {"capsule": [0.08, 0.3]}
        m.bodies[f"link{i}"].contact = {}
    sim = polhode.Simulation(m, tau=True)
    sim.reset(LYING)
    while sim.time < 2:
        damped(sim)
    return sim


def damped(sim):
    sim.tau = -2 * sim.qd
    sim.step()


def arm():
    """Links of 0.3 m with skewed inertias, hinges about z, y, z, ..."""
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 1000, "step": "1 ms"})
    before = "ground"
    for i in range(LINKS):
        link = m.add_body(f"link{i}", mass=2 - 0.2 * i, inertia=[0.02, 0.03, 0.02], position=[0.02 * i, 0.01, 0.3 * i + 0.15])
        m.add_joint(f"j{i}", "revolute", [before, link], at=[0.02 * i, 0, 0.3 * i], axis="y" if i % 2 else "z")
        before = link
    return m


def mujoco_arm(table=False):
    """The same arm, with MuJoCo's default of one step, semi-implicit Euler of 1 ms."""
    shape = '<geom type="capsule" pos="0 0.01 0.15" size="0.04 0.11"/>' if table else ""
    floor = '<geom type="box" pos="0 0 -0.06" size="3 3 0.01"/>' if table else ""
    open_, close = "", ""
    for i in range(LINKS):
        place = f"{0.02 if i else 0} 0 {0.3 if i else 0}"
        open_ += (f'<body pos="{place}"><joint type="hinge" axis="{"0 1 0" if i % 2 else "0 0 1"}"/>'
                  f'<inertial pos="0 0.01 0.15" mass="{2 - 0.2 * i}" diaginertia="0.02 0.03 0.02"/>{shape}')
        close += "</body>"
    return f'<mujoco><option timestep="0.001" gravity="0 0 -9.81"/><worldbody>{floor}{open_}{close}</worldbody></mujoco>'


def fastest(function, calls=CALLS):
    """Smallest mean time of a call over rounds [µs]."""
    best = float("inf")
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for _ in range(calls):
            function()
        best = min(best, (time.perf_counter() - start) / calls)
    return 1e6 * best


def measure_polhode():
    q0 = np.full(LINKS, 0.5)
    plain, sim = polhode.Simulation(arm()), polhode.Simulation(arm(), tau=True)
    hold = sim.gravity_moments(q0)
    plain.reset(q0)
    found = {"step, falling, no moments": fastest(plain.step, 20)}

    def held():
        sim.tau = hold
        sim.step()

    def controlled():
        sim.tau = hold - 50 * (sim.q - q0) - 5 * sim.qd
        sim.step()

    sim.reset(q0)
    found["q, qd, tau and step, controlled"] = fastest(controlled)
    assert np.abs(sim.q - q0).max() < 1e-6, sim.q
    found["tau and step, held"] = fastest(held, 20)  # later it falls from this unstable equilibrium
    assert np.abs(sim.q - q0).max() < 0.2, sim.q
    target = sim.forward_kinematics(q0 + 0.1)[f"link{LINKS - 1}"]
    rows = np.tile(q0, (1000, 1))
    found.update({
        "read q": fastest(lambda: sim.q),
        "read qd": fastest(lambda: sim.qd),
        "read seven joints one by one after a step": fastest(
            lambda: (sim.step(), [sim.joints[f"j{i}"].coordinates for i in range(LINKS)]), 20),
        "qdd after a step": fastest(lambda: (sim.step(), sim.qdd)),
        "mass matrix": fastest(sim.mass_matrix),
        "inverse dynamics, present state": fastest(lambda: sim.inverse_dynamics(hold)),
        "inverse dynamics, a row of 1000": fastest(lambda: sim.inverse_dynamics(rows, rows, rows), 1) / 1000,
        "jacobian": fastest(lambda: sim.jacobian("link6")),
        "inverse kinematics, position and orientation": fastest(
            lambda: sim.solve("link6", target.position, target.orientation, q=q0), 20),
        "reset": fastest(sim.reset, 50),
        "reset to q, qd": fastest(lambda: sim.reset(q0, hold), 20),
    })
    for law in "barrier", "rigid":
        lying = arm_on_a_table(law=law)
        found[f"qd, tau and step, lying on a table, {law}"] = fastest(lambda: damped(lying), 20)
        assert np.abs(lying.qd).max() < 1e-6, lying.qd
    return found


def measure_mujoco():
    try:
        import mujoco
    except ModuleNotFoundError:
        return {}
    model = mujoco.MjModel.from_xml_string(mujoco_arm())
    data = mujoco.MjData(model)
    q0 = np.full(LINKS, 0.5)
    data.qpos[:] = q0
    mujoco.mj_forward(model, data)
    hold = data.qfrc_bias.copy()

    def held():
        data.qfrc_applied[:] = hold
        mujoco.mj_step(model, data)

    def controlled():
        data.qfrc_applied[:] = hold - 50 * (data.qpos - q0) - 5 * data.qvel
        mujoco.mj_step(model, data)

    found = {}
    for name, function in (("tau and step, held", held), ("q, qd, tau and step, controlled", controlled)):
        mujoco.mj_resetData(model, data)
        data.qpos[:] = q0
        found[name] = fastest(function)
    found["read q"] = fastest(lambda: data.qpos)
    found["read qd"] = fastest(lambda: data.qvel)
    M = np.zeros((LINKS, LINKS))

    arguments = (M, data.qM) if hasattr(data, "qM") else (data, M)  # before version 4, and since
    found["mass matrix"] = fastest(lambda: mujoco.mj_fullM(model, *arguments))
    found["reset"] = fastest(lambda: mujoco.mj_resetData(model, data))
    model = mujoco.MjModel.from_xml_string(mujoco_arm(table=True))
    data = mujoco.MjData(model)
    data.qpos[:] = LYING

    def damped():
        data.qfrc_applied[:] = -2 * data.qvel
        mujoco.mj_step(model, data)

    while data.time < 2:
        damped()
    found["qd, tau and step, lying on a table, barrier"] = fastest(damped, 20)
    print(f"MuJoCo {mujoco.__version__}")
    return found


if __name__ == "__main__":
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors, {time.strftime('%Y-%m-%d %H:%M')}")
    ours, other = measure_polhode(), measure_mujoco()
    for name, microseconds in ours.items():
        print(f"{name:46} {microseconds:8.2f} µs" + (f"   MuJoCo {other[name]:8.2f} µs" if name in other else ""))
