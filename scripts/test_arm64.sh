#!/usr/bin/env bash
# Builds Polhode for arm64 with Debian's cross compiler and runs its unit tests under QEMU.
#
#   scripts/test_arm64.sh [further arguments of the test program, such as --gtest_filter=Cone*]
#
# Needs apt (Debian or a child of it), cmake, ninja, and installs g++-aarch64-linux-gnu and
# qemu-user if they are missing. The arm64 libraries are fetched from the same archive as the
# machine's own, and unpacked into build/arm64-sysroot: nothing of the machine's packages changes.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(libc6-dev libstdc++6 libeigen3-dev libfmt-dev libyaml-cpp-dev libtinyxml2-dev libhdf5-dev
  libsuitesparse-dev libmumps-seq-dev libopenblas-pthread-dev libspectra-dev libssl-dev zlib1g-dev
  nlohmann-json3-dev libcli11-dev libgtest-dev libgmock-dev)
sysroot=$PWD/build/arm64-sysroot

if ! command -v aarch64-linux-gnu-g++ >/dev/null || ! command -v qemu-aarch64 >/dev/null; then
  as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update
  "${as_root[@]}" apt-get install -y --no-install-recommends g++-aarch64-linux-gnu qemu-user
fi

fetch_libraries() {
  # A private package state with arm64 as its only architecture and nothing installed, so that
  # apt resolves the whole closure, C library included.
  local state=$PWD/build/arm64-apt
  rm -rf "$state" "$sysroot.new"
  mkdir -p "$state"/{lists/partial,archives/partial} "$sysroot.new"
  : >"$state/status"
  local apt=(apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64
    -o APT::Install-Recommends=false -o APT::Sandbox::User= -o Debug::NoLocking=1
    -o "Dir::State=$state" -o "Dir::State::lists=$state/lists" -o "Dir::State::status=$state/status"
    -o "Dir::Cache=$state" -o "Dir::Cache::archives=$state/archives")
  "${apt[@]}" update
  "${apt[@]}" install -y --download-only "${packages[@]}"
  for package in "$state"/archives/*.deb; do
    dpkg-deb -x "$package" "$sysroot.new"
  done
  # What the alternatives of Debian would choose.
  for library in libblas.so.3 liblapack.so.3 libopenblas.so.0; do
    ln -sfn "openblas-pthread/$library" "$sysroot.new/usr/lib/aarch64-linux-gnu/$library"
  done
  # Links that name the machine's root must name the folder's.
  find "$sysroot.new" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
    ln -sfn "$(realpath -m --relative-to="$(dirname "$link")" \
      "$sysroot.new$(readlink "$link")")" "$link"
  done
  rm -rf "$state"
  mv "$sysroot.new" "$sysroot"
}
[ -d "$sysroot" ] || fetch_libraries

export POLHODE_ARM64_SYSROOT=$sysroot
cmake --preset arm64
cmake --build build/arm64 --target polhode_cli polhode_unit_tests

# One emulator for many tests: starting it costs more than most of them.
run_part() {
  GTEST_TOTAL_SHARDS=$parts GTEST_SHARD_INDEX=$1 qemu-aarch64 -L "$sysroot" \
    build/arm64/tests/polhode_unit_tests --gtest_brief=1 "${@:2}" >"build/arm64/part$1.log" 2>&1
}
parts=$(nproc)
running=()
for ((part = 0; part < parts; ++part)); do
  run_part "$part" "$@" &
  running+=($!)
done
status=0
for process in "${running[@]}"; do
  wait "$process" || status=1
done
cat build/arm64/part*.log
exit "$status"
