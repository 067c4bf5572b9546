"""The decks of the relations: small bodies that meet, together, every formulation, law, solver, load and reading. quantities.py says how they are marked."""

import math

from quantities import parse_unit

FIELDS = ("displacement, velocity, stress, strain, deformation gradient, octahedral shear stress, octahedral shear strain, von Mises stress, deviator norm, "
          "mean stress, damage, internal force, block")
ROTATIONS = ", rotation, angular velocity, internal moment"

SOFT = "{model: elastic, density: 2 t/m3, Young modulus: 1e4 kPa, Poisson ratio: 0.2}"
BAR = "{model: elastic-1d, density: 2 t/m3, Young modulus: 1e4 kPa}"
PLATE = "{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.1 m, 0.2 m], to: V[0.9 m, 0.7 m]}}}}"
CUBE = "{b: {material: m, spacing: 0.1 m, shape: {box: {from: V[0.1 m, 0.2 m, -0.1 m], to: V[0.7 m, 0.6 m, 0.2 m]}}}}"
PLACES = {2: "selections:\n  left: {face: x-, layers: 2}\n  right: {face: x+, layers: 2}\n  corner: {nearest: V[0.85 m, 0.65 m]}\n"
             "  middle: {inside: {box: {from: V[0.3 m, 0.3 m], to: V[0.6 m, 0.6 m]}}}\n",
          3: "selections:\n  left: {face: x-, layers: 2}\n  right: {face: x+, layers: 2}\n  corner: {nearest: V[0.65 m, 0.55 m, 0.15 m]}\n"
             "  middle: {inside: {box: {from: V[0.2 m, 0.2 m, -0.1 m], to: V[0.5 m, 0.5 m, 0.2 m]}}}\n"}
GAPS = {2: "[V[0.35 m, 0.35 m], V[0.45 m, 0.45 m]]", 3: "[V[0.35 m, 0.35 m, 0.05 m], V[0.45 m, 0.45 m, 0.05 m]]"}
PULL = {2: "  - {name: grip, on: left, displacement: V[0, 0]}\n"
           "  - {name: pull, on: right, velocity: V[2 m/s, 0.8 m/s], history: {ramp to: 0.0125 s}}\n",
        3: "  - {name: grip, on: left, displacement: V[0, 0, 0]}\n"
           "  - {name: pull, on: right, velocity: V[2 m/s, 0.8 m/s, -1.2 m/s], history: {ramp to: 0.0125 s}}\n"}
STRETCH = {2: "  - {name: grip, on: left, displacement: V[0, 0]}\n"
              "  - {name: pull, on: right, displacement: V[0.004 m, 0.001 m], history: {ramp to: 1 s}}\n",
           3: "  - {name: grip, on: left, displacement: V[0, 0, 0]}\n"
              "  - {name: pull, on: right, displacement: V[0.004 m, 0.001 m, -0.002 m], history: {ramp to: 1 s}}\n"}
RUN = "{explicit: {time step: 3e-4 s, steps: 24}}"
REST = "{static: {end time: 1 s, increments: 3, residual: 1e-11}}"

decks = {}


def deck(name, dimensions=2, body=None, materials=None, material=SOFT, peridynamics="", loads=None, solve=RUN, more="", watch=None, fields=FIELDS, held=True,
         places=None, results="number: 1", variants=None, tolerance=1e-8, seen=True, axes=None, files=None, ways=(), cracks="", same=(), value=None):
    """A deck by name. variants: which relations it takes part in (u units, s scales, a axes); seen: with the usual readings."""
    if variants is None:  # scaling tells little beyond other units: of some decks only
        variants = "usa" if len(decks) % 5 == 0 else "ua"
    space = "space: plane strain" if dimensions == 2 else "space: 3-D, horizon: 2.015 spacings"
    if "space:" in peridynamics:
        space = ""
    text = "units: UNITS\n"
    text += f"materials: {materials or '{m: ' + material + '}'}\n"
    text += f"body: {body or (PLATE if dimensions == 2 else CUBE)}\n"
    text += places if places is not None else PLACES[dimensions]
    text += f"peridynamics: {{{peridynamics}{', ' if peridynamics and space else ''}{space}}}\n"
    text += cracks + more
    text += "loads:\n" + (loads if loads is not None else (REST and (STRETCH if "static" in solve else PULL)[dimensions]))
    text += f"solve: {solve}\n" if solve[0] != "\n" else f"solve:{solve}"
    text += "watch:\n  total: {displacement of: {all: yes}, every: 1}\n  books: {energy: yes, every: 1}\n"
    if seen:
        text += (f"  moved: {{displacement of: right, every: 1}}\n  fast: {{velocity of: right, every: 1}}\n  pulled: {{force on: right, every: 1}}\n"
                 f"  strained: {{stress and strain of: middle, every: 1}}\n  harmed: {{damage of: right, every: 1}}\n  gap: {{opening between: {GAPS[dimensions]}, every: 1}}\n"
                 f"  bond: {{bond between: {GAPS[dimensions]}, every: 1}}\n")
        if held:
            text += "  left: {reaction on: left, every: 1}\n"
    text += watch or ""
    text += f"profiles: {{layers: {{of: {{all: yes}}, along: x, every: 1}}}}\n"
    text += f"results: {{{results}, precision: double, fields: [{fields}]}}\npictures: []\n"
    decks[name] = {"text": text, "dimensions": dimensions, "variants": variants, "tolerance": tolerance, "files": files or {}, "axes": axes, "ways": ways, "same": same, "value": value}


