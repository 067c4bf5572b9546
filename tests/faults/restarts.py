#!/usr/bin/env python3
"""Stops runs anywhere and takes them up again: they must end in the same bits as runs that nobody stopped.

Small bodies go through all pairs and triples of solvers, with every law that has a history and every formulation that takes the law. A run is
stopped after some step and taken up with --restart; histories, the log of the solution, results and the last checkpoint must be the same.

usage: restarts.py COMMAND COMPARE_RESULTS [--cases N] [--stops N] [--seed K] [--body NAME] [--solvers LETTERS]
  --cases N    so many cases, drawn at random (0: all pairs and triples of all bodies, for the night)
  --stops N    so many stops in each case, one of them at the end of a stage (0: at every step)
  --seed K     of what is drawn (1)
  --body NAME, --solvers LETTERS  one body of BODIES, one sequence of SOLVERS, like "SER"
"""
import argparse
import concurrent.futures
import filecmp
import itertools
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

ELASTIC = "density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2"
LINE = "density: 2.4, Young modulus: 30 GPa"
CORRESPONDENCE = "formulation: correspondence, space: plane stress"
BONDS = "formulation: bond-based, space: plane stress"
BARS = """\
bars:
  low: {points: [[0.01, 0.02], [0.13, 0.02]], diameter: 12 mm, material: s, bond: {compressive strength: 30 MPa, rib spacing: 5 mm}}
"""
STEEL = "  s: {model: menegotto-pinto, density: 7.85, Young modulus: 200 GPa, yield stress: 20 MPa, hardening ratio: 0.01}\n"

