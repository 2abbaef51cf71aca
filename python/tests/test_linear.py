# SPDX-License-Identifier: Apache-2.0
"""Linearisation and inverse dynamics against closed forms."""

from typing import Callable

import numpy as np
import pytest

import polhode
from conftest import make_pendulum

CART, POLE, HALF, INERTIA, G = 2.0, 0.3, 0.4, 0.02, 9.81


def cart_pole(**pole: object) -> polhode.Model:
    """A pole that stands on a cart; the cart slides along x."""
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 1, "step": 0.001})
    m.add_body("cart", mass=CART, inertia=[1, 1, 1])
    m.add_body("pole", mass=POLE, inertia=[INERTIA] * 3, position=[0, 0, HALF], **pole)
    m.add_joint("slide", "prismatic", ["ground", "cart"], at=[0, 0, 0], axis="x")
    m.add_joint("hinge", "revolute", ["cart", "pole"], at=[0, 0, 0], axis="y")
    m.add_load("push", "force", body="cart", force=[0, 0, 0])
    m.add_load("motor", "rotary_motor", joint="hinge", moment=0)
    return m


def test_a_cart_pole_has_the_matrices_of_the_textbook() -> None:
    outputs = ["joints.hinge.coordinates", "bodies.pole.velocity.x"]
    s = polhode.linearize(cart_pole(), ["push.x", "loads.motor"], outputs)
    assert s.states == ["joints.slide.coordinates.0", "joints.hinge.coordinates.0",
                        "joints.slide.rates.0", "joints.hinge.rates.0"]
    # (M+m) x'' + m l a'' = F,  m l x'' + (J + m l^2) a'' = m g l a + T
    M = np.array([[CART + POLE, POLE * HALF], [POLE * HALF, INERTIA + POLE * HALF**2]])
    A, B = np.zeros((4, 4)), np.zeros((4, 2))
    A[:2, 2:] = np.eye(2)
    A[2:, :2] = np.linalg.solve(M, [[0.0, 0.0], [0.0, POLE * G * HALF]])
    B[2:] = np.linalg.inv(M)
    assert s.A == pytest.approx(A, abs=1e-11 * np.abs(A).max())
    assert s.B == pytest.approx(B, abs=1e-11 * np.abs(B).max())
    assert s.C == pytest.approx(np.array([[0, 1, 0, 0], [0, 0, 1, HALF]]), abs=1e-12)
    assert s.D == pytest.approx(np.zeros((2, 2)), abs=1e-12)
    assert s.outputs == ["joints.hinge.coordinates.0", "bodies.pole.velocity.x"] and s.inputs[0] == "push.x"


def test_a_reaction_goes_through() -> None:
    s = polhode.linearize(cart_pole(), ["push.z"], ["joints.slide.force"])
    assert abs(s.D[2, 0]) == pytest.approx(1.0, abs=1e-9)  # a vertical force on the cart reduces the load of its guide


def test_about_a_steady_motion_coordinates_that_nothing_depends_on_have_no_stiffness() -> None:
    # A pendulum on a shaft of constant rate, at its angle of equilibrium:
    # a'' = W^2 sin a cos a (1) - g/l sin a for a point; its linearisation is -W^2 sin(a)^2 for a fixed rate.
    W, L = 6.0, 1.0
    angle = np.arccos(G / (W**2 * L))
    s, c = np.sin(angle), np.cos(angle)
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 1, "step": 0.001})
    m.add_body("shaft", mass=1, inertia=[1e6, 1e6, 1e6], angular_velocity=[0, 0, W])
    m.add_body("bob", mass=1e-3, inertia=[1e-12] * 3, position=[L * s, 0, -L * c], velocity=[0, W * L * s, 0],
               angular_velocity=[0, 0, W])
    m.add_joint("axle", "revolute", ["ground", "shaft"], at=[0, 0, 0], axis="z")
    m.add_joint("pin", "revolute", ["shaft", "bob"], at=[0, 0, 0], axis="y")
    A = polhode.linearize(m).A
    inertia = 1 + 1e-12 / 1e-3  # the bob's own, as a part of m l^2
    assert A[3, 1] == pytest.approx(-(W**2) * s**2 / inertia, rel=1e-11)
    assert A[3, 2] == pytest.approx(2 * W * s * c / inertia, rel=1e-10) or A[3, 2] == pytest.approx(
        -2 * W * s * c / inertia, rel=1e-10)
    assert np.abs(A[2:, 0]).max() < 1e-10 * W**2  # the shaft's angle


