#!/usr/bin/env bash
# From a fresh clone to a first result: installs what is missing, builds, runs a mechanism.
#
#   scripts/quickstart.sh            the N-four-bar mechanism of the IFToMM benchmark library:
#                                    40 cells, 81 bodies, 10 s in steps of 10 ms
#   scripts/quickstart.sh MODEL ...  any model, with the options of `polhode run`
set -euo pipefail
cd "$(dirname "$0")/.."

purposes=(build)
if [ -z "${CXX:-}" ]; then
  # Clang compiles the library in less than half of GCC's time. CXX names another compiler.
  purposes+=(quickstart)
  export CC=clang CXX=clang++
fi
bash scripts/packages.sh "${purposes[@]}"
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
cmake -S . -B build/quickstart -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_BUILD_TESTS=OFF >/dev/null
cmake --build build/quickstart --target polhode_cli
polhode=build/quickstart/apps/polhode/polhode

if [ $# -gt 0 ]; then
  exec "$polhode" run "$@"
fi
mkdir -p build/first_run
"$polhode" examples n_four_bar --set N=40 -o build/first_run/n_four_bar.yaml
"$polhode" run build/first_run/n_four_bar.yaml --set output.every="20 ms" --set output.paraview=true --view

cat <<END

Where to look:
  build/first_run/n_four_bar.results/view.html            moving pictures and plots: open it with a browser
  build/first_run/n_four_bar.yaml                         the model
  build/first_run/n_four_bar.results/results.h5           motion, reactions, energies (HDF5)
  build/first_run/n_four_bar.results/paraview/results.pvd moving shapes, for ParaView
Next:
  $polhode examples          what else there is
  $polhode run --help        options of a run
  docs/tour.md               a tour of five minutes
END
