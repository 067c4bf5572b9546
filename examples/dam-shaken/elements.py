"""The elastic dam by plane stress elements of OpenSees (SSPquad): prints its four lowest frequencies in Hz, without water and with the added mass of Westergaard."""
import math

import openseespy.opensees as ops

ROWS, COLUMNS, LEVEL = 104, 32, 91.75
HEIGHTS = [66.5 * j / 66 for j in range(67)] + [66.5 + 36.5 * j / (ROWS - 66) for j in range(1, ROWS - 65)]


def width(y):
    return 70 - 50.75 * y / 66.5 if y < 66.5 else 19.25 - 4.45 * (y - 66.5) / 36.5


def dam(water):
    node = lambda i, j: 1 + j * (COLUMNS + 1) + i
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    mass = [[0.0] * (COLUMNS + 1) for _ in HEIGHTS]
    for j, y in enumerate(HEIGHTS):
        for i in range(COLUMNS + 1):
            ops.node(node(i, j), width(y) * i / COLUMNS, y)
    for i in range(COLUMNS + 1):
        ops.fix(node(i, 0), 1, 1)
    ops.nDMaterial("ElasticIsotropic", 1, 31.027e6, 0.2)
    for j in range(ROWS):
        area = (HEIGHTS[j + 1] - HEIGHTS[j]) * (width(HEIGHTS[j]) + width(HEIGHTS[j + 1])) / 2 / COLUMNS
        for i in range(COLUMNS):
            corners = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
            ops.element("SSPquad", 1 + j * COLUMNS + i, *(node(*c) for c in corners), 1, "PlaneStress", 1.0)
            for a, b in corners:
                mass[b][a] += 2.643 * area / 4
    for j, y in enumerate(HEIGHTS):
        for i in range(COLUMNS + 1):
            share = (HEIGHTS[min(j + 1, ROWS)] - HEIGHTS[max(j - 1, 0)]) / 2
            added = 7 / 8 * math.sqrt(LEVEL * max(0, LEVEL - y)) * share if water and i == 0 else 0
            ops.mass(node(i, j), mass[j][i] + added, mass[j][i])
    return [math.sqrt(value) / (2 * math.pi) for value in ops.eigen(4)]


for water in (False, True):
    print(*dam(water))
