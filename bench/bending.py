#!/usr/bin/env python3
"""Measures the bending strength of plain beams over that of a cohesive crack with the same tensile strength, fracture
energy and softening curve, by depth and number of particle rows. Writes the table between the marks `bending strength`
of PAGE. source/domain/bending_strength.c has a copy of the table, which must follow.

  bending.py BRECCIA PAGE          all rows of CASES
  bending.py BRECCIA PAGE WORDS    the rows that contain these words; printed and not written

A beam on two supports at a distance of three depths carries a force in its middle; the opening of the middle of its
lower face is controlled (E 30 GPa, f_t 3 MPa, G_F 100 N/m, plane stress). The reference (cohesive_strength) is
independent of peridynamics: half of the beam as four-node elements, condensed to the nodes of its middle section, on
which a fictitious crack grows node by node (Hillerborg 1976; Petersson 1981). Its strength is exact to 1 % with 40
elements over the depth."""
import csv
import json
import math
import subprocess
import sys
import tempfile

from pages import write

YOUNG, STRENGTH, ENERGY, POISSON = 30e9, 3e6, 100.0, 0.2
SPAN, OVERHANG, THICKNESS, DEPTHS, ROWS, ELEMENTS = 3.0, 0.25, 0.1, (0.1, 0.2, 0.4), (10, 20), 40
LENGTH = YOUNG * ENERGY / STRENGTH**2  # E G_F / f_t^2


# ---- softening curves: stress over f_t and its slope at v = opening f_t / G_F ----

def exponential(v, decay=25.0, tail=0.25):
    """Curve of the law exponential-softening with its default parameters."""
    whole = -math.expm1(-decay)
    area = (tail / 2 + 1 - 1 / whole + 1 / decay) / (1 + tail)
    x = v * area
    if x >= 1:
        return 0.0, 0.0
    fall = math.exp(-decay * x)
    return (1 - (1 - fall) / whole + tail * (1 - x)) / (1 + tail), -(decay * fall / whole + tail) / (1 + tail) * area


def linear(v):
    return (1 - v / 2, -0.5) if v < 2 else (0.0, 0.0)


def petersson(v):
    x = v * 5 / 18
    if x < 2 / 9:
        return 1 - 3 * x, -5 / 6
    return (3 / 7 * (1 - x), -3 / 7 * 5 / 18) if x < 1 else (0.0, 0.0)


def decaying(v):
    return math.exp(-v), -math.exp(-v)


# ---- cohesive crack ----

def element(poisson):
    """Returns the stiffness of a square element of E = 1 and thickness 1 in plane stress, by 2 x 2 points."""
    c, g = 1 / (1 - poisson**2), 1 / math.sqrt(3)
    law = [[c, c * poisson, 0], [c * poisson, c, 0], [0, 0, c * (1 - poisson) / 2]]
    stiffness = [[0.0] * 8 for _ in range(8)]
    for a in (-g, g):
        for b in (-g, g):
            slopes = [(-(1 - b) / 2, -(1 - a) / 2), ((1 - b) / 2, -(1 + a) / 2), ((1 + b) / 2, (1 + a) / 2), (-(1 + b) / 2, (1 - a) / 2)]
            strain = [[s for x, _ in slopes for s in (x, 0.0)], [s for _, y in slopes for s in (0.0, y)], [s for x, y in slopes for s in (y, x)]]
            for i in range(8):
                for j in range(8):
                    stiffness[i][j] += sum(strain[p][i] * law[p][q] * strain[q][j] for p in range(3) for q in range(3)) / 4
    return stiffness


