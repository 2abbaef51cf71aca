# SPDX-License-Identifier: Apache-2.0
"""Polhode, by its command line.

Its summary has the processor time from the first frame to the last, with the start and the results file, which other
programs do not write; that of a run of one very short step, the bare run, tells how much that is.
"""

from __future__ import annotations

import json
import os
import pathlib
import statistics
import subprocess
import tempfile
from typing import Any

import h5py
from mechanism import Joint, Mechanism, Vector, cross, minus
from program import Method, Outcome, halved, steps_of

ORDER_2, COMPOSITION, EXTRAPOLATION = "order 2", "composition, order {}", "extrapolation, order {}"
AUTOMATIC, EXTRAPOLATED = "tolerance", "tolerance, extrapolation"
TOLERANCES = tuple(10.0**-k for k in range(3, 12))
LONGEST_RUN = 120.0  # of the wall [s]
BARE = 1e-6  # duration of a bare run relative to that of the case


class Polhode:
    name = "Polhode"

    def __init__(self) -> None:
        self.program = os.environ.get("POLHODE", "polhode")

    def version(self) -> str:
        found = subprocess.run([self.program, "--version"], capture_output=True, text=True, check=True).stdout
        return found.split()[-1]

    def absent(self, mechanism: Mechanism) -> str:
        return ""

    def remarks(self, mechanism: Mechanism) -> str:
        short = {"duration": BARE * mechanism.duration, "step": BARE * mechanism.duration}
        bare = statistics.median(self.call(mechanism, short)[1]["cpu_time_s"] for _ in range(5))
        told = f"{1e3 * bare:.0f} ms of every time are start and results file"
        return told + (", no composition as the model dissipates" if mechanism.dissipates() else "")

    def methods(self, mechanism: Mechanism) -> tuple[Method, ...]:
        # A step of a higher order holds many of order 2.
        short = mechanism.duration / (100.0 if mechanism.duration < 0.1 else 400.0)
        found = [Method(ORDER_2, "step", halved(short, 14))]
        if not mechanism.dissipates():
            found += [Method(COMPOSITION.format(order), "step", halved(8.0 * short, 12)) for order in (6, 8)]
        found += [Method(EXTRAPOLATION.format(order), "step", halved(8.0 * short, 12)) for order in (6, 8)]
        found.append(Method(AUTOMATIC, "tolerance", TOLERANCES))
        if not mechanism.dissipates():
            found.append(Method(EXTRAPOLATED, "tolerance", TOLERANCES))
        return tuple(found)

    def run(self, mechanism: Mechanism, method: Method, value: float) -> Outcome:
        end, summary = self.call(mechanism, analysis(mechanism, method, value))
        return Outcome(end, summary["cpu_time_s"], summary["steps"], summary["newton_iterations"])

    def call(self, mechanism: Mechanism, how: dict[str, Any]) -> tuple[tuple[float, ...], dict[str, Any]]:
        """What is compared, and the summary of a run."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "model.yaml"
            path.write_text(json.dumps(model(mechanism, how), indent=1))
            command = [self.program, "run", str(path), "--json", "--quiet", "--threads", "1"]
            done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_RUN, check=False)
            if done.returncode not in (0, 4):
                raise RuntimeError((done.stderr or done.stdout).strip()[:200])
            summary: dict[str, Any] = json.loads(done.stdout)
            if summary["end"] != "finished":
                raise RuntimeError(str(summary["message"])[:200])
            with h5py.File(pathlib.Path(folder) / "model.results" / "results.h5") as results:
                return observe(mechanism, results), summary


def analysis(mechanism: Mechanism, method: Method, value: float) -> dict[str, Any]:
    """The analysis of a model file for a method."""
    told: dict[str, Any] = {"duration": mechanism.duration}
    if method.control == "step":
        told["step"] = mechanism.duration / steps_of(mechanism.duration, value)
        told["order"] = int(method.name.split()[-1])
    else:
        told["tolerance"] = value
    for word in ("composition", "extrapolation"):
        if word in method.name:
            told["method"] = word
    return told


def model(mechanism: Mechanism, how: dict[str, Any]) -> dict[str, Any]:
    """The content of a model file."""
    bodies: dict[str, Any] = {}
    for body in mechanism.bodies:
        bodies[body.name] = {
            "mass": body.mass,
            "inertia": body.inertia,
            "position": body.position,
            "velocity": body.velocity,
            "angular_velocity": body.angular_velocity,
            "orientation": {"matrix": body.axes},
        }
    loads: dict[str, Any] = {}
    for spring in mechanism.springs:
        loads[spring.name] = {
            "type": "spring_damper",
            "bodies": spring.bodies,
            "at": spring.at,
            "stiffness": spring.stiffness,
            "damping": spring.damping,
            "free_length": spring.free_length,
        }
    for moment in mechanism.moments:
        loads[moment.name] = {"type": "moment", "body": moment.body, "moment": moment.moment}
    content: dict[str, Any] = {
        "format": 1,
        "gravity": mechanism.gravity,
        "bodies": bodies,
        "joints": {joint.name: joint_entry(joint) for joint in mechanism.joints},
    }
    if loads:
        content["loads"] = loads
    content["analysis"] = how
    content["output"] = {"every": how["duration"]}
    return content


def joint_entry(joint: Joint) -> dict[str, Any]:
    entry: dict[str, Any] = {"type": joint.kind, "bodies": [joint.parent, joint.child], "at": joint.at}
    if joint.kind == "universal":
        entry["axes"] = joint.axes
    elif joint.kind != "spherical":
        entry["axis"] = joint.axes[0]
    return entry


def rotated(q: Vector, scalar: float, a: Vector) -> Vector:
    """A vector rotated by a quaternion."""
    t = cross(q, a)
    u = cross(q, t)
    return (
        a[0] + 2.0 * (scalar * t[0] + u[0]),
        a[1] + 2.0 * (scalar * t[1] + u[1]),
        a[2] + 2.0 * (scalar * t[2] + u[2]),
    )


def observe(mechanism: Mechanism, results: Any) -> tuple[float, ...]:
    end: list[float] = []
    packed = results["packed"]

    def place_in(kind: str, name: str) -> int:
        return [str(n) for n in packed[f"{kind}/names"].asstr()[:]].index(name)

    for seen in mechanism.observed:
        if seen.joint:
            first = packed["joints/first"][place_in("joints", seen.joint)]
            end.append(float(packed["joints/coordinates"][-1][first]) + seen.offset)
        else:
            body = mechanism.body(seen.body)
            arm = minus(seen.point, body.position)
            in_body: Vector = (
                sum(body.axes[k][0] * arm[k] for k in range(3)),
                sum(body.axes[k][1] * arm[k] for k in range(3)),
                sum(body.axes[k][2] * arm[k] for k in range(3)),
            )
            row = place_in("bodies", seen.body)
            w, x, y, z = (float(c) for c in packed["bodies/orientation"][-1][row])
            turned = rotated((x, y, z), w, in_body)
            place = packed["bodies/position"][-1][row]
            end += [float(place[k]) + turned[k] for k in seen.components]
    return tuple(end)
