"""VTK's own reader opens our result files, finds every time step, and the same numbers as the histories hold."""

import csv
import subprocess
import sys
from pathlib import Path

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

command, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2])

DECK = """
title: For VTK
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 1.5, Young modulus: 150 MPa, Poisson ratio: 0.25}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [20, 7, 4], first particle: [0, 0, 0]}}}}
cracks: [{cut: {line: [[1, -1], [1, 0.2]]}}]
failure: {critical stretch: 0.004}
loads: [{on: {face: x+, layers: 2}, body force: [3000, 0, 0], history: {ramp to: 0.002}}]
solve: {explicit: {steps: 200, time step: 4e-5}}
watch:
  a: {displacement of: {nearest: [1.9, 0.3, 0.1]}, every: 1}
  b: {stress and strain of: {nearest: [0.5, 0.2, 0.2]}, every: 1}
results: {number: 8, precision: double, fields: [displacement, stress, damage]}
"""


def history(name):
    with open(work / "deck" / f"{name}.csv") as file:
        return {int(row["step"]): row for row in csv.DictReader(file)}


def main():
    (work / "deck.yaml").write_text(DECK)
    subprocess.run([command, "run", "deck.yaml", "--quiet"], cwd=work, check=True)
    reader = vtkHDFReader()
    reader.SetFileName(str(work / "deck" / "results.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 9, reader.GetNumberOfSteps()
    a, b = history("a"), history("b")
    checked = 0
    for k in range(9):
        reader.SetStep(k)
        reader.Update()
        cloud = reader.GetOutput()
        assert cloud.GetNumberOfPoints() == 560 and cloud.GetNumberOfVerts() == 560, cloud
        points = vtk_to_numpy(cloud.GetPoints().GetData())
        fields = {n: vtk_to_numpy(cloud.GetPointData().GetArray(n)) for n in ("displacement", "stress", "damage")}
        step, time = 25 * k, reader.GetTimeValue()
        assert abs(time - 4e-5 * step) < 1e-12, (step, time)
        near = lambda x: int(((points - x) ** 2).sum(axis=1).argmin())
        i, j = near([1.9, 0.3, 0.1]), near([0.5, 0.2, 0.2])
        for c, axis in enumerate("xyz"):
            assert fields["displacement"][i, c] == float(a[step][f"{axis} (m)"]), (step, axis)
        for c, name in enumerate(["stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress zx"]):
            assert fields["stress"][j, c] == float(b[step][f"{name} (kPa)"]), (step, name)
        checked += 9
    assert fields["damage"].max() > 0
    print(f"VTK reads 9 steps; {checked} numbers are those of the histories")


main()
