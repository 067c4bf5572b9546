"""Problems of other programs as decks of this one: name, deck, and files of particles beside it.

Model and constants are those of the problem: linear peridynamic solid with plain weights, bonds with the constant of
the continuum, correspondence; particles with whole volumes within the horizon. What the other program found is in
values.csv, and the file that holds it in sources.csv.
"""

import math

STEEL = "{model: elastic, density: 7800, bulk modulus: 130e9, shear modulus: 78e9}"
ALUMINIUM = "{model: j2, density: 2.7e-3, bulk modulus: 67549, shear modulus: 25902.2, yield stress: YIELD}"
LPS = "{formulation: ordinary, space: 3-D, lattice weights: plain, horizon: %s%s}"

problems = {}


def problem(name, material, body, peridynamics, loads, solve, watch, more="", files=None):
    """Adds a problem: `loads` and `watch` are lists of entries, `body` is the content of the block."""
    blocks(name, {"m": material}, {"b": f"material: m, {body}"}, peridynamics, loads, solve, watch, more, files)


def blocks(name, materials, body, peridynamics, loads, solve, watch, more="", files=None):
    """Adds a problem of several materials and blocks, by their names."""
    text = "units: {length: m, force: N, time: s}\nmaterials:\n"
    text += "".join(f"  {key}: {law}\n" for key, law in materials.items()) + "body:\n"
    text += "".join(f"  {key}: {{{block}}}\n" for key, block in body.items())
    text += f"peridynamics: {peridynamics}\n{more}loads:\n" + "".join(f"  - {{{load}}}\n" for load in loads)
    text += f"solve: {solve}\nwatch:\n" + "".join(f"  {entry}\n" for entry in watch)
    problems[name] = (text + "results: {number: 0}\npictures: []\n", files or {})


def lattice(spacing, particles, first, kind="cubic", more=""):
    """A block of particles on a lattice, by the place of its first one."""
    box = f"{{particles: {particles}, first particle: {first}}}"
    return f"lattice: {kind}, spacing: {spacing}, {more}shape: {{box: {box}}}"


def nearest(*place):
    return f"{{nearest: [{', '.join(repr(c) for c in place)}]}}"


def readings(places, quantities, every=1):
    """Watches of single particles: displacement1, velocity1, force1 ... of the places in turn."""
    words = {"displacement": "displacement of", "velocity": "velocity of", "force": "force on"}
    return [f"{q}{k + 1}: {{{words[q]}: {nearest(*place)}, every: {every}}}"
            for k, place in enumerate(places) for q in quantities]


def box(low, high):
    return f"{{inside: {{box: {{from: {low}, to: {high}}}}}}}"


# ---- two and three particles in a row ----

