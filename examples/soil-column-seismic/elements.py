"""The same column by elements of OpenSees (stdBrick), nodes of one height tied: writes a table of time, displacement and velocity of the top and acceleration of the ground, then
shear strain and shear stress in elements, by MOTION.AT2 LAW SIDE STEP DURATION HEIGHTS... LAW is elastic or multi-yield; all in m, kN, s."""
import sys
from math import pi, sqrt

import openseespy.opensees as ops

from motions import STEP, read

MOTION, LAW, SIDE, TIME, DURATION, *HEIGHTS = [sys.argv[1], sys.argv[2], *map(float, sys.argv[3:])]
HEIGHT, DENSITY, SHEAR, BULK, STRENGTH = 20.0, 1.5, 60e3, 100e3, 30.0
rows = round(HEIGHT / SIDE)
ops.model("basic", "-ndm", 3, "-ndf", 3)
node = lambda corner, j: 1 + 4 * j + corner
for j in range(rows + 1):
    for corner, (x, y) in enumerate(((0, 0), (SIDE, 0), (SIDE, SIDE), (0, SIDE))):
        ops.node(node(corner, j), x, y, j * SIDE)
        if j == 0:
            ops.fix(node(corner, 0), 1, 1, 1)
    for corner in range(1, 4) if j else ():
        ops.equalDOF(node(0, j), node(corner, j), 1, 2, 3)
if LAW == "elastic":
    ops.nDMaterial("ElasticIsotropic", 1, 9 * BULK * SHEAR / (3 * BULK + SHEAR), (3 * BULK - 2 * SHEAR) / (2 * (3 * BULK + SHEAR)), DENSITY)
else:  # its cohesion c is that of an octahedral strength of 2 sqrt(2) c / 3
    ops.nDMaterial("PressureIndependMultiYield", 1, 3, DENSITY, SHEAR, BULK, 3 * STRENGTH / (2 * sqrt(2)), 0.1, 0.0, 100.0, 0.0, 20)
for j in range(rows):
    ops.element("stdBrick", 1 + j, *(node(corner, j + up) for up in (0, 1) for corner in range(4)), 1)
if LAW != "elastic":
    ops.updateMaterialStage("-material", 1, "-stage", 1)
low, high = 2 * pi * 2.5, 2 * pi * 12.5
ops.rayleigh(0.02 * 2 * low * high / (low + high), 0.0, 0.02 * 2 / (low + high), 0.0)
ground = read(MOTION)
ops.timeSeries("Path", 1, "-dt", STEP, "-values", *ground, "-factor", 9.81)
ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
ops.constraints("Transformation")
ops.numberer("RCM")
ops.system("UmfPack")
ops.test("NormDispIncr", 1e-8, 500)
ops.algorithm("ModifiedNewton", "-initial")
ops.integrator("Newmark", 0.5, 0.25)
ops.analysis("Transient")


def mean(element, word, component=5):
    """Over the points of an element; zx is the last component."""
    return sum(ops.eleResponse(element, "material", str(k), word)[component] for k in range(1, 9)) / 8


watched = [1 + int(h / SIDE) for h in HEIGHTS]
at = lambda t: 9.81 * ground[min(round(t / STEP), len(ground) - 1)]
for n in range(round(DURATION / TIME) + 1):
    if n and ops.analyze(1, TIME):
        sys.exit(f"no equilibrium at {ops.getTime()}")
    if n % max(1, round(STEP / TIME)) == 0:
        print(n * TIME, ops.nodeDisp(node(0, rows), 1), ops.nodeVel(node(0, rows), 1), at(n * TIME), *(mean(e, word) for e in watched for word in ("strain", "stress")))
