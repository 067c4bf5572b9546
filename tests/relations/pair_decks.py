"""Decks of the tables of pairs: a deck takes one level of each factor; a small body of two blocks combines all levels.

Decks mark units and axes as in quantities.py. A restated deck describes the same body in another way: it lists
materials, blocks, loads and watches in reverse order, and divides a block of one material into two blocks of two
materials with equal parameters."""

import random

TIME = 6e-3  # end of all runs (s); a compression wave travels half the length of the body until then
SIZES = {"small": 1.0, "large": 40.0}  # of loads: strains of about 0.25 % and 10 %

FACTORS = {
    "formulation": ("correspondence", "small strain", "ordinary", "hybrid", "micropolar", "bonds", "mixed"),
    "space": ("strain", "stress", "3-D"),
    "materials": ("one", "contrast", "fine", "laws"),
    "solver": ("explicit", "Newmark", "HHT", "Newton", "loose", "relaxation", "quasi-static", "stages"),
    "damping": ("none", "mass", "stiffness", "both", "local"),
    "boundary": ("pull", "guide", "set", "force", "tie", "spring", "mirror", "dashpots", "shake"),
    "extra": ("none", "bars", "slip", "contact", "breaking", "prestress", "swelling", "spin"),
    "size": ("small", "large"),
    "sign": ("+", "-"),
}

# Relations of the sample: a deck passes through one of them. The whole table applies both to each deck.
RELATIONS = {"relation": ("restatement", "restart")}

# Groups of factors whose pairs of levels the sample contains: state of the solver across a restart, laws of two
# materials across a joint, and signs of loads with signs of strains and stresses at first.
DANGEROUS = (
    ("solver", "damping", "boundary", "relation"),
    ("formulation", "materials"),
    ("sign", "extra"),
)

AT_REST = ("Newton", "loose", "relaxation")
DAMPED = ("mass", "stiffness", "both", "local")

# Levels that exclude each other, with the reason. A case is excluded if it has a level of every factor of an entry.
EXCLUDED = (
    ({"solver": AT_REST, "damping": DAMPED}, "static increments have no velocities to damp"),
    ({"solver": AT_REST, "boundary": ("dashpots",)}, "dashpots exert no force without velocities"),
    ({"solver": AT_REST, "extra": ("spin",)}, "static increments take no initial velocity"),
    ({"solver": ("quasi-static",), "damping": DAMPED}, "the quasi-static solver chooses the damping itself"),
    ({"solver": ("Newmark", "HHT"), "damping": ("local",)}, "the implicit solver has no local damping"),
    (
        {"damping": ("local",), "relation": ("restatement",)},
        "local damping follows the signs of velocities, which round-off decides where a particle is at rest",
    ),
    (
        {"formulation": ("ordinary", "micropolar", "bonds", "mixed"), "extra": ("prestress",)},
        "only correspondence and hybrid families take an initial stress tensor",
    ),
    (
        {"materials": ("laws",), "extra": ("prestress",)},
        "the stress at first would shift the strain at which a law yields and so the size of all loads",
    ),
    (
        {"solver": ("explicit", "stages"), "damping": ("stiffness", "both"), "extra": ("bars", "slip", "contact")},
        "explicit stiffness damping covers neither bars nor contact; the deck is refused",
    ),
    (
        {"formulation": ("ordinary", "mixed", "bonds"), "materials": ("laws",), "extra": ("swelling",)},
        "the yielding and viscous laws of these formulations take no free strains; the deck is refused",
    ),
    (
        {"solver": AT_REST, "extra": ("breaking",), "boundary": ("force", "tie", "spring", "mirror", "shake")},
        "a force beyond the strength of the body has no equilibrium",
    ),
    (
        {"solver": AT_REST, "formulation": ("micropolar",), "materials": ("laws",)},
        "a force beyond the strength of softening links has no equilibrium",
    ),
    (
        {"solver": ("loose",), "extra": ("contact",)},
        "contact converges linearly: forces that this energy tolerance leaves out of balance show in sums of reactions",
    ),
    (
        {"solver": (*AT_REST, "stages"), "extra": ("contact",), "size": ("large",)},
        "an iteration of contact leaves an error of the size of the strain: 10 % of strain need small increments",
    ),
    (
        {"solver": AT_REST, "boundary": ("shake",), "size": ("large",)},
        "the body force of this acceleration crushes the body: no equilibrium",
    ),
    ({"materials": ("fine",), "space": ("3-D",)}, "too many particles for a small test"),
    (
        {"materials": ("fine",), "formulation": ("bonds",)},
        "bonds between lattices of two spacings have no surface correction; the deck is refused",
    ),
    ({"materials": ("fine",), "boundary": ("mirror",)}, "the faces of a support belong to one lattice"),
)