def hanging_pendulum(m: polhode.Model) -> float:
    """A pendulum; returns the square of its frequency."""
    m.add_body("arm", mass=2, inertia=[0.2, 0.3, 0.2], position=[0, 0, -0.7])
    m.add_joint("hinge", "revolute", ["ground", "arm"], at=[0, 0, 0], axis="y")
    return 2 * G * 0.7 / (0.3 + 2 * 0.7**2)


def hanging_four_bar(m: polhode.Model) -> float:
    """A parallelogram of two cranks and a coupler that hang, with redundant rows; the square of its frequency."""
    length = 0.8
    for name, x in (("left", 0.0), ("right", 1.0)):
        m.add_body(name, mass=1.5, inertia=[0.05] * 3, position=[x, 0, -length / 2])
        m.add_joint(f"top_{name}", "revolute", ["ground", name], at=[x, 0, 0], axis="y")
    m.add_body("coupler", mass=3, inertia=[0.2] * 3, position=[0.4, 0, -length])
    m.add_joint("foot_left", "revolute", ["left", "coupler"], at=[0, 0, -length], axis="y")
    m.add_joint("foot_right", "revolute", ["coupler", "right"], at=[1, 0, -length], axis="y")
    stiffness = G * (2 * 1.5 * length / 2 + 3 * length)
    return stiffness / (2 * (0.05 + 1.5 * length**2 / 4) + 3 * length**2)


@pytest.mark.parametrize("build", [hanging_pendulum, hanging_four_bar])
def test_small_swings_have_the_frequency_of_the_closed_form(build: "Callable[[polhode.Model], float]") -> None:
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 1, "step": 0.001})
    square = build(m)
    values = np.linalg.eigvals(polhode.linearize(m).A)
    assert np.abs(values.real).max() < 1e-10 * np.sqrt(square)
    assert values.imag.max() == pytest.approx(np.sqrt(square), rel=1e-11)
    (mode,) = polhode.modes(m, about="start")
    assert mode.frequency == pytest.approx(np.sqrt(square) / (2 * np.pi), rel=1e-11)


@pytest.mark.parametrize("spin", [1.0, 100.0, 3000.0])
def test_a_spinning_disc_in_gimbals_has_the_nutation_of_the_closed_form(spin: float) -> None:
    # (A + I_x) a'' + C w b' = 0, (A + I_y) b'' - C w a' = 0: free but for lambda^2 = -(C w)^2 / ((A + I_x) (A + I_y)).
    polar, across, outer, inner = 0.4, 0.25, 0.03, 0.02
    m = polhode.Model(gravity=[0, 0, 0], analysis={"duration": 1, "step": 0.001})
    m.add_body("outer", mass=1, inertia=[outer] * 3)
    m.add_body("inner", mass=1, inertia=[inner] * 3)
    m.add_body("disc", mass=2, inertia=[across, across, polar], angular_velocity=[0, 0, spin])
    m.add_joint("a", "revolute", ["ground", "outer"], at=[0, 0, 0], axis="x")
    m.add_joint("b", "revolute", ["outer", "inner"], at=[0, 0, 0], axis="y")
    m.add_joint("c", "revolute", ["inner", "disc"], at=[0, 0, 0], axis="z")
    values = np.linalg.eigvals(polhode.linearize(m).A)
    nutation = polar * spin / np.sqrt((across + inner + outer) * (across + inner))
    assert values.imag.max() == pytest.approx(nutation, rel=1e-10)
    assert np.sort(np.abs(values))[:4] == pytest.approx(np.zeros(4), abs=1e-4 * spin)  # square roots of rounding


def test_python_control_takes_the_matrices() -> None:
    control = pytest.importorskip("control")
    s = polhode.linearize(cart_pole(), ["push.x"], ["joints.hinge.coordinates"])
    inputs, outputs, states = ([n.replace(".", "_") for n in names] for names in (s.inputs, s.outputs, s.states))
    plant = control.ss(s.A, s.B, s.C, s.D, inputs=inputs, outputs=outputs, states=states)
    assert plant.input_labels == ["push_x"] and np.allclose(np.sort(plant.poles()), np.sort(np.linalg.eigvals(s.A)))
    gain, _, poles = control.lqr(plant, np.eye(len(s.states)), [[1.0]])  # supports the weight
    assert np.max(np.real(np.linalg.eigvals(s.A))) > 0 > np.max(np.real(poles))
    assert np.max(np.real(np.linalg.eigvals(s.A - s.B @ gain))) < 0


