#!/usr/bin/env bash
# Looks through the sources with clang-tidy and the checks of .clang-tidy; nothing is built.
#
#   scripts/tidy.sh                         all of src and apps, about 20 minutes on two cores
#   scripts/tidy.sh src/polhode/io apps     only files whose path holds one of these
#   scripts/tidy.sh --changed [commit]      only files changed since a commit, default origin/main
#
# Ends with exit status 1 if there are findings.
set -uo pipefail
cd "$(dirname "$0")/.."

build=build/tidy
mkdir -p build
CC=clang CXX=clang++ cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_UNITY=OFF \
  -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DPOLHODE_BUILD_TESTS=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >"$build.log" 2>&1 ||
  { cat "$build.log"; exit 1; }

if [ "${1:-}" = --changed ]; then
  mapfile -t files < <(git diff --name-only "${2:-origin/main}" -- 'src/*.cpp' 'apps/*.cpp')
elif [ $# -gt 0 ]; then
  mapfile -t files < <(find src apps -name '*.cpp' | grep -F "${@/#/-e}" | sort)
else
  mapfile -t files < <(find src apps -name '*.cpp' | sort)
fi
# Vector kernels of other processors are not in the list of what is compiled.
for i in "${!files[@]}"; do
  grep -qF "/${files[i]}\"" "$build/compile_commands.json" || unset "files[$i]"
done
[ ${#files[@]} -gt 0 ] || { echo "Nothing to look at."; exit 0; }

printf '%s\n' "${files[@]}" |
  xargs -P "$(nproc)" -n 2 clang-tidy -p "$build" --quiet 2>/dev/null
result=$?
[ "$result" = 0 ] && echo "${#files[@]} files, no findings."
exit "$result"
