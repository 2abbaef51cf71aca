#!/usr/bin/env bash
# Builds the files of a release from a clean clone of this commit and checks them: the source, the archive for any Linux, the Debian
# packages, a wheel for each Python that is found, and SHA256SUMS, in build/release-files. It makes no tag and uploads nothing.
#
#   scripts/release.sh                       every stage: clone check test packages wheels root sums
#   scripts/release.sh packages sums         these stages; those before them have run
#   PYTHONS="python3.11" scripts/release.sh wheels      these Pythons, instead of those from 3.9 to 3.13 that are found
#   ROOTS="bookworm trixie" scripts/release.sh root     Debian releases whose fresh systems run the files; ROOTS= none (the archive
#                                            still runs in a root with nothing but the C library)
#
# clone     a clone of this commit without anything else; refused where tracked files have changes
# check     one version everywhere, a changelog with its date, no notes left in changes/, no tag of that version, formats, documents
# test      scripts/test.sh there
# packages  scripts/package.sh there, and the source as one archive, which holds the files of the commit and no others
# wheels    scripts/build_wheel.sh and scripts/test_wheel.sh there for each Python
# root      scripts/test_package.sh there: systems without a compiler
# sums      checksums, and the list of files that must be there
set -euo pipefail
cd "$(dirname "$0")/.."

here=$PWD clone=$PWD/build/release-clone files=$PWD/build/release-files
export CCACHE_NOHASHDIR=1
say() { printf '\n== %s (%s min)\n' "$1" "$((SECONDS / 60))"; }
fail() { echo "scripts/release.sh: $1" >&2; exit 1; }
version() { sed -nE 's/^project\(polhode VERSION ([0-9.]+) .*/\1/p' "$clone/CMakeLists.txt"; }

make_clone() {
  [ -z "$(git status --porcelain --untracked-files=no)" ] || fail "tracked files have changes. Commit them first."
  rm -rf "$clone" "$files"
  git clone -q "$here" "$clone"
  git -C "$clone" checkout -q --detach "$(git rev-parse HEAD)"
  mkdir -p "$files"
  echo "commit $(git -C "$clone" rev-parse HEAD), version $(version)"
}

check() {
  local notes
  grep -qE "^## ${1//./\\.} \([0-9]{4}-[0-9]{2}-[0-9]{2}\)\$" "$clone/CHANGELOG.md" || fail "CHANGELOG.md has no section '## $1 (date)'. Write it from changes/."
  notes=$(git -C "$clone" ls-files changes | grep -cv '^changes/README\.md$' || true)
  [ "$notes" = 0 ] || fail "changes/ has $notes notes that are not in CHANGELOG.md. Add them there and remove them."
  ! git -C "$clone" rev-parse -q --verify "refs/tags/v$1" >/dev/null || fail "the tag v$1 is there already. Choose the next version in CMakeLists.txt."
  (cd "$clone" && bash scripts/format.sh --check && python3 tools/check_docs.py && python3 tools/check_equations.py)
}

packages() {
  (cd "$clone" && bash scripts/package.sh)
  cp "$clone"/dist/*.deb "$clone"/dist/polhode-*-Linux-*.tar.gz "$files"
  # Without names and times of this machine: the same commit gives the same bytes.
  git -C "$clone" archive --format=tar --prefix="polhode-$1/" HEAD | gzip -n -9 >"$files/polhode-$1.tar.gz"
  diff <(tar tzf "$files/polhode-$1.tar.gz" | sed "s|^polhode-$1/||" | grep -v '/$' | grep . | LC_ALL=C sort) \
    <(git -C "$clone" -c core.quotePath=off ls-files | LC_ALL=C sort) || fail "polhode-$1.tar.gz has other files than the commit"
}

found_pythons() {
  local minor candidate
  for minor in 9 10 11 12 13; do
    for candidate in "python3.$minor" "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor".*/bin/python; do
      "$candidate" -c "import venv, sys; assert sys.version_info[:2] == (3, $minor)" 2>/dev/null && { echo "$candidate"; break; }
    done
  done
}

wheels() {
  local python tag
  for python in ${PYTHONS:-$(found_pythons)}; do
    tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
    say "wheel of $tag"
    (cd "$clone" && export PYTHON=$python ENVIRONMENT=$clone/build/wheel-environment-$tag BUILD_FOLDER=build/wheel-$tag &&
      bash scripts/build_wheel.sh && bash scripts/test_wheel.sh)
    rm -f "$files"/polhode-"$1"-"$tag"-*.whl
    mv "$clone"/dist/polhode-"$1"-"$tag"-*.whl "$files"
  done
}

sums() {
  local name wanted
  for wanted in "polhode-$1.tar.gz" "polhode-$1-Linux-*.tar.gz" "polhode_$1_*.deb" "libpolhode-dev_$1_*.deb" "polhode-$1-cp*.whl"; do
    compgen -G "$files/$wanted" >/dev/null || fail "$wanted is missing in $files. Run its stage."
  done
  for name in "$files"/*; do
    case "$(basename "$name")" in SHA256SUMS | *[-_]"$1"[-_.]*) ;; *) fail "$(basename "$name") is no file of version $1. Remove it." ;; esac
  done
  (cd "$files" && rm -f SHA256SUMS && sha256sum -- * >SHA256SUMS.new && mv SHA256SUMS.new SHA256SUMS && sha256sum --check --quiet SHA256SUMS)
  cat "$files/SHA256SUMS"
  echo "Ready: git tag -a v$1 $(git -C "$clone" rev-parse --short HEAD) -m 'Polhode $1'"
}

stages=("$@")
[ $# -gt 0 ] || stages=(clone check test packages wheels root sums)
for stage in "${stages[@]}"; do
  case "$stage" in clone | check | test | packages | wheels | root | sums) ;; *) fail "'$stage' is no stage; there are clone, check, test, packages, wheels, root, sums" ;; esac
done
for stage in "${stages[@]}"; do
  say "$stage"
  [ "$stage" = clone ] || [ -d "$clone" ] || fail "there is no clone. Begin with the stage clone."
  case "$stage" in
    clone) make_clone ;;
    check) check "$(version)" ;;
    test) (cd "$clone" && bash scripts/test.sh </dev/null) ;;
    packages) packages "$(version)" ;;
    wheels) wheels "$(version)" ;;
    root) (cd "$clone" && bash scripts/test_package.sh ${ROOTS-bookworm trixie}) ;;
    sums) sums "$(version)" ;;
  esac
done