GRIPS = "  grip: {reaction of: grip, every: 1}\n  pull: {reaction of: pull, every: 1}\n  value: {load: pull, every: 1}\n"

# ---- formulations, in the plane and in space, in motion and at rest

for space in ("plane strain", "plane stress"):
    short = space[6:]
    deck(f"correspondence {short}", peridynamics=f"space: {space}", watch=GRIPS, ways=("mass", "work", "derived", "moments", "lagrange"),
         same=[("Young modulus: 1e4 kPa, Poisson ratio: 0.2", "bulk modulus: 5555.555555555556 kPa, shear modulus: 4166.666666666667 kPa")])
    deck(f"correspondence small {short}", peridynamics=f"strain: small, zero-energy control: {{none: yes}}, space: {space}", solve=REST, watch=GRIPS,
         ways=("work", "derived", "hooke"))
    deck(f"ordinary {short}", peridynamics=f"formulation: ordinary, influence: conical, space: {space}", watch=GRIPS, ways=("mass", "work", "moments"))
    deck(f"hybrid {short}", peridynamics=f"formulation: hybrid, space: {space}", watch=GRIPS, ways=("mass", "work", "derived", "moments"))
    deck(f"micropolar {short}", peridynamics=f"formulation: micropolar, space: {space}", watch=GRIPS, fields=FIELDS + ROTATIONS, ways=("mass moved", "work"))
    deck(f"bonds {short}", material=BAR, peridynamics=f"formulation: bond-based, surface correction: energy, influence: gaussian, space: {space}", watch=GRIPS,
         ways=("mass", "work", "moments"))
deck("correspondence", 3, peridynamics="influence: quartic, zero-energy control: {wan: 0.1}", watch=GRIPS, ways=("mass", "work", "derived", "moments", "lagrange"))
deck("correspondence at rest", 3, solve=REST, watch=GRIPS, ways=("work", "derived"))
deck("ordinary", 3, peridynamics="formulation: ordinary, lattice weights: plain, volume correction: partial", watch=GRIPS, ways=("mass", "work", "moments"))
deck("ordinary at rest", 3, peridynamics="formulation: ordinary, influence: inverse", solve=REST, watch=GRIPS, ways=("work",))
deck("hybrid", 3, peridynamics="formulation: hybrid, strain: small, own bond: 0.8", watch=GRIPS, ways=("mass", "work", "derived", "moments"))
deck("hybrid at rest", 3, peridynamics="formulation: hybrid", solve=REST, watch=GRIPS, ways=("work", "derived"))
deck("pairwise", peridynamics="formulation: hybrid, form: pairwise", solve="{explicit: {time step: 1e-4 s, steps: 24, stiffness damping: 1e-4 s}}", watch=GRIPS)
deck("micropolar", 3, peridynamics="formulation: micropolar, torsion: 0.7", watch=GRIPS, fields=FIELDS + ROTATIONS, ways=("mass moved", "work"))
deck("micropolar at rest", 3, peridynamics="formulation: micropolar", solve=REST, watch=GRIPS, fields=FIELDS + ROTATIONS, ways=("work",))
deck("thesis", peridynamics="formulation: micropolar, kinematics: thesis", solve=REST, watch=GRIPS, fields=FIELDS + ROTATIONS)
deck("bonds", 3, material=BAR, peridynamics="formulation: bond-based, calibration: uniaxial, influence: cubic-spline", watch=GRIPS, ways=("mass", "work", "moments"))
deck("bonds at rest", 3, material=BAR, peridynamics="formulation: bond-based, calibration: continuum, influence: inverse-square, volume correction: partial-beyond",
     solve=REST, watch=GRIPS, ways=("work",))
deck("two regions", body="{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.1 m, 0.2 m], to: V[0.5 m, 0.7 m]}}},"
     " c: {material: n, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.5 m, 0.2 m], to: V[1 m, 0.7 m]}}}}",
     materials="{m: " + SOFT + ", n: {model: elastic, density: 3 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.1}}",
     peridynamics="regions: {far: {blocks: [c], formulation: ordinary}}", watch=GRIPS, ways=("work",))
deck("two regions of hybrid bonds", body="{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.1 m, 0.2 m], to: V[0.5 m, 0.7 m]}}},"
     " c: {material: n, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.5 m, 0.2 m], to: V[1 m, 0.7 m]}}}}",
     materials="{m: " + SOFT + ", n: {model: elastic, density: 3 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.1}}",
     peridynamics="regions: {far: {blocks: [c], formulation: hybrid}}", watch=GRIPS, ways=("work",), seen=True)