PAIR = [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
ROW = [(-1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
PAIR_BODY = "spacing: 2, file: pair.csv"
PAIR_FILE = {"pair.csv": "x,y,z,volume\n-1,0,0,2\n1,0,0,2\n"}
TOGETHER = [f"on: {nearest(x, 0, 0)}, initial velocity: {{translation: [{-x}, 0, 0]}}" for x in (-1.0, 1.0)]
STILL = "history: {table: [[0, 0], [2e-5, 1], [4e-5, 1]]}"  # moved to its place, where it stays until it is let go
BOTH = ("displacement", "velocity", "force")

problem("two particles", STEEL, PAIR_BODY, LPS % (2, ""), TOGETHER, "{explicit: {time step: 1e-5, steps: 5}}",
        readings(PAIR, BOTH) + ["books: {energy: yes, every: 1}"], files=PAIR_FILE)
problem("two particles let go", STEEL, PAIR_BODY, LPS % (2, ""),
        [f"name: push{k}, on: {nearest(x, 0, 0)}, displacement: [{-x * 1e-5}, 0, 0], {STILL}"
         for k, x in enumerate((-1.0, 1.0))],
        "[{explicit: {time step: 1e-5, steps: 4}}, {explicit: {time step: 1e-5, steps: 5}, without: [push0, push1]}]",
        readings(PAIR, BOTH), files=PAIR_FILE)
problem("two particles by Newmark", STEEL, PAIR_BODY, LPS % (2, ""), TOGETHER,
        "{implicit: {time step: 1e-5, end time: 5e-5, local error: 1e9, residual: 1e-13}}",
        readings(PAIR, BOTH), files=PAIR_FILE)
problem("three particles", STEEL, lattice(1, "[3, 1, 1]", "[-1, 0, 0]"), LPS % (1.1, ""),
        TOGETHER, "{explicit: {time step: 1e-5, steps: 5}}",
        readings(ROW[::2], ("displacement", "velocity")) + ["books: {energy: yes, every: 1}"])
# In a row that is strained evenly the deviator is nothing, and forces do not depend on the influence function.
problem("three particles by 1 over length", STEEL, lattice(1, "[3, 1, 1]", "[-1, 0, 0]"),
        LPS % (2.1, ", influence: inverse"), TOGETHER, "{explicit: {time step: 1e-6, steps: 5}}",
        readings(ROW[::2], BOTH) + ["books: {energy: yes, every: 1}"])
problem("stretched pair", STEEL, "spacing: 1, file: pair.csv", LPS % (1.1, ""),
        [f"on: {nearest(x, 0, 0)}, displacement: [{x}, 0, 0]" for x in (0.0, 1.0)],
        "{explicit: {time step: 1e-5, steps: 1}}",
        readings([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)], ("force",)),
        files={"pair.csv": "x,y,z,volume\n0,0,0,1\n1,0,0,1\n"})

# ---- pairs of which one tears ----

PAIRS = [(x, y, 0.5) for y in (0.5, 1.5) for x in (0.525, 1.575)]
SPEEDS = (-244.939, -244.959, 244.939, 244.959)
problem("pairs torn", STEEL.replace("78e9", "60e9"), "spacing: 1, file: pairs.csv", LPS % (1.01, ""),
        [f"on: {nearest(*place)}, initial velocity: {{translation: [0, {v}, 0]}}" for place, v in zip(PAIRS, SPEEDS)],
        "{explicit: {time step: 1e-8, steps: 8000}}", readings(PAIRS, ("displacement", "velocity"), 1000),
        more="failure: {critical stretch: 0.02}\n",
        files={"pairs.csv": "x,y,z,volume\n" + "".join(f"{x},{y},{z},1.05\n" for x, y, z in PAIRS)})

# ---- bodies that are strained evenly: bonds and the linear solid, forces on a third of the body ----

EVEN = "on: {all: yes}, field: {displacement: [%s]}"


def pulled(name, young, body, peridynamics, strain, ends):
    law = f"{{model: elastic-1d, density: 7800, Young modulus: {young!r}}}"
    problem(name, law, body, peridynamics, [EVEN % strain],
            "{static: {increments: 1}}", [f"low: {{force on: {ends[0]}}}", f"high: {{force on: {ends[1]}}}"])


BONDS = "{formulation: bond-based, calibration: continuum, horizon: 0.751, space: %s}"
pulled("bonds in space", 1.5 * 200e9, lattice(0.25, "[4, 24, 4]", "[-0.375, -2.875, -0.375]"), BONDS % "3-D",
       "0, 0.001 * y, 0", (box([-1, -3, -1], [1, -1.5, 1]), box([-1, 1.5, -1], [1, 3, 1])))
for space, factor in (("plane stress", 4 / 3), ("plane strain", 1.25)):
    pulled(f"bonds in {space}", factor * 200e9,
           lattice(0.25, "[4, 24]", "[-0.375, -2.875]", "square", "thickness: 0.25, "), BONDS % space,
           "0, 0.001 * y", (box([-1, -3], [1, -1.5]), box([-1, 1.5], [1, 3])))
problem("bar stretched evenly", "{model: elastic, density: 8.05, bulk modulus: 160e10, shear modulus: 79.3e10}",
        lattice(0.05, "[20, 5, 5]", "[-0.475, -0.1, -0.1]"), LPS % (0.1502, ""), [EVEN % "0.1 * x, 0, 0"],
        "{static: {increments: 1}}",
        ["low: {force on: {face: x-, layers: 6}}", "high: {force on: {face: x+, layers: 6}}"])

# ---- deformation gradients, of which a history has E = (F^T F - 1) / 2 ----

FLATTENED = f"{math.expm1(0.0953)!r} * x, {math.expm1(-0.0953)!r} * y, 0"
for name, field in (("flattened", FLATTENED), ("sheared", "0.05 * y, 0.05 * x, 0"),
                    ("sheared simply", "0.1 * y, 0, 0"), ("turned", "0.05 * y, -0.05 * x, 0")):
    problem(f"cube {name}", STEEL.replace("78e9", "60e9"),
            lattice(1.1 / 3, "[3, 3, 3]", f"[{-1.1 / 3}, {-1.1 / 3}, {-1.1 / 3}]"),
            "{formulation: correspondence, horizon: 5, zero-energy control: {none: yes}}", [EVEN % field],
            "{static: {increments: 1}}", ["middle: {stress and strain of: {nearest: [0, 0, 0]}}",
                                          "corner: {stress and strain of: {nearest: [-1, -1, -1]}}"])

# ---- waves and bodies at rest ----

GLASS = "{model: elastic, density: 2200, bulk modulus: 14.90e9, shear modulus: 8.94e9}"
BAR_PLACES = [(-0.02, 0.0, 0.0), (0.0, 0.0, 0.0), (0.02, 0.004, 0.004), (-0.01, 0.002, -0.004), (0.02, 0.0, 0.0)]
problem("wave in a bar", GLASS, lattice(0.002, "[21, 5, 5]", "[-0.02, -0.004, -0.004]"), LPS % (0.00601, ""),
        ["on: {face: x-, layers: 3}, initial velocity: {translation: [-100, 0, 0]}"],
        "{explicit: {time step: 9.0659e-08, steps: 220}}",
        readings(BAR_PLACES, ("displacement", "velocity", "force"), 20))

SIXTH = 1 / 6
END = 11.5 * SIXTH
SLENDER_PLACES = [(-11.5 * SIXTH, SIXTH, 0.0), (-SIXTH / 2, 0.0, 0.0), (SIXTH / 2, SIXTH, -SIXTH),
                  (7.5 * SIXTH, SIXTH, SIXTH), (6.5 * SIXTH, 0.0, SIXTH)]
EDGES = [("free, 0, free", "y-", x) for x in "-+"] + [("free, free, 0", "z-", x) for x in "-+"]
GRIPS = ([f"on: {{face: x{end}, layers: 4}}, displacement: [{end}0.02, free, free], history: {{ramp to: 1}}"
          for end in "-+"]
         + [f"on: {{all of: [{{face: {face}}}, {{face: x{end}}}]}}, displacement: [{held}]"
            for held, face, end in EDGES])
SOFT = "density: 8e-9, bulk modulus: 1.515e5, shear modulus: 7.813e4"
problem("bar between grips", f"{{model: elastic, {SOFT}}}",
        lattice(SIXTH, "[24, 3, 3]", f"[{-END}, {-SIXTH}, {-SIXTH}]"), LPS % (0.5025, ""), GRIPS,
        "{static: {increments: 2, residual: 1e-12}}", readings(SLENDER_PLACES, ("displacement", "force")))
# The right half has a law that could flow, and does not.
blocks("bar of two laws", {"left": f"{{model: elastic, {SOFT}}}", "right": f"{{model: j2, {SOFT}, yield stress: 1e5}}"},
       {name: f"material: {name}, " + lattice(SIXTH, "[12, 3, 3]", f"[{first}, {-SIXTH}, {-SIXTH}]")
        for name, first in (("left", -END), ("right", SIXTH / 2))}, LPS % (0.5025, ""), GRIPS,
       "{static: {increments: 2, residual: 1e-12}}", readings(SLENDER_PLACES, ("displacement", "force")))

BRICK_PLACES = [(-1.0, -0.5, -0.5), (1.0, -0.5, -0.5), (0.0, 0.5, -0.5),
                (-1.0, -0.5, 0.5), (1.0, -0.5, 0.5), (0.0, 0.5, 0.5)]
problem("brick pressed", STEEL, lattice(1, "[3, 2, 2]", "[-1, -0.5, -0.5]"), LPS % (1.75, ""),
        ["on: {face: x-}, displacement: [0, free, free]",
         "on: {face: x+}, displacement: [-0.1, free, free], history: {ramp to: 1}",
         f"on: {{any of: [{nearest(-1, -0.5, -0.5)}, {nearest(-1, 0.5, -0.5)}]}}, displacement: [free, free, 0]",
         f"on: {{any of: [{nearest(-1, -0.5, -0.5)}, {nearest(-1, -0.5, 0.5)}]}}, displacement: [free, 0, free]"],
        "{static: {increments: 20, residual: 1e-13}}", readings(BRICK_PLACES, ("displacement", "force")))

CORNER = nearest(-2, -2, -2)
AXES = [("free, 0, 0", "y-", "z-"), ("0, free, 0", "x-", "z-"), ("0, 0, free", "x-", "y-")]
problem("cube warmed", STEEL, lattice(1, "[5, 5, 5]", "[-2, -2, -2]"), LPS % (1.75, ""),
        [f"on: {CORNER}, displacement: [0, 0, 0]"]
        + [f"on: {{all of: [{{face: {a}}}, {{face: {b}}}], except: {CORNER}}}, displacement: [{held}]"
           for held, a, b in AXES]
        + ["on: {all: yes}, initial strain: 0.01"], "{static: {increments: 1, residual: 1e-13}}",
        readings([(2.0, 2.0, 2.0), (0.0, 0.0, 0.0)], ("displacement",)))

# ---- plastic flow ----

# The other program yields at ||t||^2 = 2 psi with psi = 25 Y^2 / (8 pi horizon^5), that of a whole ball of neighbours;
# here it is q^2 = m ||t||^2 / 5 with the m of the particle, 0.375 for each corner of this cube.
HORIZON, OF_CORNER = 1.75, 0.375
UNIAXIAL = 351.79 * (5 * OF_CORNER / (4 * math.pi * HORIZON ** 5)) ** 0.5
CUBE_PLACES = [(x, y, z) for z in (0.25, 0.75) for y in (0.25, 0.75) for x in (0.25, 0.75)]
problem("cube that flows", ALUMINIUM.replace("YIELD", repr(UNIAXIAL)), lattice(0.5, "[2, 2, 2]", "[0.25, 0.25, 0.25]"),
        LPS % (HORIZON, ""), [f"on: {{face: z{s}}}, initial velocity: {{translation: [0, 0, {s}200]}}" for s in "-+"],
        "{explicit: {time step: 1e-6, steps: 35000}}",
        readings([CUBE_PLACES[0], CUBE_PLACES[-1]], ("displacement", "velocity", "force"), 1000))