def condensed(n, poisson):
    """Returns the stiffness of the horizontal displacements of the middle section, positive where the crack opens by
    twice their size, and the forces there of a unit force on the whole beam: half of the beam as elements of side 1/n,
    all other displacements eliminated."""
    columns, nodes, support = round(n * (OVERHANG + SPAN / 2)), n + 1, round(n * OVERHANG)
    size, band = 2 * nodes * (columns + 1), 4 * nodes + 2

    def number(i, j, k):  # horizontal displacements of the middle section come last
        return 2 * (i * nodes + j) + k if i < columns else 2 * columns * nodes + (j if k else nodes + j)

    rows, force, local = [[0.0] * min(band, size - i) for i in range(size)], [0.0] * size, element(poisson)
    for i in range(columns):
        for j in range(n):
            ends = [number(*p, k) for p in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)) for k in (0, 1)]
            for a in range(8):
                for b in range(8):
                    if ends[b] >= ends[a]:
                        rows[ends[a]][ends[b] - ends[a]] += local[a][b]
    rows[number(support, 0, 1)][0] += 1e9
    force[number(columns, n, 1)] = -0.5
    for i in range(size - nodes):
        pivot = rows[i]
        for o in range(1, len(pivot)):
            if pivot[o]:
                q, row = pivot[o] / pivot[0], rows[i + o]
                for t in range(len(pivot) - o):
                    row[t] -= q * pivot[o + t]
                force[i + o] -= q * force[i]
    first = size - nodes
    stiffness = [[rows[first + min(a, b)][abs(a - b)] for b in range(nodes)] for a in range(nodes)]
    return stiffness, [-f for f in force[first:]]


def solved(matrix, right):
    n, m = len(right), [row[:] + [r] for row, r in zip(matrix, right)]
    for c in range(n):
        p = max(range(c, n), key=lambda r: abs(m[r][c]))
        m[c], m[p] = m[p], m[c]
        for r in range(c + 1, n):
            q = m[r][c] / m[c][c]
            for t in range(c, n + 1):
                m[r][t] -= q * m[c][t]
    x = [0.0] * n
    for c in reversed(range(n)):
        x[c] = (m[c][n] - sum(m[c][t] * x[t] for t in range(c + 1, n))) / m[c][c]
    return x


def cohesive_strength(depth, curve, beam):
    """Returns the largest 1.5 P S / (t h^2) over f_t. The node ahead of k open nodes has the stress f_t; lengths in
    depths, stresses in f_t."""
    stiffness, per_force = beam
    n, most, x = len(per_force) - 1, 0.0, []
    area = [1 / n * (0.5 if j in (0, n) else 1) for j in range(n + 1)]
    for k in range(n - 1):
        x = x[:-1] + [0.0] * min(k, 1) + (x[-1:] or [1.0])
        for _ in range(60):
            matrix, right = [], []
            for i in range(k + 1):
                row = stiffness[i][:k] + [per_force[i]]
                stress, slope = curve(max(0.0, 2 * x[i] * depth / LENGTH)) if i < k else (1.0, 0.0)
                right.append(-sum(a * b for a, b in zip(row, x)) - area[i] * stress)
                if i < k:
                    row[i] += area[i] * slope * 2 * depth / LENGTH
                matrix.append(row)
            change = solved(matrix, right)
            x = [a + b for a, b in zip(x, change)]
            if max(map(abs, change)) < 1e-9 * max(map(abs, x)):
                break
        else:
            break
        most = max(most, 1.5 * SPAN * abs(x[-1]))
        if 1.5 * SPAN * abs(x[-1]) < 0.8 * most:
            break
    return most


# ---- beams of particles ----

BOND = {"tensile strength": STRENGTH, "fracture energy": ENERGY}
# formulation, law, lattice, horizon in spacings, parameters of the material, keys of peridynamics, curve
CASES = [
    ("bond-based", "exponential-softening", "square", 3.015, BOND, {"surface correction": "energy"}, exponential),
    ("bond-based", "bilinear-softening", "square", 3.015, BOND, {"surface correction": "energy"}, linear),
    ("bond-based", "trilinear-softening", "square", 3.015, BOND, {"surface correction": "energy"}, petersson),
    ("hybrid", "mazars", "square", 2.015, {**BOND, "Poisson ratio": POISSON}, {}, decaying),
    ("micropolar", "link-damage", "hexagonal", 1.5,
     {"tensile stretch": STRENGTH / YOUNG, "fracture energy": ENERGY, "Poisson ratio": POISSON}, {}, linear),
]


