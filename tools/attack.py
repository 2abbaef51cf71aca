#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks the program with damaged and hostile input, and kills it while it runs.

    tools/attack.py                       the attacks that the test suite runs, about two minutes
    tools/attack.py --times 50            fifty times as many
    tools/attack.py --seconds 3600        all kinds in turn, for an hour
    tools/attack.py --seed 7 results      other random numbers; one kind only
    tools/attack.py --keep FOLDER         inputs of faults are kept there

Kinds: models (words and bytes of model files changed), meshes (bytes of mesh and surface files), robots (words and bytes of URDF, MJCF
and SDFormat files), results (results.h5 cut or
with changed bytes, read by convert, plot and view; numbers that are shown must be those of the run), checkpoints (changed bytes, which must be refused, and forged ones with a
valid checksum), kills (kill -9 at a random time, restart, and comparison of all files with a run in one go).

An attack fails if the program is ended by a signal, does not end, reports an internal error, or accepts what must be refused;
a killed run, if any file differs. Everything follows from the seed, except for the times of kills. Needs only Python;
POLHODE=path/to/polhode is the program. The exit code is 1 if an attack has found a fault.
"""
import argparse
import hashlib
import json
import pathlib
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "examples")]
sys.dont_write_bytecode = True
from support import program  # noqa: E402

LIMIT = 100.0  # [s] for one command: beyond, it hangs.
XML_VALUE = rb"""("[^"<]*"|'[^'<]*'|>[^<>]+<)"""  # An attribute's, or the text of a tag.
INTERNAL_ERROR = 1
EXIT_CODES = {0, 2, 3, 4, 5, 6, 75}  # docs/reference/cli.md; 1 is a fault of the program.
# Attacks of a round; the suite runs one round, about two minutes on two cores.
ROUND = {"models": 300, "meshes": 120, "robots": 120, "results": 240, "checkpoints": 240, "kills": 6}

# Models that write what is attacked: bodies and a joint; contact with friction; a solid in statics' mesh, moved.
MODELS = {
    "swing": """format: 1
gravity: [0, 0, -9.81]
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}, b: {mass: 1, inertia: [1, 1, 1], position: [2, 0, 0]}}
joints: {A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}, B: {type: spherical, bodies: [a, b], at: [1.5, 0, 0]}}
loads: {s: {type: spring_damper, bodies: [ground, b], at: [[0, 0, 1], [2, 0, 0]], stiffness: 10, damping: 0.1}}
analysis: {duration: 0.5, step: 5 ms}
output: {every: 10 ms, probes: {p: {body: b}}}
""",
    "drop": """format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  box: {shape: {box: [0.2, 0.2, 0.2]}, density: 1000, position: [0, 0, 0.13], velocity: [1, 0, 0]}
  ball: {shape: {sphere: 0.2}, density: 1000, position: [0.5, 0, 0.12], velocity: [-1, 0, 0]}
contacts: {default: {friction: 0.3}}
analysis: {duration: 0.1, step: 2 ms}
output: {every: 4 ms}
""",
}

# Models whose results alone are attacked: a deformable solid, and a beam on a hinge.
READ_MODELS = {
    "pad": """format: 1
gravity: [0, 0, -9.81]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}
bodies: {block: {mass: 2, inertia: [1, 1, 1], position: [0.5, 0.5, 1.5]}}
solids: {pad: {mesh: {block: {size: [1, 1, 1], cells: [2, 2, 2]}, position: [0.5, 0.5, 0.5]}, material: rubber,
  bonded: {ground: {plane: {axis: z, at: min}}, block: {plane: {axis: z, at: max}}}}}
analysis: {duration: 0.1, step: 2 ms}
output: {every: 2 ms}
""",
    "whip": """format: 1
gravity: [0, 0, -9.81]
materials: {steel: {type: elastic, youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7800}}
sections: {rod: {type: circle, diameter: 1 cm, material: steel}}
beams: {whip: {points: [[0, 0, 0], [1, 0, 0]], elements: 6, section: rod, up: z}}
joints: {hinge: {type: revolute, bodies: [ground, whip.start], at: [0, 0, 0], axis: y}}
analysis: {duration: 0.2, step: 1 ms}
output: {every: 1 ms}
""",
}


class Fault(Exception):
    """What the program did wrong."""


