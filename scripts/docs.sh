#!/usr/bin/env bash
# Builds the documentation site into build/docs/html: open index.html, with the network off if you like. Warnings are
# errors, and all links are followed. Sphinx goes into a virtual environment under build/; where that cannot be had, it
# says so and ends with 77.
#
#   scripts/docs.sh                    with the runs of some examples, to play, where the program is built
#   POLHODE=path/to/polhode scripts/docs.sh
#   LIVE="knee stack" scripts/docs.sh  these examples are run; LIVE= none
set -euo pipefail
cd "$(dirname "$0")/.."

skip() { echo "skipped: $1"; exit 77; }
environment=$PWD/build/docs/environment
python=$environment/bin/python
mkdir -p build/docs
[ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment" 2>/dev/null || skip "python3 cannot make a virtual environment: install python3-venv"
"$python" -c "import sphinx, myst_parser, furo, latex2mathml" 2>/dev/null ||
  "$python" -m pip install --quiet --disable-pip-version-check -r docs/site/requirements.txt || skip "the packages of docs/site/requirements.txt cannot be fetched"

polhode=${POLHODE:-build/release/apps/polhode/polhode}
live=${LIVE-"crank_rocker double_pendulum heavy_top knee n_four_bar newtons_cradle suspension_corner tumbling_body"}
options=()
if [ -x "$polhode" ] && [ -n "$live" ]; then
  "$python" docs/site/run_live.py "$polhode" build/docs/live $live
  options=(--live build/docs/live)
else
  echo "No live runs: the program is not built, or LIVE is empty."
fi
PYTHONDONTWRITEBYTECODE=1 "$python" docs/site/assemble.py build/docs/source "${options[@]}"
PYTHONDONTWRITEBYTECODE=1 "$python" -m sphinx -q -W --keep-going -j auto -c docs/site -d build/docs/doctrees -b html build/docs/source build/docs/html
cp -r build/docs/source/extra/. build/docs/html/
"$python" docs/site/check_site.py build/docs/html
# In a headless browser, where there is one with the packages of the viewer's tests.
if command -v node >/dev/null && [ -d viewer/node_modules ]; then
  node viewer/test/site.mjs build/docs/html || [ $? -eq 77 ]
fi
echo "build/docs/html/index.html"
