"""The plate with a crack by hybrid bonds with uniaxial laws and with laws in space, by correspondence, and at rest by finite elements."""
import itertools
import os
import subprocess
from math import sqrt

from reporting import Run, between, chart, picture, table

YOUNG, YIELD, HARDENING, SPACING = 150e3, 1500, 0.01, 0.03  # kPa, m
LIGAMENT = 39 * SPACING * 2 * SPACING  # m2


# A plate of two layers of bonds, wide and whole: what it shows of the modulus that its bonds are given

def families(horizon):
    """Bond vectors in spacings: of a particle inside, and of one in a plate of two layers."""
    reach = range(-int(horizon), int(horizon) + 1)
    inside = [v for v in itertools.product(reach, repeat=3) if 0 < sum(c * c for c in v) <= horizon * horizon]
    return inside, [v for v in inside if v[2] in (0, 1)]


class Slab:
    """Bonds get their stiffness from whole families, of which uniform expansion costs the energy of E and a Poisson ratio of 1/4; stresses over E."""

    def __init__(self, horizon):
        inside, self.family = families(horizon)
        length = lambda v: sqrt(sum(c * c for c in v))
        self.weight = 6 / sum(length(v) for v in inside)  # c V / 2 over E
        self.bonds = [(length(v), [c * c / length(v)**2 for c in v], v) for v in self.family]
        sums = lambda f: self.weight * sum(l * f(n) for l, n, _ in self.bonds)
        xx, xy, xz, zz = (sums(f) for f in (lambda n: n[0]**2, lambda n: n[0] * n[1], lambda n: n[0] * n[2], lambda n: n[2]**2))
        xx, self.shear, xy = xx - xz**2 / zz, xy, xy - xz**2 / zz  # nothing pulls across the plate
        self.ratio = xy / xx
        self.young = xx * (1 - self.ratio**2)

    def pulled(self, strain, law):
        """Stress along x with free sides and faces; law: stress of a bond by its stretch."""
        stress = lambda k, e: self.weight * sum(l * n[k] * law(sum(a * b for a, b in zip(n, e))) for l, n, _ in self.bonds)

        def free(k, rest):
            """The strain along k at which nothing pulls there; rest completes the strains."""
            low, high = -strain, strain
            for _ in range(40):
                middle = (low + high) / 2
                low, high = (middle, high) if stress(k, rest(middle)) < 0 else (low, middle)
            return (low + high) / 2

        across = lambda y: [strain, y, free(2, lambda z: [strain, y, z])]
        return stress(0, across(free(1, across)))

    def toughness(self, stretch):
        """Energy that bonds across a plane between two columns hold at a stretch, over E times the spacing."""
        return self.weight * stretch**2 * sum(l * v[0] for l, _, v in self.bonds if v[0] > 0)


slabs = {m: Slab(m) for m in (1.5, 2.015)}


def steel(stretch):
    over = max(0, abs(stretch) - YIELD / YOUNG)
    return (1 if stretch > 0 else -1) * (min(abs(stretch), YIELD / YOUNG) + HARDENING * over)


between("calibration", table(
    ["horizon, spacings", "bonds of a particle, of those inside a body", "E shown over E of the law, along x", "Poisson ratio", "2 (1 + ν) G / E"],
    [[f"{m:g}", f"{len(s.family)} of {len(families(m)[0])}", f"{s.young:.6f}", f"{s.ratio:.4f}", f"{2 * (1 + s.ratio) * s.shear / s.young:.3f}"]
     for m, s in slabs.items()]))
slab = slabs[1.5]
curve = {e: YOUNG / slab.young * slab.pulled(e, steel) for e in (0.01, 0.02, 0.05)}
between("yield", table(
    ["strain along x, sides free", *(f"{e:g}" for e in curve)],
    [["steel of uniaxial bonds: stress of the plate (kPa)", *(f"{s:.0f}" for s in curve.values())],
     ["the law itself; J2 in space (kPa)", *(f"{YOUNG * steel(e):.0f}" for e in curve)]]))


# At rest

class Rest:
    def __init__(self, edits=()):
        run = Run("rest.yaml", edits=edits)
        self.mouth, self.middle, self.seconds = 1000 * run.last("mouth", "opening"), 1000 * run.last("middle", "opening"), run.summary["wall_seconds"]


