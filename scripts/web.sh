#!/usr/bin/env bash
# Builds the engine for web pages (WebAssembly) with Debian's emscripten, runs a mechanism there,
# under node, and on this machine, and compares all digits.
#
#   scripts/web.sh
#
# Installs emscripten and node if they are missing. See web/CMakeLists.txt for what is left out.
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/packages.sh build test web
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
emcmake cmake -S . -B build/web -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build/web
cmake --preset release >/dev/null
cmake --build build/release --target polhode_web_n_four_bar

node build/web/web/n_four_bar.js | tee build/web/page.txt
build/release/tests/polhode_web_n_four_bar | tee build/web/machine.txt
if cmp -s build/web/page.txt build/web/machine.txt; then
  echo "The web page has the same digits as this machine."
else
  echo "The web page's digits (above) differ from this machine's (below)." >&2
  exit 1
fi
