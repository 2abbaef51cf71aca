# SPDX-License-Identifier: Apache-2.0
"""Text files in the format of FEBio's log file, and what a run with a closed form has in them."""

import pathlib
from typing import Any

import numpy as np
import pytest

import polhode

# A block of 1000 kg in free fall, which turns about z, beside a fixed body.
MODEL = """<?xml version="1.0" encoding="ISO-8859-1"?>
<!-- A comment. -->
<febio_spec version="4.0">
  <Module type="solid"/>
  <Control><analysis>DYNAMIC</analysis><time_steps>10</time_steps><step_size>0.05</step_size>
    <solver type="solid"><rhoi>1</rhoi></solver></Control>
  <Material>
    <material id="1" name="wall" type="rigid body"><center_of_mass>0,0,0</center_of_mass></material>
    <material id="2" name="the block" type="rigid body"><density>1000</density></material>
  </Material>
  <Mesh>
    <Nodes>
      <node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">1,1,0</node><node id="4">0,1,0</node>
      <node id="5">0,0,1</node><node id="6">1,0,1</node><node id="7">1,1,1</node><node id="8">0,1,1</node>
    </Nodes>
    <Elements type="hex8" name="part"><elem id="1">1,2,3,4,5,6,7,8</elem></Elements>
    <NodeSet name="corners">1,7</NodeSet>
  </Mesh>
  <MeshDomains><SolidDomain name="part" mat="the block"/></MeshDomains>
  <Rigid>
    <rigid_bc type="rigid_fixed"><rb>wall</rb>
      <Rx_dof>1</Rx_dof><Ry_dof>1</Ry_dof><Rz_dof>1</Rz_dof><Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof>
    </rigid_bc>
    <rigid_ic type="initial_rigid_angular_velocity"><rb>the block</rb><value>0,0,0.5</value></rigid_ic>
  </Rigid>
  <Loads><body_load type="body force"><force>0,0,10</force></body_load></Loads>
  <Output><logfile file="run.log">{requests}</logfile></Output>
</febio_spec>
"""


def written(tmp_path: pathlib.Path, requests: str) -> "list[str]":
    file = tmp_path / "fall.feb"
    file.write_text(MODEL.format(requests=requests))
    return polhode.write_febio_log(polhode.run(polhode.load(file)), file, tmp_path)


def blocks(path: str) -> "list[tuple[int, float, str, Any]]":
    """Step, time, title and rows of each record, as a reader of FEBio's files has them."""
    records = []
    for part in pathlib.Path(path).read_text().split("*Step  = ")[1:]:
        step, time, data, *rows = part.splitlines()
        records.append((int(step), float(time.removeprefix("*Time  = ")), data.removeprefix("*Data  = "),
                        np.array([[float(x) for x in row.replace(",", " ").split()] for row in rows])))
    return records


def test_bodies_and_nodes_are_written_as_febio_does(tmp_path: pathlib.Path) -> None:
    paths = written(tmp_path, '<rigid_body_data data="x;z;vz;omz;qz;qw" file="body.txt" delim=", ">2</rigid_body_data>'
                              '<node_data data="x;y;z;uz" name="places" node_set="corners"/>')
    assert [pathlib.Path(p).name for p in paths] == ["body.txt", "fall_node_data_2.txt"]
    records = blocks(paths[0])
    assert [r[0] for r in records] == list(range(1, 11))
    for _, t, title, rows in records:
        assert title == "x;z;vz;omz;qz;qw"
        turn = 0.25 * t
        assert rows[0] == pytest.approx([2, 0.5, 0.5 - 5 * t * t, -10 * t, 0.5, np.sin(turn), np.cos(turn)], abs=2e-5)
    for _, t, title, rows in blocks(paths[1]):
        assert title == "places"
        c, s = 0.5 * np.cos(0.5 * t), 0.5 * np.sin(0.5 * t)
        assert rows[0] == pytest.approx([1, 0.5 - c + s, 0.5 - c - s, -5 * t * t, -5 * t * t], abs=2e-4)
        assert rows[1] == pytest.approx([7, 0.5 + c - s, 0.5 + c + s, 1 - 5 * t * t, -5 * t * t], abs=2e-4)
    text = (tmp_path / "body.txt").read_text()
    assert text.startswith("*Step  = 1\n*Time  = 0.05\n*Data  = x;z;vz;omz;qz;qw\n2, 0.5, ")