# name: (parameters of the material, keys of peridynamics, further sections, further materials)
BODIES = {
    "j2": (f"model: j2, {ELASTIC}, yield stress: 2 MPa, hardening modulus: 1 GPa", CORRESPONDENCE, "", ""),
    "viscoelastic": (f"model: viscoelastic, {ELASTIC}, relaxing share: 0.5, relaxation time: 1e-4", CORRESPONDENCE, "", ""),
    "multi-yield-j2": ("model: multi-yield-j2, density: 2.4, shear modulus: 12.5 GPa, bulk modulus: 16.7 GPa, octahedral strength: 2 MPa", CORRESPONDENCE, "", ""),
    "cap": (f"model: cap, {ELASTIC}, envelope strength: 2 MPa, cap ratio: 4, cap position: 9 MPa, largest compaction: 0.05, compaction rate: 1e-5 1/kPa, "
            "tension cut-off: 2 MPa", "formulation: correspondence, space: plane strain", "", ""),
    "drucker-prager": (f"model: drucker-prager, {ELASTIC}, cohesion: 2 MPa, friction angle: 30 deg", CORRESPONDENCE, "", ""),
    "mohr-coulomb": (f"model: mohr-coulomb, {ELASTIC}, cohesion: 2 MPa, friction angle: 30 deg, dilation angle: 30 deg, tensile strength: 3.46 MPa", CORRESPONDENCE, "", ""),
    "bounding-surface-clay": (f"model: bounding-surface-clay, {ELASTIC}, undrained strength: 2 MPa, hardening modulus: 12 GPa", CORRESPONDENCE,
                              "failure: {critical stretch: 3e-4, near grips: hold}\n", ""),
    "damage-plasticity": (f"model: damage-plasticity, {ELASTIC}, tensile strength: 3 MPa, compressive strength: 30 MPa, fracture energy: 100 N/m", CORRESPONDENCE, "", ""),
    "mazars": (f"model: mazars, {ELASTIC}, tensile strength: 3 MPa, fracture energy: 100 N/m", CORRESPONDENCE, "", ""),
    "mazars in plane strain": (f"model: mazars, {ELASTIC}, tensile strength: 3 MPa, fracture energy: 100 N/m", "formulation: correspondence, space: plane strain", "", ""),
    "softening bonds": (f"model: exponential-softening, {LINE}, tensile strength: 3 MPa, fracture energy: 100 N/m", BONDS, "failure: {near grips: hold}\n", ""),
    "bilinear bonds": (f"model: bilinear-softening, {LINE}, tensile strength: 3 MPa, fracture energy: 100 N/m", BONDS, "", ""),
    "trilinear bonds": (f"model: trilinear-softening, {LINE}, tensile strength: 3 MPa, fracture energy: 100 N/m", BONDS, "", ""),
    "brittle bonds": (f"model: elastic-brittle, {LINE}, tensile strength: 3 MPa", BONDS, "", ""),
    "crushing bonds": (f"model: fib-concrete, {LINE}, tensile strength: 3 MPa, fracture energy: 100 N/m, compressive strength: 30 MPa", BONDS, "", ""),
    "park bonds": ("model: kent-scott-park, density: 2.4, compressive strength: 30 MPa, residual strength: 6 MPa", BONDS, "", ""),
    "concrete bonds": ("model: concrete02, density: 2.4, compressive strength: 30 MPa, residual strength: 6 MPa, tensile strength: 2 MPa, "
                       "tension softening: 2 GPa", BONDS, "", ""),
    "confined bonds": (f"model: mander, {LINE}, compressive strength: 30 MPa, confining pressure: 2 MPa", BONDS, "", ""),
    "plastic bonds": (f"model: menegotto-pinto, {LINE}, yield stress: 2 MPa", BONDS, "", ""),
    "perfectly plastic bonds": (f"model: elastic-perfectly-plastic, {LINE}, yield stress: 2 MPa", BONDS, "", ""),
    "bilinear plastic bonds": (f"model: steel-bilinear, {LINE}, yield stress: 2 MPa, hardening ratio: 0.05, compression shift: 0.1", BONDS, "", ""),
    "hybrid": (f"model: mazars, {ELASTIC}, tensile strength: 3 MPa, fracture energy: 100 N/m", "formulation: hybrid, space: plane stress", "", ""),
    "hybrid flow": (f"model: j2, {ELASTIC}, yield stress: 2 MPa", "formulation: hybrid, space: plane strain", "failure: {critical stretch: 3e-4, near grips: hold}\n", ""),
    "flow": (f"model: j2, {ELASTIC}, yield stress: 2 MPa", "formulation: ordinary, space: plane strain", "", ""),
    "links": (f"model: link-damage, {ELASTIC}, tensile stretch: 1e-4, fracture energy: 100 N/m", "formulation: micropolar, space: plane stress", "", ""),
    "bars": (f"model: exponential-softening, {LINE}, tensile strength: 3 MPa, fracture energy: 100 N/m", BONDS, BARS, STEEL),
}
WITHOUT_HISTORY = ("elastic", "elastic-1d")
DECK = """\
units: {{length: m, force: kN, time: s}}
materials:
  c: {{{material}}}
{materials}body: {{b: {{material: c, lattice: square, spacing: 0.02, thickness: 0.1, shape: {{box: {{particles: [8, 5], first particle: [0, 0]}}}}}}}}
peridynamics: {{{peridynamics}}}
{sections}loads:
  - {{on: {{face: x-, layers: 2}}, displacement: [0, 0]}}
  - {{name: pull, on: {{face: x+, layers: 2}}, displacement: [{along}, {across}], history: {{ramp to: 1}}}}
solve:
{stages}watch: {{end: {{displacement of: {{face: x+}}, every: 1}}, energy: {{energy: yes, every: 1}}}}
results: {{number: 3, checkpoint steps: 3, precision: double, fields: [displacement]}}
pictures: []
"""
SOLVERS = {
    "S": "static: {increments: 4}",
    "R": "static: {increments: 2, method: relaxation, residual: 1e-6}",
    "I": "implicit: {end time: 6e-5, time step: 2e-5}",
    "E": "explicit: {steps: 7}",
}
SAME = ("end.csv", "energy.csv", "results.xdmf", "solution.txt")  # byte by byte
ALIKE = ("results.vtkhdf", "checkpoint.h5")  # by what is in them


def deck(body, solvers, chance):
    material, peridynamics, sections, materials = BODIES[body]
    pull = chance.uniform(0.5, 2)  # times what begins to yield or to crack
    stages = "".join(f"  - {{name: s{k}, {SOLVERS[letter]}}}\n" for k, letter in enumerate(solvers))
    return DECK.format(material=material, peridynamics=peridynamics, sections=sections, materials=materials, stages=stages,
                       along=f"{1.4e-5 * pull:.3g}", across=chance.choice(["free", "0", "6e-6"]))


