# SPDX-License-Identifier: Apache-2.0
"""Models in code: keys, faults, round trips."""

import copy
import pathlib
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import polhode
from conftest import EXAMPLES, make_pendulum
from polhode import _native, _schema, _text


def test_a_model_in_code_is_the_model_of_the_file(pendulum: polhode.Model) -> None:
    text = """\
format: 1
gravity: [0, 0, -9.81]
analysis: {duration: 1, step: 5 ms}
bodies:
  arm: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [0.5, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}
"""
    assert polhode.from_text(text) == pendulum
    assert pendulum.to_yaml() == text


def test_values_are_read_and_set_by_name(pendulum: polhode.Model) -> None:
    body = pendulum.bodies["arm"]
    body.mass = 2
    body.density = None
    body.position[2] = 0.25
    assert pendulum.to_dict()["bodies"]["arm"] == {
        "shape": {"box": [1, 0.05, 0.05]}, "position": [0.5, 0, 0.25], "mass": 2}
    assert body.velocity is None
    pendulum.output.probes.add("tip", body="arm", point=np.array([0.5, 0, 0]))
    assert pendulum.to_dict()["output"] == {"probes": {"tip": {"body": "arm", "point": [0.5, 0.0, 0.0]}}}
    assert "angular_velocity" in dir(body) and "add_body" in dir(pendulum) and "Box" in dir(polhode)
    assert body._ipython_key_completions_() == ["shape", "position", "mass"]
    assert repr(body) == "<body 'arm' {shape: {box: [1, 0.05, 0.05]}, position: [0.5, 0, 0.25], mass: 2}>"
    assert repr(pendulum) == "<polhode.Model: 1 body, 1 joint>"


def lists_of_the_schema() -> "list[tuple[tuple[str, ...], str]]":
    """Paths of named objects in a model, and their tables: (("contacts", "pairs"), "contact_pair")."""
    found: "list[tuple[tuple[str, ...], str]]" = []
    for key in _schema.keys(""):
        section = _schema.section_of("", key)
        inner = [((key, k), _schema.named_of(section, k)) for k in _schema.keys(section)] if section else []
        for path, table in [((key,), _schema.named_of("", key)), *inner]:
            if table:
                found.append((path, table))
    return found


def test_every_list_of_the_model_file_has_a_method_that_adds_to_it() -> None:
    given: "dict[str, tuple[object, ...]]" = {"load": ("force",), "material": ("elastic",),
                                              "joint": ("revolute", ["ground", "b"])}

    def add(m: polhode.Model, table: str) -> Any:
        if table == "part":
            return m.attach("leg.yaml", name="x")
        return getattr(m, f"add_{table}")("x", *given.get(table, ()))

    lists = lists_of_the_schema()
    assert (("events",), "event") in lists and (("output", "probes"), "probe") in lists and len(lists) >= 14
    for path, table in lists:
        assert table == "part" or hasattr(polhode.Model, f"add_{table}"), f"no add_{table} for {'.'.join(path)}"
        m = polhode.Model()
        added, tree = add(m, table), m.to_dict()
        for key in path:
            tree = tree[key]
        assert list(tree) == ["x"] and added.name == "x" and added._path() == ".".join((*path, "x"))
        with pytest.raises(polhode.ModelError, match="'x' is taken"):
            add(m, table)


def test_an_event_lets_go_and_ends_the_run() -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 3, "step": "5 ms"})
    ball = m.add_body("ball", mass=2, inertia=[0.05, 0.05, 0.05])
    hook = m.add_joint("hook", "fixed", ["ground", ball], at=[0, 0, 0])
    m.add_event("let_go", at="0.2 s", off=[hook])
    down = m.add_event("down", when={"body": ball, "channel": "z", "below": -1}, after="let_go", stop=True)
    assert polhode.from_text(m.to_yaml()) == m and down.when.below == -1
    r = polhode.run(m)
    fall = 0.2 + (2 / 9.81) ** 0.5  # of 1 m, from rest
    assert [e["event"] for e in r.ledger.events] == ["let_go", "down"]
    assert abs(r.ledger.events[0]["time"] - 0.2) < 1e-12 and abs(r.ledger.events[1]["time"] - fall) < 1e-9
    assert abs(r.ledger.t - fall) < 1e-9
    with pytest.raises(polhode.ModelError, match="of"):
        m.add_event("again", at=1, of=[hook])