def uniaxial(m):
    return [("model: elastic,", "model: elastic-1d,"), (", Poisson ratio: 0.25", ""), ("Young modulus: 150 MPa", f"Young modulus: {YOUNG / slabs[m].young:.9g} kPa"),
            ("form: variational, strain: small, ", ""), ("horizon: 1.5", f"horizon: {m}")]


def by_correspondence(m, fades="softening"):
    return [("formulation: hybrid, form: variational, ", f"formulation: correspondence, zero-energy control: {{silling: 0.1, fades: {fades}}}, "), ("horizon: 1.5", f"horizon: {m}")]


def elements(slab, sides):
    """Openings at the mouth and in the middle by OpenSees, of the plate and of one with the moduli of uniaxial bonds; nothing where it is not set up."""
    python = "../../.venv/opensees/bin/python"
    if not os.path.exists(python):
        return [], []
    words = [YOUNG, slab.ratio, YOUNG * slab.shear / slab.young, *sides]
    said = subprocess.run([python, "elements.py", *map(str, words)], check=True, capture_output=True, text=True).stdout
    rows = [[1000 * float(word) for word in line.split()[:2]] for line in said.splitlines()[:2 * len(sides)]]
    return rows[:len(sides)], rows[len(sides):]


SIDES = (30, 15, 7.5)
solid, like_bonds = elements(slab, SIDES)
wider = elements(slabs[2.015], SIDES[-1:])[1]
rest = {
    "laws in space: hybrid, variational, 1.5": (Rest(), solid),
    "hybrid, variational, 2.015": (Rest([("horizon: 1.5", "horizon: 2.015")]), solid),
    "hybrid, pairwise, 1.5": (Rest([("variational", "pairwise")]), solid),
    "correspondence, 1.5": (Rest(by_correspondence(1.5)), solid),
    "correspondence, 3.015": (Rest(by_correspondence(3.015)), solid),
    "uniaxial laws: hybrid, 1.5": (Rest(uniaxial(1.5)), like_bonds),
    "hybrid, 2.015": (Rest(uniaxial(2.015)), wider),
}
rows = []
for name, (r, judge) in rest.items():
    far = [f"{100 * (a / b - 1):+.2f} %" for a, b in zip((r.mouth, r.middle), judge[-1])] if judge else ["not run"] * 2
    rows.append([name, f"{r.mouth:.3f}", far[0], f"{r.middle:.3f}", far[1], f"{r.seconds:.1f}"])
for name, found in (("finite elements", solid), ("finite elements with the moduli of uniaxial bonds, 1.5", like_bonds)):
    rows += [[f"{name}, sides of {side:g} mm", f"{mouth:.3f}", "", f"{middle:.3f}", "", ""] for side, (mouth, middle) in zip(SIDES, found)]
between("rest", table(["horizon in spacings", "mouth (mm)", "from finite elements", "middle (mm)", "from finite elements", "seconds"], rows))


# In motion

class Motion:
    def __init__(self, deck, settings=(), edits=(), results=0):
        self.run = run = Run(deck, settings, edits=edits, results=results)
        self.summary = run.summary
        self.opening = list(zip(run.column("mouth", "time"), run.column("mouth", "opening")))

    def mouth(self, time):
        """Opening in mm, between two rows of the history."""
        (t, a), (u, b) = next(pair for pair in zip(self.opening, self.opening[1:]) if pair[1][0] >= time)
        return f"{1000 * (a + (b - a) * (time - t) / (u - t)):.2f}"

    def severed(self):
        return next((f"{1000 * t:.1f}" for t, o in zip(self.run.column("edge", "time"), self.run.column("edge", "opening")) if o >= 0.02), "not by 92")

    def path(self):
        """How far from its line there is a crack, which is a third of a family broken, in spacings."""
        for spacings, watch in ((10, "beyond-ten"), (5, "beyond-five"), (2, "beyond-two")):
            if self.run.last(watch, "largest") > 0.33:
                return f"more than {spacings}"
        return "2 at most"

    def column(self, elastic):
        """What an elastic plate seems to dissipate is imbalance."""
        s, e = self.summary, self.summary["energy"]
        imbalance = f"{100 * max(e['imbalance'], abs(e['dissipated']) / e['external']):.0e} %" if elastic else "–"
        spent = e["fracture"] + (0 if elastic else e["dissipated"])
        return [f"{1e6 * s['time_step']:.1f}", f"{s['steps']}", self.mouth(0.01), self.mouth(0.02), self.mouth(0.04),
                f"{1000 * s['first_broken_bond']['time']:.1f}" if s["first_broken_bond"] else "none",
                self.severed(), f"{s['broken_bonds']}", self.path(), f"{spent / LIGAMENT:.1f}", imbalance, f"{s['wall_seconds']:.0f}"]


