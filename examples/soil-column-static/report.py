"""The column: forms, horizons and loads beside the closed form; correspondence and finite elements; other sides and bases."""
import os
import subprocess
from math import ceil, sqrt

from reporting import LINE, Run, STYLES, between, chart, table

HEIGHT, WIDTH, SHEAR_MODULUS, STRENGTH, PEAK, SURFACES, INCREMENTS = 10, 2, 60e3, 30, 0.1, 20, 18  # m, kPa
REFERENCE = PEAK * STRENGTH / (SHEAR_MODULUS * PEAK - STRENGTH)  # octahedral strain of the hyperbola
HORIZONS = (1.5, 2.015, 3.015)


def hyperbola(stress):
    """Strain of simple shear."""
    t = stress / sqrt(1.5)
    return sqrt(1.5) * t * REFERENCE / (SHEAR_MODULUS * REFERENCE - t)


# Corners of the backbone: they stand on the hyperbola, all moved by what the straight line up to the first of them saves.
CORNERS = [sqrt(1.5) * STRENGTH * n / SURFACES for n in range(1, SURFACES)]
EARLY = hyperbola(CORNERS[0]) - CORNERS[0] / SHEAR_MODULUS
POLYGON = [(0, 0)] + [(hyperbola(t) - EARLY, t) for t in CORNERS]
STRAIN, STRESS = POLYGON[INCREMENTS]  # at 0.9 of the strength

HYBRID = "formulation: hybrid, form: variational"
BASE, SIDES = "  - {on: {face: y-}, support: {held: all}}\n", "  - {on: {face: x-}, support: {held: periodic}}\n"
HYBRIDS = {"hybrid, variational": [], "hybrid, pairwise": [("form: variational", "form: pairwise")]}
CONTROLS = {"kept": "silling: 0.2", "fades with yielding": "silling: 0.2, fades: yielding", "none": "none: yes"}
CORRESPONDENCE = {name: [(HYBRID, f"formulation: correspondence, zero-energy control: {{{words}}}")] for name, words in CONTROLS.items()}


def told(share):
    if not abs(share) < 100:
        return "lost"
    if abs(share) < 1e-7:
        return "< 1e-7"
    return f"{share:+.0e}" if abs(share) < 1e-5 else f"{100 * share:+.3f} %" if abs(share) < 1e-3 else f"{100 * share:+.1f} %"


SPREADS = {"as by the bonds cut off": [], "on the last row": [("traction:", "spread: layers, traction:")]}


class Column(Run):
    def __init__(self, horizon, edits, spacing=0.25):
        rows = [(n + 0.5) * spacing for n in range(round(HEIGHT / spacing))]
        super().__init__("column.yaml", [f"variables.dx={spacing} m", f"variables.layers={horizon}"], [(1, y) for y in rows], edits)
        self.heights, self.strains = rows, [self.last(f"s{n}", "strain xy") for n in range(len(rows))]
        self.moved = self.last("top", "x") / (STRAIN * rows[-1]) - 1  # of the last row, whose centres are half a spacing below the top

    def cells(self):
        """Errors in the middle, at the top, and the largest of the strain in any row."""
        far = [strain / STRAIN - 1 for strain in self.strains]
        n = max(range(len(far)), key=lambda k: abs(far[k]))
        where = "" if not 1e-7 <= abs(far[n]) < 100 else f", {HEIGHT - self.heights[n]:.3g} m below the top"
        strain, stress = (self.last("middle", what + " xy") for what in ("strain", "stress"))
        return [told(strain / STRAIN - 1), told(stress / STRESS - 1), told(self.moved), told(far[n]) + where]


def elements(side):
    """Strain, stress and displacement by OpenSees after each increment; nothing where it is not set up."""
    python = "../../.venv/opensees/bin/python"
    if not os.path.exists(python):
        return []
    said = subprocess.run([python, "elements.py", str(side), str(INCREMENTS)], check=True, capture_output=True, text=True).stdout
    return [[float(word) for word in line.split()] for line in said.splitlines()[:INCREMENTS]]