deck("unlike blocks", body="{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.1 m, 0.2 m], to: V[0.5 m, 0.7 m]}}},"
     " c: {material: n, lattice: square, spacing: 0.05 m, thickness: 0.2 m, shape: {box: {from: V[0.5 m, 0.2 m], to: V[1 m, 0.7 m]}}}}",
     materials="{m: " + SOFT + ", n: {model: elastic, density: 3 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.1}}",
     peridynamics="horizon: 0.21 m", solve="{explicit: {time step: 1e-4 s, steps: 20}}", watch=GRIPS, seen=False, places=PLACES[2], ways=("work",))
deck("bar", body="{b: {material: m, lattice: line, spacing: 0.1 m, area: 0.03 m2, shape: {box: {from: [0.1 m, 0], to: [1.1 m, 0.1 m]}}}}", material=BAR,
     peridynamics="formulation: bond-based, space: 1-D", places="", seen=False, variants="u", solve="{explicit: {end time: 0.01 s}}",
     loads="  - {on: {face: x-}, displacement: [0, 0]}\n  - {name: pull, on: {face: x+}, force: [0.3 kN, 0], history: {sine: {frequency: 120 Hz, phase: 30 deg}}}\n",
     watch="  end: {velocity of: {face: x+}, every: 1}\n  value: {load: pull, every: 1}\n")
deck("hexagons", body=PLATE.replace("square", "hexagonal"), peridynamics="formulation: micropolar, space: plane stress", watch=GRIPS, variants="u",
     fields=FIELDS + ROTATIONS, places=PLACES[2], seen=False)
deck("face-centred", 3, body="{b: {material: m, lattice: face-centred cubic, spacing: 0.1 m, shape: {box: {particles: [6, 4, 5]}}}}", peridynamics="space: 3-D, horizon: 1.6 spacings", watch=GRIPS, variants="u", seen=False)
deck("scattered", body="{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, file: points.csv}}", variants="u",
     files={"points.csv": lambda system: "x (mm),y,volume (cm3)\n" + "".join(
         f"{100 * i + 150 + 7 * ((i * j) % 3)},{(0.1 * j + 0.25 + 0.004 * ((i + 2 * j) % 5)) / parse_unit(system.names[0])[0]:.10g},{2000 + 10 * i}\n"
         for i in range(8) for j in range(5))},
     watch=GRIPS, seen=False)

# ---- laws

LAWS = {
    "j2": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, yield stress: 40 kPa, saturation stress: 60 kPa, saturation rate: 30, "
           "hardening modulus: 100 kPa, kinematic modulus: 300 kPa", "equivalent plastic strain"),
    "viscoelastic": ("density: 2 t/m3, Young modulus: 1e4 kPa, Poisson ratio: 0.3, relaxing share: 0.6, relaxation time: 0.002 s", ""),
    "multi-yield-j2": ("density: 2 t/m3, shear modulus: 6e3 kPa, bulk modulus: 1e4 kPa, octahedral strength: 20 kPa, surfaces: 8, peak octahedral strain: 0.02",
                       "active surface"),
    "cap": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, envelope strength: 60 kPa, envelope drop: 20 kPa, envelope rate: 0.01 1/kPa, "
            "envelope slope: 0.1, cap ratio: 2, cap position: 90 kPa, largest compaction: 0.4, compaction rate: 0.002 1/kPa, tension cut-off: 30 kPa", "cap parameter"),
    "drucker-prager": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, cohesion: 20 kPa, friction angle: 30 deg, dilation angle: 10 deg, "
                       "tension cut-off: 30 kPa, hardening modulus: 500 kPa, saturation gain: 10 kPa, saturation rate: 50", "equivalent plastic strain"),
    "mohr-coulomb": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, cohesion: 20 kPa, friction angle: 30 deg, dilation angle: 10 deg, "
                     "tensile strength: 15 kPa", ""),
    "bounding-surface-clay": ("density: 2 t/m3, shear modulus: 6e3 kPa, bulk modulus: 1e4 kPa, undrained strength: 30 kPa, hardening modulus: 6e3 kPa, "
                              "least hardening: 50 kPa", "distance to the bounding surface"),
    "damage-plasticity": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, tensile strength: 20 kPa, compressive strength: 150 kPa, "
                          "fracture energy: 0.08 kN/m, initial fracture energy: 0.03 kN/m, crushing energy: 5 kN/m",
                          "plastic strain in tension, plastic strain in compression, material damage"),
    "mazars": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, tensile strength: 20 kPa, fracture energy: 0.08 kN/m", "equivalent strain, material damage"),
    "link-damage": ("density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, tensile stretch: 0.001, fracture energy: 0.08 kN/m, compressive stretch: 0.002",
                    "tensile damage, compressive damage"),
}
for law, (parameters, names) in LAWS.items():
    deck(f"law {law}", material="{model: %s, %s}" % (law, parameters), fields=FIELDS + (", " + names if names else ""),
         peridynamics="formulation: hybrid" if law in ("drucker-prager", "j2") else "", solve="{explicit: {time step: 2e-4 s, steps: 40}}",
         watch=GRIPS + ("  past: {history of: middle, every: 1}\n" if names else ""), ways=("mass", "work", "derived"), variants="ua",
         loads="  - {name: grip, on: left, displacement: V[0, 0]}\n  - {name: pull, on: right, velocity: V[-1.5 m/s, 0.4 m/s], history: {table: [[0 s, 1], [0.004 s, 1], "
         "[0.0041 s, -1.5], [1 s, -1.5]]}}\n")
