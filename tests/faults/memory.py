#!/usr/bin/env python3
"""Refuses the command one call for memory after the other.

Every verb is run once to count its calls, then once for each call that is refused (failing_memory.c does it). It must never end by a
signal or keep memory that it was given, and either end with status 1 and one line "out of memory: ...", or, where it could do without, with
the same output and files as with all its memory. What a run leaves that ended so can be taken up with all memory, to the same results,
unless it says that there is nothing to take up.

usage: memory.py COMMAND SHIM COMPARE_RESULTS [--every K] [--places K] [--decks K] [--verb NAME] [--libraries]
  --every K    the first call from each place of the program, and one in K of the others (1: all)
  --places K   the first call from one in K places only
  --decks K    one in K decks of the relations only
  --verb NAME  one verb only
  --libraries  calls of the libraries too: these may say it in their own way, and some of them crash or never end (KNOWN_ENDS), but none may
               let the program end with status 0 and wrong files, and the program's own code may not crash
"""
import argparse
import collections
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "relations"))
from decks import decks as RELATIONS
from quantities import System

PLATE = """\
title: Plate
variables: {width: 6 cm}
units: {length: m, force: kN, time: s}
materials:
  clay: {model: j2, density: 1500 kg/m3, Young modulus: 60 MPa, Poisson ratio: 0.25, yield stress: 30 kPa}
body:
  plate: {material: clay, lattice: square, thickness: 0.1, spacing: 1 cm, shape: {box: {from: [0, 0], to: ['${width}', 0.06]}}}
cracks: [{cut: {line: [[0.03, -1], [0.03, 0.02]]}}]
peridynamics: {space: plane strain}
failure: {critical stretch: 0.002, near grips: break}
selections: {left: {inside: {box: {from: [0, 0], to: [0.01, 0.06]}}}, right: {inside: {box: {from: [0.05, 0], to: [0.06, 0.06]}}}}
loads:
  - {on: left, name: pull, displacement: [0, free]}
  - {on: right, velocity: [0.5, free], history: {ramp to: 1e-4}}
  - {on: {face: y+}, pressure: 1 kPa, history: {table: [[0, 0], [1, 1]]}}
  - {on: {nearest: [0.03, 0.05]}, spring: {stiffness: 1 kN/m}}
solve: {explicit: {steps: 12, local damping: 0.2}}
watch:
  mouth: {opening between: [[0.025, 0], [0.035, 0]]}
  grip: {force on: right}
  work: {energy: yes}
results: {number: 2, checkpoint steps: 5}
pictures: [{field: damage, deformed: 2, broken bonds: yes}]
"""

GRAINS = """\
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 30 kN/m}
  s: {model: elastic-1d, density: 2.4, Young modulus: 30 GPa}
body:
  grains: {material: c, spacing: 1, file: grains.csv}
  hammer: {material: s, spacing: 1, shape: {box: {from: [1, 4.2, 0], to: [3, 6.2, 2]}}}
peridynamics: {formulation: bond-based, calibration: continuum}
contact: {friction: 0.3}
loads:
  - {on: {face: x-, layers: 1}, velocity: [0, 0, 0]}
  - {on: {face: x+, layers: 1}, velocity: [80, 0, 0], history: {ramp to: 0.002}}
  - {on: {block: hammer}, velocity: [0, -80, 0]}
solve: {explicit: {steps: 40}}
watch: {work: {energy: yes}}
results: {number: 2, checkpoint steps: 13, fields: [displacement, damage, bond damage]}
"""

HALVES = """\
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: elastic, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.25}
body:
  left: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.08, 0.05]}}}
  right: {material: s, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0.08, 0], to: [0.16, 0.05]}}}
peridynamics: {space: plane strain, formulation: ordinary, regions: {fibres: {blocks: [left], formulation: bond-based}}}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, free]}
  - {on: {face: x+, layers: 2}, velocity: [0.5, free]}
solve:
  - {name: slow, explicit: {steps: 6}}
  - {name: fast, explicit: {steps: 6}}
results: {number: 1, fields: [displacement, stress]}
"""