HEAD = ["strain in the middle", "stress there", "displacement of the last row", "strain, at the worst"]
BONDS, LAST = SPREADS
columns, rows = {}, []
for name, edits in HYBRIDS.items():
    for m in HORIZONS[:2]:
        for spacing, spread in ((0.5, BONDS), (0.25, BONDS), (0.25, LAST)):
            column = columns[name, m, spread, spacing] = Column(m, edits + SPREADS[spread], spacing)
            rows.append([name, f"{m:g}", f"{spacing:g} m", spread, *column.cells()])
by_elements = elements(0.5)
if by_elements:
    strain, stress, top = by_elements[-1]
    rows.append(["finite elements (quad of OpenSees)", "", "0.5 m", "even", told(strain / STRAIN - 1), told(stress / STRESS - 1),
                 told(top / STRAIN / HEIGHT - 1), ""])
between("hybrid", table(["", "horizon, spacings", "spacing", "traction", *HEAD], rows))

rows = []
for name, edits in CORRESPONDENCE.items():
    for m in HORIZONS:
        for spread, said in SPREADS.items():
            column = columns[name, m, spread, 0.25] = Column(m, edits + said)
            rows.append([name, f"{m:g}", spread, *column.cells()])
between("correspondence", table(["control", "horizon, spacings", "traction", *HEAD], rows))

WAYS = {
    "rows of particles tied": (0.25, [(SIDES, "  - {on: {except: {face: x-}}, tie: {to: {face: x-}}}\n")]),
    "the outermost pair of each row tied": (0.25, [(SIDES, "  - {on: {face: x+}, tie: {to: {face: x-}}}\n")]),
    **{f"periodic; two rows below the wall clamped, {spacing:g} m": (spacing, [
        (BASE, "  - {on: {face: y-, layers: 2}, displacement: [0, 0]}\n"), ("{from: [0, 0]", '{from: [0, "${-2*dx}"]')]) for spacing in (0.25, 0.125)},
}
rows = []
for way, (spacing, changed) in WAYS.items():
    for name, edits in HYBRIDS.items():
        column = Column(1.5, edits + changed, spacing)
        inside = column.moved * column.heights[-1] / spacing
        rows.append([way, name, *column.cells(), f"{inside:.2f}" if "clamped" in way else ""])
between("ways", table(["sides and base, horizon 1.5 spacings", "", *HEAD, "spacings by which the column is longer"], rows))

path = columns["hybrid, variational", 1.5, BONDS, 0.25]
curve = [100 * g for g in path.column("middle", "strain xy")], path.column("middle", "stress xy")
smooth = [n * STRESS / 200 for n in range(201)]
chart("backbone", "Shear stress against shear strain in the middle of the column", "shear strain [%]", "shear stress [kPa]",
      [("hyperbola", "with lines lw 1.5 dt 2 lc rgb '#999999'", [(100 * hyperbola(t), t) for t in smooth]),
       ("polygon of its surfaces", LINE, [(100 * g, t) for g, t in POLYGON[:INCREMENTS + 1]]),
       ("hybrid", "with points pt 7 ps 1 lc rgb '#c8501e'", list(zip(*curve)))] +
      ([("finite elements", "with points pt 6 ps 2 lw 1.5 lc rgb '#21918c'", [(100 * g, t) for g, t, _ in by_elements])] if by_elements else []))
profiles = [("hybrid, 1.5: by the bonds cut off", ("hybrid, variational", 1.5, BONDS, 0.25)), ("hybrid, 1.5: last row", ("hybrid, variational", 1.5, LAST, 0.25)),
            ("hybrid, 2.015: last row", ("hybrid, variational", 2.015, LAST, 0.25)), ("correspondence, 3.015: last row", ("kept", 3.015, LAST, 0.25))]
chart("height", "Shear strain over the height, by the rows that take the traction", "shear strain [%]", "height [m]",
      [(label, style, [(100 * s, y) for s, y in zip(columns[key].strains, columns[key].heights)]) for (label, key), style in zip(profiles, STYLES)],
      "set yrange [0:10]\nset xrange [0:0.6]")
