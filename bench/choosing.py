#!/usr/bin/env python3
"""Measures tables of docs/choosing.md on bodies at rest and writes them there.

  choosing.py BRECCIA PAGE              all tables
  choosing.py BRECCIA PAGE TABLE ...    some of: bending, strips, prisms, cuts, factors

bending   pure bending in plane strain, deflection over M L^2 / (2 E' I), for Poisson ratios up to 0.499
strips    largest stress of strips of softening bonds over the tensile strength, by direction of the lattice
prisms    largest load of pressed prisms of bonds, over f_c times the section
cuts      height of vertical cuts in clay that still stand, over 3.776 s_u / gamma
factors   factors of safety of cuts and slopes, over closed forms and slip circles

A run takes up to ten seconds of processor time, those of factors up to two minutes, all of them ten minutes."""
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


def circle_factor(cohesion, slope, center, radius):
    """Returns the factor of safety of a slip circle by Bishop (1955), without pore water; infinity of a circle that cuts no
    ground of the slope. @param slope  friction angle (degrees), unit weight, height, angle (degrees)"""
    friction, weight, height, angle = slope
    tangent, run_out, strips = math.tan(math.radians(friction)), height / math.tan(math.radians(angle)), 200

    def surface(x):
        return min(height, max(0.0, x / run_out * height))
    low, high = center[0] - radius, center[0] + radius
    fine = [low + (high - low) * (k + 0.5) / 4000 for k in range(4000)]
    inside = [x for x in fine if surface(x) > center[1] - math.sqrt(radius**2 - (x - center[0])**2)]
    if len(inside) < 100 or center[1] < height:
        return math.inf
    width, parts, driving = (inside[-1] - inside[0]) / strips, [], 0.0
    for k in range(strips):
        x = inside[0] + (k + 0.5) * width
        sine = (x - center[0]) / radius
        load = weight * (surface(x) - center[1] + radius * math.sqrt(1 - sine**2)) * width
        parts.append((sine, math.sqrt(1 - sine**2), load))
        driving += load * sine
    if driving <= 0:
        return math.inf
    factor = 1.0
    for _ in range(30):
        resisting = sum((cohesion * width + load * tangent) / (cosine + sine * tangent / factor) for sine, cosine, load in parts)
        factor = resisting / driving
        if not 0 < factor < 100:
            return math.inf
    return factor