REST = """\
units: {length: m, force: kN, time: s}
materials: {c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}}
body: {b: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.1, 0.05]}}}}
peridynamics: {space: plane stress, formulation: bond-based}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, displacement: [5e-6, free]}
solve: {static: {increments: 3}}
results: {number: 1, fields: [displacement, stress]}
"""

BARS = """\
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: steel-bilinear, density: 7.85, Young modulus: 200 GPa, yield stress: 300 MPa, hardening ratio: 0.01}
body: {beam: {material: c, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {particles: [10, 5], first particle: [0, 0]}}}}
bars:
  low: {points: [[0.01, 0.02], [0.17, 0.02]], diameter: 12 mm, number: 2, material: s, bond: {compressive strength: 30 MPa, rib spacing: 5 mm}}
  links: {points: [[0.05, 0.02], [0.05, 0.06]], diameter: 6 mm, material: s, repeat: {along: [1, 0], pitch: 0.05, number: 2}}
peridynamics: {formulation: bond-based, space: plane stress}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, velocity: [0.5, free]}
solve: {explicit: {steps: 8}}
watch: {low: {bar: low, every: 2}, work: {energy: yes}}
results: {number: 1, checkpoint steps: 3, fields: [displacement]}
pictures: []
"""

STAGES = REST.replace("solve: {static: {increments: 3}}", """\
solve:
  - {name: pull, explicit: {steps: 3}}
  - {name: swing, implicit: {end time: 1e-5, time step: 1e-5, Rayleigh damping: {ratio: 0.05, from: 3000, to: 20000}}}
watch: {energy: {energy: yes, every: 1}}""")

TORN = "variables: {load: 1 MPa}\n" + REST.replace("displacement: [5e-6, free]", "pressure: '-${load}'").replace("increments: 3", "increments: 2, smallest increment: 0.4")

TEST = """\
title: Steel under cycles
units: {length: m, force: kN, time: s}
material: {model: j2, density: 7.85 t/m3, Young modulus: 200 GPa, Poisson ratio: 0.3, yield stress: 250 MPa, hardening modulus: 4 GPa}
test: {kind: triaxial, strain: 0.01, steps: 20}
against: measured.csv
fit: {yield stress: {from: 1e5, to: 1e6}}
"""


def file_of(name):
    """The file name of a deck of the relations."""
    return "relation-" + re.sub("[^a-z0-9]+", "-", name.lower())


def write_relation(folder, name):
    with open(os.path.join(folder, file_of(name) + ".yaml"), "w") as file:
        file.write(System().deck(RELATIONS[name]["text"]))
    for other, text in RELATIONS[name]["files"].items():
        with open(os.path.join(folder, other), "w") as file:
            file.write(text(System()))


def write_decks(folder):
    for name, words in (("plate", PLATE), ("grains", GRAINS), ("halves", HALVES), ("rest", REST), ("bars", BARS), ("stages", STAGES), ("torn", TORN), ("test", TEST)):
        with open(os.path.join(folder, name + ".yaml"), "w") as file:
            file.write(words)
    with open(os.path.join(folder, "grains.csv"), "w") as file:
        file.write("x,y,z,volume\n")
        for k in range(2):
            for j in range(4):
                for i in range(5):
                    file.write(f"{i}.0{(i * 7 + j * 3 + k) % 10},{j}.0{(i * 3 + j * 5 + k * 7) % 10},{k}.0{(i + j * 9 + k) % 10},1\n")
    with open(os.path.join(folder, "motion.csv"), "w") as file:
        file.write("time (s),velocity\n" + "".join(f"{k * 0.01},{(k % 7) * 0.1 - 0.3}\n" for k in range(40)))
    with open(os.path.join(folder, "measured.csv"), "w") as file:
        file.write("axial strain,deviator (kPa)\n" + "".join(f"{k * 1e-3},{min(k * 2e5, 2.5e5 + k * 4e3)}\n" for k in range(11)))


