#!/usr/bin/env python3
"""Measures what a crack takes of its loads over the fracture energy that was asked for: a notched strip that a wedge
opens, by formulation, law or criterion, lattice, direction of the crack and horizon. Writes a table of PAGE.

  toughness.py BRECCIA PAGE               square lattices, default horizons, cracks along rows and diagonals
  toughness.py BRECCIA PAGE all           all of LATTICES, HORIZONS and DIRECTIONS
  toughness.py BRECCIA PAGE WORDS         of all, the rows that hold these words; printed and not written

A run takes 10 to 15 s of processor time; there are 26 runs without words. The strip is 0.6 m long and 0.4 m high and has a notch of 0.16 m. Its
outer rows turn about a point beyond its end, so that the crack runs through the strip steadily. What the loads feel is
their work less the energy stored at the end, over G_F times the ligament; what bonds take is the energy of fracture and
damage that the run books, over the same. The difference leaves when the crack jumps from bond to bond (lattice
trapping)."""
import concurrent.futures
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

from pages import write

YOUNG, ENERGY, SPACING = 30e9, 100.0, 0.02
LENGTH, HALF, NOTCH, HINGE, FREE, TURN, INCREMENTS = 0.6, 0.2, 0.16, 0.81, 0.13994, 3.1967481587743743e-4, 60
DIRECTIONS = (0.0, math.degrees(math.atan(0.5)), 45.0)
HORIZONS = (1.5, 2.015, 3.015)
USUAL = {"micropolar": 1.5, "hybrid": 2.015}  # horizons of decks that give none; 3.015 of all others
ELASTIC = {"model": "elastic", "Poisson ratio": 0.2}
FIBRE = {"model": "elastic-1d"}
STRETCH = {"fracture energy": ENERGY}
BOND = {"criterion": "critical bond energy", "fracture energy": ENERGY}


def law(model, strength, **more):
    return {"model": model, "tensile strength": strength, "fracture energy": ENERGY, **more}


# formulation, law or criterion, material, failure, horizons
ROWS = [
    ("bond-based", "critical stretch", FIBRE, STRETCH, HORIZONS),
    ("bond-based", "critical bond energy", FIBRE, BOND, HORIZONS),
    ("ordinary", "critical stretch", ELASTIC, STRETCH, HORIZONS),
    ("ordinary", "critical bond energy", ELASTIC, BOND, HORIZONS),
    ("hybrid", "critical bond energy", ELASTIC, BOND, HORIZONS),
    ("correspondence", "critical bond energy", ELASTIC, BOND, HORIZONS[1:]),
    ("bond-based", "exponential-softening", law("exponential-softening", 6e6), None, HORIZONS),
    ("hybrid", "mazars", law("mazars", 6e6, **{"Poisson ratio": 0.2}), None, HORIZONS[:2]),
    ("hybrid", "mazars, 3 MPa", law("mazars", 3e6, **{"Poisson ratio": 0.2}), None, HORIZONS[:2]),
    ("hybrid", "damage-plasticity, 3 MPa", law("damage-plasticity", 3e6, **{"Poisson ratio": 0.2, "compressive strength": 30e6}), None, HORIZONS[:2]),
    ("correspondence", "mazars", law("mazars", 6e6, **{"Poisson ratio": 0.2}), None, HORIZONS[1:]),
    ("correspondence", "mazars, 3 MPa", law("mazars", 3e6, **{"Poisson ratio": 0.2}), None, HORIZONS[1:]),
    ("micropolar", "link-damage", {"model": "link-damage", "Poisson ratio": 0.2, "tensile stretch": 2e-4, "fracture energy": ENERGY}, None, HORIZONS[:1]),
]
LATTICES = ("square", "hexagonal")