def test_events_and_controllers_read_cables_and_contacts() -> None:
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": 1, "step": "2 ms"})
    floor = m.add_body("floor", fixed=True, shape={"plane": "z"})
    crate = m.add_body("crate", mass=2, inertia=[1, 1, 1], shape={"box": [0.2, 0.2, 0.2]}, position=[0, 0, 1])
    rope = m.add_cable("rope", through=[["ground", [0, 0, 2]], [crate]], stiffness="2 kN", free_length=0.99)
    m.contacts.default = {"restitution": 0}
    m.add_controller("hold", cable=rope, channel="tension", setpoint="10 N", proportional=0.2)
    m.add_load("lift", "force", body=crate, force=[0, 0, {"controller": "hold"}])
    m.add_event("tight", when={"cable": rope, "channel": "tension", "above": "23 N"}, off=[crate])
    m.add_event("far", when={"contact": [crate, floor], "channel": "gap", "below": 0.5}, stop=True)
    again = polhode.from_text(m.to_yaml())
    assert again == m and again.events["tight"].off == ["crate"]
    # The rope's k is 2 kN / 0.99 m: its tension is 22.025 - (22.025 - T) cos(w t) with T = 0.01 k and w^2 = 0.8 k / 2.
    k = 2000 / 0.99
    tight = next(e for e in polhode.run(m).ledger.events if e["event"] == "tight")
    assert abs(tight["time"] - np.arccos(-0.975 / (22.025 - 0.01 * k)) / (0.4 * k) ** 0.5) < 2e-4
    m.events["tight"].when.channel = "tensoin"
    with pytest.raises(polhode.ModelError, match="no channel of the cable 'rope'. Did you mean 'tension'"):
        m.check()


def test_a_controller_holds_a_speed() -> None:
    m = polhode.Model(analysis={"duration": 5, "step": "5 ms"})
    disc = m.add_body("disc", mass=1, inertia=[0.1, 0.1, 0.2])
    axle = m.add_joint("axle", "revolute", ["ground", disc], at=[0, 0, 0], axis="z")
    m.add_controller("pi", joint=axle, channel="rate rz", setpoint=10, proportional=1.1, integral=2)
    m.add_load("motor", "rotary_motor", joint=axle, moment={"controller": "pi"})
    assert polhode.from_text(m.to_yaml()) == m and m.controllers["pi"].integral == 2
    speed = polhode.run(m).bodies["disc"].angular_velocity[:, 2]
    # J w'' + kp w' + ki w = ki 10, from rest with J w'(0) = kp 10
    decay, turn = 1.1 / 0.4, (2 / 0.2 - (1.1 / 0.4) ** 2) ** 0.5
    t = 5.0
    exact = 10 - np.exp(-decay * t) * (10 * np.cos(turn * t) + (10 * decay - 55) / turn * np.sin(turn * t))
    assert abs(speed[-1] - exact) < 1e-4
    with pytest.raises(polhode.ModelError, match="gain"):
        m.add_controller("p", joint=axle, channel="rate rz", gain=3)


def test_an_unknown_key_is_refused_at_once_with_the_nearest(pendulum: polhode.Model) -> None:
    with pytest.raises(polhode.ModelError) as error:
        pendulum.bodies["arm"].densty = 3
    assert error.value.path == "bodies.arm.densty" and "Did you mean 'density'" in error.value.hint
    with pytest.raises(polhode.ModelError, match="axix"):
        pendulum.add_joint("other", "revolute", ["ground", "arm"], at=[0, 0, 0], axix="y")
    assert list(pendulum.joints) == ["hinge"]
    with pytest.raises(polhode.ModelError, match="is taken"):
        pendulum.add_body("arm", mass=1)
    with pytest.raises(KeyError, match="Did you mean 'arm'"):
        _ = pendulum.bodies["amr"]


def test_faults_have_path_and_hint_and_in_files_line_and_column(tmp_path: pathlib.Path,
                                                                pendulum: polhode.Model) -> None:
    pendulum.joints["hinge"].bodies = ["ground", "arn"]
    with pytest.raises(polhode.ModelError) as error:
        pendulum.check()
    assert error.value.path == "joints.hinge.bodies" and "Did you mean 'arm'?" in error.value.hint
    assert error.value.line is None and error.value.file is None
    path = tmp_path / "m.yaml"
    pendulum.save(path)
    with pytest.raises(polhode.ModelError) as error:
        polhode.load(path).check()
    assert error.value.file == str(path) and error.value.line == 7 and "^" in str(error.value)
    copied = pickle.loads(pickle.dumps(error.value))
    assert str(copied) == str(error.value)
    path.write_text("format: [1")
    with pytest.raises(polhode.ModelError) as error:
        polhode.load(path)
    assert error.value.line == 1
    with pytest.raises(OSError):
        polhode.load(tmp_path / "none.yaml")


