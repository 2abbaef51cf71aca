# SPDX-License-Identifier: Apache-2.0
"""Natural frequencies and shapes."""

from __future__ import annotations

import json
import os
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _native
from ._errors import NotConverged
from ._model import Model, Overrides, load

if TYPE_CHECKING:
    from ._simulation import Simulation


class Mode:
    """A free vibration Re(shape · exp(λ t)) about an equilibrium.

    frequency |λ|/2π [Hz]; eigenvalue λ, complex [rad/s]; damping_ratio -Re λ/|λ| [-]; kind:
    oscillation, flutter, divergence, overdamped or free; motion: description of a free one;
    participation (3,) [√kg] and effective_mass (3,) [-] along x, y, z; residual [-]. About a spin
    frequency is that in the turning frame; whirl: forward, backward, none or unknown, and
    world_frequency [Hz] that in the world, or None.
    """

    frequency: float
    damping_ratio: float
    kind: str
    motion: str
    residual: float
    whirl: str
    world_frequency: "Optional[float]"

    def __init__(self, values: "dict[str, Any]") -> None:
        self.eigenvalue = complex(*values.pop("eigenvalue"))
        self._shapes: "dict[str, Any]" = values.pop("shapes")
        self.__dict__.update(values)

    def shape(self, body: str) -> Any:
        """Displacement of the body's centre of mass and its small rotation (6,), world axes, complex;
        mass-normalised."""
        real, imaginary = np.asarray(self._shapes[body])
        return real + 1j * imaginary

    def __repr__(self) -> str:
        return f"<Mode: {self.frequency:.6g} Hz, {self.kind}>"


class Modes(list):  # type: ignore[type-arg]
    """Modes of a model: divergence first, then by |λ|. total_mass [kg]; warnings, texts; held, contacts and
    stops that hold like joints (law: rigid); spin [rad/s], the speed of the frame in which they are seen."""

    total_mass: float
    spin: float
    warnings: "list[str]"
    held: "list[str]"

    @property
    def frequencies(self) -> Any:
        """(count,) [Hz]"""
        return np.array([mode.frequency for mode in self])


def modes(
    model: "Union[Model, str, os.PathLike[str]]",
    count: Optional[int] = None,
    *,
    about: Optional[str] = None,
    overrides: Overrides = None,
) -> Modes:
    """Natural frequencies and shapes of a model.

    count: number of modes; None: the model's analysis.count. about: "equilibrium", found by statics from
    the start, or "start". Raises ModelError for a model with faults, NotConverged if there is no
    equilibrium.
    """
    model = model if isinstance(model, Model) else load(model)
    return _modes_of(_native.modes(model._compile(overrides), count, about))


def _modes_of(found: "dict[str, Any]") -> Modes:
    if found["message"]:
        raise NotConverged(found["message"])
    result = Modes(Mode(values) for values in found["modes"])
    result.total_mass = found["total_mass"]
    result.warnings = found["warnings"]
    result.held = found["held"]
    result.spin = found["spin"]
    for warning in result.warnings:
        warnings.warn(warning, stacklevel=3)
    return result


def spin_modes(
    model: "Union[Model, str, os.PathLike[str]]",
    spin: "Union[None, float, str, Sequence[float]]" = None,
    *,
    axis: "Union[None, str, Sequence[float]]" = None,
    through: "Optional[Sequence[float]]" = None,
    ground: Optional[str] = None,
    count: Optional[int] = None,
    about: Optional[str] = None,
    overrides: Overrides = None,
) -> "list[Modes]":
    """Modes about a steady spin at each of its speeds, seen from the turning frame.

    spin: a speed [rad/s], several, or a text such as "0:3000:500 rpm"; axis: "z" or a vector; through: a
    point of the axis [m]; ground: "stands" or "turns". None: analysis.spin, spin_axis, spin_through and
    spin_ground of the model. count and about as in modes(). Raises ModelError for a model with faults or
    one that is not steady in that frame, NotConverged if there is no equilibrium at a speed.
    """
    model = model if isinstance(model, Model) else load(model)

    def text(value: Any) -> str:
        if value is None:
            return ""
        return json.dumps(value if isinstance(value, str) else np.asarray(value, dtype=float).tolist())

    found = _native.spin_modes(
        model._compile(overrides), count, about, text(spin), text(axis), text(through), text(ground)
    )
    return [_modes_of(values) for values in found]


class Matrices(NamedTuple):
    """Matrices of M ẍ + C ẋ + K x - Gᵀ μ = 0, G x = 0 about a state, as SciPy sparse arrays.

    Unknowns: displacement of the centre of mass [m] and small rotation [rad] of each moving body,
    (6 n,), world axes; then those of the nodes of solids. C and K are the derivatives of
    forces by velocities and displacements, including springs, dampers, gravity on joints and geometric
    terms. Rows of G, the Jacobian of the joints, have unit length; compliant joints are springs in K.
    """

    M: Any
    C: Any
    K: Any
    G: Any


def matrices(simulation: "Union[Simulation, Model]") -> Matrices:
    """Mass, damping and stiffness matrices and the Jacobian of the joints at the present state of a
    simulation, or at the start of a model, with zero velocities. Computed as dense matrices: for models
    of up to some hundred bodies."""
    from scipy import sparse

    from ._simulation import Simulation

    if isinstance(simulation, Model):
        simulation = Simulation(simulation)
    return Matrices(*(sparse.csr_array(a) for a in _native.matrices(simulation._engine.copy())))