deck("law j2 of ordinary", material="{model: j2, density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, yield stress: 20 kPa}", peridynamics="formulation: ordinary",
     fields=FIELDS + ", equivalent plastic strain", watch=GRIPS + "  past: {history of: middle, every: 1}\n", ways=("mass", "work"))
deck("law viscoelastic of ordinary", material="{model: viscoelastic, %s}" % LAWS["viscoelastic"][0], peridynamics="formulation: ordinary, space: plane stress", watch=GRIPS)
deck("law link-damage of links", material="{model: link-damage, %s}" % LAWS["link-damage"][0].replace("0.08 kN/m", "8e-3 kN/m"), peridynamics="formulation: micropolar",
     watch=GRIPS, fields=FIELDS + ROTATIONS, ways=("work",))

FIBRES = {
    "elastic-brittle": "Young modulus: 1e4 kPa, tensile strength: 60 kPa",
    "bilinear-softening": "Young modulus: 1e4 kPa, tensile strength: 30 kPa, fracture energy: 0.1 kN/m",
    "trilinear-softening": "Young modulus: 1e4 kPa, tensile strength: 30 kPa, fracture energy: 0.1 kN/m",
    "exponential-softening": "Young modulus: 1e4 kPa, tensile strength: 30 kPa, fracture energy: 0.2 kN/m",
    "fib-concrete": "Young modulus: 1e4 kPa, tensile strength: 30 kPa, fracture energy: 0.2 kN/m, compressive strength: 50 kPa, peak strain: 0.01, crushing energy: 1 kN/m",
    "kent-scott-park": "compressive strength: 10 kPa, peak strain: 0.002, residual strength: 2 kPa",
    "concrete02": "compressive strength: 10 kPa, peak strain: 0.002, residual strength: 2 kPa, tensile strength: 3 kPa, tension softening: 500 kPa",
    "mander": "compressive strength: 10 kPa, peak strain: 0.002, Young modulus: 1e4 kPa, confining pressure: 1 kPa",
    "elastic-perfectly-plastic": "Young modulus: 1e4 kPa, yield stress: 30 kPa, compressive yield stress: 20 kPa",
    "steel-bilinear": "Young modulus: 1e4 kPa, yield stress: 30 kPa, hardening ratio: 0.05, compression shift: 0.1, tension shift: 0.2",
    "menegotto-pinto": "Young modulus: 1e4 kPa, yield stress: 30 kPa, hardening ratio: 0.05, roundness: 18",
}
NAMES = {"kent-scott-park": "largest compressive strain", "concrete02": "largest tensile strain", "mander": "largest compressive strain",
         "elastic-perfectly-plastic": "plastic strain", "steel-bilinear": "least strain", "menegotto-pinto": "largest strain"}
for law, parameters in FIBRES.items():
    deck(f"law {law}", material="{model: %s, density: 2 t/m3, %s%s}" % (law, parameters, ", largest strain: 0.02" if law == "steel-bilinear" else ""),
         peridynamics="formulation: bond-based", watch=GRIPS + "  past: {history of: middle, every: 1}\n", fields=FIELDS + ", " + NAMES.get(law, "bond damage"),
         solve="{explicit: {time step: 2e-4 s, steps: 40}}", ways=("mass", "work"), variants="u", tolerance=5e-3 if law == "menegotto-pinto" else 1e-8,  # where nothing moves the signs of roundings are reversals
         loads="  - {name: grip, on: left, displacement: V[0, 0]}\n  - {name: pull, on: right, velocity: V[1.5 m/s, 0.4 m/s], history: {table: [[0 s, 1], [0.004 s, 1], "
         "[0.0041 s, -1.5], [1 s, -1.5]]}}\n")

# ---- breaking, cuts and contact

CUT = "cracks: [{cut: {line: [V[0.4 m, 0.1 m], V[0.4 m, 0.4 m]]}}]\n"
FAST = PULL[2].replace("2 m/s, 0.8 m/s", "20 m/s, 6 m/s")
for name, criterion, peridynamics in (("critical stretch", "critical stretch: 0.01", ""), ("fracture energy", "fracture energy: 0.02 kN/m", "formulation: ordinary"),
                                      ("bond energy", "criterion: critical bond energy, fracture energy: 5e-3 kN/m", "formulation: ordinary"),
                                      ("bond energy itself", "criterion: critical bond energy, bond energy: 3 kN/m5", ""),
                                      ("bond stress", "criterion: critical bond stress, bond tensile strength: 90 kPa, bond shear strength: 60 kPa", "formulation: hybrid"),
                                      ("links break", "critical stretch: 0.01", "formulation: micropolar"),
                                      ("fibres break", "fracture energy: 0.02 kN/m", "formulation: bond-based")):
    deck(name, material=BAR if "bond-based" in peridynamics else SOFT, peridynamics=peridynamics, more="failure: {%s, near grips: break}\n" % criterion, cracks=CUT, loads=FAST,
         solve="{explicit: {time step: 1.5e-4 s, steps: 60}}", watch=GRIPS, tolerance=1e-6, ways=("work", "broken") + (("mass",) if "micropolar" not in peridynamics else ()))