def test_what_cannot_be_linearised_is_told() -> None:
    with pytest.raises(KeyError, match="unknown load 'pusch'. Did you mean 'push'"):
        polhode.linearize(cart_pole(), ["pusch.x"])
    with pytest.raises(KeyError, match="unknown joint 'hinges'. Did you mean 'hinge'"):
        polhode.linearize(cart_pole(), [], ["joints.hinges.rates"])
    with pytest.raises(polhode.ModelError, match="has no such input"):
        polhode.linearize(cart_pole(), ["push"])
    m = polhode.Model()
    m.add_body("stone", mass=1, inertia=[1, 2, 3])
    with pytest.raises(ValueError, match="3 of 6 degrees of freedom are neither coordinates"):
        polhode.linearize(m)


def test_inverse_dynamics_of_a_pendulum() -> None:
    m = make_pendulum()
    t = np.linspace(0, 1, 201)
    angle = 0.3 * (t - np.sin(2 * np.pi * t) / (2 * np.pi))  # from rest to rest
    moment = polhode.inverse_dynamics(m, t, {"hinge": angle})["hinge"]
    mass, inertia = 2.5, 2.5 * (1 + 0.05**2) / 12 + 2.5 * 0.25
    faster = 0.3 * 2 * np.pi * np.sin(2 * np.pi * t)
    # A positive angle about y lowers the arm, in the direction of gravity.
    needed = inertia * faster - mass * 9.81 * 0.5 * np.cos(angle)
    # The step of 5 ms: order 2 of (2 pi dt)^2.
    assert moment[:, 1] == pytest.approx(needed, abs=1e-3 * np.abs(needed).max())
    assert np.abs(moment[:, [0, 2]]).max() < 1e-8
    with pytest.raises(polhode.ModelError, match="unknown joint 'hinges'"):
        polhode.inverse_dynamics(m, t, {"hinges": angle})


@pytest.mark.parametrize("spin", [0.1, 10.0, 1000.0])
def test_modes_about_a_spin_of_a_free_body_have_eulers_nutation(spin: float) -> None:
    m = polhode.Model()
    m.add_body("a", mass=1, inertia=[2, 3, 4])
    (modes,) = polhode.spin_modes(m, spin, axis="z")
    nutation = spin * np.sqrt((4 - 2) * (4 - 3) / (2 * 3)) / (2 * np.pi)  # of Ω along the axis of C, in the body
    assert min(abs(mode.frequency - nutation) for mode in modes) < 1e-7 * spin


def on_its_stop(angle: str, **analysis: object) -> polhode.Model:
    """A pendulum with another one below it, held up by a stop or free of it."""
    m = polhode.Model(gravity=[0, 0, -G], contacts={"default": {"law": "rigid"}}, analysis=analysis)
    m.add_body("upper", mass=2, inertia=[0.01] * 3, position=[-0.3, 0, 2])
    m.add_body("lower", mass=1, inertia=[0.02] * 3, position=[-0.3, 0, 1.5])
    m.add_joint("hinge", "revolute", ["ground", "upper"], at=[0, 0, 2.5], axis="y", limits={"lower": angle})
    m.add_joint("knee", "revolute", ["upper", "lower"], at=[-0.3, 0, 2], axis="y")
    return m


def test_stops_that_hold_are_named_in_modes_and_refused_in_linearisations() -> None:
    found = polhode.modes(on_its_stop("0 deg"))
    assert found.held == ["the stop of joint 'hinge'"]
    # The lower one swings alone: J + m l^2 about the knee.
    assert found[0].frequency == pytest.approx(np.sqrt(G * 0.5 / (0.02 + 0.25)) / (2 * np.pi), rel=1e-9)
    moving = {"type": "dynamics", "duration": 1, "step": 0.001}
    with pytest.raises(ValueError, match="the stop of joint 'hinge' is closed here"):
        polhode.linearize(on_its_stop("0 deg", **moving))
    with pytest.raises(polhode.ModelError, match="closed in this motion"):
        polhode.matrices(on_its_stop("0 deg", **moving))
    assert len(polhode.linearize(on_its_stop("-10 deg", **moving)).states) == 4
