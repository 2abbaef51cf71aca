# SPDX-License-Identifier: Apache-2.0
"""Models as files of other programs, read by MuJoCo, which is independent of Polhode."""

import pathlib
from typing import Any

import numpy as np
import pytest

import polhode

DURATION = 0.5


def tree(types: "dict[str, dict[str, Any]]", loads: "dict[str, dict[str, Any]]") -> polhode.Model:
    """Four bodies with products of inertia in a chain, with a joint of each type given by its name.

    The last body moves freely.
    """
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": DURATION, "step": "2 ms", "order": 8})
    m.add_body("arm", mass=2, inertia={"xx": 0.3, "yy": 0.4, "zz": 0.5, "xy": 0.05, "xz": -0.07, "yz": 0.02},
               com=[0.2, -0.1, 0.05], position=[0.5, 0.1, 0.2], orientation={"axis": [0, 1, 1], "angle": 1.1})
    m.add_body("second", mass=1.5, inertia={"xx": 0.02, "yy": 0.03, "zz": 0.04, "xy": 0.003, "xz": 0.001, "yz": -0.004},
               position=[0.9, 0.3, 0.1], orientation={"axis": [3, -1, 2], "angle": 2.2})
    m.add_body("third", mass=0.7, inertia=[0.01, 0.02, 0.015], com=[0, 0.1, 0], position=[1.1, 0.4, 0],
               orientation={"axis": "y", "angle": "90 deg"}, shape=polhode.Box(0.1, 0.2, 0.3))
    m.add_body("free", mass=1, inertia={"xx": 0.1, "yy": 0.2, "zz": 0.25, "xz": 0.03}, com=[0.1, 0.2, 0.3],
               position=[3, 0, 0], orientation={"axis": "x", "angle": 1.0})
    bodies = ["ground", "arm", "second", "third"]
    for k, (name, keys) in enumerate(types.items()):
        point = [[0.2, 0.1, 0.3], [0.7, 0.2, 0.1], [1, 0.4, 0]][k]
        pair = [bodies[k], bodies[k + 1]]
        keys = dict(keys)
        if keys.pop("reversed", False):
            pair.reverse()
        m.add_joint(name, keys.pop("type"), pair, at=point, **keys)
    for name, keys in loads.items():
        m.add_load(name, **keys)
    return m


