#!/usr/bin/env python3
"""Measures tables of docs/choosing.md on bodies at rest and writes them there.

  choosing.py BRECCIA PAGE              all tables
  choosing.py BRECCIA PAGE TABLE ...    some of: bending, strips, prisms, cuts

bending   pure bending in plane strain, deflection over M L^2 / (2 E' I), for Poisson ratios up to 0.499
strips    largest stress of strips of softening bonds over the tensile strength, by direction of the lattice
prisms    largest load of pressed prisms of bonds, over f_c times the section
cuts      height of vertical cuts in clay that still stand, over 3.776 s_u / gamma

A run takes up to ten seconds of processor time, all of them a minute."""
import concurrent.futures
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

from pages import write
from toughness import box

BENT = {"ordinary": ((21, 3.015), (11, 3.015), (11, 2.015)), "correspondence": ((11, 3.015),), "hybrid": ((11, 2.015),)}
RATIOS = (0.3, 0.45, 0.49, 0.495, 0.499)
STRIPS = (("trilinear", 3.015), ("bilinear", 3.015), ("exponential", 3.015), ("trilinear", 2.015), ("trilinear", 1.5))
ANGLES = (0.0, 26.565, 45.0)
CRUSHED = "fib-concrete"
SOFTENING = "exponential-softening"
PRISMS = (  # law, held platens, spacing (mm)
    (SOFTENING, False, 20), (SOFTENING, True, 20), (CRUSHED, False, 20), (CRUSHED, False, 10), (CRUSHED, True, 20),
)

GRAVITY = 15.0  # m/s2, at the end of the stage
FADES = {"formulation": "correspondence", "zero-energy control": {"silling": 0.2, "fades": "yielding"}}
CUTS = (
    ({"formulation": "ordinary"}, "ordinary"),
    (FADES, "correspondence, control fades, `influence: constant`"),
    ({**FADES, "influence": "conical"}, "correspondence, control fades, `influence: conical`"),
)
ACROSS = 8  # spacings across the height of a cut


def run(program, deck, may_end="nothing"):
    """Returns the columns of the histories of a run by name of the history, and what `check` prints of the deck. A run
    may end early with these words."""
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/deck.yaml", "w") as file:
            json.dump({**deck, "pictures": [], "results": {"number": 0}}, file)
        done = subprocess.run([program, "run", f"{folder}/deck.yaml", "--quiet", "--threads", "1", "--output", f"{folder}/run"],
                              capture_output=True, text=True)
        told = subprocess.run([program, "check", f"{folder}/deck.yaml"], capture_output=True, text=True).stdout
        if done.returncode and may_end not in done.stderr:
            sys.exit(done.stderr.strip()[:300])
        columns = {}
        for name in deck["watch"]:
            with open(f"{folder}/run/{name}.csv") as file:
                rows = list(csv.reader(file))
            columns[name] = {head.split(" (")[0]: [float(row[n]) for row in rows[1:]] for n, head in enumerate(rows[0])}
    return columns, told


def bent(case):
    """A strip of height 1 m and length 4 m on a plane of symmetry; its last columns are bent to a circle."""
    formulation, rows, horizon, ratio = case
    spacing, across = 1 / rows, ratio / (1 - ratio)
    far = {"on": {"face": "x+", "layers": math.ceil(horizon)}, "name": "end", "history": {"ramp to": 1},
           "field": {"displacement": ["-1e-5*x*y/(1 m)", f"0.5e-5*(x*x+{across!r}*y*y)/(1 m)"]}}
    return {
        "materials": {"m": {"model": "elastic", "density": 2400, "Young modulus": 1e9, "Poisson ratio": ratio}},
        "body": {"b": {"material": "m", "lattice": "square", "spacing": spacing, "thickness": 1.0, "shape": {"box": {
            "particles": [4 * rows, rows], "first particle": [spacing / 2, (spacing - 1) / 2]}}}},
        "peridynamics": {"formulation": formulation, "space": "plane strain", "horizon": f"{horizon} spacings",
                         **({} if formulation == "ordinary" else {"strain": "small"})},
        "loads": [{"on": {"face": "x-"}, "support": {"held": "across"}}, far],
        "solve": {"static": {"increments": 1}},
        "watch": {"end": {"reaction of": "end"}, "first": {"displacement of": {"nearest": [0, 0]}},
                  "middle": {"displacement of": {"nearest": [2 - spacing / 2, 0]}}},
    }


