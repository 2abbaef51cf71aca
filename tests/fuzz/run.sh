#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the reader of model files: tests/fuzz/run.sh [seconds, default 600] [build folder].
# Inputs that break it are left in <build folder>/crashes and make the script fail.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-600}
build=${2:-$root/build/fuzz}

CC=clang CXX=clang++ cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DPOLHODE_BUILD_FUZZERS=ON -DPOLHODE_BUILD_APPS=OFF > /dev/null
cmake --build "$build" --target read_model_fuzzer

mkdir -p "$build/found" "$build/crashes"
fuzzer=$(find "$build" -name read_model_fuzzer -type f | head -n 1)
"$fuzzer" "$build/found" "$root/tests/corpus/good" "$root/tests/corpus/broken" \
  -dict="$root/tests/fuzz/model_file.dict" -artifact_prefix="$build/crashes/" \
  -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1
echo "No input broke the reader in $seconds seconds."