MODELS = {
    "hinge, slide, ball": tree(
        {"a": {"type": "revolute", "axis": [1, -1, 2], "start": 0.4, "start_rate": 1.5, "reversed": True},
         "b": {"type": "prismatic", "axis": [1, 1, 0.3], "start": -0.05, "start_rate": 0.2},
         "c": {"type": "spherical"}},
        {"spring": {"type": "torsional_spring", "joint": "a", "stiffness": 5, "damping": 0.3, "free_angle": 0.2},
         "flywheel": {"type": "rotary_inerter", "joint": "a", "inertance": 0.4},
         "buffer": {"type": "translational_spring", "joint": "b", "stiffness": 300, "free_displacement": 0.02},
         "drag": {"type": "vector_damper", "bodies": ["third", "second"], "at": [[1, 0.4, 0]] * 2,
                  "turning_damping": 0.02},
         "servo": {"type": "rotary_servo", "joint": "a", "angle": 0.5, "stiffness": 2, "damping": 0.1},
         "motor": {"type": "linear_motor", "joint": "b", "force": 1.5}}),
    "forces, moments, dampers of free bodies": tree(
        {"a": {"type": "revolute", "axis": [1, -1, 2], "start": 0.4},
         "b": {"type": "prismatic", "axis": [1, 1, 0.3], "start": -0.05},
         "c": {"type": "revolute", "axis": "y", "start": 2.5}},
        {"carried": {"type": "force", "body": "second", "force": [0, 0, 8.829]},
         "wind": {"type": "force", "body": "third", "at": [1.1, 0.3, 0.1], "force": [0.4, -0.3, 0.2]},
         "jet": {"type": "force", "body": "free", "at_body": [0.3, 0.1, 0], "force": [0.1, 0.7, -0.4],
                 "body_fixed": True},
         "twist": {"type": "moment", "body": "arm", "moment": [0.3, 0.1, -0.5]},
         "wheel": {"type": "moment", "body": "free", "moment": [0.02, -0.1, 0.03], "body_fixed": True},
         "air": {"type": "vector_damper", "bodies": ["ground", "free"], "at_body": [[0, 0, 0]] * 2,
                 "damping": 0.2, "turning_damping": 0.2}}),
    "universal, cylindrical, planar": tree(
        {"a": {"type": "universal", "axes": [[1, 1, 0], [1, -1, 1]], "start": {"rx": 0.3, "ry": -0.5}},
         "b": {"type": "cylindrical", "axis": [1, 1, 0.3], "start": {"z": 0.1, "rz": 0.6}},
         "c": {"type": "planar", "axis": [0.2, 1, 0], "start": {"x": 0.1, "y": -0.05, "rz": 0.4},
               "start_rate": {"x": 0.3, "y": 0.2, "rz": 1}}}, {}),
    "universal, cylindrical, planar, from the child": tree(
        {"a": {"type": "universal", "axes": [[1, 1, 0], [1, -1, 1]], "start": {"rx": 0.3, "ry": -0.5},
               "start_rate": {"rx": 0.7, "ry": 0.4}, "reversed": True},
         "b": {"type": "cylindrical", "axis": [1, 1, 0.3], "start": {"z": 0.1, "rz": 0.6}, "reversed": True},
         "c": {"type": "planar", "axis": [0.2, 1, 0], "start": {"x": 0.1, "y": -0.05, "rz": 0.4},
               "start_rate": {"x": 0.3, "y": 0.2, "rz": 1}, "reversed": True}}, {}),
}
TREE = {"a": {"type": "revolute", "axis": [1, -1, 2], "start": 0.4},
        "b": {"type": "prismatic", "axis": [1, 1, 0.3], "start": -0.05, "reversed": True},
        "c": {"type": "revolute", "axis": "y", "start": 2.5, "reversed": True}}


def rotation(q: Any) -> Any:
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def compare(mujoco: Any, model: Any, data: Any, m: polhode.Model, inertia: "dict[str, Any]") -> None:
    """Mass, inertia and place of all bodies at the start, and their motion, against those of MuJoCo.

    Its fourth-order Runge-Kutta method leaves some 1e-11 m at this step, 3e-10 m at 2.5 times it.
    """
    r = polhode.run(m)
    mujoco.mj_forward(model, data)
    for name, J in inertia.items():
        body = model.body(name)
        R = data.body(name).ximat.reshape(3, 3)
        A = rotation(r.bodies[name].orientation[0])
        assert body.mass[0] == pytest.approx(m.bodies[name].mass, rel=1e-14)
        assert R @ np.diag(body.inertia) @ R.T == pytest.approx(A @ J @ A.T, abs=1e-10)
        assert data.body(name).xipos == pytest.approx(r.bodies[name].position[0], abs=1e-12)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = 1e-4
    for _ in range(round(DURATION / model.opt.timestep)):
        mujoco.mj_step(model, data)
    for name in inertia:
        assert data.body(name).xipos == pytest.approx(r.bodies[name].position[-1], abs=1e-10)


def inertias(m: polhode.Model) -> "dict[str, Any]":
    def tensor(J: Any) -> Any:
        if isinstance(J, list):
            return np.diag(J)
        J = J.to_dict() if hasattr(J, "to_dict") else dict(J)
        xy, xz, yz = (J.get(k, 0.0) for k in ("xy", "xz", "yz"))
        return np.array([[J["xx"], xy, xz], [xy, J["yy"], yz], [xz, yz, J["zz"]]])

    return {name: tensor(body["inertia"]) for name, body in m.to_dict()["bodies"].items()}


