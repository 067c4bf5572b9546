"""The same column by plane strain elements of OpenSees (quad) with its PressureIndependMultiYield, pairs of nodes of one height tied: prints the shear strain and
shear stress in the middle of the column and the displacement of its top after each of the increments, for the side of an element in m."""
import sys
from math import sqrt

import openseespy.opensees as ops

SIDE, INCREMENTS, HEIGHT, WIDTH, STRENGTH = float(sys.argv[1]), int(sys.argv[2]), 10.0, 2.0, 30.0
TRACTION = 0.9 * sqrt(1.5) * STRENGTH
columns, rows = round(WIDTH / SIDE), round(HEIGHT / SIDE)
node = lambda i, j: 1 + j * (columns + 1) + i
ops.model("basic", "-ndm", 2, "-ndf", 2)
for j in range(rows + 1):
    for i in range(columns + 1):
        ops.node(node(i, j), i * SIDE, j * SIDE)
for i in range(columns + 1):
    ops.fix(node(i, 0), 1, 1)
for j in range(1, rows + 1):
    ops.equalDOF(node(0, j), node(columns, j), 1, 2)
# Its cohesion c is that of an octahedral strength of 2 sqrt(2) c / 3.
ops.nDMaterial("PressureIndependMultiYield", 1, 2, 1.5, 60e3, 100e3, 3 * STRENGTH / (2 * sqrt(2)), 0.1, 0.0, 100.0, 0.0, 20)
for j in range(rows):
    for i in range(columns):
        ops.element("quad", 1 + j * columns + i, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1), 1.0, "PlaneStrain", 1)
ops.updateMaterialStage("-material", 1, "-stage", 1)
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
for i in range(columns + 1):
    ops.load(node(i, rows), TRACTION * SIDE * (0.5 if i in (0, columns) else 1), 0.0)
ops.system("UmfPack")
ops.numberer("RCM")
ops.constraints("Transformation")
ops.test("NormDispIncr", 1e-11, 200)
ops.algorithm("Newton")
ops.integrator("LoadControl", 1 / INCREMENTS)
ops.analysis("Static")
middle = 1 + (rows // 2) * columns + columns // 2
for _ in range(INCREMENTS):
    assert ops.analyze(1) == 0
    stress, strain = (ops.eleResponse(middle, "material", "1", word) for word in ("stress", "strain"))
    print(strain[2], stress[3], ops.nodeDisp(node(0, rows), 1))  # xx, yy, zz, xy and xx, yy, xy