# verb: (what must be done before, what is walked, files that it writes)
WALKS = {
    "check": ([], "check plate.yaml --set failure.critical\\ stretch=3e-3", []),
    "check-grains": ([], "check grains.yaml", []),
    "check-halves": ([], "check halves.yaml", []),
    "run": ([], "run plate.yaml", ["plate"]),
    "run-grains": ([], "run grains.yaml", ["grains"]),
    "run-halves": ([], "run halves.yaml", ["halves"]),
    "run-rest": ([], "run rest.yaml", ["rest"]),
    "run-bars": ([], "run bars.yaml", ["bars"]),
    "run-stages": ([], "run stages.yaml", ["stages"]),
    "restart": (["run plate.yaml --steps 6"], "run plate.yaml --restart", ["plate"]),
    "restart-grains": (["run grains.yaml --steps 20"], "run grains.yaml --restart", ["grains"]),
    "plot": (["run plate.yaml"], "plot plate --field stress --component xx --output picture.png", ["picture.png"]),
    "plot-curve": (["run plate.yaml"], "plot plate --curve mouth.distance:grip.x --output curve.png", ["curve.png"]),
    "plot-energy": (["run plate.yaml"], "plot plate --energy --output energy.svg", ["energy.svg"]),
    "material": ([], "material test.yaml --output rows.csv --picture curve.png", ["rows.csv", "curve.png"]),
    "calibrate": ([], "calibrate test.yaml", []),
    "schema": ([], "schema", []),
    "schema-markdown": ([], "schema --markdown", []),
    "models": ([], "models", []),
    "models-markdown": ([], "models --markdown", []),
    "new": ([], "new --example materials/mazars fresh.yaml", ["fresh.yaml"]),
    "new-list": ([], "new --example", []),
    "study": ([], "study plate.yaml --vary body.plate.spacing=1\\ cm,1.5\\ cm --threads 1 --jobs 1 --curve mouth.distance:grip.x",
              ["plate-study/table.csv", "plate-study/table.txt"]),
    "modes": ([], "modes rest.yaml --count 2", ["rest-modes"]),
    "failure": ([], "failure torn.yaml --load variables.load=1\\ MPa:9\\ MPa --within 0.9 --jobs 1 --threads 1", ["torn-failure/failure.csv"]),
    "spectrum": ([], "spectrum motion.csv --column velocity --unit m/s --periods 0.1:1 --count 3", ["motion-spectrum"]),
    "calibrate-concrete": ([], "calibrate concrete --fc 4000psi", []),
}
RELATION = "relation: "
WALKS |= {RELATION + name: ([], f"run {file_of(name)}.yaml", [file_of(name)]) for name in RELATIONS}

# what differs from one good run to the next
TIMES = re.compile(rb"[0-9.]+ ns per directed bond|[0-9.]+ s for [0-9]+ steps|\"(wall_seconds|ns_per_directed_bond_step)\": [0-9.e+-]+|"
                   rb"(about|at least) [0-9.]+ (s|min|h)|, [0-9]+ s$", re.M)


# how it is told: by us, or by a file's message with the system's own words
TOLD = re.compile("out of memory|Cannot allocate memory")

# what crashes by itself when it is refused memory, or tries again without end
KNOWN_ENDS = ("crash in libarpack", "crash in libdmumps", "crash in libfontconfig", "crash in libfyaml", "crash in libgfortran", "crash in libhdf5",
              "crash in libmumps", "crash in libudunits2", "no end in libfontconfig")
CASES = ("study", "failure")  # verbs of which each case tells it, and whose own last line says in which file there is more
LOG = re.compile(r"/log\.txt tells more$")
KEPT = re.compile("^kept: .*$", re.M)
END = re.compile("^(?:crash|no end) in .*$", re.M)