for name, criterion, peridynamics, when in (("critical stretch", "critical stretch: 0.01", "", 0.00625),
                                            ("bond stress", "criterion: critical bond stress, bond tensile strength: 90 kPa", "formulation: hybrid", 0.0050415)):
    deck(f"first to break by {name}", peridynamics=peridynamics, more="failure: {%s, near grips: break}\n" % criterion, seen=False, variants="",
         loads="  - {name: pull, on: {all: yes}, field: {displacement: ['0.02 * x', 0]}, history: {ramp to: 0.0125 s}}\n",
         solve="{explicit: {time step: 5e-5 s, steps: 130}}", ways=("first",), value=when, tolerance=1e-6)
deck("no failure within", more="failure: {critical stretch: 0.01, near grips: break, no failure within: {of: right, distance: 0.15 m}}\n", cracks=CUT, loads=FAST,
     solve="{explicit: {time step: 1.5e-4 s, steps: 60}}", watch=GRIPS, tolerance=1e-6)
deck("breaking at rest", material=SOFT, more="failure: {critical stretch: 0.01, near grips: break}\n", cracks=CUT, peridynamics="formulation: ordinary",
     loads=STRETCH[2].replace("0.004 m", "0.02 m"), solve="{static: {end time: 1 s, increments: 4, residual: 1e-11}}", watch=GRIPS, ways=("broken",))
# ---- bars, two that are parallel and one across; one of each kind slips

STEEL = "{m: " + SOFT + ", s: {model: steel-bilinear, density: 7 t/m3, Young modulus: 2e6 kPa, yield stress: 4 MPa, hardening ratio: 0.01}}"
BARS = ("bars:\n"
        "  long: {material: s, points: [V[0.15 m, 0.35 m], V[0.85 m, 0.5 m]], diameter: 0.02 m, number: 2}\n"
        "  short: {material: s, points: [V[0.45 m, 0.25 m], V[0.55 m, 0.65 m]], area: 2e-4 m2}\n")
SLIPPING = BARS.replace("number: 2", "number: 2, bond: {law: linear, stiffness: 2e4 kN/m3}, bonded: [0.1 m, 0.6 m], anchored: [start]").replace(
    "area: 2e-4 m2", "area: 2e-4 m2, bond: {law: fib, compressive strength: 30 MPa, rib spacing: 8 mm}")
deck("bars", materials=STEEL, more=BARS, watch=GRIPS, ways=("work", ))
deck("bars at rest", materials=STEEL.replace("4 MPa", "40 MPa"), more=BARS, solve=REST, watch=GRIPS, ways=("work", ))
deck("bars that slip", materials=STEEL, more=SLIPPING, watch=GRIPS, ways=("work", ))
deck("bars that slip at rest", materials=STEEL, more=SLIPPING, solve=REST, watch=GRIPS, ways=("work", ))

deck("notch", cracks="cracks: [{remove: {box: {from: V[0.4 m, 0.1 m], to: V[0.5 m, 0.4 m]}}, cut faces: yes}]\n", watch=GRIPS)
deck("cut in space", 3, cracks="cracks: [{cut: {polygon: [V[0.4 m, 0.1 m, -0.2 m], V[0.4 m, 0.4 m, -0.2 m], V[0.4 m, 0.4 m, 0.3 m], V[0.4 m, 0.1 m, 0.3 m]]}}]\n", watch=GRIPS,
     variants="u")
TWO = ("{b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: V[0.1 m, 0.2 m], to: V[0.5 m, 0.7 m]}}},"
       " c: {material: m, lattice: square, spacing: 0.05 m, thickness: 0.2 m, shape: {box: {from: V[0.505 m, 0.3 m], to: V[0.905 m, 0.6 m]}}}}")
for name, contact, ways in (("impact", "{}", ()), ("friction", "{stiffness: 0.7, friction: 0.3}", ("slides",))):
    deck(name, body=TWO, cracks="cracks: [{cut: {line: [V[0.5025 m, 0.1 m], V[0.5025 m, 0.8 m]]}}]\n", peridynamics="formulation: ordinary, horizon: 0.2 m", more=f"contact: {contact}\nfailure: {{critical stretch: 0.05}}\n", places="", seen=False,
         loads="  - {on: {block: b}, initial velocity: {translation: V[1 m/s, %s m/s]}}\n" % (3 if ways else 0.6), solve="{explicit: {time step: 1e-4 s, steps: 60}}", ways=ways,
         watch="  first: {velocity of: {block: b}, every: 1}\n  second: {velocity of: {block: c}, every: 1}\n")
