"""meshio and VTK's reader of XDMF open results.xdmf and find every time step, with the numbers that the histories hold."""

import csv
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersTensor import vtkTensorPrincipalInvariants
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

command, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2])

DECK = """
title: For meshio
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 1.5, Young modulus: 150 MPa, Poisson ratio: 0.25}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [12, 7, 4], first particle: [0, 0, 0]}}}}
loads:
  - {on: {face: x+, layers: 2}, body force: [3000, 700, 300], history: {ramp to: 0.002}}
solve: {explicit: {steps: 40, time step: 4e-5}}
watch:
  a: {displacement of: {nearest: [1.1, 0.3, 0.1]}, every: 1}
  b: {stress and strain of: {nearest: [0.5, 0.2, 0.2]}, every: 1}
results: {number: 4, precision: double, fields: [displacement, stress, octahedral shear stress]}
"""


def history(name):
    with open(work / "xdmf" / f"{name}.csv") as file:
        return {int(row["step"]): row for row in csv.DictReader(file)}


def stress_of(row):
    """xx yy zz xy yz xz: the order of VTK's symmetric tensors."""
    return [float(value) for key, value in row.items() if key.endswith("(kPa)")][:6]


def principal_by_vtk(cloud, point):
    """Principal stresses as VTK finds them in an array of six components, largest first."""
    invariants = vtkTensorPrincipalInvariants()
    invariants.SetInputData(cloud)
    invariants.GetPointDataArraySelection().EnableArray("stress")
    invariants.Update()
    data = invariants.GetOutputDataObject(0).GetPointData()
    return [data.GetArray(invariants.GetSigmaValueArrayName("stress", n)).GetValue(point) for n in (1, 2, 3)]


def check(step, time, points, fields, a, b):
    near = lambda x: int(((points - x) ** 2).sum(axis=1).argmin())
    i, j = near([1.1, 0.3, 0.1]), near([0.5, 0.2, 0.2])
    assert abs(time - 4e-5 * step) < 1e-12, (step, time)
    for c, axis in enumerate("xyz"):
        assert fields["displacement"][i, c] == float(a[step][f"{axis} (m)"]), (step, axis)
    assert list(fields["stress"][j]) == stress_of(b[step]), (step, fields["stress"][j])
    assert fields["octahedral shear stress"].shape == (336,)
    return j


def main():
    (work / "xdmf.yaml").write_text(DECK)
    subprocess.run([command, "run", "xdmf.yaml", "--quiet"], cwd=work, check=True)
    # A run that stops and goes on leaves the same views.
    subprocess.run([command, "run", "xdmf.yaml", "--quiet", "--steps", "20"], cwd=work, check=True)
    subprocess.run([command, "run", "xdmf.yaml", "--quiet", "--restart"], cwd=work, check=True)
    path = work / "xdmf" / "results.xdmf"
    a, b = history("a"), history("b")
    with meshio.xdmf.TimeSeriesReader(path) as reader:
        points, cells = reader.read_points_cells()
        assert points.shape == (336, 3) and cells[0].type == "vertex" and cells[0].data.shape == (336, 1), cells
        assert reader.num_steps == 5, reader.num_steps
        for k in range(5):
            time, fields, _ = reader.read_data(k)
            check(10 * k, time, points, fields, a, b)
        meshio.Mesh(points, cells, point_data=fields).write(work / "last.vtu")

    reader = vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert len(times) == 5, times
    for k, time in enumerate(times):
        reader.UpdateTimeStep(time)
        cloud = reader.GetOutputDataObject(0)
        data = cloud.GetPointData()
        fields = {data.GetArrayName(n): vtk_to_numpy(data.GetArray(n)) for n in range(data.GetNumberOfArrays())}
        j = check(10 * k, time, vtk_to_numpy(cloud.GetPoints().GetData()), fields, a, b)
        xx, yy, zz, xy, yz, xz = stress_of(b[10 * k])
        principal = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[::-1]
        found = principal_by_vtk(cloud, j)
        assert np.allclose(found, principal, atol=1e-6 * max(1e-6, abs(principal).max())), (k, found, principal)
    print("meshio and VTK read 5 steps of XDMF; tensors stand in VTK's order")


main()