def turned(points, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [[c * x - s * y, s * x + c * y] for x, y in points]


def box(x0, x1, y0, y1, degrees):
    return {"polygon": {"corners": turned([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], degrees)}}


def wedge(name, side, degrees):
    """Returns the load that turns the rows beyond FREE of one side about the hinge on the line of the crack."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    along, across = f"({-s:.12f}*x+{c:.12f}*y)", f"({HINGE} m-({c:.12f}*x+{s:.12f}*y))"
    field = [f"{side * TURN}*({c:.12f}*{along}-({s:.12f})*{across})", f"{side * TURN}*({s:.12f}*{along}+{c:.12f}*{across})"]
    rows = (FREE, 2 * HALF) if side > 0 else (-2 * HALF, -FREE)
    return {"name": name, "on": {"inside": box(-0.1, LENGTH + 0.1, *rows, degrees)}, "field": {"displacement": field}, "history": {"ramp to": 1.0}}


def deck(row, lattice, horizon, degrees, space="plane stress"):
    formulation, _, material, failure, _ = row
    shape = {"box": {"from": [0.0, -HALF], "to": [LENGTH, HALF]}} if degrees == 0 else box(0, LENGTH, -HALF, HALF, degrees)
    made = {
        "materials": {"m": {**material, "density": 2400, "Young modulus": YOUNG}},
        "body": {"b": {"material": "m", "lattice": lattice, "spacing": SPACING, "shape": shape, "thickness": 1.0}},
        "peridynamics": {"formulation": formulation, "space": space, "horizon": f"{horizon} spacings"},
        "cracks": [{"cut": {"line": turned([(-0.1, 1e-5), (NOTCH, 1e-5)], degrees)}}],
        "loads": [wedge("up", 1, degrees), wedge("down", -1, degrees)],
        "solve": {"static": {"increments": INCREMENTS}},
        "watch": {"e": {"energy": True}},
        "pictures": [],
    }
    return {**made, "failure": {**failure, "near grips": "hold"}} if failure else made


def run(program, case):
    """Returns the shares of G_F times the ligament that the loads feel and that bonds take; NaN where a run fails."""
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/strip.yaml", "w") as file:
            json.dump(deck(*case), file)
        done = subprocess.run([program, "run", f"{folder}/strip.yaml", "--quiet", "--threads", "1", "--output", f"{folder}/run"], capture_output=True, text=True)
        if done.returncode:
            print(case[0][:2], case[1:], done.stderr.strip()[:300], file=sys.stderr)
            return math.nan, math.nan
        with open(f"{folder}/run/e.csv") as file:
            last = list(csv.DictReader(file))[-1]
    energy = {key.split(" (")[0]: float(value) for key, value in last.items()}
    whole = ENERGY * (LENGTH - NOTCH)
    return (energy["external"] - energy["stored"]) / whole, (energy["fracture"] + energy["dissipated"]) / whole


def name(case):
    return f"{case[0][0]} | {case[0][1]} | {case[1]} | {case[2]}"


def chosen(words):
    """Returns the cases to run: row, lattice, horizon, direction."""
    whole = [(row, lattice, horizon, degrees)
             for row in ROWS for lattice in LATTICES for horizon in row[4] for degrees in DIRECTIONS]
    if not words:
        return [c for c in whole if c[1] == "square" and c[2] == USUAL.get(c[0][0], 3.015) and c[3] in (0.0, 45.0)]
    return whole if words == ("all",) else [c for c in whole if all(w in f"{name(c)} | {c[3]:.0f}" for w in words)]


def table(found):
    """Returns the lines of a table from cases with their shares."""
    directions = sorted({case[3] for case, _ in found})
    lines = ["| formulation | law or criterion | lattice | δ/Δx | " + " | ".join(f"{d:.4g}°" for d in directions) + " |",
             "|---" * (4 + len(directions)) + "|"]
    for key in dict.fromkeys(name(case) for case, _ in found):
        shares = {case[3]: both for case, both in found if name(case) == key}
        cells = (f"{shares[d][0]:.2f} ({shares[d][1]:.2f})" if d in shares else "" for d in directions)
        lines.append(f"| {key} | " + " | ".join(cells) + " |")
    return lines


def main(program, page, *words):
    cases = chosen(words)
    found = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for case, both in zip(cases, pool.map(lambda case: run(program, case), cases)):
            found.append((case, both))
            print(f"{name(case)} | {case[3]:.0f}°: {both[0]:.2f} ({both[1]:.2f})", flush=True)
    lines = table(found)
    if words and words != ("all",):
        print("\n".join(lines))
    else:
        write(page, "toughness", lines)


if __name__ == "__main__":
    main(*sys.argv[1:])