def allowed(case, factor, level):
    """Returns true if a case, complete or not, may have a level of another factor."""
    case = dict(case, **{factor: level})
    return not any(all(case.get(f) in levels for f, levels in item.items()) for item, _ in EXCLUDED)


def pair(f, a, g, b):
    return (f, a, g, b) if f < g else (g, b, f, a)


def pairs_of(case):
    return {pair(f, a, g, b) for f, a in case.items() for g, b in case.items() if f < g}


def all_pairs(factors):
    """Returns all pairs of levels of two factors that do not exclude each other."""
    return {
        pair(f, a, g, b)
        for f in factors
        for g in factors
        if f < g
        for a in factors[f]
        for b in factors[g]
        if allowed({f: a}, g, b)
    }


def completed(case, missing, factors, generator):
    """Completes a case factor by factor with the allowed level that adds the most missing pairs.

    @return None where no level is allowed
    """
    others = [name for name in factors if name not in case]
    generator.shuffle(others)
    for name in others:
        levels = [level for level in factors[name] if allowed(case, name, level)]
        if not levels:
            return None
        generator.shuffle(levels)
        case[name] = max(levels, key=lambda level: sum(pair(name, level, g, b) in missing for g, b in case.items()))
    return case


def covering_array(seed, factors, missing, tries=20):
    """Finds cases that contain all missing pairs of levels of two factors, by greedy search.

    Of several cases that begin with a missing pair each, the search takes the one with the most missing pairs. A seed
    gives the same cases on every machine.
    """
    generator, cases = random.Random(seed), []
    while missing:
        ordered = sorted(missing)
        found = []
        for _ in range(tries):
            f, a, g, b = generator.choice(ordered)
            case = completed({f: a, g: b}, missing, factors, generator)
            if case:
                found.append(case)
        best = max(found, key=lambda case: len(pairs_of(case) & missing))
        cases.append(best)
        missing = missing - pairs_of(best)
    return cases


def table(seed):
    """Returns cases that contain every allowed pair of levels of all factors."""
    return covering_array(seed, FACTORS, all_pairs(FACTORS))


def sample(seed):
    """Returns cases in the plane, with a relation each, that contain the pairs of levels of dangerous factors."""
    factors = dict(FACTORS, space=("strain", "stress"), **RELATIONS)
    together = [set(group) for group in DANGEROUS]
    wanted = {p for p in all_pairs(factors) if any({p[0], p[2]} <= group for group in together)}
    return covering_array(seed, factors, wanted)


# ---- decks ----

FIELDS = "displacement, velocity, stress, strain, damage, internal force, block"
ROTATIONS = ", rotation, angular velocity, internal moment"