def test_lists_of_numbers_are_those_of_febio(tmp_path: pathlib.Path) -> None:
    paths = written(tmp_path, '<node_data data="x">1:7:3, 8</node_data>')
    assert [int(row[0]) for row in blocks(paths[0])[0][3]] == [1, 4, 7, 8]
    paths = written(tmp_path, '<rigid_body_data data="x"/>')
    assert [int(row[0]) for row in blocks(paths[0])[0][3]] == [1, 2]


def test_each_request_for_a_body_is_written(tmp_path: pathlib.Path) -> None:
    requests = [f'<rigid_body_data data="{data}" file="{name}.txt">2</rigid_body_data>'
                for name, data in (("a", "x;y;z"), ("b", "qx;qy;qz;qw"), ("c", "thx;thy;thz"), ("d", "omz"))]
    paths = written(tmp_path, "".join(requests))
    assert [pathlib.Path(p).name for p in paths] == ["a.txt", "b.txt", "c.txt", "d.txt"]
    for (_, t, _, b), (_, _, _, c), (_, _, _, d) in zip(*(blocks(p) for p in paths[1:])):
        assert b[0] == pytest.approx([2, 0, 0, np.sin(0.25 * t), np.cos(0.25 * t)], abs=2e-5)
        assert c[0] == pytest.approx([2, 0, 0, 0.5 * t], abs=2e-4)
        assert d[0] == pytest.approx([2, 0.5], abs=1e-9)


def test_what_no_probe_has_is_a_warning(tmp_path: pathlib.Path) -> None:
    with pytest.warns(UserWarning, match='<element_data data="sx"> is not written: the result does not have it'):
        assert written(tmp_path, '<element_data data="sx">1</element_data>') == []
    with pytest.warns(UserWarning, match='<rigid_body_data data="x;Fx"> is not written'):
        assert written(tmp_path, '<rigid_body_data data="x;Fx">2</rigid_body_data>') == []


def test_other_files_are_refused(tmp_path: pathlib.Path) -> None:
    written(tmp_path, '<node_data data="x">1</node_data>')
    result = polhode.run(polhode.load(tmp_path / "fall.feb"))
    for text in ("<robot/>", '<!DOCTYPE a [<!ENTITY b "c">]><febio_spec/>'):
        (tmp_path / "other.feb").write_text(text)
        with pytest.raises(ValueError, match="is no FEBio file"):
            polhode.write_febio_log(result, tmp_path / "other.feb")


# A cube of modulus 1000 between the ground and a rigid grip that stretches it by half, its sides held.
TISSUE = """<febio_spec version="4.0">
  <Module type="solid"/>
  <Control><analysis>STATIC</analysis><time_steps>5</time_steps><step_size>0.2</step_size></Control>
  <Material>
    <material id="1" name="soft" type="neo-Hookean"><density>1</density><E>1000</E><v>0</v></material>
    <material id="2" name="the grip" type="rigid body"><density>1</density></material>
  </Material>
  <Mesh>
    <Nodes>
      <node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">1,1,0</node><node id="4">0,1,0</node>
      <node id="5">0,0,1</node><node id="6">1,0,1</node><node id="7">1,1,1</node><node id="8">0,1,1</node>
      <node id="9">2,0,0</node><node id="10">2,1,0</node><node id="11">2,0,1</node><node id="12">2,1,1</node>
    </Nodes>
    <Elements type="hex8" name="cube"><elem id="7">1,2,3,4,5,6,7,8</elem></Elements>
    <Elements type="hex8" name="block"><elem id="8">2,9,10,3,6,11,12,7</elem></Elements>
    <NodeSet name="wall">1,4,5,8</NodeSet>
  </Mesh>
  <MeshDomains><SolidDomain name="cube" mat="soft"/><SolidDomain name="block" mat="the grip"/></MeshDomains>
  <Boundary>
    <bc type="zero displacement" node_set="wall"><x_dof>1</x_dof><y_dof>1</y_dof><z_dof>1</z_dof></bc>
  </Boundary>
  <Rigid>
    <rigid_bc type="rigid_displacement"><rb>the grip</rb><dof>Rx</dof><value lc="1">0.5</value></rigid_bc>
    <rigid_bc type="rigid_fixed"><rb>the grip</rb>
      <Ry_dof>1</Ry_dof><Rz_dof>1</Rz_dof><Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>
  </Rigid>
  <LoadData>
    <load_controller id="1" type="loadcurve"><points><pt>0,0</pt><pt>1,1</pt></points></load_controller>
  </LoadData>
  <Output><logfile>{requests}</logfile></Output>
</febio_spec>
"""


