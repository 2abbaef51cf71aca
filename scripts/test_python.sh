#!/usr/bin/env bash
# Installs the Python package into a virtual environment under build/ and runs its tests there.
# More arguments go to pytest.
set -euo pipefail
cd "$(dirname "$0")/.."
environment=$PWD/build/python-tests
python=$environment/bin/python
[ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment"
"$python" -m pip install --quiet --disable-pip-version-check -r python/requirements.txt
# The same compiler names and base folder as the other builds, so that a compiler cache serves all of them.
export CC=${CC:-cc} CXX=${CXX:-c++} CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
export OPENBLAS_NUM_THREADS=1
log=build/python-install.log
"$python" -m pip install --disable-pip-version-check --no-build-isolation --no-deps --force-reinstall -v . >"$log" 2>&1 ||
  { tail -50 "$log"; exit 1; }
"$python" -m ruff check --quiet python
(cd "$environment" && bin/mypy --config-file "$OLDPWD/pyproject.toml" --python-executable "$python" -p polhode)
"$python" -m pytest -q -p no:cacheprovider --timeout 300 "$@"