LAWS = {
    "j2": (
        "model: j2, density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, yield stress: YIELD, hardening"
        " modulus: 1000 kPa, kinematic modulus: 3000 kPa"
    ),
    "j2 of families": "model: j2, density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.3, yield stress: YIELD",
    "viscoelastic": (
        "model: viscoelastic, density: 6 t/m3, Young modulus: 4e4 kPa, Poisson ratio: 0.2, relaxing share: 0.6,"
        " relaxation time: 0.002 s"
    ),
    "drucker-prager": (
        "model: drucker-prager, density: 6 t/m3, Young modulus: 4e4 kPa, Poisson ratio: 0.3, cohesion: YIELD, friction"
        " angle: 20 deg, dilation angle: 10 deg, hardening modulus: 2000 kPa"
    ),
    "link-damage": (
        "model: link-damage, density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, tensile stretch: STRETCH,"
        " fracture energy: TOUGHNESS"
    ),
    "elastic": "model: elastic, density: 6 t/m3, Young modulus: 4e4 kPa, Poisson ratio: 0.1",
    "steel-bilinear": (
        "model: steel-bilinear, density: 2 t/m3, Young modulus: 2e4 kPa, yield stress: YIELD, hardening ratio: 0.2"
    ),
    "elastic-1d": "model: elastic-1d, density: 6 t/m3, Young modulus: 4e4 kPa",
}
LAWS_OF = {
    "correspondence": ("j2", "viscoelastic"),
    "small strain": ("j2", "viscoelastic"),
    "ordinary": ("j2 of families", "viscoelastic"),
    "hybrid": ("j2", "drucker-prager"),
    "micropolar": ("link-damage", "elastic"),
    "bonds": ("steel-bilinear", "elastic-1d"),
    "mixed": ("j2", "viscoelastic"),
}
PERIDYNAMICS = {
    "correspondence": "influence: conical",
    "small strain": "strain: small",
    "ordinary": "formulation: ordinary",
    "hybrid": "formulation: hybrid",
    "micropolar": "formulation: micropolar",
    "bonds": "formulation: bond-based, surface correction: energy",
    "mixed": "regions: {far: {blocks: [c], formulation: ordinary}}",
}
DAMPING = {
    "none": "",
    "mass": ", damping: 60 1/s",
    "stiffness": ", stiffness damping: 6e-5 s",
    "both": ", damping: 40 1/s, stiffness damping: 4e-5 s",
    "local": ", local damping: 0.4",
}
RATE = {"mass": 60.0, "both": 40.0}
EXPLICIT = "explicit: {time step: 3e-4 s, steps: 20%s}"
IMPLICIT = "implicit: {end time: 6e-3 s, time step: 1.5e-3 s, local error: 1, residual: 1e-11%s}"
SOLVERS = {
    "explicit": EXPLICIT,
    "Newmark": IMPLICIT,
    "HHT": IMPLICIT.replace("local error", "scheme: HHT, alpha: -0.1, local error"),
    "Newton": "static: {end time: 6e-3 s, increments: 2, residual: 1e-10%s}",
    "loose": "static: {end time: 6e-3 s, increments: 2, residual: 1e-3, energy tolerance: 1e-18%s}",
    "relaxation": (
        "static: {end time: 6e-3 s, increments: 2, method: relaxation, residual: 1e-9, relaxation iterations: 5000%s}"
    ),
    "quasi-static": "explicit: {time step: 3e-4 s, quasi-static: {period: 5e-3 s, ramp: 0.8, hold: 0.4}%s}",
    "stages": EXPLICIT,
}
STEPS = {"explicit": 9, "quasi-static": 9, "stages": 8}  # before a restart; implicit and static solvers: 1


