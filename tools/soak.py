#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs small random scenes of contact and reports those that gain energy, penetrate too deeply or do not finish.

    tools/soak.py                    scenes 1 to 1000
    tools/soak.py --scenes 17,40-60  these
    tools/soak.py --limit 60         at most a minute of wall time for each
    tools/soak.py --write 17 DIR     writes scene 17 to DIR/model.json, to run it by hand

A scene is made from its number alone: shapes, grounds, joints with stops, cables, solids, law, restitution,
friction, step. Checks of each scene up to its end: no step adds mechanical energy, by the energy balance and, for rigid
bodies, by their masses and velocities; the energy balance is closed; no penetration exceeds that of the law,
by the program and, in planes, by the shapes' own corners; all numbers are finite. Needs only Python;
POLHODE=path/to/polhode is the program. The exit code is 1 if a scene has a fault.
"""
import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "examples")]
sys.dont_write_bytecode = True
from support import program  # noqa: E402

# Bounds of the rise of mechanical energy and of the error of the energy balance, relative to the scene's energy. The non-smooth law
# solves a step to 1e-3 of gravity's velocity change in it, which is 9e-3 of the small energy of a scene at rest (scene 390).
RISE = {"barrier": 1e-6, "hertz": 1e-6, "linear": 1e-6, "nonsmooth": 1e-2, "rigid": 1e-9}
BALANCE = {"barrier": 1e-9, "hertz": 1e-9, "linear": 1e-9, "nonsmooth": 1e-2, "rigid": 1e-9}
# Bound of penetration, relative to the smallest half size of the largest body: the barrier's band is 1e-3; hertz and linear are stiff
# enough to stop one body within their bound, not several at once; the non-smooth law may sink by 3e-3 in a step; the rigid law by
# what counts as touching.
DEEPEST = {"barrier": 1e-3, "hertz": 0.05, "linear": 0.05, "nonsmooth": 0.1, "rigid": 1e-8}
ROUNDED = 2e-3  # Edges are rounded by 1e-3 of a half size, so that sharp corners are deeper.
WALL_LIMIT = 5.0  # [s], after which a scene is stopped by default.
NOT_CONVERGED, TOO_SLOW = 4, 75  # Exit codes.
STEPS = {10e-3: 30, 5e-3: 40, 2e-3: 50, 1e-3: 60, 0.5e-3: 80, 0.1e-3: 120}  # [s], and how many of them.


class Dice:
    """Pseudo-random numbers, the same with every version of Python."""

    def __init__(self, seed):
        self._random = random.Random(seed)

    def between(self, low, high):
        return low + (high - low) * self._random.random()

    def log_between(self, low, high):
        return low * (high / low) ** self._random.random()

    def one_of(self, things):
        return things[min(int(self._random.random() * len(things)), len(things) - 1)]

    def happens(self, chance):
        return self._random.random() < chance

    def vector(self, size):
        return [self.between(-size, size) for _ in range(3)]

    def quaternion(self):
        while True:
            q = [self.between(-1, 1) for _ in range(4)]
            n = math.sqrt(sum(x * x for x in q))
            if 0.1 < n < 1:
                return [x / n for x in q]


def turned(q, v):
    """A vector in body axes, transformed to ground axes."""
    w, x, y, z = q
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx]


def back(q, v):
    """A vector in ground axes, transformed to body axes."""
    return turned([q[0], -q[1], -q[2], -q[3]], v)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Shape:
    """A shape with its mass properties and its support function."""

    def __init__(self, dice, kind, size):
        self.kind, self.points, self.triangles = kind, [], []
        a = [size * dice.between(0.5, 1) for _ in range(3)]  # Half sizes.
        if kind in ("sphere", "hull", "mesh"):
            a = [a[0]] * 3
        elif kind != "box" and kind != "ellipsoid":
            a[1] = a[0]
        if kind == "capsule":
            a[2] += a[0]
        self.half = a
        if kind == "hull":  # Centrally symmetric, so that its centre is known.
            half = [dice.vector(a[0]) for _ in range(6)]
            self.points = half + [[-x for x in p] for p in half]
        elif kind == "mesh":
            self._torus(a[0])
        sizes = [2 * x for x in a]
        self.model = {
            "sphere": lambda: {"sphere": sizes[0]}, "box": lambda: {"box": sizes},
            "ellipsoid": lambda: {"ellipsoid": sizes}, "capsule": lambda: {"capsule": [sizes[0], sizes[2]]},
            "cylinder": lambda: {"cylinder": [sizes[0], sizes[2]]}, "cone": lambda: {"cone": [sizes[0], sizes[2]]},
            "tube": lambda: {"tube": [sizes[0], 0.6 * sizes[0], sizes[2]]},
            "hull": lambda: {"hull": {"points": self.points}}, "mesh": lambda: {"mesh": {"file": "torus.obj"}}}[kind]()
        part = 0.2 if kind in ("sphere", "ellipsoid") else 1 / 3
        self.gyration = [part * (a[1] ** 2 + a[2] ** 2), part * (a[2] ** 2 + a[0] ** 2), part * (a[0] ** 2 + a[1] ** 2)]

    def _torus(self, size):
        around, across, R, r = 12, 8, 0.65 * size, 0.35 * size
        for i in range(around):
            for j in range(across):
                u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
                ring = R + r * math.cos(v)
                self.points.append([ring * math.cos(u), ring * math.sin(u), r * math.sin(v)])
                n = [((i + p) % around) * across + (j + q) % across for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))]
                self.triangles += [[n[0], n[1], n[2]], [n[0], n[2], n[3]]]
        self.half = [size, size, r]

    def obj(self):
        return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in self.points) + \
            "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in self.triangles)

    def reach(self, d):
        """Largest extent along a unit vector in the body's axes."""
        a = self.half
        if self.points:
            return max(dot(p, d) for p in self.points)
        across = math.sqrt(max(0, 1 - d[2] ** 2))
        if self.kind in ("sphere", "ellipsoid"):
            return math.sqrt(sum((x * y) ** 2 for x, y in zip(a, d)))
        if self.kind == "box":
            return sum(abs(x * y) for x, y in zip(a, d))
        if self.kind == "capsule":
            return abs(d[2]) * (a[2] - a[0]) + a[0]
        if self.kind == "cone":
            return max(1.5 * a[2] * d[2], -0.5 * a[2] * d[2] + a[0] * across)
        return abs(d[2]) * a[2] + a[0] * across