def test_elements_and_forces_are_those_of_a_stretched_cube(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "pull.feb"
    file.write_text(TISSUE.format(requests='<element_data data="sx;sy;x;sed"/>'
                                           '<rigid_body_data data="x;ux;Fx;Fy">2</rigid_body_data>'
                                           '<node_data data="x;ux"/><node_data data="Rx">2</node_data>'))
    # One of all elements is rigid.
    with pytest.warns(UserWarning) as told:
        polhode.write_febio_log(polhode.run(polhode.load(file)), file, tmp_path)
    assert [str(w.message).split(" is not")[0] for w in told] == ['<element_data data="sx;sy;x;sed">',
                                                                  '<node_data data="Rx">']
    file.write_text(file.read_text().replace("sed\"/>", "sed\">7</element_data>"))
    with pytest.warns(UserWarning, match='<node_data data="Rx"> is not written'):
        paths = polhode.write_febio_log(polhode.run(polhode.load(file)), file, tmp_path)
    elements, bodies, nodes = (blocks(path) for path in paths)
    assert [r[1] for r in elements] == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    for (_, t, _, element), (_, _, _, body), (_, _, _, node) in zip(elements, bodies, nodes):
        # The volume ratio is the stretch, and Lamé's constants are 0 and 500.
        stretch = 1 + 0.5 * t
        force = 500 * (stretch**2 - 1) / stretch
        energy = 250 * (stretch**2 - 1) - 500 * np.log(stretch)
        assert element[0] == pytest.approx([7, force, 0, 0.5 * stretch, energy], rel=2e-5, abs=1e-6)
        assert body[0] == pytest.approx([2, 0.5 + stretch, 0.5 * t, force, 0], rel=2e-5, abs=1e-6)
        assert node[:, 0] == pytest.approx(range(1, 13))
        assert node[1] == pytest.approx([2, stretch, 0.5 * t], rel=2e-5)
        assert node[11] == pytest.approx([12, 2 + 0.5 * t, 0.5 * t], rel=2e-5)


def test_connectors_act_on_their_first_body(tmp_path: pathlib.Path) -> None:
    lock = ('<rigid_connector name="hook" type="rigid lock"><body_a>wall</body_a><body_b>the block</body_b>'
            "<joint_origin>0.5,0.5,0.5</joint_origin></rigid_connector></Rigid>")
    file = tmp_path / "hang.feb"
    text = MODEL.replace("</Rigid>", lock).replace("0,0,0.5</value>", "0,0,0</value>")
    request = '<rigid_connector_data data="RCFx;RCFz;RCMx" file="c.txt">1</rigid_connector_data>'
    file.write_text(text.format(requests=request))
    records = blocks(polhode.write_febio_log(polhode.run(polhode.load(file)), file, tmp_path)[0])
    assert [r[1] for r in records] == pytest.approx([0.05 * k for k in range(1, 11)])
    for _, _, _, rows in records:
        assert rows[0] == pytest.approx([1, 0, -10000, 0], abs=1e-6)


def test_all_nodes_of_a_body_that_turns_are_written(tmp_path: pathlib.Path) -> None:
    some = blocks(written(tmp_path, '<node_data data="x;y;z;uy;vx">1:8</node_data>')[0])
    every = blocks(written(tmp_path, '<node_data data="x;y;z;uy;vx"/>')[0])
    for _, t, _, rows in every:
        exact = next(r[3] for r in some if r[1] == pytest.approx(t))
        assert rows == pytest.approx(exact, abs=2e-5)
