# SPDX-License-Identifier: Apache-2.0
"""Loads that Python gives: functions of the time, and of the motion."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

from ._errors import fault

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Vector = NDArray[np.float64]

#: What a function along a coordinate may give: these drives, not those that prescribe the motion.
EFFORTS = ("force", "moment", "pull")
DERIVATIVES = ("position", "velocity", "turn", "angular_velocity")


class BodyReading:
    """Motion of a body as a force reads it, SI units and world axes: arrays to read, not to keep.

    position and velocity (3,) [m], [m/s] are those of the point that the force acts at, for a moment of
    the centre of mass; orientation (4,) is the quaternion (w, x, y, z) body to world,
    angular_velocity (3,) [rad/s]. The numbers change with the next call: copy what is to be kept.
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
    """A force or moment that depends on the motion, with what the engine may know about it.

    A plain function f(t, body) or f(t, q, rate) does as well; this adds
      tangent:  None: derivatives by differences, 6 or 2 more calls an iteration. A function: derivatives, of
                f(t, body) a map from "position", "velocity", "turn" (a small rotation of the body, world
                axes) and "angular_velocity" to (3, 3) arrays, what is left out is zero; of f(t, q, rate) two numbers,
                by q and by the rate. False: zero, for forces that hardly change within a step: if they do,
                iterations take longer or do not converge.
      velocity: False if the function reads no velocity: then it may go with orders above 2.

    Both get the same arguments. They must depend on nothing else: they are called several times in each step, also
    for steps that are then refused.
    """

    def __init__(self, function: "Callable[..., Any]", *, tangent: "Union[None, bool, Callable[..., Any]]" = None,
                 velocity: bool = True) -> None:
        if not callable(function) or not (tangent is None or tangent is False or callable(tangent)):
            raise TypeError("function has to be callable, tangent callable, None or False")
        self.function = function
        self.tangent = tangent
        self.velocity = velocity

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)

    def __repr__(self) -> str:
        return f"StateFunction({self.function!r}, tangent={self.tangent!r}, velocity={self.velocity})"


def derivative_parts(given: Any) -> "dict[str, Any]":
    """Derivatives that a tangent gave, checked."""
    if not isinstance(given, Mapping):
        raise TypeError(f"A tangent has to give a map with some of {', '.join(DERIVATIVES)}.")
    for key, rows in given.items():
        if key not in DERIVATIVES:
            raise TypeError(f"A tangent gave '{key}'; it may give {', '.join(DERIVATIVES)}.")
        if len(rows) != 3:
            raise TypeError(f"A tangent has to give three rows of three numbers for '{key}'.")
    return {key: rows.tolist() if hasattr(rows, "tolist") else rows for key, rows in given.items()}


def arguments_of(function: Any) -> Optional[int]:
    """How many arguments a callable needs; None if it does not tell."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return None
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return None
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(p.kind in positional and p.default is p.empty for p in parameters)


class LoadCall:
    """A callable that stands in a model's tree, and what it is for."""

    def __init__(self, load: str, fields: "dict[str, Any]", path: "tuple[Any, ...]", function: Any) -> None:
        """load: name in the whole; fields: of the load; path: within the load, the key and perhaps a component."""
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
                        "Whole forces and moments on bodies can, and the force, moment or pull in a joint or along a "
                        "line; here the function has one argument, the time")
        if needed is not None and needed != wanted:
            here = "f(t, body)" if self.is_vector else "f(t, q, rate)"
            raise fault(where, f"{inner!r} takes {needed} arguments",
                        f"Give f(t), or {here} for what depends on the motion" if self.key in EFFORTS else "Give f(t)")

    def install(self, compiled: Any) -> None:
        """Sets the function in a compiled model."""
        if not self.of_motion:
            compiled.set_function(self.load, self.component, self.function)
            return
        f = self.function if isinstance(self.function, StateFunction) else StateFunction(self.function)
        compiled.set_motion_function(self.load, f.function, f.tangent, not self.is_vector, f.velocity)