def deflection(program, case):
    """Returns the deflection between the plane of symmetry and the middle, over that of the moment."""
    _, rows, _, ratio = case
    found, _ = run(program, bent(case))
    first, last = 0.5 / rows, 2 - 0.5 / rows
    curvature = 2 * (found["middle"]["y"][-1] - found["first"]["y"][-1]) / (last**2 - first**2)
    moment = abs(found["end"]["moment z"][-1])
    return abs(curvature) * 1e9 / (1 - ratio**2) / 12 / moment


def strip(case):
    """A strip of 150 mm by 60 mm whose middle softens, along a direction of the lattice; its ends are pulled apart."""
    (law, horizon), degrees = case
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    block = {"lattice": "square", "spacing": 5, "thickness": 100}

    def part(first, last, half=29.9):
        return box(first, last, -half, half, degrees)
    return {
        "units": {"length": "mm", "force": "N", "time": "s"},
        "materials": {"e": {"model": "elastic-1d", "density": 2.4e-9, "Young modulus": 30000},
                      "m": {"model": f"{law}-softening", "density": 2.4e-9, "Young modulus": 30000, "tensile strength": 3,
                            "fracture energy": 0.1}},
        "body": {"l": {**block, "material": "e", "shape": part(0, 45)}, "m": {**block, "material": "m", "shape": part(45, 105)},
                 "r": {**block, "material": "e", "shape": part(105, 150)}},
        "peridynamics": {"formulation": "bond-based", "space": "plane stress", "horizon": f"{horizon} spacings",
                         "surface correction": "energy"},
        "loads": [{"on": {"inside": part(-5, 16, 60)}, "displacement": [0, 0]},
                  {"name": "pull", "on": {"inside": part(134, 155, 60)}, "displacement": [0.03 * c, 0.03 * s],
                   "history": {"ramp to": 1}}],
        "solve": {"static": {"increments": 20}},
        "watch": {"pull": {"reaction of": "pull"}},
    }


def strength(program, case):
    """Returns the largest stress over the tensile strength, and the band that `check` prints."""
    found, told = run(program, strip(case))
    force = max(math.hypot(x, y) for x, y in zip(found["pull"]["x"], found["pull"]["y"]))
    # The volume over the length is the mean section of the rows that stand inside.
    particles = int(re.search(r"(\d+) particles", told)[1])
    band = re.search(r"pulled one way carries ([\d.]+) to ([\d.]+)", told)
    return force / (particles * 25 * 100 / 150) / 3, f"{float(band[1]):.2f} to {float(band[2]):.3g}"


def prism(case):
    """A prism of 0.2 m by 0.4 m, 0.2 m thick, pressed by 2 mm."""
    law, held, spacing = case
    crushing = {"compressive strength": 38, "peak strain": 0.0022} if law == CRUSHED else {}
    middle = [100 + spacing / 2, spacing / 2]
    sides = [] if held else [{"on": {"nearest": middle}, "displacement": [0, "free"]},
                             {"on": {"nearest": [middle[0], 400 - middle[1]]}, "displacement": [0, "free"]}]
    across = 0 if held else "free"
    return {
        "units": {"length": "mm", "force": "N", "time": "s"},
        "materials": {"m": {"model": law, "density": 2.4e-9, "Young modulus": 33000, "tensile strength": 2.9,
                            "fracture energy": 0.14, **crushing}},
        "body": {"b": {"material": "m", "lattice": "square", "spacing": spacing, "thickness": 200, "shape": {"box": {
            "from": [0, 0], "to": [200, 400]}}}},
        "peridynamics": {"formulation": "bond-based", "space": "plane stress", "surface correction": "energy"},
        "failure": {"near grips": "hold"},
        "loads": [{"on": {"face": "y-", "layers": 3}, "displacement": [across, 0]}, *sides,
                  {"name": "press", "on": {"face": "y+", "layers": 3}, "displacement": [across, -2], "history": {"ramp to": 1}}],
        "solve": {"static": {"increments": 40, "method": "relaxation", "residual": 1e-3, "relaxation iterations": 20000}},
        "watch": {"press": {"reaction of": "press"}},
    }


def crushed(program, case):
    """Returns the largest load and that at the end (kN), and the work of the load between them (J)."""
    found, _ = run(program, prism(case))
    forces, times = [abs(y) / 1e3 for y in found["press"]["y"]], found["press"]["time"]
    peak = forces.index(max(forces))
    steps = zip(times[peak:], times[peak + 1:], forces[peak:], forces[peak + 1:])
    return forces[peak], forces[-1], sum((last - first) * 2 * (f + g) / 2 for first, last, f, g in steps)


