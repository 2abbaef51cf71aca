# SPDX-License-Identifier: Apache-2.0
"""Loads given by Python functions of time and of the motion."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

from ._errors import fault

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Vector = NDArray[np.float64]

#: Drives that a function along a coordinate may return; not those that prescribe the motion.
EFFORTS = ("force", "moment", "pull")
DERIVATIVES = ("position", "velocity", "turn", "angular_velocity")


class BodyReading:
    """Motion of a body, the argument of a force, in SI units and world axes.

    position and velocity (3,) [m], [m/s] are those of the point of application, for a moment of the
    centre of mass; orientation (4,) is the quaternion (w, x, y, z) body to world,
    angular_velocity (3,) [rad/s]. The arrays are reused by the next call: copy numbers to be stored.
    """

    __slots__ = ("position", "velocity", "orientation", "angular_velocity")

    def __init__(self, position: "Vector", velocity: "Vector", orientation: "Vector",
                 angular_velocity: "Vector") -> None:
        self.position = position
        self.velocity = velocity
        self.orientation = orientation
        self.angular_velocity = angular_velocity

    def __repr__(self) -> str:
        return "\n".join(f"{name:18} {getattr(self, name)}" for name in self.__slots__)


class StateFunction:
    """A force or moment that depends on the motion, with its derivatives and dependence on velocity.

    A plain function f(t, body) or f(t, q, rate) is sufficient; this class adds
      tangent:  None: derivatives by differences, 6 or 2 more calls per iteration. A function: derivatives, for
                f(t, body) a map from "position", "velocity", "turn" (a small rotation of the body, world
                axes) and "angular_velocity" to (3, 3) arrays, missing ones are zero; for f(t, q, rate) two numbers,
                the derivatives by q and by the rate. False: zero, for forces that hardly change within a step;
                otherwise iterations converge slowly or not at all.
      velocity: False if the function does not depend on velocities; this allows orders above 2.

    Both functions get the same arguments and must depend on nothing else: they are called several times in each step,
    also in steps that are rejected. Raises TypeError for arguments of other types.
    """

    def __init__(self, function: "Callable[..., Any]", *, tangent: "Union[None, bool, Callable[..., Any]]" = None,
                 velocity: bool = True) -> None:
        if not callable(function) or not (tangent is None or tangent is False or callable(tangent)):
            raise TypeError("function must be callable, tangent callable, None or False")
        self.function = function
        self.tangent = tangent
        self.velocity = velocity

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)

    def __repr__(self) -> str:
        return f"StateFunction({self.function!r}, tangent={self.tangent!r}, velocity={self.velocity})"


def derivative_parts(given: Any) -> "dict[str, Any]":
    """Checked derivatives of a tangent."""
    if not isinstance(given, Mapping):
        raise TypeError(f"A tangent must return a map with keys from {', '.join(DERIVATIVES)}.")
    for key, rows in given.items():
        if key not in DERIVATIVES:
            raise TypeError(f"A tangent returned the key '{key}'. Use {', '.join(DERIVATIVES)}.")
        if len(rows) != 3:
            raise TypeError(f"A tangent must return three rows of three numbers for '{key}'.")
    return {key: rows.tolist() if hasattr(rows, "tolist") else rows for key, rows in given.items()}


def arguments_of(function: Any) -> Optional[int]:
    """Number of arguments that a callable requires; None if it is unknown."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return None
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return None
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(p.kind in positional and p.default is p.empty for p in parameters)


class LoadCall:
    """A callable in the tree of a model, with its load and key."""

    def __init__(self, load: str, fields: "dict[str, Any]", path: "tuple[Any, ...]", function: Any) -> None:
        """load: name in the whole model; fields: its keys; path: within the load, the key and possibly a component."""
        self.load, self.function = load, function
        self.key = str(path[0])
        self.component = int(path[1]) if len(path) == 2 else -1
        self.is_vector = self.key in ("force", "moment") and "body" in fields
        inner = function.function if isinstance(function, StateFunction) else function
        needed = arguments_of(inner)
        self.of_motion = isinstance(function, StateFunction) or (needed is not None and needed > 1)
        wanted = 1 if not self.of_motion else 2 if self.is_vector else 3
        where = ".".join(("loads", load, *map(str, path)))
        if self.of_motion and (self.component >= 0 or self.key not in EFFORTS or "solid" in fields):
            raise fault(where, "cannot depend on the motion",
                        "Use a function of time here. Complete forces and moments on bodies, and the force, moment "
                        "or pull in a joint or along a line may depend on the motion")
        if needed is not None and needed != wanted:
            here = "f(t, body)" if self.is_vector else "f(t, q, rate)"
            raise fault(where, f"{inner!r} takes {needed} arguments",
                        f"Give f(t), or {here} for a dependence on the motion" if self.key in EFFORTS else "Give f(t)")

    def install(self, compiled: Any) -> None:
        """Sets the function in a compiled model."""
        if not self.of_motion:
            compiled.set_function(self.load, self.component, self.function)
            return
        f = self.function if isinstance(self.function, StateFunction) else StateFunction(self.function)
        compiled.set_motion_function(self.load, f.function, f.tangent, not self.is_vector, f.velocity)
