# SPDX-License-Identifier: Apache-2.0
"""The interface of the compared programs."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Sequence
from typing import Protocol

from mechanism import Mechanism


@dataclasses.dataclass(frozen=True)
class Method:
    """An integrator of a program, with the steps [s] or tolerances at which it is run, coarse ones first."""

    name: str
    control: str  # step, or tolerance
    values: tuple[float, ...]


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What is compared, at the end, and the processor time of the steps [s]."""

    end: tuple[float, ...]
    cpu: float
    steps: int | None = None
    iterations: int | None = None


class Program(Protocol):
    """A program of the comparison. `absent` says why it cannot express a mechanism, or is empty."""

    name: str

    def version(self) -> str: ...

    def absent(self, mechanism: Mechanism) -> str: ...

    def remarks(self, mechanism: Mechanism) -> str: ...

    def methods(self, mechanism: Mechanism) -> Sequence[Method]: ...

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome: ...


def halved(first: float, count: int, ratio: float = 2.0) -> tuple[float, ...]:
    """A falling row of steps or tolerances."""
    return tuple(first / ratio**k for k in range(count))


def explicit_steps(duration: float, dissipates: bool, count: int) -> tuple[float, ...]:
    """Steps of an explicit method; with the stiff dampers of the governor it is stable below 0.2 ms only."""
    return halved(duration / (51200.0 if dissipates else 100.0 if duration < 0.1 else 400.0), count)


def steps_of(duration: float, step: float) -> int:
    """The number of equal steps nearest to the given length."""
    return max(1, round(duration / step))


def timed(work: Callable[[], None]) -> float:
    """Processor time of all threads that a call takes [s]."""
    begin = time.process_time()
    work()
    return time.process_time() - begin
