# SPDX-License-Identifier: Apache-2.0
"""Polhode: implicit dynamics of rigid and deformable multibody systems.

    import polhode
    m = polhode.Model(gravity=[0, 0, -9.81], analysis={"duration": "2 s", "step": "5 ms"})
    arm = m.add_body("arm", shape=polhode.Box(1, 0.05, 0.05), density=1000, position=[0.5, 0, 0])
    m.add_joint("hinge", "revolute", ["ground", arm], at=[0, 0, 0], axis="y")
    r = polhode.run(m)
    r.bodies["arm"].position    # (T, 3), m

SI units; vectors are in world axes unless stated otherwise.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from . import _native
from ._errors import Fault, ModelError, NotConverged, NotReached
from ._functions import BodyReading, StateFunction
from ._model import Model, from_text, load
from ._native import version as __version__

if TYPE_CHECKING:
    from . import rotations
    from ._batch import Batch, batch
    from ._derivatives import Uncertainty
    from ._design import Minimum, minimize
    from ._equations import StepEquations, step_equations
    from ._febio import write_febio_log
    from ._fit import Experiment, Fit, fit
    from ._frameworks import jax_function, torch_function
    from ._gradient import Gradient, gradient
    from ._joint_space import Pose
    from ._linear import StateSpace, inverse_dynamics, linearize
    from ._modes import Matrices, Mode, Modes, matrices, modes, spin_modes
    from ._result import Result, open
    from ._run import run
    from ._simulation import Simulation, Step
    from ._sweep import sweep

# Loaded at first use: NumPy takes longer to import than everything else.
_LATER = {
    "_batch": ["Batch", "batch"],
    "_derivatives": ["Uncertainty"],
    "_design": ["Minimum", "minimize"],
    "_equations": ["StepEquations", "step_equations"],
    "_febio": ["write_febio_log"],
    "_fit": ["Experiment", "Fit", "fit"],
    "_frameworks": ["jax_function", "torch_function"],
    "_gradient": ["Gradient", "gradient"],
    "_joint_space": ["Pose"],
    "_linear": ["StateSpace", "inverse_dynamics", "linearize"],
    "_modes": ["Matrices", "Mode", "Modes", "matrices", "modes", "spin_modes"],
    "_result": ["Result", "open"],
    "_run": ["run"],
    "_simulation": ["Simulation", "Step"],
    "_sweep": ["sweep"],
}
for _error in (Fault, ModelError, NotConverged, NotReached):
    _error.__module__ = __name__  # public names in tracebacks
_HOME = {name: module for module, names in _LATER.items() for name in names}

__all__ = [
    "Batch", "BodyReading", "Experiment", "Fault", "Fit", "Gradient", "Matrices", "Minimum", "Mode", "Model",
    "ModelError", "Modes", "NotConverged", "NotReached", "Pose", "Result", "Simulation", "StateFunction", "StateSpace",
    "Step", "StepEquations", "Uncertainty", "__version__", "batch", "fit", "from_text", "gradient", "inverse_dynamics",
    "jax_function", "linearize", "load", "matrices", "minimize", "modes", "open", "rotations", "run", "spin_modes",
    "step_equations", "sweep", "torch_function", "write_febio_log",
]


def __getattr__(name: str) -> Any:
    """Shapes, made from the engine's tables, and rarely used modules, both loaded at first use."""
    if name in ("gym", "rotations"):
        return importlib.import_module(f".{name}", __name__)
    if name in _HOME:
        return getattr(importlib.import_module(f".{_HOME[name]}", __name__), name)
    if name[:1].isupper():
        from . import _shapes

        if name in _shapes.kinds():
            return _shapes.shape_class(name)
    near = "" if name.startswith("_") else _native.closest(name, __dir__())
    raise AttributeError(f"module 'polhode' has no attribute '{name}'" + (f". Did you mean '{near}'?" if near else ""))


def __dir__() -> "list[str]":
    from . import _shapes

    return sorted({*__all__, *_shapes.kinds()})
