# SPDX-License-Identifier: Apache-2.0
"""Runs as differentiable functions of JAX and PyTorch."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import Any, Callable

import numpy as np

from ._errors import fault
from ._model import Model, Overrides
from ._result import Result
from ._run import run


class _Runs:
    """Channels of a run as a function of parameters, and the transposed derivative."""

    def __init__(self, model: Model, parameters: "Sequence[str]", channels: "Sequence[str]",
                 overrides: Overrides) -> None:
        self.model, self.overrides = model, dict(overrides or {})
        self.parameters = [parameters] if isinstance(parameters, str) else list(parameters)
        self.channels = [channels] if isinstance(channels, str) else list(channels)
        if not self.parameters or not self.channels:
            raise fault("", "a function of a run needs parameters and channels",
                        "Name paths such as variables.L, and channels such as bodies.rod.position")
        first = run(model, overrides=self.overrides, progress=False)
        self.shapes = {name: np.asarray(first[name]).shape for name in self.channels}

    def result(self, x: Any) -> Result:
        values = dict(zip(self.parameters, np.asarray(x, dtype=float).tolist()))
        return run(self.model, overrides={**self.overrides, **values}, progress=False)

    def check(self, shape: "tuple[int, ...]") -> None:
        """Raises ValueError if parameters of this shape are not those of the function."""
        if shape != (len(self.parameters),):
            raise ValueError(f"the parameters have the shape {shape}, not ({len(self.parameters)},)")

    def values(self, x: Any) -> "dict[str, Any]":
        """Channels as arrays (frames, ...)."""
        result = self.result(x)
        found = {name: np.array(result[name], dtype=float) for name in self.channels}
        for name, array in found.items():
            if array.shape != self.shapes[name]:
                raise ValueError(f"'{name}' has the shape {array.shape}, and {self.shapes[name]} with the model's own "
                                 "values: the number of frames may not depend on the parameters")
        return found

    def slope(self, x: Any, weights: "Mapping[str, Any]") -> Any:
        """Derivative of the weighted sum of channels by the parameters."""
        given = {name: np.asarray(weights[name], dtype=float) for name in self.channels}
        return np.array(list(self.result(x).pull_back(given, self.parameters).values()))


def jax_function(model: Model, parameters: "Sequence[str]", channels: "Sequence[str]", *,
                 overrides: Overrides = None) -> "Callable[[Any], dict[str, Any]]":
    """Channels of a run as a function of parameters that JAX differentiates, by reverse mode.

    parameters: paths of numbers of the model; the function takes an array of their values (p,).
    channels:   positions and velocities, as Result.pull_back takes them; the function returns a dict of arrays
                (frames, ...).
    overrides:  other changes of the model.

    jax.grad of a loss of these arrays costs three runs and one adjoint. It may be in jax.jit and, one run after the
    other, in jax.vmap. Raises ImportError without JAX, ValueError if JAX computes in single precision, or in use for
    parameters of another shape; JAX passes on the errors of polhode.run and Result.pull_back as its own.
    """
    jax = importlib.import_module("jax")
    if not jax.config.jax_enable_x64:
        raise ValueError("JAX computes in single precision; call jax.config.update(\"jax_enable_x64\", True) first")
    runs = _Runs(model, parameters, channels, overrides)
    out = {name: jax.ShapeDtypeStruct(shape, float) for name, shape in runs.shapes.items()}
    back = jax.ShapeDtypeStruct((len(runs.parameters),), float)

    @jax.custom_vjp  # type: ignore[untyped-decorator]
    def function(x: Any) -> Any:
        runs.check(jax.numpy.shape(x))
        return jax.pure_callback(runs.values, out, x, vmap_method="sequential")

    def forward(x: Any) -> "tuple[Any, Any]":
        return function(x), x

    def backward(x: Any, weights: Any) -> "tuple[Any]":
        return (jax.pure_callback(runs.slope, back, x, weights, vmap_method="sequential"),)

    function.defvjp(forward, backward)
    found: "Callable[[Any], dict[str, Any]]" = function
    return found


def torch_function(model: Model, parameters: "Sequence[str]", channels: "Sequence[str]", *,
                   overrides: Overrides = None) -> "Callable[[Any], dict[str, Any]]":
    """Channels of a run as a function of parameters that PyTorch differentiates, by reverse mode.

    As jax_function: of a tensor of values (p,), returns a dict of tensors (frames, ...) in double precision on the
    processor. Raises ImportError without PyTorch; in use ValueError for parameters of another shape, and the errors of
    polhode.run and Result.pull_back.
    """
    torch = importlib.import_module("torch")
    runs = _Runs(model, parameters, channels, overrides)

    class Run(torch.autograd.Function):  # type: ignore[misc, name-defined]
        @staticmethod
        def forward(ctx: Any, x: Any) -> Any:
            ctx.save_for_backward(x)
            return tuple(torch.from_numpy(array) for array in runs.values(x.detach().cpu().numpy()).values())

        @staticmethod
        def backward(ctx: Any, *weights: Any) -> Any:
            (x,) = ctx.saved_tensors
            given = {name: np.zeros(shape) if w is None else w.cpu().numpy()
                     for (name, shape), w in zip(runs.shapes.items(), weights)}
            slope = runs.slope(x.detach().cpu().numpy(), given)
            return torch.from_numpy(slope).to(dtype=x.dtype, device=x.device)

    def function(x: Any) -> "dict[str, Any]":
        runs.check(tuple(x.shape))
        return dict(zip(runs.channels, Run.apply(x)))

    return function