class Case:
    def __init__(self, options, work, number, body, solvers):
        self.options, self.body, self.solvers = options, body, solvers
        self.folder = os.path.join(work, f"case-{number}")
        self.chance = random.Random(f"{options.seed} {body} {solvers}")

    def run(self, output, *more):
        words = [self.options.command, "run", "deck.yaml", "--quiet", "--threads", "1", "--output", output, *more]
        return subprocess.run(words, cwd=self.folder, capture_output=True, text=True, errors="replace", timeout=300)

    def difference(self, output):
        """The first file that is not as in the whole run; none if all are."""
        for name in SAME:
            whole, here = f"{self.folder}/whole/{name}", f"{self.folder}/{output}/{name}"
            if os.path.exists(whole) and not (os.path.exists(here) and filecmp.cmp(whole, here, shallow=False)):
                return f"{name} differs"
        for name in ALIKE:
            whole, here = f"{self.folder}/whole/{name}", f"{self.folder}/{output}/{name}"
            if not os.path.exists(whole):
                continue
            done = subprocess.run([self.options.compare, whole, here], capture_output=True, text=True)
            if done.returncode:
                return f"{name} differs: {done.stdout.strip()[:120]!r}"
        return ""

    def steps(self):
        """Steps of the whole run, one for each row of the history; the first is that before the run."""
        with open(f"{self.folder}/whole/end.csv") as rows:
            return len(rows.readlines()) - 2

    def ends(self):
        """The steps with which the stages before the last one end."""
        with open(f"{self.folder}/whole/summary.json") as file:
            stages = json.load(file).get("stages", [])
        return [int(stage["steps"][1]) for stage in stages[:-1]]

    def chosen(self):
        steps = list(range(1, self.steps()))
        if not self.options.stops or len(steps) <= self.options.stops:
            return steps
        likely = [step for step in self.ends() if step in steps] or steps  # what a stage leaves in memory only is felt in later ones
        return sorted({self.chance.choice(likely), *self.chance.sample(steps, self.options.stops - 1)})

    def go(self):
        """Returns the numbers of restarts and of whole runs that failed, and what was wrong."""
        os.makedirs(self.folder)
        with open(f"{self.folder}/deck.yaml", "w") as file:
            file.write(deck(self.body, self.solvers, self.chance))
        whole = self.run("whole")
        if whole.returncode not in (0, 1):
            return 0, 0, [f"{self.body}, {self.solvers}: status {whole.returncode}: {whole.stderr.strip()[:300]}"]
        problems, stops = [], self.chosen()
        for step in stops:
            shutil.rmtree(f"{self.folder}/part", ignore_errors=True)
            first = self.run("part", "--steps", str(step))
            again = self.run("part", "--restart") if not first.returncode else first
            problem = "" if again.returncode == whole.returncode else f"status {again.returncode}, not {whole.returncode}: {again.stderr.strip()[:200]}"
            problem = problem or self.difference("part")
            if problem:
                problems.append(f"{self.body}, {self.solvers}, stopped at step {step} of {self.steps()}: {problem}")
        if problems and os.environ.get("RESTARTS_KEEP"):
            print(f"kept: {self.folder}")
        else:
            shutil.rmtree(self.folder)
        return len(stops), whole.returncode, problems


def laws_without_body(command):
    """Laws of the program that remember something and that no body has."""
    words = subprocess.run([command, "models"], capture_output=True, text=True, check=True).stdout
    laws = re.findall(r"^([\w-]+): ", words.split("\nFormulations")[0], re.MULTILINE)
    named = {law for body in BODIES.values() for law in re.findall(r"model: ([\w-]+)", body[0] + body[3])}
    return [law for law in laws if law not in named and law not in WITHOUT_HISTORY]


def all_cases(options):
    bodies = [options.body] if options.body else list(BODIES)
    sequences = [options.solvers] if options.solvers else ["".join(s) for n in (2, 3) for s in itertools.product(SOLVERS, repeat=n)]
    return [(body, sequence) for body in bodies for sequence in sequences]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("command", type=os.path.abspath)
    parser.add_argument("compare", type=os.path.abspath)
    parser.add_argument("--cases", type=int, default=12)
    parser.add_argument("--stops", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--body", choices=BODIES)
    parser.add_argument("--solvers")
    options = parser.parse_args()
    missing = laws_without_body(options.command)
    if missing:
        sys.exit(f"no body has the laws {', '.join(missing)}: add one of each to BODIES")
    cases = all_cases(options)
    if options.cases and len(cases) > options.cases:
        random.Random(options.seed).shuffle(cases)
        cases = cases[: options.cases]
    work = tempfile.mkdtemp(prefix="breccia-restarts-")
    try:
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            done = list(pool.map(lambda one: Case(options, work, one[0], *one[1]).go(), enumerate(cases)))
    finally:
        if not os.environ.get("RESTARTS_KEEP"):
            shutil.rmtree(work, ignore_errors=True)
    problems = [words for _, _, all in done for words in all]
    for words in problems[:40]:
        print(f"LOST: {words}")
    restarts, failed = sum(n for n, _, _ in done), sum(n for _, n, _ in done)
    print(f"restarts: {len(cases)} cases, {failed} of them ended early, {restarts} restarts, {len(problems)} problems")
    if 4 * failed > len(cases) + 4:
        sys.exit("too many runs end early, the walk is too tame")
    sys.exit(1 if problems else 0)


main()
