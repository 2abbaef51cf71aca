#!/usr/bin/env bash
# Tests of the viewer; skipped (exit code 77) without node, npm or the packages of package.json.
#
#   viewer/test.sh built   type check, and comparison of dist/viewer.html with the build of src/
#   viewer/test.sh page    pages in a headless Chromium; POLHODE is the program that writes them
set -euo pipefail
cd "$(dirname "$0")"

skip() { echo "skipped: $1"; exit 77; }
command -v node >/dev/null || skip "there is no node: install the Debian packages nodejs and npm"
if [ ! -d node_modules ]; then
  command -v npm >/dev/null || skip "there is no npm: install the Debian package npm"
  npm ci --no-audit --no-fund >/dev/null || skip "the packages of viewer/package-lock.json cannot be fetched"
fi
case "${1:-}" in
  built)
    node node_modules/typescript/bin/tsc --noEmit
    node build.mjs --check
    ;;
  page) node test/run.mjs ;;
  *) echo "viewer/test.sh built|page" >&2; exit 2 ;;
esac
