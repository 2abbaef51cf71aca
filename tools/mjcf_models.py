#!/usr/bin/env python3
"""Imports the MJCF files of published models, and compares mass and motion with MuJoCo.

    POLHODE=build/release/apps/polhode/polhode tools/mjcf_models.py [--table FILE] [--actuators]

Installs mujoco (Apache-2.0), PyYAML and, for their files only, dm-control (Apache-2.0), gymnasium (MIT) and gymnasium-robotics (MIT)
into build/mjcf. For each file it compares total mass, centre of mass and inertia at the model's configuration, and the centres of
mass of the named bodies after 1 s of free motion from rest at coordinates that were displaced at random (seeded), with MuJoCo's
compiler and its Runge-Kutta steps. Contacts, limits, friction, actuators and soft constraints are off on both sides. The error of a
step must be what two steps of Polhode say at second order, and small. With --actuators these act, at controls of zero, so that servos pull
to their zero. By hand: the files are no part of the project.
"""
import argparse
import json
import os
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from robots import ROOT, in_own_environment, places, polhode, tabulate  # noqa: E402

VENV = ROOT / "build/mjcf"
PACKAGES = ["mujoco==4.0.0", "numpy", "PyYAML"]
FILES = ["dm-control==1.0.50", "gymnasium==1.4.0", "gymnasium-robotics==1.4.2"]
OPTIONS = ["--set", "import.shapes=none", "--set", "import.limits=false", "--set", "import.friction=false", "--set", "import.keyframe=none"]
STEPS_MS = [(2, 1), (0.5, 0.25), (0.125, 0.0625)]
ROUND_OFF = 1e-12  # Relative, of sums over a few dozen bodies.
MESHES = 1e-7  # Likewise where they follow from meshes, whose points are in single precision there.
SUMS = 1e-8  # Likewise where lengths of tendons are slides with 1e-10 of the inertia of their joints.
NO_MASS = 1e-9  # Of the size: effect of links without mass, which take 1e-10 of the next body here.
CLOSE = 1e-3  # Of the model's size: an error that is only just of second order shows nothing above it.


def allowed(name):
    return re.sub("[^A-Za-z0-9_-]", "_", name)


