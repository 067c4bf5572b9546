"""The cantilever: formulations, horizons and spacings; how its wall and its load are told; finite elements beside it."""
import os
import subprocess
from math import ceil

from reporting import LINE, Run, between, chart, picture, table

LENGTH, HEIGHT, WIDTH, MODULUS, RATIO, LOAD = 2, 0.4, 0.1, 30e6, 0.2, 100  # m, kPa, kN
INERTIA = WIDTH * HEIGHT**3 / 12
TIP = LOAD * LENGTH**3 / (3 * MODULUS * INERTIA) + (4 + 5 * RATIO) * LOAD * HEIGHT**2 * LENGTH / (24 * MODULUS * INERTIA)
STRESS = LOAD * LENGTH / 2 * HEIGHT / 4 / INERTIA
SPACINGS, HORIZONS = (40, 20, 10), (1.5, 2.015)  # mm, spacings
HYBRID = "formulation: hybrid, form: variational, space: plane stress, strain: small"
ONE = [("model: elastic", "model: elastic-1d"), (", Poisson ratio: 0.2", "")]
# Where bonds do not tell how a traction is spread, the last column takes 1.5 P and the one before it -0.5 P, so that the resultant is at the end, too.
LAST = [("traction:", "spread: layers, traction:")]
TWO = [('traction: [0, "${-P/(0.4 m*0.1 m)}"]}', 'force: [0, "${-2*P}"]}\n  - {on: {face: x+, layers: 2}, force: [0, "${P}"]}')]
FORMULATIONS = {
    "hybrid, variational": [],
    "hybrid, pairwise": [("variational", "pairwise")],
    "correspondence": [("hybrid, form: variational", "correspondence")],
    "ordinary": TWO + [(HYBRID, "formulation: ordinary, space: plane stress")],
    "bond-based, calibration: uniaxial, surface correction: energy":
        TWO + ONE + [(HYBRID, "formulation: bond-based, calibration: uniaxial, surface correction: energy, space: plane stress")],
}
WALL, BODY = "{on: {face: x-}, support: {held: all}}", "from: [0, 0], to: [2 m, 0.4 m]"


class Beam:
    def __init__(self, spacing, horizon, edits, beyond=0.5):
        """beyond: how far the end of the beam is from the last column, in spacings"""
        self.run = Run("cantilever.yaml", [f"variables.dx={spacing} mm", f"variables.layers={horizon}"], edits=edits)
        last, both = (-1000 * self.run.last(watch, "y") for watch in ("end", "last-two"))
        self.tip = last + 2 * beyond * (last - both)
        self.deviation = 100 * (self.tip / 1000 / TIP - 1)
        self.stress = 100 * (self.run.last("quarter", "stress xx") / STRESS - 1)


def finite_elements(sides):
    """Deflections and stresses by OpenSees; nothing where it is not set up."""
    python = "../../.venv/opensees/bin/python"
    if not os.path.exists(python):
        return []
    said = subprocess.run([python, "elements.py", *map(str, sides)], check=True, capture_output=True, text=True).stdout
    rows = [[float(word) for word in line.split()[:2]] for line in said.splitlines()[:len(sides)]]
    return [(100 * (-u / TIP - 1), 100 * (s / STRESS - 1)) for u, s in rows]


def wall(horizon, far):
    """Edits that hold columns outside the wall; the last of them stands this far from it, in spacings."""
    k = ceil(horizon)
    body = f'from: ["${{-{k - 1 + far + 0.5}*dx}}", 0], to: ["${{2 m + {0.5 - far}*dx}}", 0.4 m]'
    return [(WALL, f"{{on: {{face: x-, layers: {k}}}, displacement: [0, 0]}}"), (BODY, body)]


beams = {(name, m, d): Beam(d, m, edits) for name, edits in FORMULATIONS.items() for m in HORIZONS for d in SPACINGS}
rows = [[name, f"{m:g}"] + [f"{beams[name, m, d].deviation:+.2f} %" for d in SPACINGS] + [f"{beams[name, m, d].stress:+.2f} %" for d in SPACINGS]
        for name in FORMULATIONS for m in HORIZONS]
elements = finite_elements(SPACINGS)
if elements:
    rows.append(["finite elements (SSPquad of OpenSees)", ""] + [f"{u:+.2f} %" for u, _ in elements] + ["–"] + [f"{s:+.2f} %" for _, s in elements[1:]])
between("formulation", table(["formulation", "horizon, spacings"] + [f"deflection, {d} mm" for d in SPACINGS] + [f"stress, {d} mm" for d in SPACINGS], rows))

ways = {
    "as in the deck": (lambda m: [], 0.5),
    "support, all of the load on the last column": (lambda m: LAST, 0.5),
    "columns outside held at 0, the face of the nearest at the wall": (lambda m: wall(m, 0.5), 0.5),
    "columns outside held at 0, the centres of the nearest on the wall; the last column at the end of the beam takes the load":
        (lambda m: wall(m, 0) + LAST, 0),
}
hybrids = list(FORMULATIONS)[:2]
between("ways", table(["wall and load, spacing 20 mm"] + [f"{name}, {m:g}" for name in hybrids for m in HORIZONS],
                      [[way] + [f"{Beam(20, m, FORMULATIONS[name] + edits(m), beyond).deviation:+.2f} %" for name in hybrids for m in HORIZONS]
                       for way, (edits, beyond) in ways.items()]))

picture(beams["hybrid, variational", 2.015, 20].run, "stress", "stress", "--component", "xx", "--deformed", "10")
COLOURS = ["#c8501e", "#21918c", "#3b3f87", "#8a6d00", "#7a3b7a"]
chart("convergence", "Deflection of the end, distance from plane elasticity", "spacing [mm]", "distance [%]",
      [(f"{name.split(', calibration')[0]}, {m:g}", f"with linespoints pt {7 if m == 1.5 else 6} ps 0.8 lw 1.5 dt {1 if m == 1.5 else 2} lc rgb '{colour}'",
        [(d, abs(beams[name, m, d].deviation)) for d in SPACINGS]) for name, colour in zip(FORMULATIONS, COLOURS) for m in HORIZONS] +
      ([("finite elements", LINE, [(d, abs(u)) for d, (u, _) in zip(SPACINGS, elements)])] if elements else []),
      "set logscale xy\nset xtics (10, 20, 40)\nset ytics (0.1, 0.2, 0.5, 1, 2, 5, 10)\nset xrange [8:50]\nset yrange [0.08:30]")