def words_of(command):
    return [w.replace("\\ ", " ") for w in re.split(r"(?<!\\) ", command)]


class Walk:
    def __init__(self, options, verb, known):
        self.options, self.verb = options, verb
        self.known = known  # places of calls that other verbs were refused; those of this one are added
        self.before, self.command, self.files = WALKS[verb]
        self.folder = tempfile.mkdtemp(prefix="memory.")
        self.shim = shutil.copy(options.shim, self.folder)  # LD_PRELOAD ends a name at a blank
        self.ends = collections.Counter()
        self.start = os.path.join(self.folder, "start")
        os.mkdir(self.start)
        self.of_relation = verb.startswith(RELATION)
        if self.of_relation:
            write_relation(self.start, verb.removeprefix(RELATION))
        else:
            write_decks(self.start)
        for command in self.before:
            self.run(self.start, command, None)

    def run(self, folder, command, call, on=False, must=True):
        """One run of the command in a folder. call None: with nothing in the way; must: it is to go well then"""
        environment = dict(os.environ, OMP_NUM_THREADS="1")
        if call is not None:
            environment.update(LD_PRELOAD=self.shim, BRECCIA_FAIL_AT=str(call), BRECCIA_FAIL_ON="1" if on else "0",
                               BRECCIA_FAIL_WHOSE="all" if self.options.libraries else "program",
                               BRECCIA_FAIL_COUNT=os.path.join(self.folder, "count") if call == 0 else "")
        done = subprocess.run([self.options.command] + words_of(command), cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=1800)
        if must and not call and done.returncode:
            sys.exit(f"{self.verb}: '{command}' fails with all its memory: {done.stderr.decode()}")
        return done

    def fresh(self, name):
        folder = os.path.join(self.folder, name)
        shutil.copytree(self.start, folder)
        return folder

    def written(self, folder):
        """All that was written, relative to the folder."""
        found = []
        for name in self.files:
            whole = os.path.join(folder, name)
            if os.path.isdir(whole):
                for at, _, names in os.walk(whole):
                    found += [os.path.relpath(os.path.join(at, n), folder) for n in names]
            elif os.path.exists(whole):
                found.append(name)
        return sorted(found)

    def differs(self, folder, only=""):
        """The first file that is not as with all memory; None if all are. only: endings of the files that count"""
        names, expected = ([n for n in all if n.endswith(only)] for all in (self.written(folder), self.expected))
        if names != expected:
            return f"files {sorted(set(names) ^ set(expected))}"
        for name in names:
            good, here = os.path.join(self.good, name), os.path.join(folder, name)
            if name.endswith((".vtkhdf", ".h5")):
                if subprocess.run([self.options.compare, good, here], stdout=subprocess.DEVNULL).returncode:
                    return name
            elif TIMES.sub(b"", open(good, "rb").read()) != TIMES.sub(b"", open(here, "rb").read()):
                return name
        return None

    def ended(self, signal, words):
        """What is wrong with an end by a signal; None if a library is known to have it."""
        found = END.findall(words)
        if not found or not self.options.libraries or not found[0].startswith(KNOWN_ENDS):
            return found[0] if found else f"ended by signal {signal}"
        self.ends[found[0]] += 1
        return None

    def taken_up(self, folder):
        """What is wrong with a run that is taken up after its end for lack of memory; None if nothing is."""
        command = self.command if "--restart" in self.command else self.command + " --restart"
        done = self.run(folder, command, None, must=False)
        if done.returncode:
            none = done.returncode == 2 and b"there is no checkpoint" in done.stderr
            return None if none else f"taken up, it ends with status {done.returncode}: {done.stderr[:200]!r}"
        wrong = self.differs(folder, (".vtkhdf", ".csv", ".xdmf"))
        return wrong and f"taken up, it ends with another {wrong}"

    def judge(self, call, on):
        folder = self.fresh(f"{call}-{int(on)}")
        done = self.run(folder, self.command, call, on)
        words = done.stderr.decode(errors="replace").strip()
        kept = KEPT.search(words)
        words = KEPT.sub("", words).strip()
        problem = None
        if kept:
            problem = kept.group()
        elif done.returncode < 0:
            problem = self.ended(-done.returncode, words)
        elif done.returncode == 0:
            wrong = self.differs(folder)
            if wrong:
                problem = f"status 0, but not as it should be: {wrong}"
            elif TIMES.sub(b"", done.stdout) != self.printed:
                problem = "status 0, but it printed something else"
        elif self.options.libraries:
            if done.returncode > 2 or not words:
                problem = f"status {done.returncode}"
        else:
            lines = [line for line in words.split("\n") if not re.match("(\\S+: )?warning:", line)]
            if self.verb in CASES:
                lines = [line for line in lines if not LOG.search(line)]
            if done.returncode != 1:
                problem = f"status {done.returncode}"
            elif not lines or not all(TOLD.search(line) for line in lines) or (len(lines) > 1 and self.verb not in CASES):
                problem = "not one line that tells it"
        if done.returncode and not problem and words_of(self.command)[0] == "run":
            problem = self.taken_up(folder)
        shutil.rmtree(folder)
        if problem:
            return f"{self.verb}: call {call}{' and on' if on else ''}: {problem}: {words[:300]!r}"
        return None

    def go(self, pool):
        self.good = self.fresh("good")
        self.printed = TIMES.sub(b"", self.run(self.good, self.command, 0).stdout)
        self.expected = self.written(self.good)
        with open(os.path.join(self.folder, "count")) as file:
            rows = [line.split() for line in file]
        if not rows:
            sys.exit(f"{self.verb}: asks for no memory: is the command the right one?")
        first = {place: int(call) for call, place in reversed(rows) if place not in self.known}
        calls = max(int(call) for call, _ in rows)
        self.known.update(first)
        # Neighbours in time are alike: of the others every K-th, from a first that differs from verb to verb; of verbs with few calls some at
        # least, but of the decks of the relations, which are many, no more than that.
        every = self.options.every if self.of_relation else min(self.options.every, max(1, calls // 3))
        chosen = sorted({*sorted(first.values())[::self.options.places], *range(1 + sum(map(ord, self.verb)) % every, calls + 1, every)})
        problems = [p for p in pool.map(lambda n: self.judge(n, n % 2 == 0), chosen) if p]
        shutil.rmtree(self.folder)
        for problem in problems:
            print("FAIL:", problem)
        print(f"{self.verb}: {calls} calls, {len(first)} of them from new places, {len(chosen)} refused, {len(problems)} problems{tell(self.ends)}", flush=True)
        return len(chosen), problems, self.ends


def tell(ends):
    return "".join(f", {count} times a {end}" for end, count in sorted(ends.items()))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("shim")
    parser.add_argument("compare")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--places", type=int, default=1)
    parser.add_argument("--decks", type=int, default=1)
    parser.add_argument("--verb")
    parser.add_argument("--libraries", action="store_true")
    options = parser.parse_args()
    for name in ("command", "shim", "compare"):
        setattr(options, name, os.path.abspath(getattr(options, name)))
    refused, problems, ends, places = 0, [], collections.Counter(), set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        relations = [verb for verb in WALKS if verb.startswith(RELATION)]
        left_out = set(relations) - set(relations[:: options.decks])
        for verb in [options.verb] if options.verb else [verb for verb in WALKS if verb not in left_out]:
            count, found, known = Walk(options, verb, places).go(pool)
            refused += count
            problems += found
            ends += known
    print(f"memory{' of libraries too' if options.libraries else ''}: {refused} calls refused, {len(problems)} problems{tell(ends)}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
