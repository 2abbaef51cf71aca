#!/usr/bin/env bash
# Builds the documentation site into build/docs/html: open index.html, with the network off if you like. Warnings are
# errors, and all links are followed. The theory goes into theory.pdf, too, where there is a Chromium. Sphinx goes into a virtual environment under build/; where that cannot be had, it
# says so and ends with 77.
#
#   scripts/docs.sh                    with the runs of some examples, to play, where the program is built
#   POLHODE=path/to/polhode scripts/docs.sh
#   LIVE="knee stack" scripts/docs.sh  these examples are run; LIVE= none
#   scripts/docs.sh --version 0.2      as build/docs/site/0.2, with a choice of all versions there and a list of them, index.html
#   scripts/docs.sh --version 0.1 --of v0.1.0   the same of another commit
set -euo pipefail
cd "$(dirname "$0")/.."

version= commit=
while [ $# -gt 0 ]; do
  case "$1" in
    --version) version=${2:?--version needs a name}; shift 2 ;;
    --of) commit=${2:?--of needs a commit}; shift 2 ;;
    *) echo "scripts/docs.sh: '$1' is not known; there are --version NAME and --of COMMIT" >&2; exit 2 ;;
  esac
done
case "$version" in *[!A-Za-z0-9._-]* | .*) echo "scripts/docs.sh: --version '$version' is no name of a folder" >&2; exit 2 ;; esac
[ -z "$commit" ] || [ -n "$version" ] || { echo "scripts/docs.sh: --of goes with --version" >&2; exit 2; }
if [ -n "$commit" ]; then
  tree=$PWD/build/docs/tree
  git worktree add --force --detach "$tree" "$commit" >/dev/null
  trap 'git worktree remove --force "$tree"' EXIT
  POLHODE=${POLHODE:-$PWD/build/release/apps/polhode/polhode} "$tree/scripts/docs.sh" --version "$version"
  mkdir -p build/docs/site
  rm -rf "build/docs/site/$version"
  cp -r "$tree/build/docs/site/$version" build/docs/site/
  "${PYTHON:-python3}" docs/site/versions.py build/docs/site
  exit
fi
export POLHODE_DOCS_VERSION=$version

skip() { echo "skipped: $1"; exit 77; }
environment=$PWD/build/docs/environment
python=$environment/bin/python
mkdir -p build/docs
[ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment" 2>/dev/null || skip "python3 cannot make a virtual environment: install python3-venv"
"$python" -c "import sphinx, myst_parser, furo, latex2mathml, pypdf" 2>/dev/null ||
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
for browser in "${CHROMIUM:-}" chromium chromium-browser google-chrome; do
  [ -n "$browser" ] && command -v "$browser" >/dev/null && { options+=(--pdf); break; }
done
PYTHONDONTWRITEBYTECODE=1 "$python" docs/site/assemble.py build/docs/source "${options[@]}"
PYTHONDONTWRITEBYTECODE=1 "$python" -m sphinx -q -W --keep-going -j auto -c docs/site -d build/docs/doctrees -b html build/docs/source build/docs/html
[ ! -d build/docs/source/extra ] || cp -r build/docs/source/extra/. build/docs/html/
"$python" docs/site/theory_pdf.py build/docs/html build/docs/html/theory.pdf "${version:-$(sed -n 's/.*VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt | head -1)}" || [ $? -eq 77 ]
"$python" docs/site/check_site.py build/docs/html
place=build/docs/html
if [ -n "$version" ]; then
  place=build/docs/site/$version
  rm -rf "$place"
  mkdir -p build/docs/site
  cp -r build/docs/html "$place"
  "$python" docs/site/versions.py build/docs/site
fi
# In a headless browser, where there is one with the packages of the viewer's tests.
if command -v node >/dev/null && [ -d viewer/node_modules ]; then
  node viewer/test/site.mjs "$place" || [ $? -eq 77 ]
fi
echo "$place/index.html"
