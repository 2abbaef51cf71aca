#!/usr/bin/env bash
# Everything that is tested, in the order of what fails fastest. This is what CI runs.
#
#   scripts/test.sh              all of it but the sanitizers
#   scripts/test.sh --sanitize   the unit tests under address and undefined-behaviour sanitizers too
#   scripts/test.sh --threads    simulations in several threads under the thread sanitizer, nothing else
#   scripts/test.sh --quick      release build and unit tests only
#
# Ends with a line "N passed, N failed, N skipped" and exits 1 if something failed. Tests that depend on the machine's load
# (label `timing`) have a second chance, and are named if they use it: tools/run_tests.py.
set -uo pipefail
cd "$(dirname "$0")/.."

quick=no
sanitize=no
threads=no
[ "${1:-}" = --threads ] && threads=yes
[ "${1:-}" = --quick ] && quick=yes
[ "${1:-}" = --sanitize ] && sanitize=yes
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 POLHODE_WERROR=ON
export POLHODE_ASSERTIONS=1  # in every program that a test starts
jobs=$(nproc)
passed=0
failed=0
skipped=0
failures=()
notes=()
logs=build/test-logs
mkdir -p "$logs"

heading() { printf '\n== %s (%s min)\n' "$1" "$((SECONDS / 60))"; }

# One test of its own: a command that succeeds or fails.
check() {
  local name=$1
  shift
  heading "$name"
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("$name")
    return 1
  fi
}

# The tests of a build folder, counted one by one.
tests() {
  local name=$1 folder=$2
  shift 2
  local log="$logs/${name// /-}.log" counts
  heading "$name"
  python3 tools/run_tests.py "$folder" -j "$jobs" "$@" >"$log" 2>&1
  local result=$?
  cat "$log"
  counts=$(tail -1 "$log" | sed -nE 's/^([0-9]+) passed, ([0-9]+) failed, ([0-9]+) skipped$/\1 \2 \3/p')
  if [ -z "$counts" ]; then
    failed=$((failed + 1))
    failures+=("$name: the tests did not start")
    return 1
  fi
  read -r -a counts <<<"$counts"
  passed=$((passed + counts[0]))
  failed=$((failed + counts[1]))
  skipped=$((skipped + counts[2]))
  mapfile -t -O ${#notes[@]} notes < <(grep -E '^(skipped|second chance used): ' "$log")
  [ "$result" = 0 ] || failures+=("$name, see $log")
}

# The unit tests in one process for each processor: starting one for each test takes longer than they do.
unit_tests_under_sanitizers() {
  heading "unit tests under sanitizers"
  local shard log count processes=()
  for ((shard = 0; shard < jobs; shard++)); do
    (cd build/dev/tests && GTEST_COLOR=no GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$shard \
      timeout 7200 ./polhode_unit_tests) >"$logs/sanitizers-$shard.log" 2>&1 &
    processes+=($!)
  done
  for ((shard = 0; shard < jobs; shard++)); do
    log=$logs/sanitizers-$shard.log
    wait "${processes[shard]}" && count=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?.*/\1/p' "$log") || count=
    if [ -n "$count" ]; then
      passed=$((passed + count))
      count=$(sed -nE 's/^\[  SKIPPED \] ([0-9]+) tests?.*/\1/p' "$log")
      skipped=$((skipped + ${count:-0}))
    else  # a failed test, a finding, which ends the process, or a test that ended it or hangs
      grep -aE '^\[  FAILED  \]|ERROR: |runtime error:|assertion failed' "$log" | head -50
      tail -30 "$log"
      failed=$((failed + 1))
      failures+=("unit tests under sanitizers, see $log")
    fi
  done
}

# Simulations in threads under the thread sanitizer; a program without tests has failed.
thread_tests() {
  local program=build/threads/tests/polhode_thread_tests
  "$program" --gtest_list_tests | grep -q '^  ' || { echo "$program has no tests"; return 1; }
  TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1 "$program"
}

configure_and_build() {
  local preset=$1
  shift
  cmake --preset "$preset" "$@" >"$logs/configure-$preset.log" 2>&1 ||
    { cat "$logs/configure-$preset.log"; return 1; }
  cmake --build "build/$preset" -j "$jobs" ${targets:+--target $targets}
}

finish() {
  echo
  for note in "${notes[@]}"; do echo "$note"; done
  for failure in "${failures[@]}"; do echo "failed: $failure"; done
  command -v ccache >/dev/null && ccache -s 2>/dev/null | grep -iE '^ *(hits|misses):' | head -2
  echo "$((SECONDS / 60)) min $((SECONDS % 60)) s"
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" = 0 ]
  exit
}

check "packages" bash scripts/packages.sh build test || finish
if [ "$quick" = yes ]; then
  targets="polhode_cli polhode_unit_tests" check "release build" configure_and_build release || finish
  tests "unit tests" build/release -L unit
  finish
fi

# Everything is compiled for the sanitizer, but only one program of tests is made.
if [ "$threads" = yes ]; then
  targets=polhode_thread_tests check "thread sanitizer build" configure_and_build threads &&
    check "simulations in threads" thread_tests
  finish
fi

check "format" bash scripts/format.sh --check
benchmarks=OFF
[ -f benchmarks/CMakeLists.txt ] && benchmarks=ON
check "release build" configure_and_build release -DPOLHODE_BUILD_BENCHMARKS=$benchmarks &&
  tests "release tests" build/release

# Clang reads what g++ has built: warnings that only one of them has.
check "clang" python3 tools/check_clang.py build/release --library

# Address and undefined-behaviour sanitizers, on what is fast enough under them; the corpus of the
# fuzzer (tests/fuzz/run.sh) is read by the unit tests, so it is replayed here.
if [ "$sanitize" = yes ]; then
  targets="polhode_cli polhode_unit_tests" check "sanitizer build" configure_and_build dev &&
    unit_tests_under_sanitizers
fi

finish