def cut(keys):
    """A vertical cut of 8 m in clay of s_u = 40 kPa under a growing weight, on 8 m of the same clay, 16 m wide on both sides."""
    return {
        "units": {"length": "m", "force": "kN", "time": "s"},
        "materials": {"clay": {"model": "j2", "density": 2, "Young modulus": 1e5, "Poisson ratio": 0.45, "yield stress": 40 * math.sqrt(3)}},
        "body": {"ground": {"material": "clay", "lattice": "square", "spacing": 8 / ACROSS, "thickness": 1, "shape": {"difference": [
            {"box": {"from": [0, 0], "to": [32, 16]}}, {"box": {"from": [16, 8], "to": [32, 16]}}]}}},
        "peridynamics": {**keys, "space": "plane strain", "horizon": "2.015 spacings"},
        "loads": [{"on": {"face": "x-"}, "support": {"held": "across"}}, {"on": {"face": "x+"}, "support": {"held": "across"}},
                  {"on": {"face": "y-"}, "support": {"held": "all"}}, {"gravity": [0, -GRAVITY], "history": {"ramp to": 1}}],
        "solve": {"static": {"increments": 30, "smallest increment": 0.1}},
        "watch": {"crest": {"displacement of": {"nearest": [15.9, 16]}, "every": 1}},
    }


def stands(program, keys):
    """Returns the largest weight with equilibrium, as gamma H / s_u over 3.776."""
    found, _ = run(program, cut(keys), "no equilibrium")
    return found["crest"]["time"][-1] * GRAVITY * 2 * 8 / 40 / 3.776


def bending_table(pool, program):
    cases = [(formulation, *body, ratio) for formulation, bodies in BENT.items() for body in bodies for ratio in RATIOS]
    found = dict(zip(cases, pool.map(lambda case: deflection(program, case), cases)))
    lines = ["| Poisson ratio | " + " | ".join(f"{ratio:g}" for ratio in RATIOS) + " |", "|---" * (len(RATIOS) + 1) + "|"]
    for formulation, bodies in BENT.items():
        for rows, horizon in bodies:
            cells = " | ".join(f"{found[formulation, rows, horizon, ratio]:.2f}" for ratio in RATIOS)
            lines.append(f"| {formulation}, {rows} rows, horizon of {horizon:g} spacings | {cells} |")
    return lines


def strips_table(pool, program):
    cases = [(body, degrees) for body in STRIPS for degrees in ANGLES]
    found = dict(zip(cases, pool.map(lambda case: strength(program, case), cases)))
    lines = ["| law | δ/Δx | " + " | ".join(f"{degrees:.3g}°" for degrees in ANGLES) + " | told |", "|---" * (len(ANGLES) + 3) + "|"]
    for body in STRIPS:
        cells = " | ".join(f"{found[body, degrees][0]:.2f}" for degrees in ANGLES)
        lines.append(f"| {body[0]} | {body[1]:g} | {cells} | {found[body, ANGLES[0]][1]} |")
    return lines


def prisms_table(pool, program):
    lines = ["| law, platens, spacing | largest load, kN | over f_c times the section | load at 2 mm, kN | work from the peak to 2 mm, J |",
             "|---|---|---|---|---|"]
    for (law, held, spacing), (most, last, work) in zip(PRISMS, pool.map(lambda case: crushed(program, case), PRISMS)):
        lines.append(f"| `{law}`, {'held' if held else 'smooth'}, {spacing} mm | {most:.0f} | {most / (38 * 40):.3f} | {last:.0f} | {work:.0f} |")
    return lines


def cuts_table(pool, program):
    lines = ["| formulation | spacings across the height | computed over it |", "|---|---|---|"]
    for (_, name), share in zip(CUTS, pool.map(lambda row: stands(program, row[0]), CUTS)):
        lines.append(f"| {name} | {ACROSS} | {100 * (share - 1):+.0f} % |")
    return lines


TABLES = {"bending": bending_table, "strips": strips_table, "prisms": prisms_table, "cuts": cuts_table}


def main(program, page, *names):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for name in names or TABLES:
            lines = TABLES[name](pool, program)
            print("\n".join(lines), flush=True)
            write(page, name, lines)


if __name__ == "__main__":
    main(*sys.argv[1:])
