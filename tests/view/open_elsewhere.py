#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the files of `polhode convert` with VTK and pyarrow and compares their numbers with results.h5.

POLHODE=path/to/polhode is the program. VTK, pyarrow and h5py are those of this Python or are installed into a
virtual environment under build/. Exit code 77, skipped, if they cannot be installed.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from python_packages import need  # noqa: E402

need("vtk", "pyarrow", "h5py", "numpy")

import h5py  # noqa: E402
import numpy as np  # noqa: E402
import pyarrow.parquet  # noqa: E402
import vtk  # noqa: E402
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

MODEL = """format: 1
title: Everything with points
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {box: [4, 4, 0.1]}, position: [0, 0, -2]}
  stick: {shape: {box: [1, 0.1, 0.2]}, density: 1000, position: [0.5, 0, 0], angular_velocity: [1, 2, 3]}
materials:
  rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 8000}
sections:
  rod: {type: circle, diameter: 20 mm, material: steel}
solids:
  block_a: {mesh: {block: {size: [1, 1, 1], cells: [2, 1, 1]}, position: [0, 3, 0]}, element: hex20, material: rubber, velocity: [1, 0, 0]}
  wedge: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}, position: [5, 3, 0]}, element: wedge6, material: rubber}
beams:
  mast: {points: [[-1, 0, 0], [-1, 0, 1]], elements: 4, section: rod, up: y, bonded: {ground: start}}
cables:
  stay: {through: [[ground, [-2, 0, 0]], [mast, end]], stiffness: 10 kN}
analysis: {duration: 10 ms, step: 1 ms, rho_inf: 0.8}
output: {every: 2 ms}
"""


def turned(q, p):
    """p rotated by the quaternion w, x, y, z."""
    w, u = q[0], q[1:]
    return p + 2 * np.cross(u, np.cross(u, p) + w * p)


def enclosed(grid):
    """Volume within the faces that VTK finds, by the divergence theorem: negative if they face inward."""
    surface, triangles = vtk.vtkDataSetSurfaceFilter(), vtk.vtkTriangleFilter()
    surface.SetInputData(grid)
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    found = triangles.GetOutput()
    points = vtk_to_numpy(found.GetPoints().GetData()).astype(float)
    a, b, c = (points[vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3)[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def vtkhdf(results):
    reader = vtk.vtkHDFReader()
    reader.SetFileName("out.vtkhdf")
    reader.UpdateInformation()
    time = results["time"][:]
    assert reader.GetNumberOfSteps() == len(time) == 6
    for frame in range(len(time)):
        reader.SetStep(frame)
        reader.Update()
        data = reader.GetOutput()
        blocks = {data.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()): data.GetPartition(i, 0) for i in range(data.GetNumberOfPartitionedDataSets())}
        assert list(blocks) == ["floor", "stick", "block_a", "wedge", "mast", "stay"], list(blocks)

        def field(block, of, name):
            return vtk_to_numpy(getattr(blocks[block], f"Get{of}Data")().GetArray(name))

        for name in ("block_a", "wedge"):
            stored, block = results[f"solids/{name}"], blocks[name]
            points = vtk_to_numpy(block.GetPoints().GetData())
            assert abs(points - stored["nodes/reference"][:] - stored["nodes/displacement"][frame]).max() < 1e-12
            for part, of in (("nodes", "Point"), ("elements", "Cell")):
                for quantity in stored[part]:
                    if quantity not in ("reference", "connectivity", "offsets", "vtk_type"):
                        assert (field(name, of, quantity) == stored[f"{part}/{quantity}"][frame]).all(), quantity
            assert abs(enclosed(block) - 1) < 1e-3, enclosed(block)  # cells are not inverted
        assert blocks["block_a"].GetCellType(0) == vtk.VTK_QUADRATIC_HEXAHEDRON and blocks["wedge"].GetCellType(0) == vtk.VTK_WEDGE
        mast = results["beams/mast/nodes/position"][frame]
        assert (vtk_to_numpy(blocks["mast"].GetPoints().GetData()) == mast).all() and blocks["mast"].GetNumberOfCells() == 4
        assert (field("stay", "Cell", "tension") == results["cables/stay/tension"][frame]).all()

        assert set(field("stick", "Cell", "body")) == {list(results["packed/bodies/names"].asstr()[:]).index("stick")}
        points = vtk_to_numpy(blocks["stick"].GetPoints().GetData())
        r, q = (results[f"bodies/stick/{k}"][frame] for k in ("position", "orientation"))
        back = np.array([turned(q * [1, -1, -1, -1], p - r) for p in points])
        assert abs(abs(back) - [0.5, 0.05, 0.1]).max() < 1e-9, back
        v, w = (results[f"bodies/stick/{k}"][frame] for k in ("velocity", "angular_velocity"))
        assert abs(field("stick", "Point", "velocity") - v - np.cross(w, points - r)).max() < 1e-12
    return len(blocks)


def parquet(polhode, results):
    table = pyarrow.parquet.read_table("out.parquet")
    assert (table["t"].to_numpy() == results["time"][:]).all()
    assert (table["bodies.stick.position.z"].to_numpy() == results["bodies/stick/position"][:, 2]).all()
    assert table.schema.field("bodies.stick.velocity.x").metadata == {b"unit": b"m/s"}
    assert table.schema.metadata[b"title"] == b"Everything with points"
    subprocess.run([polhode, "convert", "m.results", "part.parquet", "--channels", "energy.kinetic"], check=True)
    assert pyarrow.parquet.read_table("part.parquet").column_names == ["t", "energy.kinetic"]
    bare = pathlib.Path("bare")  # a Python without pyarrow
    venv.create(bare)
    told = subprocess.run([polhode, "convert", "m.results", "x.parquet"], capture_output=True, text=True, env={**os.environ, "POLHODE_PYTHON": str(bare / "bin/python")})
    assert told.returncode == 3 and "pip install pyarrow" in told.stderr and not pathlib.Path("x.parquet").exists(), told
    return len(table.column_names)


def main():
    polhode = os.environ["POLHODE"]
    os.environ["POLHODE_PYTHON"] = sys.executable
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("m.yaml").write_text(MODEL)
        subprocess.run([polhode, "run", "m.yaml", "--quiet"], check=True)
        for name in ("out.vtkhdf", "out.parquet"):
            subprocess.run([polhode, "convert", "m.results", name], check=True)
        with h5py.File("m.results/results.h5") as results:
            blocks, columns = vtkhdf(results), parquet(polhode, results)
        os.chdir(ROOT)
    print(f"VTK {vtk.vtkVersion().GetVTKVersion()} reads {blocks} blocks, pyarrow {pyarrow.__version__} {columns} columns.")


main()
