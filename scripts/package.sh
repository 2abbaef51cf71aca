#!/usr/bin/env bash
# Builds the packages of a release into dist/: polhode and libpolhode-dev for this Debian (.deb), and an archive that
# runs from any folder of any Linux with this or a newer C library (.tar.gz), with all other libraries inside.
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/packages.sh build
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
build=build/package
make() {
  cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DPOLHODE_BUILD_TESTS=OFF \
    -DPOLHODE_RELOCATABLE="$2" >/dev/null
  cmake --build $build >/dev/null
  rm -rf $build/out
  cpack --config $build/CPackConfig.cmake -G "$1" -B $build/out >$build/cpack.log 2>&1 || { cat $build/cpack.log >&2; exit 1; }
  cp $build/out/*."$3" dist/
}
mkdir -p dist
rm -f dist/*.deb dist/polhode-*-Linux-*.tar.gz
make DEB OFF deb
make TGZ ON tar.gz
du -h dist/*.deb dist/*.tar.gz
