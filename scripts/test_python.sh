#!/usr/bin/env bash
# Builds the wheel, installs it into a virtual environment under build/ and runs its tests there; then makes it
# self-contained and tries that one in an empty environment. More arguments go to pytest, and end it there.
set -euo pipefail
cd "$(dirname "$0")/.."
environment=$PWD/build/python-tests
python=$environment/bin/python
[ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment"
"$python" -m pip install --quiet --disable-pip-version-check -r python/requirements.txt
# The same compiler names, options and base folder as the other builds, so that a compiler cache serves all of them.
export CC=${CC:-cc} CXX=${CXX:-c++} CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 POLHODE_WERROR=ON
export OPENBLAS_NUM_THREADS=1
log=build/python-install.log
rm -rf build/wheel
"$python" -m pip wheel --disable-pip-version-check --no-build-isolation --no-deps -w build/wheel -v . >"$log" 2>&1 ||
  { tail -50 "$log"; exit 1; }
"$python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall build/wheel/polhode-*.whl
"$python" -m ruff check --quiet python benchmarks/peers tests/benchmark_peers.py
mypy=(bin/mypy --config-file "$PWD/pyproject.toml" --python-executable "$python")
(cd "$environment" && "${mypy[@]}" -p polhode && "${mypy[@]}" "$OLDPWD/python/tests")
(cd "$environment" && MYPYPATH=$OLDPWD/benchmarks/peers "${mypy[@]}" "$OLDPWD"/benchmarks/peers/*.py "$OLDPWD/tests/benchmark_peers.py")
"$python" -m pytest -q -p no:cacheprovider --timeout 300 "$@"
[ $# = 0 ] || exit 0
bash scripts/build_wheel.sh build/wheel/polhode-*.whl
PYTHON=$python bash scripts/test_wheel.sh
