# SPDX-License-Identifier: Apache-2.0
"""Invariance of results with respect to frame and units."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import polhode
from polhode import rotations as so3

Array = npt.NDArray[np.float64]

_turns = st.tuples(*[st.floats(-1.7, 1.7)] * 3).map(np.array)
_shifts = st.tuples(*[st.floats(-3, 3)] * 3).map(np.array)


_EYE, _ZERO = np.eye(3), np.zeros(3)


def double_pendulum(R: Array = _EYE, shift: Array = _ZERO, **scale: float) -> polhode.Model:
    """Two bars on spherical joints and a spring, in a rotated and shifted frame."""
    L, M, T = scale.get("length", 1), scale.get("mass", 1), scale.get("time", 1)
    units = {k: u for k, u in (("length", "mm" if L != 1 else "m"), ("mass", "g" if M != 1 else "kg"),
                               ("time", "ms" if T != 1 else "s"))}

    def place(x: "list[float]") -> "list[float]":
        placed: "list[float]" = ((R @ np.array(x) + shift) * L).tolist()
        return placed

    def turn(x: "list[float]", unit: float) -> "list[float]":
        turned: "list[float]" = (R @ np.array(x) * unit).tolist()
        return turned

    m = polhode.Model(units=units, gravity=turn([0, 0, -9.81], L / T**2),
                      analysis={"duration": 0.3 * T, "step": 0.01 * T})
    attitude = {"matrix": R.tolist()}
    for name, x in (("upper", 0.5), ("lower", 1.5)):
        m.add_body(name, mass=2 * M, inertia=[0.02 * M * L**2, 0.3 * M * L**2, 0.29 * M * L**2], orientation=attitude,
                   position=place([x, 0, 0]), angular_velocity=turn([0, 0.5, 0.3], 1 / T))
    m.add_joint("a", "spherical", ["ground", "upper"], at=place([0, 0, 0]))
    m.add_joint("b", "spherical", ["upper", "lower"], at=place([1, 0, 0]))
    m.add_load("s", "spring_damper", bodies=["ground", "lower"], at=[place([2, 1, 1]), place([2, 0, 0])],
               stiffness=30 * M / T**2, free_length=0.5 * L)
    return m


_PLAIN = polhode.run(double_pendulum())


@settings(deadline=None, max_examples=25)
@given(_turns, _shifts)
def test_motion_and_reactions_do_not_depend_on_the_frame(v: Array, shift: Array) -> None:
    R = so3.matrix_from_rotation_vector(v)
    r = polhode.run(double_pendulum(R, shift))
    for name in ("upper", "lower"):
        assert r.bodies[name].position == pytest.approx(_PLAIN.bodies[name].position @ R.T + shift, abs=1e-10)
        assert r.bodies[name].angular_velocity == pytest.approx(_PLAIN.bodies[name].angular_velocity @ R.T, abs=1e-9)
    assert r.joints["b"].force == pytest.approx(_PLAIN.joints["b"].force @ R.T, abs=1e-7)
    assert r.energy.kinetic == pytest.approx(_PLAIN.energy.kinetic, abs=1e-10)


@settings(deadline=None, max_examples=8)
@given(st.sampled_from([1, 1000]), st.sampled_from([1, 1000]), st.sampled_from([1, 1000]))
def test_motion_does_not_depend_on_the_units(length: float, mass: float, time: float) -> None:
    r = polhode.run(double_pendulum(length=length, mass=mass, time=time))
    assert r.time == pytest.approx(_PLAIN.time, rel=1e-12)
    assert r.bodies["lower"].position == pytest.approx(_PLAIN.bodies["lower"].position, abs=1e-10)
    assert r.joints["a"].force == pytest.approx(_PLAIN.joints["a"].force, abs=1e-7)
