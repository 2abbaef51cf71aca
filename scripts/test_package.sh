#!/usr/bin/env bash
# Tests the packages of dist/ (scripts/package.sh makes them). The archive runs in a folder that becomes the root of
# everything and has the C library and nothing else; its results must be those of the program that was built here. With
# names of Debian releases, such as bookworm trixie, it runs in a fresh system of each as well, and the .deb on that
# of this release; neither has a compiler (needs root, debootstrap and a network).
#
#   scripts/test_package.sh [RELEASE ...]
set -euo pipefail
cd "$(dirname "$0")/.."
built=$PWD/build/package/apps/polhode/polhode
archive=$(echo "$PWD"/dist/polhode-*-Linux-*.tar.gz)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
as_root=()
[ "$(id -u)" = 0 ] || as_root=(--map-root-user)
# enter ROOT COMMAND ...: with processes of its own, as a program finds its folder in /proc.
enter() {
  mkdir -p "$1/proc"
  env -i /usr/bin/unshare "${as_root[@]}" --mount --pid --fork --mount-proc="$1/proc" /usr/sbin/chroot "$@"
}

# Models of bodies alone (tree elimination), of a loop, of a solid (MUMPS is opened by name).
mkdir "$work/models"
cp examples/double_pendulum/model.yaml "$work/models/pendulum.yaml"
"$built" examples n_four_bar --set N=2 -o "$work/models/four_bar.yaml" >/dev/null
cp examples/rubber_bushing/model.yaml "$work/models/bushing.yaml"
declare -A short=([pendulum]="analysis.duration=0.1 s" [four_bar]="analysis.duration=0.1 s"
  [bushing]="solids.rubber.mesh.tube.cells=[1, 8, 1]")
hash_of() { grep -o '"result_hash": *"[^"]*"'; }
for model in "${!short[@]}"; do
  "$built" run "$work/models/$model.yaml" --quiet --json --set "${short[$model]}" -o "$work/here/$model" | hash_of >"$work/$model.hash"
done

# same_results ROOT PROGRAM: in another root the program gives the same bits.
same_results() {
  cp -r "$work/models" "$1/models"
  for model in "${!short[@]}"; do
    enter "$1" "$2" run "/models/$model.yaml" --quiet --json --set "${short[$model]}" -o "/out/$model" |
      hash_of | diff "$work/$model.hash" - || { echo "$model differs in $1" >&2; exit 1; }
  done
}

root=$work/empty
mkdir -p "$root/opt"
tar xzf "$archive" -C "$root/opt"
program=$(cd "$root" && echo opt/polhode-*/bin/polhode)
for library in $(ldd "$built" | grep -oE '/[^ ]*/(ld-linux[^ ]*|lib(c|m|dl|rt|pthread|resolv)\.so[^ ]*)'); do
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done
same_results "$root" "/$program"
echo "the archive runs where there is nothing but the C library"

# The source as a release has it, without git.
mkdir "$work/source"
git archive HEAD | tar x -C "$work/source"
export CCACHE_BASEDIR=$work/source CCACHE_NOHASHDIR=1
cmake -S "$work/source" -B "$work/source/build/release" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_BUILD_TESTS=OFF >/dev/null
cmake --build "$work/source/build/release" --target polhode_cli >/dev/null
"$work/source/build/release/apps/polhode/polhode" run "$work/models/pendulum.yaml" --quiet --json --set "${short[pendulum]}" \
  -o "$work/from_source" | hash_of | diff "$work/pendulum.hash" -
echo "the source builds without git"

here=$(. /etc/os-release && echo "$VERSION_CODENAME")
for release in "$@"; do
  system=$work/$release
  debootstrap --variant=minbase "$release" "$system" >"$work/log" 2>&1 || { tail -5 "$work/log" >&2; exit 1; }
  if [ "$release" = "$here" ]; then
    cp dist/polhode_*.deb "$system/"
    chroot "$system" sh -c 'apt-get update -q && apt-get install -q -y --no-install-recommends ./polhode_*.deb' >"$work/log" 2>&1 ||
      { tail -5 "$work/log" >&2; exit 1; }
    same_results "$system" /usr/bin/polhode
    enter "$system" /usr/bin/polhode doctor >"$work/log" || { cat "$work/log" >&2; exit 1; }
    echo "the package runs on a fresh $release"
  fi
  ! enter "$system" /bin/sh -c 'PATH=/usr/bin:/bin; command -v c++ || command -v cc || command -v python3' || { echo "$release has a compiler or Python" >&2; exit 1; }
  rm -rf "$system/models" "$system/out"
  tar xzf "$archive" -C "$system/opt"
  same_results "$system" "/$program"
  echo "the archive runs on a fresh $release"
  rm -rf "$system"
done
