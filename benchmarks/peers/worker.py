# SPDX-License-Identifier: Apache-2.0
"""One program on one case, in a process of its own: a line of JSON for every run.

    worker.py PROGRAM CASE SECONDS [POINTS]

Without POINTS, a JSON list of [method, value], every method goes from coarse to fine until a run takes more than half
of SECONDS, more for many bodies, or is very accurate.
"""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any

import cases
import references
from program import Program

PROGRAMS = {
    "Polhode": "with_polhode",
    "MuJoCo": "with_mujoco",
    "Exudyn": "with_exudyn",
    "Drake": "with_drake",
    "Pinocchio": "with_pinocchio",
}
FINEST = 3e-10  # ends a row [m or rad]
MOST_FAILURES = 12


def program_of(name: str) -> Program:
    made: Program = getattr(importlib.import_module(PROGRAMS[name]), name)()
    return made


def tell(line: dict[str, Any]) -> None:
    print("RESULT " + json.dumps(line), flush=True)


def main(name: str, case: str, most: float, points: list[tuple[str, float]] | None) -> None:
    mechanism, program, reference = cases.all_cases()[case], program_of(name), references.load()[case]
    head = {
        "program": name,
        "version": program.version(),
        "case": case,
        "absent": program.absent(mechanism),
        "remarks": program.remarks(mechanism),
    }
    most *= max(1.0, (len(mechanism.bodies) / 10.0) ** 0.5)
    tell(head)
    if head["absent"]:
        return
    for method in program.methods(mechanism):
        failures = 0
        for value in method.values:
            if points is not None and (method.name, value) not in points:
                continue
            line: dict[str, Any] = {
                "program": name,
                "case": case,
                "method": method.name,
                "control": method.control,
                "value": value,
            }
            try:
                outcome = program.run(mechanism, method, value)
            except Exception as error:  # programs raise exceptions of their own kinds
                tell(line | {"failed": " ".join(str(error).split())[:160]})
                failures += 1
                if failures > MOST_FAILURES:
                    break
                continue
            distance = references.distance(outcome.end, reference.value)
            tell(
                line
                | {
                    "error": distance,
                    "cpu_s": outcome.cpu,
                    "steps": outcome.steps,
                    "iterations": outcome.iterations,
                }
            )
            if points is None and (2.0 * outcome.cpu > most or distance < FINEST):
                break


if __name__ == "__main__":
    given = [(str(m), float(v)) for m, v in json.loads(sys.argv[4])] if len(sys.argv) > 4 else None
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), given)
