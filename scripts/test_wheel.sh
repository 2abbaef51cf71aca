#!/usr/bin/env bash
# Installs the wheel of dist/ (scripts/build_wheel.sh) into an empty environment and runs it there: bodies, a solid,
# results, the command. Fails if anything of the system but Python with its modules and the C and C++ libraries is loaded.
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${PYTHON:-python3}" -m venv "$work/env"
"$work/env/bin/python" -m pip install --quiet --disable-pip-version-check dist/polhode-*.whl
cp examples/rubber_bushing/model.yaml "$work/bushing.yaml"
cp examples/double_pendulum/model.yaml "$work/pendulum.yaml"
cd "$work"
env -i PATH=/nothing HOME="$work" "$work/env/bin/python" - <<'P'
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
strange = [m for m in of_system if not allowed.search(m)]
assert not strange, f"of the system: {strange}"
inside = sorted({re.split(r"[-.]", m.rsplit("/", 1)[-1])[0] for m in maps if "polhode.libs" in m})
assert "libdmumps_seq" in inside and any("blas" in name for name in inside), inside
print("inside:", ", ".join(inside))
P
