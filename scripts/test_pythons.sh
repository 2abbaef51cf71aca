#!/usr/bin/env bash
# Builds the Python package for each interpreter that is found, 3.9 to 3.13, and runs its fast tests with it; for the
# newest that has it also with NumPy 1. Part of a release, as it takes minutes for each: scripts/test_python.sh tests one.
# With arguments only these: scripts/test_pythons.sh python3.9 /opt/python3.13/bin/python
set -euo pipefail
cd "$(dirname "$0")/.."
export CC=${CC:-cc} CXX=${CXX:-c++} CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 OPENBLAS_NUM_THREADS=1
found=("$@")
if [ $# = 0 ]; then
  for version in 3.9 3.10 3.11 3.12 3.13; do
    for candidate in "python$version" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python; do
      if path=$(command -v "$candidate") && "$path" -c "import venv, sys; assert '%d.%d' % sys.version_info[:2] == '$version'" 2>/dev/null; then
        found+=("$path")
        break
      fi
    done
  done
fi
[ ${#found[@]} -gt 0 ] || { echo "no Python from 3.9 to 3.13 found" >&2; exit 1; }

# $1: interpreter, $2: NumPy wanted, e.g. "numpy<2"
test_with() {
  local version environment python log
  version=$("$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  environment=$PWD/build/python-$version
  python=$environment/bin/python
  [ -x "$python" ] || "$1" -m venv "$environment"
  "$python" -m pip install --quiet --disable-pip-version-check 'scikit-build-core>=0.10' 'nanobind>=2.4' ninja "$2" scipy pandas xarray \
    matplotlib tqdm h5py pytest pytest-timeout hypothesis
  log=$environment/install.log  # the build lies as deep as the others, so that a compiler cache serves it
  "$python" -m pip install --disable-pip-version-check --no-build-isolation --no-deps --force-reinstall -v \
    --config-settings="build-dir=build/wheel-$version" . >"$log" 2>&1 || { tail -50 "$log"; exit 1; }
  "$python" -c 'import sys, numpy, polhode; print("Python", sys.version.split()[0], "NumPy", numpy.__version__, "polhode", polhode.__version__)'
  # Notebooks, the cluster and the documents are the same Python code in all: test_python.sh runs them.
  "$python" -m pytest -q -p no:cacheprovider --timeout 600 python/tests --ignore python/tests/test_notebooks.py \
    --ignore python/tests/test_docs.py --ignore python/tests/test_show.py --deselect python/tests/test_studies.py
}

for interpreter in "${found[@]}"; do test_with "$interpreter" numpy; done
# NumPy 1 came to its end with 3.12.
for interpreter in "${found[@]}"; do
  "$interpreter" -c 'import sys; sys.exit(sys.version_info[:2] not in ((3, 11), (3, 12)))' || continue
  test_with "$interpreter" "numpy<2"
  break
done
