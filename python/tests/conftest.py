# SPDX-License-Identifier: Apache-2.0
"""Models for several tests."""

import pathlib

import pytest

import polhode

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*/model.yaml"))


def make_pendulum(**keys: object) -> polhode.Model:
    """A bar on a hinge, released horizontally."""
    analysis = {"duration": 1, "step": "5 ms"}
    m = polhode.Model(gravity=[0, 0, -9.81], analysis=analysis, **keys)
    arm = m.add_body("arm", shape=polhode.Box(1, 0.05, 0.05), density=1000, position=[0.5, 0, 0])
    m.add_joint("hinge", "revolute", ["ground", arm], at=[0, 0, 0], axis="y")
    return m


def make_chain() -> polhode.Model:
    """Three bars on ball joints, whose motion is chaotic."""
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": "3 s", "step": "20 ms"})
    before = "ground"
    for k in range(3):
        m.add_body(f"b{k}", shape=polhode.Box(0.3, 0.02, 0.02), density=1000, position=[0.15 + 0.3 * k, 0, 0])
        m.add_joint(f"j{k}", "spherical", [before, f"b{k}"], at=[0.3 * k, 0, 0])
        before = f"b{k}"
    m.bodies["b2"].angular_velocity = [0, 2, 3]
    return m


@pytest.fixture
def pendulum() -> polhode.Model:
    return make_pendulum()