LINES = ["time step (µs)", "steps", "opening of the mouth at 10 ms (mm)", "at 20 ms", "at 40 ms", "first bond breaks (ms)", "severed: the side opposite to the crack 20 mm longer (ms)", "bonds broken by 92 ms",
         "the crack leaves its line by (spacings)", "energy that bonds took and laws dissipated, over the ligament (kN/m)", "energy imbalance", "seconds"]
CLAY = ["variables.law=clay", "variables.pull=750 kN/m3"]
runs = {
    "uniaxial": Motion("uniaxial.yaml", results=1),
    "weaker": Motion("uniaxial.yaml", ["variables.stretch=0.04"], results=1),
    "space": Motion("solid.yaml", results=1),
    "wide": Motion("solid.yaml", edits=[("horizon: 1.5", "horizon: 2.015")]),
    "short": Motion("solid.yaml", edits=[("{end time: 0.092 s}", "{time step: 4e-6 s, steps: 23000}")]),
    "like": Motion("solid.yaml", edits=by_correspondence(1.5)),
    "correspondence": Motion("solid.yaml", edits=by_correspondence(3.015), results=1),
    "uniaxial-steel": Motion("uniaxial.yaml", ["variables.law=steel"], results=1),
    "space-steel": Motion("solid.yaml", ["variables.law=steel"], results=1),
    "correspondence-steel": Motion("solid.yaml", ["variables.law=steel"], by_correspondence(3.015), results=1),
    "space-clay": Motion("solid.yaml", CLAY, results=23),
    "correspondence-clay": Motion("solid.yaml", CLAY, by_correspondence(3.015), results=23),
    "fading-clay": Motion("solid.yaml", CLAY, by_correspondence(3.015, "yielding"), results=23),
}


def motion(mark, heads):
    columns = [runs[name].column(mark == "elastic") for name in heads]
    between(mark, table(["", *heads.values()], [[line, *(c[n] for c in columns)] for n, line in enumerate(LINES)]))


motion("elastic", {"uniaxial": "uniaxial laws, hybrid, 1.5", "weaker": "the same, critical stretch 0.04", "space": "laws in space, hybrid, 1.5",
                   "short": "the same, steps of 4 µs", "wide": "hybrid, 2.015", "like": "correspondence, 1.5", "correspondence": "correspondence, 3.015"})
motion("yielding", {"uniaxial-steel": "steel: uniaxial law, hybrid, 1.5", "space-steel": "J2, hybrid, 1.5", "correspondence-steel": "J2, correspondence, 3.015",
                    "space-clay": "clay: hybrid, 1.5", "correspondence-clay": "correspondence, 3.015",
                    "fading-clay": "the same, control that fades with yielding"})
between("toughness", f"All bonds across a plane between two columns hold {slab.toughness(0.05) * YOUNG / slab.young * SPACING:.1f} kN/m at a stretch of 0.05 in the elastic plate of uniaxial bonds.")

for name, run in runs.items():
    if name in ("uniaxial", "like", "wide", "short"):
        continue
    words = ("--time", "0.0792") if "clay" in name else ("--deformed", "0")
    picture(run.run, "damage", name, "--range", "0:1", *words)
COLOURS = {"uniaxial": "#c8501e", "weaker": "#8a6d00", "space": "#21918c", "correspondence": "#3b3f87"}
chart("opening", "Opening of the mouth of the crack", "time [ms]", "opening [mm]",
      [(f"{law}: {label}", f"with lines lw 1.8 dt {dash} lc rgb '{COLOURS[name]}'",
        [(1000 * t, 1000 * o) for t, o in runs[name + kind].opening[::5] if t < 0.045])
       for law, kind, dash in (("elastic", "", 1), ("steel", "-steel", 2), ("clay", "-clay", 3))
       for name, label in (("uniaxial", "uniaxial"), ("weaker", "uniaxial, to 0.04"), ("space", "space, hybrid"), ("correspondence", "space, correspondence"))
       if name + kind in runs],
      "set xrange [0:45]\nset yrange [0:200]\nset xtics 5")
