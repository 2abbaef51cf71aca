#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures of deformable solids open in meshio, with the numbers that results.h5 holds.

POLHODE=path/to/polhode says which program runs. meshio and h5py are those of this Python or are installed into a
virtual environment under build/. Exit code 77, skipped, if they cannot be installed.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from python_packages import need  # noqa: E402

need("meshio", "h5py")

import h5py  # noqa: E402
import meshio  # noqa: E402

MODEL = """format: 1
materials:
  rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}
solids:
  left: {mesh: {block: {size: [1, 1, 1], cells: [2, 1, 1]}}, element: hex8, material: rubber, velocity: [1, 0, 0]}
  right-2: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}, position: [5, 0, 0]}, element: wedge6, material: rubber}
analysis: {duration: 10 ms, step: 1 ms}
output: {paraview: true}
"""


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "two.yaml").write_text(MODEL)
        subprocess.run([os.environ["POLHODE"], "run", "two.yaml", "--quiet"], cwd=folder, check=True)
        files = sorted((folder / "two.results/paraview/solids").glob("*.vtu"))
        assert len(files) == 11, files
        results = h5py.File(folder / "two.results/results.h5")
        for frame, file in enumerate(files):
            mesh = meshio.read(file)
            assert {block.type: len(block.data) for block in mesh.cells} == {"hexahedron": 2, "wedge": 2}, mesh.cells
            assert {name: int(value.ravel()[0]) for name, value in mesh.field_data.items()} == {"solid left": 0, "solid right-2": 1}
            where = results["solids/left/nodes/reference"][:] + results["solids/left/nodes/displacement"][frame]
            assert abs(mesh.points[:len(where)] - where).max() < 1e-6
            moved = mesh.point_data["displacement"][:len(where), 0]
            assert abs(moved - 1e-3 * frame).max() < 1e-6, moved
            owners = [int(i) for block in mesh.cell_data["solid"] for i in block.ravel()]
            assert owners == [0, 0, 1, 1], owners
    print(f"{len(files)} pictures open in meshio {meshio.__version__}.")


main()