def test_shapes_have_the_sizes_of_the_model_file() -> None:
    assert polhode.Box(1, 2, 3, position=[0, 0, 1]).tree() == {"box": [1, 2, 3], "position": [0, 0, 1]}
    assert polhode.Tube(outer=0.2, inner="100 mm", length=1).tree() == {"tube": [0.2, "100 mm", 1]}
    assert polhode.Plane("z").tree() == {"plane": "z"}
    assert polhode.Mesh("a.stl", scale="1 mm").tree() == {"mesh": {"file": "a.stl", "scale": "1 mm"}}
    assert polhode.Hull(points=[[0, 0, 0]]).tree() == {"hull": {"points": [[0, 0, 0]]}}
    assert polhode.HeightField(1, [[0, 1], [0, 1]]).tree() == {
        "height_field": {"spacing": 1, "heights": [[0, 1], [0, 1]]}}
    assert repr(polhode.Sphere(0.1)) == "Sphere(diameter=0.1)"
    assert pickle.loads(pickle.dumps(polhode.Cone(1, 2))) == polhode.Cone(1, 2)
    with pytest.raises(TypeError):
        polhode.Box(1, 2)
    with pytest.raises(AttributeError):
        _ = polhode.Boxes


@pytest.mark.parametrize("kind", ["Box", "Sphere", "Cylinder", "Capsule", "Cone", "Ellipsoid", "Tube"])
def test_every_shape_is_read_by_the_engine(kind: str) -> None:
    shape = getattr(polhode, kind)
    m = polhode.Model(gravity=[0, 0, -1])
    sizes = {"x": 1, "y": 2, "z": 3, "diameter": 0.5, "length": 1, "outer": 0.5, "inner": 0.25}
    m.add_body("b", shape=shape(*[sizes[name] for name in shape.sizes]), density=10)
    m.check()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.parent.name)
def test_examples_go_through_text_without_loss(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    m = polhode.load(path)
    for name in ("again.yaml", "again.json"):
        m.save(tmp_path / name)
        assert polhode.load(tmp_path / name).to_dict() == m.to_dict()
    assert copy.copy(m) == m and pickle.loads(pickle.dumps(m)) == m


_values = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\u2028\u2029\ufeff\x85")),
    lambda inner: st.lists(inner, max_size=4)
    | st.dictionaries(st.text("abcxyz019_-", min_size=1), inner, max_size=4), max_leaves=12)


@settings(deadline=None, max_examples=300)
@given(st.dictionaries(st.text("abcxyz019_-", min_size=1), _values, min_size=1, max_size=5))
def test_any_tree_goes_through_yaml_without_loss(tree: "dict[str, object]") -> None:
    assert _native.parse(_text.block(tree), "t.yaml") == tree


def test_an_edited_model_reads_meshes_from_its_own_folder(tmp_path: pathlib.Path) -> None:
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4)]
    (tmp_path / "t.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners)
                                    + "".join(f"f {a} {b} {c}\n" for a, b, c in faces))
    m = polhode.Model()
    m.add_body("t", shape=polhode.Mesh("t.obj"), density=6)
    m.save(tmp_path / "m.yaml")
    m = polhode.load(tmp_path / "m.yaml")
    m.title = "changed"
    r = polhode.run(m, overrides={"analysis.duration": "1 ms"})
    assert r.bodies["t"].position[0] == pytest.approx([0.25] * 3, rel=1e-14)


def test_copies_do_not_change_with_the_model(pendulum: polhode.Model) -> None:
    other = pendulum.copy()
    pendulum.bodies["arm"].density = 1
    assert other == make_pendulum() and other != pendulum


def test_a_robot_is_a_model(tmp_path: pathlib.Path) -> None:
    inertial = "<inertial><mass value='2'/><inertia ixx='0.3' iyy='0.3' izz='0.2'/></inertial>"
    (tmp_path / "robot.urdf").write_text(
        f"<robot name='r'><link name='trunk'>{inertial}</link><link name='leg'>{inertial}</link>"
        "<joint name='hip' type='continuous'><parent link='trunk'/><child link='leg'/></joint></robot>")
    m = polhode.load(tmp_path / "robot.urdf", base="floating", start={"hip": 0.5})
    assert m.bodies["leg"].mass == 2 and m.joints["hip"].type == "revolute"
    assert polhode.load(tmp_path / "robot.urdf").bodies["trunk"].fixed
    m.check()
    with pytest.raises(polhode.ModelError):
        polhode.load(tmp_path / "robot.urdf", base="flying")
    (tmp_path / "robot.sdf").write_text(
        "<sdf version='1.10'><model name='r'><link name='leg'/><joint name='hip' type='ball'><parent>world</parent>"
        "<child>leg</child></joint></model></sdf>")
    assert polhode.load(tmp_path / "robot.sdf").joints["hip"].type == "spherical"
