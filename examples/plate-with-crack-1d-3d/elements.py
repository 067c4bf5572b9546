"""The elastic plate at rest by plane stress elements of OpenSees (SSPquad): prints the opening of the crack at its mouth and in its middle, in m, for sides
of elements in mm; first with Young's modulus and Poisson's ratio of the plate, then with the moduli of a plate of uniaxial bonds, E_x, nu_xy and G_xy, which
stand first among the words."""
import sys

import openseespy.opensees as ops

LENGTH, HEIGHT, THICKNESS, EDGE = 2.1, 1.92, 0.06, -0.015  # m; the lower left corner is at (EDGE, EDGE)
FROM, TO, TIP = 1.035, 1.065, 0.735  # the crack
FORCE, LOADED = 500, 0.09  # kN/m3 on so much of each end


def plate(side, moduli):
    d = side / 1000
    columns, rows = round(LENGTH / d), round(HEIGHT / d)
    node = lambda i, j: 1 + i * (rows + 1) + j
    middle = lambda k: EDGE + (k + 0.5) * d
    elements = [(i, j) for i in range(columns) for j in range(rows) if not (FROM < middle(i) < TO and middle(j) < TIP)]
    corners = lambda i, j: [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    for n in sorted({n for e in elements for n in corners(*e)}):
        i, j = divmod(n - 1, rows + 1)
        ops.node(n, EDGE + i * d, EDGE + j * d)
    young, ratio, shear = moduli
    if shear:
        ops.nDMaterial("ElasticOrthotropic", 1, young, young, young, ratio, ratio, ratio, shear, shear, shear)
    else:
        ops.nDMaterial("ElasticIsotropic", 1, young, ratio)
    for e, (i, j) in enumerate(elements):
        ops.element("SSPquad", 1 + e, *corners(i, j), 1, "PlaneStress", THICKNESS)
    ops.fix(node(0, rows), 1, 1)
    ops.fix(node(columns, rows), 0, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for i, j in elements:
        x = middle(i) - EDGE
        if x < LOADED or x > LENGTH - LOADED:
            for n in corners(i, j):
                ops.load(n, (1 if x > LOADED else -1) * FORCE * d * d * THICKNESS / 4, 0.0)
    ops.system("UmfPack")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.integrator("LoadControl", 1.0)
    ops.algorithm("Linear")
    ops.analysis("Static")
    assert ops.analyze(1) == 0

    def displacement(x, y):
        """Along x: bilinear between the nodes around a point."""
        i, j = (round((c - EDGE) / d * 2) // 2 for c in (x, y))
        a, b = ((c - EDGE) / d - k for c, k in ((x, i), (y, j)))
        return sum(w * ops.nodeDisp(node(i + p, j + q), 1) for p, q, w in
                   ((0, 0, (1 - a) * (1 - b)), (1, 0, a * (1 - b)), (0, 1, (1 - a) * b), (1, 1, a * b)) if w > 1e-9)

    return [displacement(1.08, y) - displacement(1.02, y) for y in (0, 0.36)]


bonds = [float(word) for word in sys.argv[1:4]]
for moduli in ((150e3, 0.25, None), bonds):
    for word in sys.argv[4:]:
        print(*plate(float(word), moduli))