class Scene:
    """A model, and its properties that are known without the program."""

    def __init__(self, seed, law=None):
        dice = self._dice = Dice(seed)
        self.law = law or dice.one_of(["barrier"] * 11 + ["nonsmooth"] * 4 + ["hertz"] * 3 + ["linear"] * 2)
        self.step = dice.one_of(list(STEPS))
        self.span = self.step * STEPS[self.step]
        self.size = dice.log_between(0.02, 0.4)
        self.speed = min(10, max(0.3, 2 * self.size / self.span))
        self.gravity = 0.0 if dice.happens(0.1) else 9.81
        self.e, self.mu = dice.one_of([0, 0.3, 0.7, 1]), dice.one_of([0, 0.1, 0.5])
        self.resting = dice.happens(0.25)
        if self.resting:  # Without weight nothing would move.
            self.gravity = 9.81
        self.shapes, self.masses, self.planes, self.files = {}, {}, [], {}
        self.bodies, self.joints, self.cables, self.solids, self.exclude = {}, {}, {}, {}, []
        self.field = None
        self._ground()
        self._fall()
        surfaces = False
        if self.law != "nonsmooth":
            if dice.happens(0.45):
                self._joint()
            if self.law == "barrier" and dice.happens(0.2):
                surfaces = self._cable()
            if self.law in ("barrier", "linear") and dice.happens(0.12):
                surfaces = self._solid()
        self.rigid = not self.cables and not self.solids
        law = {"law": self.law, "restitution": self.e, "friction": self.mu}
        if self.law in ("hertz", "linear") and self.e > 0 and dice.happens(0.3):
            law["rebound"] = "damped"
        if self.mu > 0 and not surfaces and dice.happens(0.25):
            if self.law != "nonsmooth":
                law["static_friction"] = 1.3 * self.mu
            law.update({"rolling_friction": 1e-2 * self.size, "torsional_friction": 1e-2 * self.size})
        self.damped = "rebound" in law
        self.model = {
            "format": 1, "title": f"Scene {seed}", "gravity": [0, 0, -self.gravity], "bodies": self.bodies,
            "contacts": {"default": law, "exclude": self.exclude},
            "analysis": {"type": "dynamics", "duration": self.span, "step": self.step}, "output": {"every": self.step}}
        if self.solids:
            self.model["materials"] = {"rubber": self.rubber}
        for key, value in (("joints", self.joints), ("cables", self.cables), ("solids", self.solids)):
            if value:
                self.model[key] = value

    def label(self):
        parts = [self.law + (" damped" if self.damped else ""), f"e {self.e}", f"mu {self.mu}",
                 f"{1e3 * self.step:g} ms", self.ground, "rest" if self.resting else "fall",
                 "+".join(s.kind for s in self.shapes.values())]
        parts += [joint["type"] + (" stop" if "limits" in joint else "") for joint in self.joints.values()]
        return ", ".join(parts + ["cable"] * bool(self.cables) + ["solid"] * bool(self.solids))

    def _ground(self):
        dice, L = self._dice, self.size
        kinds = ["plane", "block"] if self.resting else ["plane", "block", "slope", "trough", "bumps", "flat field"]
        self.ground = kind = dice.one_of(kinds)
        if kind == "block":
            self.bodies["ground_block"] = {"fixed": True, "shape": {"box": [20 * L, 20 * L, L]},
                                           "position": [0, 0, -L / 2]}
        elif kind in ("bumps", "flat field"):
            n, cell = 17, L * dice.between(0.5, 1.5)
            top = 0.3 * cell if kind == "bumps" else 0
            heights = [[top * dice.between(-1, 1) if top else 0.0 for _ in range(n)] for _ in range(n)]
            self.field = max(max(row) for row in heights)
            self.bodies["field"] = {"fixed": True, "shape": {"height_field": {"spacing": cell, "heights": heights}}}
        else:
            tilt = 0 if kind == "plane" else dice.between(0.2, 0.9)
            for i, sign in enumerate((1, -1) if kind == "trough" else (1,)):
                normal = [sign * math.sin(tilt), 0, math.cos(tilt)]
                self.planes.append(normal)
                self.bodies[f"plane_{i}"] = {"fixed": True, "shape": {"plane": normal}}
        if kind == "block":
            self.planes.append([0, 0, 1])

    def lowest(self, shape, q, x, y, top, gap):
        """Height of the centre at which a shape is clear of the grounds and of everything below a height."""
        z = top + gap + shape.reach(back(q, [0, 0, -1]))
        if self.field is not None:
            z = max(z, self.field + gap + shape.reach(back(q, [0, 0, -1])))
        for n in self.planes:
            z = max(z, (gap + shape.reach(back(q, [-c for c in n])) - n[0] * x - n[1] * y) / n[2])
        return z

    def _fall(self):
        """Bodies above one another, each clear of the one below."""
        dice, L, top = self._dice, self.size, -1e9
        kinds = ["sphere", "box", "capsule", "cylinder", "cone", "ellipsoid", "hull", "mesh", "tube"]
        if self.resting:
            kinds = ["sphere", "box", "box", "cylinder", "capsule"]
        for i in range(1 + min(int(6 * dice.between(0, 1)), 5)):
            kind = dice.one_of(kinds)
            shape = Shape(dice, kind, L * dice.between(0.4, 1))
            q = dice.quaternion()
            if self.resting:
                angle = dice.between(0, math.pi)
                q = [math.cos(angle / 2), 0, 0, math.sin(angle / 2)]
                if kind == "capsule":  # It lies.
                    q = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
            aside = 0.3 * L * (0.1 if self.resting else 1)
            x, y = dice.between(-aside, aside), dice.between(-aside, aside)
            gap = 0.0 if self.resting else L * dice.log_between(1e-4, 0.3)
            z = self.lowest(shape, q, x, y, top, gap)
            top = z + shape.reach(back(q, [0, 0, 1]))
            mass = dice.log_between(0.01, 10) * (L / 0.1) ** 3
            v, w = dice.vector(self.speed / 2), dice.vector(min(self.speed / L, 0.3 / self.step) / 2)
            v[2] -= self.speed / 2
            if self.resting:
                slides = dice.one_of([0, 0, self.speed / 2]) if i == 0 else 0
                v, w = [slides, 0, 0], [0, 0, 0]
            name = f"body_{i}"
            self.shapes[name], self.masses[name] = shape, mass
            if kind == "mesh":
                self.files[f"torus_{i}.obj"] = shape.obj()
                shape.model["mesh"]["file"] = f"torus_{i}.obj"
            self.bodies[name] = {
                "shape": shape.model, "mass": mass, "inertia": [mass * k for k in shape.gyration], "com": [0, 0, 0],
                "position_of": "com", "position": [x, y, z], "orientation": {"quaternion": q}, "velocity": v,
                "angular_velocity": w}
        self.top = top

    def _joint(self):
        """One or two joints, most of them with stops, some of which touch at the start."""
        dice, names = self._dice, list(self.shapes)
        for k in range(dice.one_of([1, 1, 2])):
            b = dice.one_of(names)
            others = ["ground"] + [name for name in names if name < b]
            a = dice.one_of(others)
            if any(joint["bodies"][1] == b for joint in self.joints.values()):
                continue
            kind = dice.one_of(["revolute", "prismatic", "spherical", "cylindrical", "distance", "slack_link"])
            centre = self.bodies[b]["position"]
            at = [c + 0.5 * d for c, d in zip(centre, dice.vector(self.size))]
            joint = {"type": kind, "bodies": [a, b], "at": at}
            if kind in ("distance", "slack_link"):
                joint["at"] = [[c + d for c, d in zip(at, dice.vector(self.size))], at]
                if math.dist(*joint["at"]) < 0.2 * self.size:
                    joint["at"][0][2] += self.size
            else:
                joint["axis"] = dice.vector(1)
            length = math.dist(*joint["at"]) if kind == "slack_link" else self.size
            if kind == "slack_link":
                joint["limits"] = {"upper": length * dice.one_of([1 + 1e-9, 1.05, 1.3])}
            elif kind in ("revolute", "prismatic", "cylindrical") and dice.happens(0.75):
                size = 0.5 if kind == "revolute" else 0.4 * self.size
                joint["limits"] = {"lower": -size * dice.one_of([0, 0.1, 0.5]), "upper": size * dice.between(0.05, 1)}
            if "limits" in joint:
                joint["limits"]["restitution"] = dice.one_of([0, 0.3, 0.7, 1])
            if kind in ("revolute", "prismatic", "cylindrical", "spherical") and dice.happens(0.3):
                joint["friction"] = {"mu": 0.2, "radius": 0.05 * self.size}
            self.joints[f"joint_{k}"] = joint

    def _cable(self):
        """A cable from above to the topmost body."""
        dice, name = self._dice, list(self.shapes)[-1]
        body = self.bodies[name]
        x, y, z = body["position"]
        length = (self.top - z) + self.size * dice.between(0.5, 2)
        mass = self.masses[name]
        cable = {"through": [["ground", [x + 0.2 * self.size, y, z + length]], [name]],
                 "stiffness": mass * 9.81 * dice.log_between(30, 3000), "mass_per_length": 0.1 * mass / length,
                 "elements": dice.one_of([3, 6])}
        touches = dice.happens(0.6)
        if touches:
            cable["contact"] = {"radius": 0.02 * self.size}
        self.cables["rope"] = cable
        if touches and self.shapes[name].kind in ("mesh", "tube"):  # It begins at their middle, which is outside.
            self.exclude.append(["rope", name])
        return touches

    def _solid(self):
        """A soft block above everything else."""
        dice, L = self._dice, self.size
        sizes = [L * dice.between(0.5, 1) for _ in range(3)]
        z = max(self.top, 0) + sizes[2] / 2 + L * 0.3
        if self.cables:
            return True
        for n in self.planes:
            z = max(z, (0.6 * L + dot([abs(c) for c in n], sizes) / 2) / n[2])
        self.rubber = {"type": "neo_hookean", "youngs_modulus": dice.log_between(1e5, 1e7), "poisson_ratio": 0.35,
                       "density": 1000, **({"viscosity": {"relaxation_time": 1e-3}} if dice.happens(0.5) else {})}
        self.solids["block"] = {
            "mesh": {"block": {"size": sizes, "cells": [2, 2, 2]}, "position": [0, 0, z]}, "element": "hex8",
            "material": "rubber", "velocity": [0, 0, -self.speed]}
        return True

    def write(self, folder):
        for name, text in self.files.items():
            (folder / name).write_text(text)
        (folder / "model.json").write_text(json.dumps(self.model, indent=1))
        return folder / "model.json"

    def band(self):
        """Reference length of the allowed depths: the smallest half size of the largest body [m]."""
        return max([min(shape.half) for shape in self.shapes.values()] + [self.size * bool(self.solids)])