def deck(case, depth, rows):
    """Returns a deck with its span: supports are the particles nearest to both ends of it."""
    formulation, law, lattice, horizon, material, keys, _ = case
    spacing = depth / rows
    half = round(SPAN * rows / 2)
    span, end = (2 * half - 1) * spacing, (half + round(OVERHANG * rows)) * spacing
    gauge = [[side * 2.5 * spacing, spacing / 2] for side in (-1, 1)]
    return span, {
        "units": {"length": "m", "force": "N", "time": "s"},
        "materials": {"m": {"model": law, "density": 2400, "Young modulus": YOUNG, **material}},
        "body": {"b": {"material": "m", "lattice": lattice, "spacing": spacing, "thickness": THICKNESS,
                       "shape": {"box": {"from": [-end, 0], "to": [end, depth]}}}},
        "peridynamics": {"formulation": formulation, "space": "plane stress", "horizon": f"{horizon} spacings", **keys},
        "loads": [{"on": {"nearest": [-span / 2, 0]}, "displacement": [0, 0]},
                  {"on": {"nearest": [span / 2, 0]}, "displacement": ["free", 0]},
                  {"name": "jack", "on": {"inside": {"box": {"from": [-1.01 * spacing, depth - spacing], "to": [1.01 * spacing, depth]}}},
                   "force": [0, -1000], "history": {"controlled": True}}],
        "solve": {"static": {"increments": 20, "control": {"opening between": gauge, "to": 5e-5}}},
        "watch": {"jack": {"load": "jack", "every": 1}},
        "results": {"number": 0}, "pictures": [],
    }


def measured(program, case, depth, rows):
    """Returns 1.5 P S / (t h^2) over f_t of the largest force; NaN where a run gives none."""
    span, made = deck(case, depth, rows)
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/beam.yaml", "w") as file:
            json.dump(made, file)
        done = subprocess.run([program, "run", f"{folder}/beam.yaml", "--quiet", "--threads", "1", "--output", f"{folder}/run"],
                              capture_output=True, text=True)
        if done.returncode:
            print(case[:2], depth, rows, done.stderr.strip()[:300], file=sys.stderr)
        try:
            with open(f"{folder}/run/jack.csv") as file:
                force = max(abs(float(row[-1])) for row in list(csv.reader(file))[1:])
        except (OSError, ValueError):
            return math.nan
    return 1.5 * force * span / (THICKNESS * depth**2 * STRENGTH)


def main(program, page, *words):
    found, beams = [], {}
    for case in CASES:
        name = f"{case[0]} | {case[1]} | {case[2]} | {case[3]}"
        if not all(word in name for word in words):
            continue
        poisson = 1 / 3 if case[0] == "bond-based" else POISSON
        beam = beams.setdefault(poisson, condensed(ELEMENTS, poisson))
        reference = {depth: cohesive_strength(depth, case[-1], beam) for depth in DEPTHS}
        for rows in ROWS:
            cells = []
            for depth in DEPTHS:
                cells.append(f"{measured(program, case, depth, rows) / reference[depth]:.2f} ({reference[depth]:.2f})")
                print(f"{name} | {rows} | {depth / LENGTH:.1f}: {cells[-1]}", flush=True)
            found.append(f"| {name} | {rows} | " + " | ".join(cells) + " |")
    lines = ["| formulation | law | lattice | δ/Δx | rows | " + " | ".join(f"h = {d / LENGTH:.1f} E G_F/f_t²" for d in DEPTHS) + " |",
             "|---" * (5 + len(DEPTHS)) + "|", *found]
    if words:
        print("\n".join(lines))
    else:
        write(page, "bending strength", lines)


if __name__ == "__main__":
    main(*sys.argv[1:])
