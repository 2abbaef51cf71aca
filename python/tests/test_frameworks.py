# SPDX-License-Identifier: Apache-2.0
"""Runs in JAX and PyTorch."""

from typing import Any

import numpy as np
import pytest
from test_derivatives import throw

import polhode

PATHS = ["bodies.ball.velocity.2", "gravity.2"]


def closed_form(steps: int) -> "tuple[float, list[float]]":
    """Sum of the squares of all heights of a throw, and its slope by speed and gravity."""
    t = np.linspace(0, 0.5, steps + 1)
    z = 1 + 4 * t - 9.81 / 2 * t * t
    return float(z @ z), [float(2 * z @ t), float(2 * z @ (t * t / 2))]


@pytest.mark.parametrize(("step", "steps"), [("50 ms", 10), ("10 ms", 50), ("1 ms", 500)])
def test_jax_differentiates_a_run(step: str, steps: int) -> None:
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    height = polhode.jax_function(throw(step), PATHS, ["bodies.ball.position", "bodies.ball.velocity.z"])

    def loss(x: Any) -> Any:
        return (height(x)["bodies.ball.position"][:, 2] ** 2).sum()

    at = jax.numpy.array([4.0, -9.81])
    value, slope = jax.value_and_grad(loss)(at)
    exact, by = closed_form(steps)
    assert float(value) == pytest.approx(exact, rel=1e-12)
    assert np.asarray(slope) == pytest.approx(by, rel=1e-10)
    assert np.asarray(jax.jit(jax.grad(loss))(at)) == pytest.approx(by, rel=1e-10)
    several = jax.vmap(jax.grad(loss))(jax.numpy.stack([at, at]))
    assert np.asarray(several) == pytest.approx(np.array([by, by]), rel=1e-10)
    with pytest.raises(ValueError, match=r"the shape \(3,\), not \(2,\)"):
        height(np.zeros(3))


def test_jax_in_single_precision_is_refused() -> None:
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(ValueError, match="single precision"):
        polhode.jax_function(throw(), PATHS, ["bodies.ball.position"])


@pytest.mark.parametrize(("step", "steps"), [("50 ms", 10), ("10 ms", 50), ("1 ms", 500)])
def test_torch_differentiates_a_run(step: str, steps: int) -> None:
    torch = pytest.importorskip("torch")
    height = polhode.torch_function(throw(step), PATHS, ["bodies.ball.position", "bodies.ball.velocity.z"])
    x = torch.tensor([4.0, -9.81], dtype=torch.float64, requires_grad=True)
    loss = (height(x)["bodies.ball.position"][:, 2] ** 2).sum()
    loss.backward()
    exact, by = closed_form(steps)
    assert loss.item() == pytest.approx(exact, rel=1e-12)
    assert x.grad.numpy() == pytest.approx(by, rel=1e-10)


def test_a_function_of_nothing_is_refused() -> None:
    pytest.importorskip("jax").config.update("jax_enable_x64", True)
    with pytest.raises(polhode.ModelError, match="needs parameters and channels"):
        polhode.jax_function(throw(), [], ["bodies.ball.position"])