def reference(mujoco, model, start, seconds, dt, bodies):
    """Centres of mass after free motion from rest; None where the method is not stable."""
    import numpy as np
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, dt
    data = mujoco.MjData(model)
    mujoco.mj_resetData(model, data)
    for address, value in start.items():
        data.qpos[address] = value
    for _ in range(round(seconds / dt)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return None if data.warning.number.any() or not np.isfinite(data.qpos).all() else data.xipos[bodies].copy()


def displaced(model):
    """Start coordinates by address, and by name as Polhode reads them."""
    import numpy as np
    random, by_address, by_name = np.random.default_rng(1), {}, {}
    for j in range(model.njnt):
        if model.jnt_type[j] not in (2, 3):  # Slides and hinges.
            continue
        b = model.jnt_bodyid[j]
        body = model.body(b).name or None
        single, k = model.body_jntnum[b] == 1, j - model.body_jntadr[b] + 1
        name = model.joint(j).name or (body and (f"{body}_joint" if single else f"{body}_joint_{k}"))
        if not name:
            continue
        address = model.jnt_qposadr[j]
        by_address[address] = by_name[name] = float(model.qpos0[address] + (0.3 if model.jnt_type[j] == 3 else 0.03) * random.uniform(-1, 1))
    return by_address, by_name


def whole(mujoco, model):
    """Total mass, centre of mass and inertia about it."""
    import numpy as np
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = model.body_mass.sum()
    com = model.body_mass @ data.xipos / mass
    inertia = np.zeros((3, 3))
    for b in range(model.nbody):
        R, x = data.ximat[b].reshape(3, 3), data.xipos[b] - com
        inertia += R @ np.diag(model.body_inertia[b]) @ R.T + model.body_mass[b] * (x @ x * np.eye(3) - np.outer(x, x))
    return mass, com, inertia


def compare(mujoco, file, actuators):
    """One row of the table: status, and what it is about."""
    options = [*OPTIONS, *(["--set", "import.actuators=false"] if not actuators else [])]
    import numpy as np
    import yaml
    done = polhode("import", file, "--json", *options)
    if done.returncode:
        what = re.sub("^.*?error: ", "", done.stderr.strip().splitlines()[0])
        return "refused", re.sub("'[^']*'", "...", what)[:110]
    report = json.loads(done.stdout)
    model = mujoco.MjModel.from_xml_path(str(file))
    off = mujoco.mjtDisableBit
    model.opt.disableflags |= off.mjDSBL_CONTACT | off.mjDSBL_LIMIT | off.mjDSBL_FRICTIONLOSS | off.mjDSBL_EQUALITY
    if not actuators:
        model.opt.disableflags |= off.mjDSBL_ACTUATION
    mass, com, inertia = whole(mujoco, model)
    size = max(1e-9, float(np.sqrt(np.abs(inertia).max() / mass)))
    worst = max(abs(report["mass"] - mass) / mass, np.abs(np.array(report["center_of_mass"]) - com).max() / max(size, np.abs(com).max()),
                np.abs(np.array(report["inertia"]) - inertia).max() / np.abs(inertia).max())
    if not worst <= (MESHES if model.nmesh else SUMS if actuators and model.ntendon else ROUND_OFF):
        return "differs", f"mass or inertia by {worst:.1e}"
    if model.neq and model.eq_active0.any():
        return "agrees", f"mass {worst:.0e}; motion not compared, as constraints are soft there"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        polhode("convert", file, folder / "model.yaml", *options)
        known = yaml.safe_load((folder / "model.yaml").read_text())["bodies"]
        bodies = [b for b in range(1, model.nbody) if model.body(b).name and model.body_mass[b] > 0
                  and not known.get(allowed(model.body(b).name), {"fixed": True}).get("fixed")]
        if not bodies:
            return "agrees", f"mass {worst:.0e}; no named body moves"
        by_address, by_name = displaced(model)
        (folder / "start.yaml").write_text(json.dumps({"format": 1, "import": {"start": by_name}}))
        more = ["--overlay", folder / "start.yaml"] if by_name else []
        names = [allowed(model.body(b).name) for b in bodies]
        for seconds in (1.0, 0.2):  # The shorter time where the motion is chaotic.
            exact, doubt = None, 0.0
            for dt in (1e-3, 1e-4, 1e-5):
                coarse, exact = (reference(mujoco, model, by_address, seconds, h, bodies) for h in (dt, dt / 2))
                doubt = np.abs(coarse - exact).max() / 15 if coarse is not None and exact is not None else np.inf
                if doubt < 1e-8 * size:
                    break
            if not np.isfinite(doubt):
                return "differs", "the reference is not stable"
            for coarse, fine in STEPS_MS:
                x = {h: places(folder, file, names, h, seconds, more, options) for h in (coarse, fine)}
                change, error = np.abs(x[coarse] - x[fine]).max(), np.abs(x[fine] - exact).max()
                how = f"mass {worst:.0e}; motion {error:.1e} m at {fine} ms after {seconds:g} s"
                # At second order the error of the finer step is a third of the change.
                if error <= 0.4 * change + 4 * doubt + NO_MASS * size and error < CLOSE * size:
                    return "agrees", how
    return "differs", how


def main():
    in_own_environment(VENV, PACKAGES)
    import subprocess
    import mujoco
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--table", help="file for the table, in Markdown")
    parser.add_argument("--only", default="", help="files whose path contains this")
    parser.add_argument("--actuators", action="store_true", help="let actuators act, at controls of zero")
    options = parser.parse_args()
    where = VENV / "files"
    if not where.exists():
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", where, *FILES], check=True)
    os.environ.setdefault("MUJOCO_GL", "disable")
    files = [f for f in sorted(where.rglob("*.xml")) if options.only in str(f) and "<mujoco" in f.read_text() and "<body" in f.read_text()
             and "<mujocoinclude" not in f.read_text()]
    tabulate(files, lambda file: compare(mujoco, file, options.actuators), options.table)


if __name__ == "__main__":
    main()