def ended(command, folder, allowed=EXIT_CODES):
    """Exit code and words of a command, with its faults raised."""
    try:
        done = subprocess.run([program(), *map(str, command)], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=LIMIT, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise Fault(f"does not end within {LIMIT:g} s") from None
    said = done.stderr.decode(errors="replace")
    if done.returncode < 0:
        raise Fault(f"ended by {signal.Signals(-done.returncode).name}: {said[-200:]}")
    if done.returncode not in allowed:
        raise Fault(f"exit code {done.returncode}: {said[-300:]}")
    if done.returncode and not said.strip():
        raise Fault(f"exit code {done.returncode} without a word")
    return done.returncode, said


def changed(dice, data, words=(b"",)):
    """Bytes with a few random changes: flipped bits, removed, doubled and inserted parts, words."""
    data = bytearray(data)
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        at = dice.randrange(len(data) + 1)
        length = dice.choice((1, 1, 2, 4, 8, 64))
        kind = dice.randrange(6)
        if kind == 0 and at < len(data):
            data[at] ^= 1 << dice.randrange(8)
        elif kind == 1 and at < len(data):
            data[at] = dice.choice((0, 1, 127, 128, 255))
        elif kind == 2:
            del data[at:at + length]
        elif kind == 3:
            data[at:at] = data[at:at + length]
        elif kind == 4:
            data[at:at + length] = dice.choice(words)
        else:
            del data[at:]
        data = data or bytearray(b"\0")
    return bytes(data)


class Attacks:
    """Input of every kind, made once, and the attacks with it."""

    def __init__(self, folder):
        self.folder = folder
        self.counts = {kind: 0 for kind in ROUND}
        self.outcomes = {kind: {} for kind in ROUND}
        self.models = sorted((ROOT / "tests/corpus/good").glob("*")) + sorted((ROOT / "examples").glob("*/model.yaml"))
        self.meshes = (sorted((ROOT / "tests/solids/mesh/data").glob("*.[miv]*")) + sorted((ROOT / "tests/geometry/data").glob("*")))
        self.meshes = [m for m in self.meshes if m.suffix in (".msh", ".vtu", ".inp", ".stl", ".obj")]
        self.robots = sorted((ROOT / "tests/corpus/robots").glob("*"))
        self.values = [r.read_bytes() for r in self.robots]
        self.values = sorted({v[1:-1] for text in self.values for v in re.findall(XML_VALUE, text)} |
                             {b"1e308", b"-1", b"0", b"0 0 0", b"1e-308", b"nan", b"inf", b"9" * 40, b"&amp;", b"x" * 300, b""})
        self.words = sorted({w.encode() for m in self.models[:9] for w in m.read_text().split()} |
                            {b"1e308", b"-1", b"0", b"1e-308", b".nan", b"[]", b"{}", b"9" * 40, b"\n", b"ground", b"x" * 300})
        self.runs = {}
        for name, text in MODELS.items():
            model = folder / f"{name}.yaml"
            model.write_text(text)
            run = folder / name
            ended(["run", model, "-o", run, "--quiet"], folder, {0})
            # The checkpoint of the middle: a run writes its last state when it is stopped.
            self.runs[name] = (model, run, self.checkpoint_of(model, run))
        self.results = {name: run for name, (_, run, _) in self.runs.items()}
        for name, text in READ_MODELS.items():
            model, self.results[name] = folder / f"{name}.yaml", folder / name
            model.write_text(text)
            ended(["run", model, "-o", folder / name, "--quiet"], folder, {0})
        self.tables = {name: self.table_of(run / "results.h5") for name, run in self.results.items()}

    def table_of(self, results):
        """Rows of numbers of a results file, without the line of names and units."""
        ended(["convert", results, "table.csv"], self.folder, {0})
        return (self.folder / "table.csv").read_text().splitlines()[1:]

    def checkpoint_of(self, model, run):
        """A checkpoint of a run that its time limit has stopped."""
        stopped = self.folder / (run.name + "_stopped")
        ended(["run", model, "-o", stopped, "--quiet", "--wall-limit", "1e-9"], self.folder, {0, 75})
        return (stopped / "checkpoint.pst").read_bytes()

    def models_attack(self, dice):
        source = dice.choice(self.models)
        file = self.folder / ("attacked" + source.suffix)
        file.write_bytes(changed(dice, source.read_bytes(), self.words))
        return ended(["check", file], self.folder), [file]

    def robots_attack(self, dice):
        source = dice.choice(self.robots)
        file = self.folder / ("attacked" + source.suffix)
        data = source.read_bytes()
        if dice.random() < 0.7:  # Other values, so that the file remains XML.
            pieces = re.split(XML_VALUE, data)
            for _ in range(dice.choice((1, 1, 2, 4))):
                at = 1 + 2 * dice.randrange(len(pieces) // 2)
                pieces[at] = pieces[at][:1] + dice.choice(self.values) + pieces[at][-1:]
            data = b"".join(pieces)
        else:
            data = changed(dice, data, self.values)
        file.write_bytes(data)
        more = dice.choice(([], ["--allow-partial"]))
        return ended([dice.choice(("check", "import")), file, *more], self.folder), [file]

    def meshes_attack(self, dice):
        source = dice.choice(self.meshes)
        mesh = self.folder / ("attacked" + source.suffix)
        mesh.write_bytes(changed(dice, source.read_bytes(), self.words))
        surface = source.suffix in (".stl", ".obj")
        thing = ("bodies: {b: {shape: {mesh: %s}, density: 1}}" if surface else
                 "materials: {m: {type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}\n"
                 "solids: {s: {mesh: {file: %s}, material: m, element: %s}}") % (
                     mesh.name if surface else (mesh.name, source.name.split("_")[0].split(".")[0]))
        file = self.folder / "attacked_mesh.yaml"
        file.write_text("format: 1\n" + thing + "\nanalysis: {duration: 1, step: 0.1}\n")
        return ended(["check", file], self.folder), [file, mesh]

    def results_attack(self, dice):
        name = dice.choice(sorted(self.results))
        good = (self.results[name] / "results.h5").read_bytes()
        if dice.random() < 1 / 3:
            data = good[:dice.randrange(len(good))]
        else:
            data = bytearray(good)
            # Structures are at the start of the file, so that part is hit more often.
            for _ in range(dice.choice((1, 1, 4, 16))):
                at = dice.randrange(len(good) if dice.random() < 0.5 else min(len(good), 30000))
                data[at] ^= 1 << dice.randrange(8)
        file, table = self.folder / "attacked.h5", self.folder / "attacked.csv"
        file.write_bytes(data)
        table.unlink(missing_ok=True)
        reader = dice.choice((["convert", file, table], ["convert", file, table], ["plot", file, "energy"], ["plot", file],
                              ["view", file, "--html", "attacked.html", "--quiet"], ["convert", file, "attacked.vtkhdf"]))
        code, said = ended(reader, self.folder)
        if code == 0 and table in reader:
            rows = table.read_text(errors="replace").splitlines()[1:]
            if not rows or rows != self.tables[name][:len(rows)] or (len(data) == len(good) and len(rows) != len(self.tables[name])):
                raise Fault(f"wrong numbers are shown of {name}, {len(data)} of {len(good)} bytes")
        return (code, said), [file]

    def checkpoints_attack(self, dice):
        name = dice.choice(sorted(self.runs))
        model, _, good = self.runs[name]
        file = self.folder / "attacked.pst"
        forged = dice.random() < 0.75
        if forged:
            data = bytearray(good[:-64])
            start = 16 + 64 + 8
            for _ in range(dice.choice((1, 1, 2, 8))):
                at = start + 8 * dice.randrange((len(data) - start) // 8)
                data[at:at + 8] = dice.choice((struct.pack("<q", dice.choice((-1, 1, 2, 3, 7, 1000, 2**31, 2**62, -2**63))),
                                               struct.pack("<d", dice.choice((-1.0, 1e300, -1e300, 1e18, float("nan"), float("inf"), 1e-300, 0.5)))))
            data += hashlib.sha256(data).hexdigest().encode()
        else:
            data = changed(dice, good)
        file.write_bytes(data)
        code, said = ended(["run", model, "-o", "attacked", "--restart", file, "--quiet", "--set", "analysis.duration=0.6", "--wall-limit", "5"],
                           self.folder)
        if not forged and bytes(data) != good and code == 0:
            raise Fault("a damaged checkpoint was accepted")
        return (code, said), [file]

    def kills_attack(self, dice):
        """Comparison of a run that is killed again and again with one in one go."""
        name = dice.choice(sorted(self.runs))
        text = MODELS[name].replace("output: {", "output: {paraview: true, ").replace("analysis: {", "analysis: {checkpoint_every: 0.05, ")
        model = self.folder / f"{name}_killed.yaml"
        model.write_text(text)
        finer = ["--set", f"analysis.step={0.02 if name == 'swing' else 0.01} ms", "--set", "output.every=1 ms"]
        whole, killed = self.folder / "whole", self.folder / "killed"
        for run in (whole, killed):
            shutil.rmtree(run, ignore_errors=True)
        started = time.monotonic()
        ended(["run", model, "-o", whole, "--quiet", *finer], self.folder, {0})
        took = time.monotonic() - started
        kills = 0
        for attempt in range(20):
            restart = ["--restart", killed / "checkpoint.pst"] if (killed / "checkpoint.pst").exists() else []
            run = subprocess.Popen([program(), "run", str(model), "-o", str(killed), "--quiet", *finer, *map(str, restart)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            try:
                said = run.communicate(timeout=took * dice.random() if attempt < 4 else LIMIT)[1].decode(errors="replace")
                if run.returncode != 0:
                    raise Fault(f"the continued run has exit code {run.returncode}: {said[-300:]}")
                break
            except subprocess.TimeoutExpired:
                run.kill()
                run.communicate()
                kills += 1
        self.compare(whole, killed)
        return (kills, f"{kills} kills"), [model]

    def compare(self, whole, killed):
        """All files of two results folders: tables by their text, results by those of `convert`."""
        for run in (whole, killed):
            ended(["convert", run / "results.h5", run / "results.csv"], self.folder, {0})
        files = {str(f.relative_to(whole)) for f in whole.rglob("*") if f.is_file()}
        others = {str(f.relative_to(killed)) for f in killed.rglob("*") if f.is_file()}
        skipped = {f for f in files | others if f.endswith(("results.h5", "checkpoint.pst")) or "lock" in f}
        if files - skipped != others - skipped:
            raise Fault(f"other files after kills: {sorted((files ^ others) - skipped)[:5]}")
        for file in sorted(files - skipped):
            a, b = (whole / file).read_bytes(), (killed / file).read_bytes()
            if a != b:
                raise Fault(f"{file} differs after kills ({len(a)} and {len(b)} bytes)")

    def attack(self, kind, dice, keep):
        self.counts[kind] += 1
        number = self.counts[kind]
        self.touched = []
        try:
            (code, _), _ = getattr(self, kind + "_attack")(dice)
            outcome = str(code)
        except Fault as fault:
            outcome = "fault"
            print(f"{kind} {number}: {fault}", flush=True)
            if keep:
                target = keep / f"{kind}_{number}"
                target.mkdir(parents=True, exist_ok=True)
                for file in self.folder.glob("attacked*"):
                    if file.is_file():
                        shutil.copy(file, target)
        self.outcomes[kind][outcome] = self.outcomes[kind].get(outcome, 0) + 1


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("kinds", nargs="*", metavar="KIND", help="models, meshes, robots, results, checkpoints, kills; left out: all")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--times", type=float, default=1.0, help="times the attacks of the suite")
    options.add_argument("--seconds", type=float, help="until this time has passed")
    options.add_argument("--keep", type=pathlib.Path, help="folder for the inputs of faults")
    given = options.parse_args()
    kinds = given.kinds or list(ROUND)
    for kind in kinds:
        if kind not in ROUND:
            options.error(f"there is no kind '{kind}'; kinds: {', '.join(ROUND)}")
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="polhode-attack-") as folder:
        attacks = Attacks(pathlib.Path(folder))
        dice = {kind: random.Random(f"{given.seed} {kind}") for kind in kinds}
        if given.seconds:
            while time.monotonic() - started < given.seconds:
                for kind in kinds:
                    for _ in range(max(1, ROUND[kind] // 6)):
                        if time.monotonic() - started < given.seconds:
                            attacks.attack(kind, dice[kind], given.keep)
        else:
            for kind in kinds:
                for _ in range(max(1, round(given.times * ROUND[kind]))):
                    attacks.attack(kind, dice[kind], given.keep)
    faults = 0
    for kind in kinds:
        outcomes = attacks.outcomes[kind]
        faults += outcomes.get("fault", 0)
        what = "kills" if kind == "kills" else "exit codes"
        print(f"{kind}: {attacks.counts[kind]} attacks, {outcomes.get('fault', 0)} faults, {what} "
              f"{json.dumps({k: outcomes[k] for k in sorted(outcomes) if k != 'fault'})}")
    print(f"{faults} faults in {time.monotonic() - started:.0f} s, seed {given.seed}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
