#!/usr/bin/env bash
# Formats the C++ sources. With --check it changes nothing and fails if a file is not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

folders=()
for folder in src apps python/src tests benchmarks examples fuzz; do
  [ -d "$folder" ] && folders+=("$folder")
done
mode=(-i)
[ "${1:-}" = "--check" ] && mode=(--dry-run --Werror)

find "${folders[@]}" \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
  xargs -0 -r clang-format "${mode[@]}"
