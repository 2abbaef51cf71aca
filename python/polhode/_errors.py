# SPDX-License-Identifier: Apache-2.0
"""Exceptions of Polhode."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional


class Fault(NamedTuple):
    """One fault of a model: its location, the error, and what to do."""

    file: Optional[str]
    line: Optional[int]
    column: Optional[int]
    path: str
    what: str
    hint: str
    excerpt: str

    def __str__(self) -> str:
        place = ""
        if self.file:
            place = f"{self.file}:{self.line}:{self.column}: " if self.line else f"{self.file}: "
        where = f"{self.path}: " if self.path else ""
        hint = f" {self.hint}" if self.hint else ""
        if hint and not hint.endswith((".", "?", "!")):
            hint += "."
        excerpt = f"\n{self.excerpt}" if self.excerpt else ""
        return f"{place}{where}{self.what}.{hint}{excerpt}"


class ModelError(ValueError):
    """Error for a faulty model, with all of its faults in `faults`.

    `file`, `line`, `column`, `path`, `what` and `hint` are those of the first one. A model that was
    built in code has neither file nor line; `path` says where in the model, e.g. "joints.A.axis".
    """

    def __init__(self, faults: "list[tuple[Any, ...]]") -> None:
        self.faults: "list[Fault]" = [Fault(f[0] or None, f[1] or None, f[2] or None, *f[3:]) for f in faults]
        super().__init__("\n".join(str(f) for f in self.faults))

    def __reduce__(self) -> "tuple[Any, ...]":
        return (type(self), ([tuple(f) for f in self.faults],))

    def __getattr__(self, name: str) -> Any:
        if name in Fault._fields and self.__dict__.get("faults"):
            return getattr(self.faults[0], name)
        raise AttributeError(name)


class NotConverged(RuntimeError):
    """Error for a step that did not converge. `result` has the results until then, or is None."""

    def __init__(self, message: str, result: Any = None) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> "tuple[Any, ...]":
        return (type(self), (str(self), self.result))


class NotReached(ValueError):
    """Error for a target of inverse kinematics that was not reached. q: the coordinates that come nearest, with the
    distance [m] and the angle [rad] that remain."""

    def __init__(self, message: str, q: Any, distance: float, angle: float) -> None:
        super().__init__(message)
        self.q, self.distance, self.angle = q, distance, angle

    def __reduce__(self) -> "tuple[Any, ...]":
        return (type(self), (str(self), self.q, self.distance, self.angle))


def fault(path: str, what: str, hint: str) -> ModelError:
    """A ModelError of one fault that has a path only."""
    return ModelError([(None, None, None, path, what, hint, "")])