deck("closing cut", cracks=CUT, more="contact: {friction: 0.2}\n", loads=PULL[2].replace("2 m/s", "-3 m/s"), watch=GRIPS, ways=("mass", "work"))
deck("closing cut at rest", cracks=CUT, more="contact: {friction: 0.2}\n", loads=STRETCH[2].replace("0.004 m", "-0.004 m"), watch=GRIPS, solve=REST, ways=("work",))
deck("closing cut in implicit steps", cracks=CUT, more="contact: {}\n", loads=PULL[2].replace("2 m/s", "-3 m/s"), watch=GRIPS, tolerance=1e-6,
     solve="{implicit: {end time: 0.006 s, time step: 0.001 s, local error: 1, residual: 1e-11}}", ways=("work",))

# ---- loads, supports and what joins bodies

GRIP = "  - {name: grip, on: left, displacement: V[0, 0]}\n"
GRIP3 = "  - {name: grip, on: left, displacement: V[0, 0, 0]}\n"
# The same load in other words, and factors of histories by hand.
SAID = {"body force": [("phase: 40 deg, from: 0.001 s, until: 0.006 s", "phase: -320 deg, from: 0.001 s, until: 0.006 s"), ("body force: V[3 kN/m3, -5 kN/m3]", "gravity: V[1.5 m/s2, -2.5 m/s2]")],
        "gravity": [("gravity: V[1 m/s2, -9.81 m/s2]", "on: {all: yes}, body force: V[2 kN/m3, -19.62 kN/m3]")],
        "pressure": [("pressure: 20 kPa", "traction: V[-20 kPa, 0]")],
        "traction": [("spread: layers, traction: V[20 kPa, -7 kPa]", "force: V[2 kN, -0.7 kN]")],
        "traction of an area": [("area: 0.013 m2, traction: V[20 kPa, -7 kPa]", "force: V[0.26 kN, -0.091 kN]")],
        "along": [("direction: V[3, -1], velocity: 0.4 m/s", "direction: V[6, -2], velocity: 0.4 m/s")],
        "acceleration": [("acceleration: V[90 m/s2, free], history: {ramp to: 0.003 s}", "acceleration: V[180 m/s2, free], history: {table: [[0 s, 0], [0.003 s, 0.5]]}")],
        "spring": [("direction: V[1, 2]", "direction: V[3, 6]")],
        "dashpots": [("{outcrop velocity", "{density: 2 t/m3, shear wave speed: 45.64354645876384 m/s, compression wave speed: 74.53559924999299 m/s, outcrop velocity"),
                     ("V[0.2 m/s, 0.1 m/s]}", "V[0.4 m/s, 0.2 m/s]}"), ("history: {sine: {frequency: 80 Hz}}", "history: {product: [{sine: {frequency: 80 Hz}}, {table: [[0 s, 0.5]]}]}")],
        "tie to others": [("directions: x", "directions: x")]}


def ramp(t, end):
    return min(t / end, 1)


def sine(t, frequency, phase):
    return math.sin(2 * math.pi * frequency * t + math.radians(phase))


VALUES = {"force": lambda t: 500 * t if t < 0.002 else 1 - (t - 0.002) / 0.016, "body force": lambda t: sine(t - 0.001, 90, 40) if 0.001 <= t <= 0.006 else 0,
          "gravity": lambda t: ramp(t, 0.003) * sine(t, 50, 90), "base acceleration": lambda t: ramp(t, 0.003) + sine(t, 50, 0) * min(500 * t, 2),
          "pressure": lambda t: ramp(t, 0.002), "dashpots": lambda t: sine(t, 80, 0)}
