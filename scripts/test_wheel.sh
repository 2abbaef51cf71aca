#!/usr/bin/env bash
# Installs the wheel of dist/ (scripts/build_wheel.sh) into an empty environment and runs it there: bodies, a solid,
# results, the command. Fails if anything of the system but Python with its modules and the C and C++ libraries is loaded.
# Then the same with NumPy 1, where there is one for this Python.
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${PYTHON:-python3}" -m venv "$work/env"
"$work/env/bin/python" -m pip install --quiet --disable-pip-version-check dist/polhode-*.whl
cp examples/rubber_bushing/model.yaml "$work/bushing.yaml"
cp examples/double_pendulum/model.yaml "$work/pendulum.yaml"
cd "$work"
cat >try.py <<'P'
import re
import subprocess
import sys

import polhode

r = polhode.run("pendulum.yaml", overrides={"analysis.duration": "0.1 s"}, output="out", progress=False)
assert polhode.open("out").frames == r.frames and r.ledger.energy_drift < 1e-12
small = {"solids.rubber.mesh.tube.cells": [1, 8, 1], "radial": "10 N"}
solid = polhode.run("bushing.yaml", overrides=small, progress=False)
assert solid.bodies["pin"].position[-1, 0] > 1e-7
command = sys.prefix + "/bin/polhode"
subprocess.run([command, "run", "bushing.yaml", "--quiet", "--set", "solids.rubber.mesh.tube.cells=[1, 8, 1]"], check=True)
maps = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line.split()[-1]}
of_system = sorted(m for m in maps if not m.startswith(sys.prefix) and "/python3" not in m)
# The C and C++ libraries, and what the modules of Python itself bring along.
allowed = re.compile(r"/(ld-linux|lib(c|m|dl|rt|pthread|util|resolv|stdc\+\+|gcc_s|python3|z|bz2|lzma|ffi))[-.]")
inside = sorted({re.split(r"[-.]", m.rsplit("/", 1)[-1])[0] for m in maps if "polhode.libs" in m})
strange = [m for m in of_system if not allowed.search(m)]
if "_hashlib" in sys.modules and "libcrypto" in inside:  # NumPy 1 loads that module of Python; ours is inside
    strange = [m for m in strange if not re.search(r"/lib(crypto|ssl)[.]", m)]
assert not strange, f"of the system: {strange}"
assert "libdmumps_seq" in inside and any("blas" in name for name in inside), inside
# What travels along is listed with its licence: in the package, by the command, and beside the libraries.
from importlib import metadata

licences = [str(f) for f in metadata.files("polhode") if "licenses" in str(f)]
for part in ["THIRD_PARTY.md", "LICENSE", "mumps", "openblas", "hdf5", "LGPL-2.1"]:
    assert any(part in name for name in licences), (part, licences)
told = subprocess.run([command, "doctor", "--licences"], check=True, capture_output=True, text=True).stdout
assert told == open(polhode.__path__[0] + "/THIRD_PARTY.md").read() and "three.js" in told
listed = [line.split("|")[1].strip() for line in told.splitlines() if line.startswith("| ") and "https://" in line]
for part in ["Eigen", "fmt", "yaml-cpp", "HDF5", "three.js", "uPlot", "nanobind", "CLI11"]:
    assert part in listed, (part, listed)
in_package = next(f for f in metadata.files("polhode") if str(f).endswith("licenses/THIRD_PARTY.md"))
assert in_package.read_text() == told
# Pages keep the notices of what they contain.
subprocess.run([command, "view", "pendulum.yaml", "--html", "page.html", "--quiet"], check=True)
page = open("page.html").read()
for notice in ["three.js authors", "Leon Sorokin", "Permission is hereby granted"]:
    assert notice in page, notice
import numpy as np

m = polhode.Model(analysis={"duration": 1, "step": 0.01})
m.add_body("b", mass=1, inertia=[1, 1, 1], position=np.array([1, 0, 0]))
m.add_load("spring", "force", body="b", at=np.array([1, 0, 0]), force=lambda t, body: -body.position)
r = polhode.run(m, progress=False)
assert abs(r.bodies["b"].position[-1, 0] - np.cos(1)) < 1e-4
assert polhode.rotations.matrix_from_rotation_vector(np.zeros((2, 3))).shape == (2, 3, 3)
print("NumPy", np.__version__, "- inside:", ", ".join(inside))
P
env -i PATH=/nothing HOME="$work" "$work/env/bin/python" try.py
rm -rf out
if "$work/env/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: 'numpy<2' 2>"$work/log"; then
  env -i PATH=/nothing HOME="$work" "$work/env/bin/python" try.py
fi