@pytest.mark.parametrize("name", MODELS)
def test_mjcf_moves_in_mujoco_as_here(name: str, tmp_path: pathlib.Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    m = MODELS[name]
    m.export(tmp_path / "robot.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    compare(mujoco, model, data, m, inertias(m))


def test_row_of_three_coordinates_is_one_in_mujoco(tmp_path: pathlib.Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    m = tree({"a": {"type": "revolute", "axis": [1, -1, 2]},
              "b": {"type": "prismatic", "axis": [1, 1, 0.3], "start": -0.05},
              "c": {"type": "revolute", "axis": "y", "start": 0.3}},
             {"row": {"type": "coupling", "joints": ["a", "b", "c"], "factors": [2, 0.5], "offset": 0.35}})
    m.export(tmp_path / "robot.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert data.nefc == 1
    assert data.efc_pos[0] == pytest.approx(0, abs=1e-14)
    row = np.zeros((1, model.nv))
    if mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(row, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    else:
        row[:] = data.efc_J.reshape(1, -1)
    at = [model.joint(name).dofadr[0] for name in "abc"]
    assert row[0, at] == pytest.approx([1, -2, -0.5])


def test_urdf_moves_in_mujoco_as_here(tmp_path: pathlib.Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    m = tree(TREE, {"oil": {"type": "torsional_spring", "joint": "c", "damping": 0.03},
                    "grease": {"type": "translational_spring", "joint": "b", "damping": 2}})
    notes = m.export(tmp_path / "robot.urdf")
    assert {n.path for n in notes if n.kind == "not in the file"} == {f"joints.{j}.start" for j in TREE}
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.urdf"))
    data = mujoco.MjData(model)
    for joint, keys in TREE.items():
        data.joint(joint).qpos[:] = keys["start"]
    compare(mujoco, model, data, m, inertias(m))


def test_shapes_in_mujoco_are_those_here(tmp_path: pathlib.Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    m = polhode.Model()
    m.add_body("b", mass=1, inertia=[1, 1, 1], com=[0, 0, 0], shape=[
        {"box": [0.1, 0.2, 0.3], "position": [1, 2, 3], "orientation": {"axis": "z", "angle": 0.5}},
        {"sphere": 0.4}, {"cylinder": [0.2, 0.6]}, {"capsule": [0.2, 1]}])
    for file in ("b.xml", "b.urdf"):
        m.export(tmp_path / file)
        text = (tmp_path / file).read_text()
        if file == "b.urdf":  # or its reader leaves visual shapes out
            text = text.replace("<link", '<mujoco><compiler discardvisual="false"/></mujoco><link', 1)
        model = mujoco.MjModel.from_xml_string(text)
        G = mujoco.mjtGeom
        sizes = {int(t): list(s) for t, s in zip(model.geom_type, model.geom_size)}
        assert sizes[G.mjGEOM_BOX] == pytest.approx([0.05, 0.1, 0.15])
        assert sizes[G.mjGEOM_SPHERE][0] == pytest.approx(0.2)
        assert sizes[G.mjGEOM_CYLINDER][:2] == pytest.approx([0.1, 0.3])
        assert sizes[G.mjGEOM_CAPSULE][:2] == pytest.approx([0.1, 0.4])
        box = list(model.geom_type).index(G.mjGEOM_BOX)
        assert model.geom_pos[box] == pytest.approx([1, 2, 3])
        assert model.geom_quat[box] == pytest.approx([np.cos(0.25), 0, 0, np.sin(0.25)])


def test_what_cannot_be_represented_is_refused_by_name(tmp_path: pathlib.Path) -> None:
    m = MODELS["hinge, slide, ball"]
    with pytest.raises(polhode.ModelError, match="joints.c: a URDF has no joint of the type spherical"):
        m.export(tmp_path / "robot.urdf")
    assert not (tmp_path / "robot.urdf").exists()
    notes = m.export(tmp_path / "robot.urdf", allow_partial=True)
    assert "joints.c" in {n.path for n in notes if n.kind == "left out"}
    with pytest.raises(polhode.ModelError, match=r"Name a file that ends in \.urdf or \.xml"):
        m.export(tmp_path / "robot.dae")
    with pytest.raises(OSError, match="missing"):
        m.export(tmp_path / "missing" / "robot.xml")