ONE = "  grip: {reaction of: grip, every: 1}\n  value: {load: it, every: 1}\n"
for name, load in (("force", "on: corner, force: V[0.2 kN, -0.1 kN], history: {table: [[0 s, 0], [0.002 s, 1], [0.01 s, 0.5]]}"),
                   ("body force", "on: {all: yes}, body force: V[3 kN/m3, -5 kN/m3], history: {sine: {frequency: 90 Hz, phase: 40 deg, from: 0.001 s, until: 0.006 s}}"),
                   ("gravity", "gravity: V[1 m/s2, -9.81 m/s2], history: {product: [{ramp to: 0.003 s}, {sine: {frequency: 50 Hz, phase: 90 deg}}]}"),
                   ("base acceleration", "base acceleration: V[3 m/s2, -2 m/s2], history: {sum: [{ramp to: 0.003 s}, {sine: {frequency: 50 Hz, "
                    "envelope: [[0 s, 0], [0.004 s, 2]]}}]}"),
                   ("pressure", "on: {face: x+}, pressure: 20 kPa, history: {ramp to: 0.002 s}"),
                   ("traction", "on: {face: x+, layers: 2}, spread: layers, traction: V[20 kPa, -7 kPa], history: {ramp to: 0.002 s}"),
                   ("traction of layers", "on: right, traction: V[20 kPa, -7 kPa]"),
                   ("traction of an area", "on: corner, area: 0.013 m2, traction: V[20 kPa, -7 kPa]"),
                   ("radial pressure", "on: right, radial pressure: {pressure: 20 kPa, area: 0.1 m2, centre: V[0.4 m, 0.3 m]}"),
                   ("initial velocity", "on: right, initial velocity: {translation: V[0.2 m/s, -0.1 m/s], rotation: [0, 0, ROTATED rad/s], about: V[0.8 m, 0.4 m]}"),
                   ("initial strain", "on: right, initial strain: -0.002, history: {ramp to: 0.002 s}"),
                   ("along", "on: right, along: {direction: V[3, -1], velocity: 0.4 m/s}, history: {ramp to: 0.003 s}"),
                   ("acceleration", "on: right, acceleration: V[90 m/s2, free], history: {ramp to: 0.003 s}"),
                   ("spring", "on: right, spring: {stiffness: 300 kN/m, direction: V[1, 2]}"),
                   ("spring to others", "on: right, spring: {stiffness: 300 kN/m, to: middle}"),
                   ("dashpots", "on: {face: x+}, dashpots: {outcrop velocity: V[0.2 m/s, 0.1 m/s]}, history: {sine: {frequency: 80 Hz}}"),
                   ("dashpots of other ground", "on: {face: y+}, dashpots: {density: 3 t/m3, shear wave speed: 50 m/s, compression wave speed: 90 m/s}"),
                   ("tie", "on: right, tie: {}"), ("tie to others", "on: {face: x+}, tie: {to: middle, directions: x}")):
    pushed = name in ("spring", "spring to others", "dashpots of other ground", "tie", "tie to others")
    deck(f"load {name}", loads=GRIP + "  - {name: it, " + load.replace("ROTATED", "1.5") + "}\n" + (
        "  - {on: {face: y+}, traction: V[10 kPa, 30 kPa], history: {ramp to: 0.002 s}}\n" if pushed else ""), watch=ONE,
         ways=("mass", "moments"), same=SAID.get(name, ()), value=VALUES.get(name))
GROUND = (("water", "on: {face: x+}, water pressure: {surface: 0.65 m, unit weight: 10 kN/m3}"), )
for name, load in GROUND:
    deck(f"load {name}", loads=GRIP + "  - {name: it, " + load + "}\n", watch=ONE, variants="u", ways=("water",))
deck("weight at rest", loads=GRIP + "  - {name: it, gravity: V[1 m/s2, -9.81 m/s2]}\n", solve=REST, watch=ONE, ways=("weighs", "derived"))
deck("load moment", peridynamics="formulation: micropolar", loads=GRIP + "  - {name: it, on: right, moment: [0, 0, 0.02 kN*m]}\n  - {on: corner, rotation: [0, 0, 2 deg], history: {ramp to: 0.005 s}}\n",
     watch=ONE, fields=FIELDS + ROTATIONS, axes="turn", ways=("mass moved",))
deck("load moment in space", 3, peridynamics="formulation: micropolar", loads=GRIP3 + "  - {name: it, on: right, moment: A[0.01 kN*m, 0.03 kN*m, -0.02 kN*m]}\n"
     "  - {on: corner, rotation: A[2 deg, free, -1 deg], history: {ramp to: 0.005 s}}\n", watch=ONE, fields=FIELDS + ROTATIONS)
deck("load radial pressure in space", 3, loads=GRIP3 + "  - {name: it, on: right, radial pressure: {pressure: 20 kPa, area: 0.1 m2, centre: V[0.4 m, 0.3 m, 0], axis: V[1, 0, 2]}}\n",
     watch=ONE)
deck("load initial velocity in space", 3, peridynamics="formulation: micropolar", fields=FIELDS + ROTATIONS, watch=ONE, loads=GRIP3 + "  - {name: it, on: right, initial velocity: "
     "{translation: V[0.2 m/s, -0.1 m/s, 0.3 m/s], rotation: A[1.5 rad/s, 0.5 rad/s, -1 rad/s]}}\n")
for held in ("all", "across", "periodic"):
    other = "  - {name: it, on: corner, force: V[0.2 kN, -0.1 kN]}\n"
    deck(f"support {held}", loads="  - {name: grip, on: {face: x-}, support: {held: %s%s}}\n" % (held, ", displacement: V[0.001 m, 0.0005 m]" if held == "all" else "") + other
         + ("  - {on: {face: y-}, displacement: V[0, 0]}\n" if held != "all" else ""), watch="  value: {load: it, every: 1}\n" + (
             "  grip: {reaction of: grip, every: 1}\n" if held != "periodic" else ""), seen=False, ways=("derived",))
deck("roller", loads="  - {name: grip, on: left, roller: V[1, 2]}\n  - {on: {nearest: V[0.85 m, 0.25 m]}, displacement: V[0, 0]}\n"
     "  - {name: it, on: corner, force: V[0.2 kN, -0.1 kN], history: {ramp to: 1 s}}\n", solve=REST, watch=ONE)
