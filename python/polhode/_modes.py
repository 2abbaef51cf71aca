# SPDX-License-Identifier: Apache-2.0
"""Natural frequencies and shapes."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

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
    participation (3,) [√kg] and effective_mass (3,) [-] along x, y, z; residual [-].
    """

    frequency: float
    damping_ratio: float
    kind: str
    motion: str
    residual: float

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
    """Modes of a model: divergence first, then by |λ|. total_mass [kg]; warnings, texts."""

    total_mass: float
    warnings: "list[str]"

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
    found = _native.modes(model._compile(overrides), count, about)
    if found["message"]:
        raise NotConverged(found["message"])
    result = Modes(Mode(values) for values in found["modes"])
    result.total_mass = found["total_mass"]
    result.warnings = found["warnings"]
    for warning in result.warnings:
        warnings.warn(warning, stacklevel=2)
    return result


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
    return Matrices(*(sparse.csr_array(a) for a in _native.matrices(simulation._engine)))
