#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Fuzzes one reader: tests/fuzz/run.sh [seconds, default 600] [build folder] [reader: model (default),
# gmsh, vtu, abaqus, stl, obj, dae, urdf, mjcf, sdf, feb, results, checkpoint, lists]. Inputs that cause failures are stored in
# <build folder>/crashes, and the script fails. POLHODE_FUZZ_LIBRARY=build/release/libpolhode.a in the environment saves building
# the library once more.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-600}
build=${2:-$root/build/fuzz}
reader=${3:-model}

meshes=$root/tests/solids/mesh/data
case $reader in
  model)
    corpus="$root/tests/corpus/good $root/tests/corpus/broken"
    words=model_file.dict ;;
  gmsh | vtu | abaqus)
    corpus="$meshes $root/tests/fuzz/found_in_meshes"
    words=mesh.dict ;;
  stl | obj | dae)
    corpus="$root/tests/geometry/data $root/tests/fuzz/found_in_surfaces"
    words=surface.dict ;;
  urdf | mjcf | sdf | feb)
    corpus="$root/tests/corpus/robots $root/tests/fuzz/found_in_robots"
    words=robot.dict ;;
  results | checkpoint | lists)
    corpus=
    words= ;;
  *)
    echo "There is no reader '$reader': model, gmsh, vtu, abaqus, stl, obj, dae, urdf, mjcf, sdf, feb, results, checkpoint or lists." >&2
    exit 2 ;;
esac

CC=clang CXX=clang++ cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DPOLHODE_BUILD_FUZZERS=ON -DPOLHODE_BUILD_APPS=OFF \
  -DPOLHODE_FUZZ_LIBRARY="${POLHODE_FUZZ_LIBRARY:+$(realpath "$POLHODE_FUZZ_LIBRARY")}" > /dev/null
cmake --build "$build" --target "read_${reader}_fuzzer"

mkdir -p "$build/found_$reader" "$build/crashes" "$root/tests/fuzz/found_in_meshes" \
  "$root/tests/fuzz/found_in_surfaces" "$root/tests/fuzz/found_in_robots"
fuzzer=$(find "$build" -name "read_${reader}_fuzzer" -type f | head -n 1)
# shellcheck disable=SC2086
"$fuzzer" "$build/found_$reader" $corpus \
  ${words:+-dict="$root/tests/fuzz/$words"} -artifact_prefix="$build/crashes/" \
  -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1
echo "No input broke the reader in $seconds seconds."
