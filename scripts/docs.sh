#!/usr/bin/env bash
# Builds the documentation site into build/docs/html: open index.html, with the network off if you like. Warnings are
# errors, and all links are followed. The theory goes into theory.pdf, too, where there is a Chromium. Sphinx goes into a
# virtual environment under build/; where that cannot be had, it says so and ends with 77.
#
#   scripts/docs.sh                    with the runs of all examples, to play, where the program is built
#   POLHODE=path/to/polhode scripts/docs.sh
#   LIVE="knee stack" scripts/docs.sh  these examples are run; LIVE= none
#   scripts/docs.sh --version 0.2      as build/docs/site/0.2, with a choice of all versions there and a list of them, index.html
#   scripts/docs.sh --version 0.1 --of v0.1.0   the same of another commit, with the program that is built here
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
skip() { echo "skipped: $1"; exit 77; }
environment=$PWD/build/docs/environment
python=$environment/bin/python
prepare() {
  mkdir -p build/docs
  [ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment" 2>/dev/null || skip "python3 cannot make a virtual environment: install python3-venv"
}
if [ -n "$commit" ]; then
  git rev-parse --quiet --verify "$commit^{commit}" >/dev/null || { echo "scripts/docs.sh: --of '$commit' is no commit of this repository" >&2; exit 2; }
  git cat-file -e "$commit:docs/site/versions.py" 2>/dev/null || { echo "scripts/docs.sh: --of '$commit' has no documentation site with versions. Name a later commit" >&2; exit 2; }
  tree=$PWD/build/docs/tree
  remove() { git worktree remove --force "$tree" 2>/dev/null || { rm -rf "$tree"; git worktree prune; }; }
  remove  # what a build that was interrupted left behind
  git worktree add --force --detach "$tree" "$commit" >/dev/null 2>&1 || { echo "scripts/docs.sh: $tree cannot be made" >&2; exit 1; }
  trap remove EXIT
  # The tools of the site and the program are those of this tree.
  mkdir -p "$tree/build/docs"
  prepare
  ln -s "$PWD/build/docs/environment" "$tree/build/docs/environment"
  status=0
  POLHODE=${POLHODE:-$PWD/build/release/apps/polhode/polhode} "$tree/scripts/docs.sh" --version "$version" || status=$?
  [ $status -eq 0 ] || exit $status
  mkdir -p build/docs/site
  rm -rf "build/docs/site/$version"
  cp -r "$tree/build/docs/site/$version" build/docs/site/
  "${PYTHON:-python3}" docs/site/versions.py build/docs/site
  echo "build/docs/site/$version/index.html"
  exit
fi
export POLHODE_DOCS_VERSION=$version

prepare
"$python" -c "import sphinx, myst_parser, furo, latex2mathml, pypdf" 2>/dev/null ||
  "$python" -m pip install --quiet --disable-pip-version-check -r docs/site/requirements.txt || skip "the packages of docs/site/requirements.txt cannot be fetched"

polhode=${POLHODE:-build/release/apps/polhode/polhode}
live=${LIVE-$(cd examples && ls */model.yaml | cut -d/ -f1)}
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
# A build that was interrupted leaves a part of the index of words, and the next one would add only what has changed; nor does
# it know what has changed in the tools of the site.
[ -e build/docs/whole ] && [ -z "$(find docs/site -newer build/docs/whole)" ] || rm -rf build/docs/doctrees
rm -f build/docs/whole
PYTHONDONTWRITEBYTECODE=1 "$python" -m sphinx -q -W --keep-going -j auto -c docs/site -d build/docs/doctrees -b html build/docs/source build/docs/html
touch build/docs/whole
[ ! -d build/docs/source/extra ] || cp -r build/docs/source/extra/. build/docs/html/
"$python" docs/site/search_text.py build/docs/html
"$python" docs/site/theory_pdf.py build/docs/html build/docs/html/theory.pdf || [ $? -eq 77 ]
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
