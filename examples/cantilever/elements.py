"""The same beam by plane stress elements of OpenSees (SSPquad), held at all nodes of the wall: prints the deflection of its end and the stress
xx in the middle of the beam, a quarter of its height below its top, for sides of elements in mm."""
import sys

import openseespy.opensees as ops


def beam(side):
    d = side / 1000
    columns, rows = round(2 / d), round(0.4 / d)
    node = lambda i, j: 1 + i * (rows + 1) + j
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    for i in range(columns + 1):
        for j in range(rows + 1):
            ops.node(node(i, j), i * d, j * d)
    for j in range(rows + 1):
        ops.fix(node(0, j), 1, 1)
    ops.nDMaterial("ElasticIsotropic", 1, 30e6, 0.2)
    for i in range(columns):
        for j in range(rows):
            ops.element("SSPquad", 1 + i * rows + j, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1), 1, "PlaneStress", 0.1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for j in range(rows + 1):
        ops.load(node(columns, j), 0.0, -100 / rows * (0.5 if j in (0, rows) else 1))
    ops.system("UmfPack")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.integrator("LoadControl", 1.0)
    ops.algorithm("Linear")
    ops.analysis("Static")
    assert ops.analyze(1) == 0
    around = [1 + i * rows + j for i in (columns // 2 - 1, columns // 2) for j in (rows * 3 // 4 - 1, rows * 3 // 4)]
    stress = sum(ops.eleResponse(e, "stress")[0] for e in around) / 4
    end = [ops.nodeDisp(node(columns, j), 2) for j in range(rows + 1)]
    return (sum(end) - (end[0] + end[-1]) / 2) / rows, stress


for word in sys.argv[1:]:
    print(*beam(float(word)))