deck("field", loads="  - {name: pull, on: right, field: {displacement: ['0.01 * y', '0.002 * x']}, history: {ramp to: 0.005 s}}\n" + GRIP, watch=GRIPS, variants="u")
deck("reaction of", solve="\n  - {static: {end time: 1 s, increments: 1, residual: 1e-11}}\n  - {explicit: {time step: 3e-4 s, steps: 12}, displacements: zero, "
     "loads: [{reaction of: pull, history: {table: [[0 s, 1], [0.003 s, 0]]}}]}\n", loads=STRETCH[2], watch=GRIPS.replace("  value: {load: pull, every: 1}\n", ""))
deck("initial stress", more="initial stress: {stress: S[-30 kPa, -50 kPa, -20 kPa, 5 kPa, 0, 0]}\n", loads=GRIP, watch="  grip: {reaction of: grip, every: 1}\n")
deck("ground at rest", more="initial stress: {surface: 0.7 m, K0: 0.6, surcharge: 3 kPa}\n", loads="  - {on: {face: y-}, support: {held: across}}\n  - {on: left, displacement: [0, free]}\n  - {on: right, displacement: [0, free]}\n"
     "  - {gravity: [0, -9.81 m/s2]}\n  - {on: {face: y+}, pressure: 3 kPa}\n", seen=False, variants="u", ways=("still",))

# ---- solvers

RATES = {"mass damping": [("{ratio: 0.2, at: 30 Hz}", "75.39822368615503 1/s")],
         "Rayleigh damping": [("Rayleigh damping: {ratio: 0.05, from: 20 Hz, to: 300 Hz}", "damping: 11.780972450961725 1/s, stiffness damping: 4.973591971621729e-05 s")],
         "Newmark with gamma": [("Rayleigh damping: {ratio: 0.05, from: 20 Hz, to: 300 Hz}", "damping: 11.780972450961725 1/s, stiffness damping: 4.973591971621729e-05 s")]}
for name, solve in (("mass damping", "{explicit: {time step: 3e-4 s, steps: 24, damping: {ratio: 0.2, at: 30 Hz}}}"), ("damping rate", "{explicit: {time step: 3e-4 s, steps: 24, damping: 40 1/s}}"),
                    ("Rayleigh damping", "{explicit: {time step: 1e-4 s, steps: 24, Rayleigh damping: {ratio: 0.05, from: 20 Hz, to: 300 Hz}}}"),
                    ("stiffness damping", "{explicit: {time step: 1e-4 s, steps: 24, stiffness damping: 2e-4 s}}"),
                    ("local damping", "{explicit: {time step: 3e-4 s, steps: 24, local damping: 0.6, rest: 1e-3}}"),
                    ("Newmark", "{implicit: {end time: 0.006 s, time step: 0.001 s, local error: 0.05, residual: 1e-11}}"),
                    ("Newmark with gamma", "{implicit: {end time: 0.006 s, time step: 0.001 s, local error: 1, gamma: 0.6, beta: 0.31, residual: 1e-11, Rayleigh damping: {ratio: 0.05, from: 20 Hz, to: 300 Hz}}}"),
                    ("HHT", "{implicit: {end time: 0.006 s, time step: 0.001 s, local error: 1, scheme: HHT, alpha: -0.1, residual: 1e-11, damping: 20 1/s}}")):
    deck(name, solve=solve, watch=GRIPS, ways=("mass", "work") + (("damped",) if name in ("mass damping", "damping rate") else ()), same=RATES.get(name, ()), tolerance=1e-8 if "explicit" in solve else 1e-6)
for name, rest in (("conjugate gradients", "increments: 2, equations: conjugate gradients, residual: 1e-10"), ("minimal residuals", "increments: 2, equations: minimal residuals, residual: 1e-10"),
                   ("relaxation", "increments: 2, method: relaxation, residual: 1e-7"), ("tolerances", "increments: 2, displacement tolerance: 1e-9, energy tolerance: 1e-12")):
    deck(name, solve="{static: {end time: 1 s, %s}}" % rest, watch=GRIPS, ways=("work",), tolerance=1e-5)
PUSH = "  - {name: it, on: corner, force: V[0.2 kN, -0.1 kN], history: {controlled: yes}}\n"
for name, control in (("control opening", f"opening between: {GAPS[2]}, to: 1e-5 m"), ("control displacement", "displacement of: corner, direction: V[1, 1], to: 0.001 m"),
                      ("control stretch", "stretch in: middle, to: 0.001"), ("control arc length", "arc length of: right, to: 0.001 m")):
    deck(name, loads=GRIP + PUSH, solve="{static: {end time: 1 s, increments: 2, residual: 1e-11, control: {%s}}}" % control, watch=ONE, tolerance=1e-6)
deck("stages", loads=GRIP, solve="\n  - {name: weight, static: {end time: 1 s, increments: 1}, laws: elastic, loads: [{name: weight, gravity: V[1 m/s2, -9.81 m/s2]}]}\n"
     "  - {name: quake, explicit: {time step: 3e-4 s, steps: 10}, displacements: zero, loads: [{name: it, on: right, velocity: V[0.4 m/s, free], history: {ramp to: 0.002 s}}]}\n"
     "  - {name: calm, implicit: {end time: 0.002 s, time step: 5e-4 s, local error: 1}, without: [it]}\n", watch=ONE, tolerance=1e-6)