class Deck:
    """The deck of a case, with the sizes, densities and loads that its relations need."""

    def __init__(self, case, name):
        self.case, self.name = case, name
        self.dimensions = 3 if case["space"] == "3-D" else 2
        self.size = SIZES[case["size"]] * (-1 if case["sign"] == "-" else 1)
        self.blocks = 1 if case["materials"] == "one" and case["formulation"] != "mixed" else 2
        # Division into two blocks changes results of 'ordinary', where the weights of a lattice end with its block, and
        # of contact, whose stiffness follows from the largest family of a block.
        self.splits = self.blocks == 1 and case["formulation"] != "ordinary" and case["extra"] != "contact"
        self.density = {"b": 2.0, "c": 2.0 if case["materials"] == "one" else 6.0}
        self.moves = case["solver"] not in AT_REST
        self.forces = []  # names and vectors of forces (kN), which their histories multiply

    def vector(self, *parts):
        """Returns a vector of components in a unit, as V[...]."""
        parts, unit = parts[: self.dimensions], parts[-1]
        return "V[" + ", ".join(f"{p:.10g} {unit}" for p in parts) + "]"

    def point(self, x, y, z):
        return f"V[{x:.10g} m, {y:.10g} m" + (f", {z:.10g} m]" if self.dimensions == 3 else "]")

    def spacing(self, block):
        return 0.05 if self.case["materials"] == "fine" and block == "c" else 0.1

    def box(self, low, high):
        return "{box: {from: %s, to: %s}}" % (self.point(*low), self.point(*high))

    def materials(self, restated):
        case, strain = self.case, abs(self.size) * 1e-3 / 0.4
        line = case["formulation"] == "bonds"
        if case["materials"] == "laws":
            laws = LAWS_OF[case["formulation"]]
        else:
            laws = ("elastic-1d" if line else "elastic",) * 2
        parts = []
        for name, law in zip("mn", laws):
            text = (
                LAWS[law]
                .replace("YIELD", f"{2e4 * strain * 0.5:.6g} kPa")
                .replace("STRETCH", f"{0.7 * strain:.6g}")
                .replace("TOUGHNESS", f"{2e4 * strain * 0.7 * strain * 2 * 0.1:.6g} kN/m")
            )
            if case["materials"] == "one" or (case["materials"] != "laws" and name == "m"):
                text = (
                    text.replace("density: 6", "density: 2").replace("4e4", "1e4").replace("ratio: 0.1", "ratio: 0.2")
                )
            parts.append(f"  {name}: {{{text}}}\n")
        if case["materials"] == "one" and not (restated and self.splits):
            parts.pop()
        if case["extra"] in ("bars", "slip"):
            parts.append(
                "  s: {model: steel-bilinear, density: 7 t/m3, Young modulus: 2e6 kPa, yield stress:"
                f" {2e6 * strain * 0.5:.6g} kPa, hardening ratio: 0.05, largest strain: 0.9}}\n"
            )
        return "materials:\n" + "".join(parts[::-1] if restated else parts)

    def body(self, restated):
        parts = []
        whole = self.blocks == 1 and not (restated and self.splits)
        for name, low, high in (("b", 0.1, 0.9 if whole else 0.5),) if whole else (("b", 0.1, 0.5), ("c", 0.5, 0.9)):
            alike = self.case["materials"] == "one" and not (restated and self.splits)
            material = "m" if name == "b" or alike else "n"
            lattice = (
                f"lattice: square, spacing: {self.spacing(name)} m, thickness: 0.2 m"
                if self.dimensions == 2
                else "spacing: 0.1 m"
            )
            parts.append(
                f"  {name}: {{material: {material}, {lattice}, shape:"
                f" {self.box((low, 0.2, -0.1), (high, 0.6, 0.2))}}}\n"
            )
        return "body:\n" + "".join(parts[::-1] if restated else parts)

    def selections(self):
        return (
            "selections:\n  left: {face: x-, layers: 2}\n  right: {face: x+, layers: 2}\n"
            f"  top: {{inside: {self.box((0.3, 0.5, -0.1), (0.7, 0.6, 0.2))}}}\n"
            f"  near: {{inside: {self.box((0.1, 0.2, -0.1), (0.5, 0.6, 0.2))}}}\n"
            f"  far: {{inside: {self.box((0.5, 0.2, -0.1), (0.9, 0.6, 0.2))}}}\n"
            f"  middle: {{inside: {self.box((0.3, 0.3, -0.1), (0.7, 0.5, 0.2))}}}\n"
        )

    def history(self, end=TIME):
        return "" if self.case["solver"] == "quasi-static" else f", history: {{ramp to: {end:.6g} s}}"

    def push(self, on="right"):
        force = [0.8 * self.size, 0.3 * self.size, -0.2 * self.size]
        self.forces.append(("push", force[: self.dimensions]))
        return f"{{name: push, on: {on}, force: {self.vector(*force, 'kN')}{self.history()}}}"

    def loads(self, blocks):
        """Returns the loads that act from the beginning, and those of the stage of motion."""
        case, shift = self.case, self.size * 1e-3
        held = ["{name: grip, on: left, displacement: %s}" % self.vector(0.0, 0.0, 0.0, "m")]
        self.forces = []
        speed = 2 * shift / TIME
        # Ramps go on beyond the end of the run, so that the acceleration is constant until then.
        fast = speed if case["solver"] == "quasi-static" else 2 * speed
        moving = {
            "pull": lambda: [
                "{name: it, on: right, velocity: %s%s}"
                % (self.vector(fast, 0.4 * fast, -0.6 * fast, "m/s"), self.history(2 * TIME))
            ],
            "guide": lambda: [
                "{name: it, on: right, along: {direction: %s, velocity: %.10g m/s}%s}"
                % ("V[3, 1, -1]" if self.dimensions == 3 else "V[3, 1]", fast, self.history(2 * TIME)),
                self.push("top"),
            ],
            "set": lambda: [
                "{name: it, on: right, displacement: %s%s}"
                % (self.vector(shift, 0.4 * shift, -0.6 * shift, "m"), self.history())
            ],
            "force": lambda: [self.push()],
            "tie": lambda: ["{name: it, on: top, tie: {directions: x}}", self.push()],
            "spring": lambda: ["{name: it, on: right, spring: {stiffness: 3000 kN/m, to: middle}}", self.push()],
            "mirror": lambda: [self.push()],
            "dashpots": lambda: [
                "{name: it, on: {face: x+}, dashpots: {outcrop velocity: %s}%s}"
                % (self.vector(0.5 * speed, 0.2 * speed, 0.3 * speed, "m/s"), self.history()),
                self.push("middle"),
            ],
            "shake": lambda: [
                "{name: it, base acceleration: %s%s}"
                % (self.vector(speed / TIME, 0.5 * speed / TIME, -0.3 * speed / TIME, "m/s2"), self.history())
            ],
        }[case["boundary"]]()
        if case["boundary"] == "mirror":
            sides = (
                [("grip", "b", "x-")]
                + [(f"floor {b}", b, "y-") for b in blocks]
                + [(f"back {b}", b, "z-") for b in blocks if self.dimensions == 3]
            )
            held = ["{name: %s, on: {block: %s, face: %s}, support: {held: across}}" % side for side in sides]
        if case["solver"] == "stages":
            held.append("{name: weight, gravity: %s}" % self.vector(300 * shift, -900 * shift, 0.0, "m/s2"))
        if case["extra"] == "swelling":
            moving.append(f"{{name: swell, on: middle, initial strain: {-0.5 * shift:.10g}{self.history()}}}")
        if case["extra"] == "spin":
            spin = (
                f"A[{0.5 * speed:.10g} rad/s, 0 rad/s, {2 * speed:.10g} rad/s]"
                if self.dimensions == 3
                else f"[0, 0, ROTATED{2 * speed:.10g} rad/s]"
            )
            moving.append(
                "{name: spin, on: top, initial velocity: {translation: %s, rotation: %s}}"
                % (self.vector(0.3 * speed, -0.2 * speed, 0.1 * speed, "m/s"), spin)
            )
        return held, moving

    def additions(self):
        case, strain = self.case, abs(self.size) * 1e-3 / 0.4
        low, high = (-0.8, 0.3)
        if case["extra"] in ("bars", "slip"):
            slips = case["extra"] == "slip"
            bond = (
                [
                    ", bond: {law: fib, compressive strength: %.6g kPa, rib spacing: 8 mm, unloading stiffness: 2e6"
                    " kN/m3}" % (2e4 * strain),
                    ", bond: {law: linear, stiffness: 2e5 kN/m3}, bonded: [0.05 m, 0.25 m], anchored: [start]",
                ]
                if slips
                else ["", ""]
            )
            return (
                f"bars:\n  long: {{material: s, points: [{self.point(0.15, 0.35, 0.05)},"
                f" {self.point(0.85, 0.45, 0.05)}], diameter: 0.02 m, number: 2{bond[0]}}}\n  short: {{material: s,"
                f" points: [{self.point(0.45, 0.25, -0.05)}, {self.point(0.55, 0.55, 0.15)}], area: 2e-4"
                f" m2{bond[1]}}}\n"
            )
        cut = (
            "cracks: [{cut: {line: [V[0.5 m, -0.6 m], V[0.5 m, 0.4 m]]}}]\n"
            if self.dimensions == 2
            else (
                f"cracks: [{{cut: {{polygon: [V[0.5 m, -0.6 m, {low} m], V[0.5 m, 0.4 m, {low} m], V[0.5 m, 0.4 m,"
                f" {high} m], V[0.5 m, -0.6 m, {high} m]]}}}}]\n"
            )
        )
        return {
            "contact": cut + "contact: {friction: 0.2}\n",
            "breaking": cut + f"failure: {{critical stretch: {1.2 * strain:.6g}, near grips: break}}\n",
            "prestress": (
                "initial stress: {stress: S[%s]}\n"
                % ", ".join(
                    f"{s * 2e4 * strain * 0.05:.6g} kPa"
                    for s in (-3, -5, 0 if case["space"] == "stress" else -2, 1, 0, 0)
                )
            ),
        }.get(case["extra"], "")

    def text(self, restated=False):
        case = self.case
        space = (
            "space: 3-D, horizon: 0.2015 m"
            if self.dimensions == 3
            else f"space: plane {case['space']}, horizon: 0.2015 m"
        )
        held, moving = self.loads("bc" if self.blocks == 2 or (restated and self.splits) else "b")
        stages = case["solver"] == "stages"
        first = held if stages else held + moving
        if restated:
            first, moving = first[::-1], moving[::-1]
        text = "units: UNITS\n" + self.materials(restated) + self.body(restated) + self.selections()
        text += f"peridynamics: {{{PERIDYNAMICS[case['formulation']]}, {space}}}\n" + self.additions()
        text += "loads:\n" + "".join(f"  - {load}\n" for load in first)
        solver = SOLVERS[case["solver"]] % DAMPING[case["damping"]]
        text += "solve:\n"
        if stages:
            text += "  - {name: weight, static: {end time: 1e-3 s, increments: 1, residual: 1e-11}}\n"
        text += "  - {name: motion, %s%s}\n" % (
            solver,
            ", displacements: zero, loads: [%s]" % ", ".join(moving) if stages else "",
        )
        watch = [
            "energies: {energy: yes, every: 1}",
            "total: {displacement of: {all: yes}, every: 1}",
            "slow: {velocity of: near, every: 1}",
            "fast: {velocity of: far, every: 1}",
            "pulled: {force on: right, every: 1}",
            "strained: {stress and strain of: middle, every: 1}",
            "harmed: {damage of: top, every: 1}",
            f"gap: {{opening between: [{self.point(0.45, 0.25, 0.05)}, {self.point(0.54, 0.26, 0.05)}], every: 1}}",
        ]
        if case["boundary"] != "mirror":
            watch.append("held: {reaction on: {all: yes}, every: 1}")
        if case["boundary"] in ("pull", "guide", "set"):
            watch.append("it: {reaction of: it, every: 1}")
        if case["extra"] in ("bars", "slip"):
            watch += [
                "steel: {bar: long, every: 1}",
                f"there: {{bar: short, at: {self.point(0.5, 0.4, 0.05)}, every: 1}}",
            ]
        watch += [f"factor-{name}: {{load: {name}, every: 1}}" for name, _ in self.forces]
        text += "watch:\n" + "".join(f"  {line}\n" for line in (watch[::-1] if restated else watch))
        text += "profiles: {layers: {of: {all: yes}, along: x, every: 2}}\n"
        return (
            text
            + "results: {number: 1, precision: double, fields:"
            f" [{FIELDS}{ROTATIONS if case['formulation'] == 'micropolar' else ''}]}}\npictures: []\n"
        )


def tolerance(case):
    """Returns the relative tolerance of restated results: round-off, or the tolerance of iterations at rest."""
    return {"loose": 1e-6, "relaxation": 1e-6}.get(case["solver"], 1e-8)


def imbalance(case):
    """Returns the tolerance of the energy balance: the error of the trapezium rule in few and long increments."""
    if case["extra"] == "prestress":
        return 1.0  # the first increment releases the initial stress of free faces at once
    softens = case["extra"] == "breaking" or (case["formulation"] == "micropolar" and case["materials"] == "laws")
    if case["size"] == "large" and (softens or case["solver"] in AT_REST):
        return 0.3
    return 0.06 if softens else 0.03
