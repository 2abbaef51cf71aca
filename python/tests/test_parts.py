# SPDX-License-Identifier: Apache-2.0
"""Models within models."""

import pathlib
from collections.abc import Mapping
from typing import Optional

import numpy as np
import pytest

import polhode


def leg() -> polhode.Model:
    m = polhode.Model(variables={"L": 0.4})
    m.add_body("thigh", mass=3, inertia=[0.1, 0.2, 0.15], position=[0, 0.1, "-L/2"], angular_velocity=[0.5, 0.2, 0.3])
    m.add_body("shin", shape=polhode.Box(0.05, 0.08, "L"), density=900, position=[0, 0.1, "-1.5*L"])
    m.add_joint("knee", "revolute", ["thigh", "shin"], at=[0, 0.1, "-L"], axis=[0.2, 1, 0.1])
    m.add_load("tendon", "torsional_spring", joint="knee", stiffness=5, damping=0.1, free_angle=0.3)
    return m


def walker(variables: "Optional[Mapping[str, float]]" = None) -> polhode.Model:
    m = polhode.Model(analysis={"duration": 0.5, "step": "5 ms"})
    m.add_body("hip", mass=10, inertia=[1, 1, 1], fixed=True)
    for name, mirror, own in (("left", None, None), ("right", "y", variables)):
        m.attach(leg(), name, prefix=name[0] + "_", at=[0, 0, -0.1], mirror=mirror, variables=own)
        y = 0.1 if name == "left" else -0.1
        m.add_joint(f"{name}_hip", "spherical", ["hip", f"{name[0]}_thigh"], at=[0, y, -0.1])
    return m


def test_mirrored_parts_of_one_machine_move_as_mirror_images() -> None:
    r = polhode.run(walker())
    left, right = r.bodies["l_shin"], r.bodies["r_shin"]
    assert np.ptp(left.position, axis=0).max() > 0.02
    assert right.position == pytest.approx(left.position * [1, -1, 1], abs=1e-11)
    assert right.angular_velocity == pytest.approx(left.angular_velocity * [-1, 1, -1], abs=1e-10)
    assert r.joints["r_knee"].coordinates == pytest.approx(r.joints["l_knee"].coordinates, abs=1e-11)


def test_variables_of_a_part_and_files_and_round_trips(tmp_path: pathlib.Path) -> None:
    m = walker(variables={"L": 0.5})
    m.save(tmp_path / "walker.yaml")
    again = polhode.load(tmp_path / "walker.yaml")
    assert again == m
    sim = polhode.Simulation(again, overrides={"parts.right.variables.L": 0.6})
    assert sim.bodies["r_shin"].position == pytest.approx([0, -0.1, -1.0])
    leg().save(tmp_path / "leg.yaml")
    alone = polhode.Model()
    alone.attach(polhode.load(tmp_path / "leg.yaml"), prefix="l_", at=[1, 0, 0])
    assert alone.parts["l"].file == str(tmp_path / "leg.yaml")
    assert polhode.Simulation(alone).bodies["l_thigh"].position == pytest.approx([1, 0.1, -0.2])


def test_faults_of_parts() -> None:
    m = walker(variables={"l": 0.5})
    with pytest.raises(polhode.ModelError, match="the part has no variable 'l'"):
        m.check()
    with pytest.raises(polhode.ModelError, match="a part needs a name"):
        m.attach(leg())
    with pytest.raises(polhode.ModelError, match="the name 'left' is taken"):
        m.attach(leg(), "left")
