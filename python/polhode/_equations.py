# SPDX-License-Identifier: Apache-2.0
"""The equations of one step, for Newton's method."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _native
from ._model import Model
from ._simulation import Simulation


class StepEquations(NamedTuple):
    """Residual and tangent of a step of length dt at an iterate x.

    x holds displacement [m] and Cayley vector [-] of each moving body over the step, (6 n,), then a multiplier for
    each constraint row, (m,). The residual is the balance of forces [N] and moments [N m] about the centres of mass,
    world axes, then the rows [m or -]. The tangent is its derivative by increments (Δr, Δθ) of the bodies and by the
    multipliers, a SciPy sparse array; rows have a term of 1e-12 on the diagonal of the scaled system, so that
    redundant rows can be solved. `moved` applies increments: x' = e.moved(-spsolve(e.tangent, e.residual)).
    """

    residual: Any
    tangent: Any
    x: Any
    bodies: "list[str]"

    def moved(self, increment: Any) -> Any:
        """The iterate x after increments: displacements and multipliers are added, rotations composed.

        increment: (6 n + m,) in the order of x: Δr [m] and Δθ [rad] of each body, then increments of the multipliers.
        """
        dx = np.asarray(increment, dtype=float)
        n = 6 * len(self.bodies)
        x: "np.ndarray[Any, Any]" = self.x + dx
        a = self.x[:n].reshape(-1, 6)[:, 3:]
        b = dx[:n].reshape(-1, 6)[:, 3:]
        q = 0.25 * np.sum(a * b, axis=1, keepdims=True)
        x[:n].reshape(-1, 6)[:, 3:] = a + (b + 0.5 * np.cross(b, a) + q * a) / (1 - q)
        return x


def step_equations(simulation: "Union[Simulation, Model]", dt: float, x: Optional[Any] = None) -> StepEquations:
    """Residual and tangent of a step of length dt [s] from the present state of a simulation or the start of a model.

    x: the iterate (6 n + m,); None: the predictor with the present velocities and multipliers. The simulation is not
    changed. The equations are those of bodies and joints with the model's method; an order above 2 takes several such
    steps. Raises ModelError for a faulty model or an x of the wrong size, with solids, with contacts and in statics.
    """
    from scipy import sparse

    if isinstance(simulation, Model):
        simulation = Simulation(simulation)
    given = None if x is None else [float(v) for v in x]
    residual, starts, rows, values, at, bodies = _native.step_equations(simulation._engine, dt, given)
    shape = (len(at), len(at))
    return StepEquations(residual, sparse.csc_array((values, rows, starts), shape=shape), at, bodies)