def least_factor(cohesion, slope, depth):
    """Returns the least factor of all slip circles that reach no deeper than a depth below the toe, by a search that
    halves its steps."""
    height = slope[2]
    best, at, step = math.inf, (0.5 * height, 1.8 * height, 0.5 * depth), 0.5 * height
    while step > 0.005 * height:
        around = [(at[0] + i * step, at[1] + j * step, at[2] + k * step) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
        found = [(circle_factor(cohesion, slope, (a, b), b + min(depth, d)), (a, b, d)) for a, b, d in around]
        least = min(found)
        if least[0] < best:
            best, at = least
        else:
            step /= 2
    return best


def spiral_height(tangent):
    """Returns gamma H / c of a vertical cut by the logarithmic spiral through its toe with the least height (Chen 1975)."""
    def height(first, last):
        grown = math.exp((last - first) * tangent)
        rise = math.sin(last) * grown - math.sin(first)
        top = math.sin(last - first) / math.sin(last) - math.cos(last) / math.sin(last) * rise
        whole = ((3 * tangent * math.cos(last) + math.sin(last)) * grown**3 - 3 * tangent * math.cos(first) - math.sin(first)) / (3 * (1 + 9 * tangent**2))
        upper = top * (2 * math.cos(first) - top) * math.sin(first) / 6
        front = grown / 6 * (math.sin(last - first) - top * math.sin(last)) * (math.cos(first) - top + math.cos(last) * grown)
        moved = whole - upper - front
        return (grown**2 - 1) / (2 * tangent * moved) * rise if moved > 0 and rise > 0 and top > 0 else math.inf
    degrees = [math.radians(0.5 * k) for k in range(1, 180)]
    return min(height(first, last) for first in degrees for last in degrees if last > first)


def spiral_factor(cohesion, degrees):
    """Returns the factor of safety of a vertical cut by logarithmic spirals. @param cohesion  over gamma H"""
    low, high, tangent = 0.5, 3.0, math.tan(math.radians(degrees))
    while high - low > 1e-3:
        factor = (low + high) / 2
        stands = 1 < spiral_height(tangent / factor) * cohesion / factor
        low, high = (factor, high) if stands else (low, factor)
    return low


TALL = (8, 12)  # heights, in spacings of 1 m
SPECIFIC = 20.0  # unit weight (kN/m3)
DEEP = 5.53  # gamma H / s_u of a slope of 45 degrees on rock at half its height below the toe (docs/theory.md, 8.7)


def clay(strength):
    return {"model": "j2", "density": SPECIFIC / 10, "Young modulus": 1e6, "Poisson ratio": 0.45, "yield stress": math.sqrt(3) * strength}


def frictional(cohesion, degrees):
    return {"model": "mohr-coulomb", "density": SPECIFIC / 10, "Young modulus": 1e6, "Poisson ratio": 0.3, "cohesion": cohesion,
            "friction angle": degrees, "dilation angle": degrees, "tensile strength": cohesion / math.tan(math.radians(degrees))}


def ground(material, corners, loads=None, periodic=False):
    """A body of ground on two held layers whose strength is reduced until it slides."""
    sides = [{"on": {"face": "x+"}, "support": {"held": "periodic" if periodic else "across"}}]
    sides += [] if periodic else [{"on": {"face": "x-"}, "support": {"held": "across"}}]
    return {
        "units": {"length": "m", "force": "kN", "time": "s"}, "materials": {"soil": material},
        "body": {"ground": {"material": "soil", "lattice": "square", "spacing": 1, "thickness": 1, "shape": {"polygon": {"corners": corners}}}},
        "peridynamics": {"formulation": "correspondence", "strain": "small", "space": "plane strain", "horizon": "2.015 spacings",
                         "influence": "conical", "zero-energy control": {"silling": 0.2, "fades": "yielding"}},
        "loads": [*sides, {"on": {"face": "y-", "layers": 2}, "displacement": [0, 0]}, {**(loads or {"gravity": [0, -10]}), "history": {"ramp to": 1}}],
        "solve": [{"static": {"increments": 5}},
                  {"displacements": "zero", "loads": [{"strength reduction": 2, "name": "weaken", "history": {"ramp to": 1}}],
                   "static": {"increments": 40, "smallest increment": 0.25}}],
        "watch": {"f": {"load": "weaken", "every": 1}},
    }


def grounds(h):
    """Returns what the table of factors has for a height: words, the right factor, its source, the deck."""
    weight, lean, foot = SPECIFIC * h, math.atan(0.5), h / 2
    cut = [[0, -h - 2], [4 * h, -h - 2], [4 * h, h], [2 * h, h], [2 * h, 0], [0, 0]]
    slope = [[-2 * h, -h / 2 - 2], [4 * h, -h / 2 - 2], [4 * h, h], [h, h], [0, 0], [-2 * h, 0]]
    cohesion, steep = 1.3 * weight / 5.50, 0.1 * weight
    pressed = {"on": {"face": "y+", "inside": {"box": {"from": [0, -1], "to": [foot, 1]}}}, "traction": [0, -100]}
    return [
        ("vertical cut, clay", 1.3, "γ H = 3.776 s_u", ground(clay(1.3 * weight / 3.776), cut)),
        ("vertical cut, φ = 20° and cohesion", spiral_factor(cohesion / weight, 20), "logarithmic spirals", ground(frictional(cohesion, 20), cut)),
        ("slope of 45°, clay, on rock at half the height below the toe", 1.4, f"γ H = {DEEP} s_u", ground(clay(1.4 * weight / DEEP), slope)),
        ("slope of 45°, φ = 20° and cohesion, the same ground", least_factor(steep, (20, SPECIFIC, h, 45), h / 2), "Bishop (1955)",
         ground(frictional(steep, 20), slope)),
        ("slope without end, clay", 1.3, "s_u / (γ H sin β)",
         ground(clay(1.3 * weight * math.sin(lean)), [[0, -2], [8, -2], [8, h], [0, h]],
                {"gravity": [10 * math.sin(lean), -10 * math.cos(lean)]}, True)),
        ("footing on clay, half its width half the height", 1.3, "5.142 s_u",
         ground(clay(130 / 5.142), [[0, -h - 2], [4 * foot, -h - 2], [4 * foot, 0], [0, 0]], pressed)),
    ]


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


def safety(program, deck):
    found, _ = run(program, deck)
    return found["f"]["value"][-1]


def factors_table(pool, program):
    rows = [grounds(h) for h in TALL]
    cases = [(row, n) for row in range(len(rows[0])) for n in range(len(TALL))]
    found = dict(zip(cases, pool.map(lambda case: safety(program, rows[case[1]][case[0]][3]), cases)))
    lines = ["| ground | right factor, by | " + " | ".join(f"{h} spacings" for h in TALL) + " |", "|---" * (2 + len(TALL)) + "|"]
    for row, (words, right, source, _) in enumerate(rows[0]):
        cells = (f"{found[row, n]:.3f} ({100 * (found[row, n] / right - 1):+.1f} %)" for n in range(len(TALL)))
        lines.append(f"| {words} | {right:.3f}, {source} | " + " | ".join(cells) + " |")
    return lines


TABLES = {"bending": bending_table, "factors": factors_table, "strips": strips_table, "prisms": prisms_table, "cuts": cuts_table}


def main(program, page, *names):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for name in names or TABLES:
            lines = TABLES[name](pool, program)
            print("\n".join(lines), flush=True)
            write(page, name, lines)


if __name__ == "__main__":
    main(*sys.argv[1:])