def table(path):
    """Columns of a table by their headers without units."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    columns = zip(*([float(cell) for cell in row] for row in rows[1:]))
    return {head.split(" [")[0]: list(column) for head, column in zip(rows[0], columns)}


def rise(values):
    """Largest rise of values above the smallest previous one."""
    least, most = values[0], 0.0
    for value in values:
        most, least = max(most, value - least), min(least, value)
    return most


def own_numbers(scene, t):
    """Kinetic and potential energy of rigid bodies at each row, and the deepest corner in any plane, from the motion."""
    energies, deepest = [0.0] * len(t["t"]), 0.0
    for name, shape in scene.shapes.items():
        mass = scene.masses[name]

        def columns(what, keys, of=name):
            return list(zip(*(t[f"bodies.{of}.{what}.{key}"] for key in keys)))

        motion = zip(columns("position", "xyz"), columns("orientation", "wxyz"), columns("velocity", "xyz"),
                     columns("angular_velocity", "xyz"))
        for i, (x, q, v, w) in enumerate(motion):
            W = back(q, w)
            energies[i] += mass * (0.5 * dot(v, v) + 0.5 * sum(k * c * c for k, c in zip(shape.gyration, W))
                                   + scene.gravity * x[2])
            for n in scene.planes:
                if scene.ground != "block" or max(abs(x[0]), abs(x[1])) < 8 * scene.size:
                    deepest = max(deepest, shape.reach(back(q, [-c for c in n])) - dot(n, x))
    return energies, deepest


def faults_of(scene, figures, t):
    """Faults of a run that finished, and its numbers."""
    found = []
    if not all(math.isfinite(x) for column in t.values() for x in column):
        return [("not finite", math.nan)], {}
    put_in = t["energy.put_in"]
    total = [e - p for e, p in zip(t["energy.total"], put_in)]
    scale = max(t["energy.kinetic"]) + max(t["energy.potential"]) - min(t["energy.potential"])
    scale += 1e-3 * scene.size * scene.gravity * sum(scene.masses.values())  # For scenes at rest.
    numbers = {"rise": rise(total) / scale, "balance": figures["energy_drift"],
               "booked": rise([-d for d in t["energy.dissipated"]]) / scale}
    if scene.law == "nonsmooth":  # The program's figure has no allowance for scenes at rest.
        sums = [e + d for e, d in zip(total, t["energy.dissipated"])]
        numbers["balance"] = max(abs(x - sums[0]) for x in sums) / scale
    own, corner = own_numbers(scene, t)
    if scene.rigid:
        numbers["own rise"] = max(0.0, max(own) - own[0]) / scale
    band = scene.band()
    numbers["depth"] = max(0.0, -(figures["contacts"]["least_gap"] or 0.0)) / band
    numbers["corner"] = corner / band
    limits = {"rise": RISE[scene.law], "booked": RISE[scene.law], "balance": BALANCE[scene.law], "own rise": RISE[scene.law],
              "depth": DEEPEST[scene.law] * (1 + 1e-6), "corner": max(1e-3, DEEPEST[scene.law]) + ROUNDED}
    found += [(what, number) for what, number in numbers.items() if not number <= limits[what]]
    return found, numbers


def run(seed, limit=WALL_LIMIT, law=None):
    """The scene, its faults, the reason of an early end, its numbers, and its wall time."""
    scene = Scene(seed, law)
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        path = scene.write(folder)
        words = ["-o", str(folder / "out"), "--json", "--quiet", "--wall-limit", str(limit)]
        done = subprocess.run([program(), "run", str(path), *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True)
        try:
            figures = json.loads(done.stdout)
        except json.JSONDecodeError:
            figures = {}
        seconds = time.perf_counter() - begin
        message = (figures.get("message") or done.stderr).strip().replace(str(folder), "")
        ends = {0: "", NOT_CONVERGED: f"stopped: {message[:300]}", TOO_SLOW: f"slow: {message}"}
        if done.returncode not in ends or (done.returncode and not message):
            return scene, [(f"exit code {done.returncode}: {message[:300]}", math.nan)], "", {}, seconds
        motion = folder / "table.csv"
        channels = [f"bodies.{name}.{what}" for name in scene.shapes
                    for what in ("position", "orientation", "velocity", "angular_velocity")]
        subprocess.run([program(), "convert", str(folder / "out"), str(motion), "--channels", "energy", *channels],
                       stdout=subprocess.DEVNULL, check=True)
        faults, numbers = faults_of(scene, figures, table(motion))
    return scene, faults, ends[done.returncode], numbers, seconds


def scenes_of(text):
    try:
        found = []
        for part in text.split(","):
            first, _, last = part.partition("-")
            found += range(int(first), int(last or first) + 1)
    except ValueError:
        raise SystemExit(f"'{text}' are not scenes. Write numbers, such as 17,40-60.") from None
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="1-1000", help="numbers of scenes, such as 17,40-60")
    parser.add_argument("--write", nargs=2, metavar=("SCENE", "DIR"), help="writes a scene into a folder")
    parser.add_argument("--limit", type=float, default=WALL_LIMIT, metavar="SECONDS", help="wall time of a scene")
    parser.add_argument("--law", choices=DEEPEST, help="law of every scene; left out: drawn by its number")
    parser.add_argument("--verbose", action="store_true", help="shows every scene")
    options = parser.parse_args()
    if options.write:
        folder = pathlib.Path(options.write[1])
        folder.mkdir(parents=True, exist_ok=True)
        print(Scene(scenes_of(options.write[0])[0], options.law).write(folder))
        return 0
    worst, bad, begin = {}, 0, time.perf_counter()
    ended = {"stopped": 0, "slow": 0}
    seeds = scenes_of(options.scenes)
    for seed in seeds:
        scene, faults, end, numbers, seconds = run(seed, options.limit, options.law)
        bad += bool(faults)
        if end:
            ended[end.partition(":")[0]] += 1
        for what, number in numbers.items():
            key = (scene.law, what)
            if number > worst.get(key, (-1.0, 0))[0]:
                worst[key] = (number, seed)
        if faults or end or options.verbose:
            print(f"scene {seed}, {seconds:.1f} s: {scene.label()}")
            for what, number in faults:
                print(f"    FAULT {what}" + (f": {number:.3g}" if math.isfinite(number) else ""))
            if end:
                print(f"    {end}")
            sys.stdout.flush()
    print(f"\n{len(seeds) - bad} of {len(seeds)} scenes without a fault, {time.perf_counter() - begin:.0f} s; "
          f"{ended['stopped']} did not converge, with a message, {ended['slow']} were stopped after {options.limit:g} s.\n"
          "Largest numbers and their scenes; energies relative to the scene's energy, lengths to a body's smallest half size:")
    for what, about in (("rise", "rise of the mechanical energy, by the balance"),
                        ("own rise", "by masses and velocities, above the start"),
                        ("booked", "decrease of the dissipated energy"), ("balance", "error of the energy balance"),
                        ("depth", "largest penetration"), ("corner", "corner within a plane")):
        laws = [(law, *worst[law, what]) for law in DEEPEST if (law, what) in worst]
        print(f"  {about.ljust(46)}" + "  ".join(f"{law} {number:.1e} ({seed})" for law, number, seed in laws))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
