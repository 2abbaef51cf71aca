#!/usr/bin/env bash
# Installs the packages of scripts/packages.txt that are missing, with apt-get.
#
#   scripts/packages.sh build [test]
#
# Does nothing where all of them are there, and only says which are missing where apt-get or the
# right to use it is.
set -euo pipefail

list="$(dirname "${BASH_SOURCE[0]}")/packages.txt"
missing=()
for purpose in "$@"; do
  while read -r for_what package; do
    [ "$for_what" = "$purpose" ] || continue
    state=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
    [ "${state:0:2}" = ii ] && continue
    # Programs that came in another way, such as an npm within a newer node, do as well.
    case "$package" in npm | chromium | ffmpeg) command -v "$package" >/dev/null && continue ;; esac
    missing+=("$package")
  done <"$list"
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if command -v sudo >/dev/null; then
    as_root=(sudo)
  else
    echo "These packages are missing, and there is no sudo to install them with:" >&2
    echo "  ${missing[*]}" >&2
    exit 1
  fi
fi
if ! command -v apt-get >/dev/null; then
  echo "There is no apt-get here. Install what these Debian packages hold: ${missing[*]}" >&2
  exit 1
fi
echo "Installing: ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
for attempt in 1 2 3; do
  "${as_root[@]}" apt-get update -q >&2 &&
    "${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}" >&2 </dev/null &&
    exit 0
  echo "apt-get failed (attempt $attempt of 3)" >&2
  sleep 5
done
exit 1
