"""Memory printed by `breccia check` against the peak of the run, and the time that a failure criterion adds.

    estimates.py BRECCIA
"""
import os
import re
import resource
import subprocess
import sys
import tempfile

os.environ.pop("MALLOC_PERTURB_", None)  # MALLOC_PERTURB_ fills memory that a run never touches
PROGRAM = os.path.abspath(sys.argv[1])
SHARE = 0.2  # relative tolerance of the printed memory
DECK = """
title: estimates
units: {{length: m, force: N, time: s}}
materials: {{m: {{model: {law}, density: 2400 kg/m3, Young modulus: 30 GPa{poisson}}}}}
body: {{b: {{material: m, spacing: 10 mm, {shape}}}}}
peridynamics: {{formulation: {formulation}, {space}horizon: {horizon} spacings}}
{more}
loads:
  - {{on: {{face: x-, layers: 3}}, displacement: {fixed}}}
  - {{on: {{face: x+}}, force: {force}}}
solve: {solve}
results: {{number: 1}}
pictures: []
"""
PLANE = {"shape": "lattice: square, thickness: 10 mm, shape: {box: {particles: [SIZE, SIZE], first particle: [0, 0]}}", "space": "space: plane stress, ",
         "horizon": 3.015, "fixed": "[0, 0]", "force": "[1 kN, 0]"}
CUBE = {"shape": "lattice: cubic, shape: {box: {particles: [SIZE, SIZE, SIZE], first particle: [0, 0, 0]}}", "space": "", "horizon": 2.015,
        "fixed": "[0, 0, 0]", "force": "[1 kN, 0, 0]"}
STATIC = "{static: {increments: 1}}"
EXPLICIT = "{explicit: {end time: 20 us}}"
failed = []


def deck(folder, formulation, body, size, solve=STATIC, more="", softens=False):
    bonds = formulation == "bond-based"
    poisson = "" if bonds else f", Poisson ratio: {0.25 if body is CUBE else 0.3}"
    law = "elastic-1d" if bonds else "mazars" if softens else "elastic"
    if softens:
        poisson += ", tensile strength: 3 MPa, fracture energy: 100 N/m"
    path = os.path.join(folder, "deck.yaml")
    with open(path, "w") as file:
        file.write(DECK.format(formulation=formulation, law=law, poisson=poisson, solve=solve, more=more, **body).replace("SIZE", str(size)))
    return path


def told(path):
    """Returns the megabytes and seconds that check prints."""
    said = subprocess.run([PROGRAM, "check", path], check=True, capture_output=True, text=True).stdout
    found = re.search(r", (\d+) MB, (?:about|at least) ([\d.]+) (s|min|h)", said)
    if not found:
        sys.exit(f"estimates: no memory and time in: {said}")
    return float(found[1]), float(found[2]) * {"s": 1, "min": 60, "h": 3600}[found[3]]


def peak(path, folder):
    """Returns the megabytes of a run, in a separate process because rusage keeps the largest of all children."""
    child = os.fork()
    if child == 0:
        done = subprocess.run([PROGRAM, "run", path, "--quiet", "--output", os.path.join(folder, "results")], capture_output=True, text=True)
        with open(os.path.join(folder, "peak"), "w") as file:
            file.write(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 / 1e6))
        if done.returncode:
            print(done.stderr)
        os._exit(done.returncode)
    if os.waitpid(child, 0)[1]:
        sys.exit(f"estimates: a run of {open(path).read()} failed")
    with open(os.path.join(folder, "peak")) as file:
        return float(file.read())


def memory(words, *arguments, **more):
    with tempfile.TemporaryDirectory() as folder:
        path = deck(folder, *arguments, **more)
        megabytes, taken = told(path)[0], peak(path, folder)
        print(f"memory: {words}: {megabytes:.0f} MB told, {taken:.0f} MB taken")
        if abs(megabytes - taken) > SHARE * taken:
            failed.append(words)


memory("small explicit plate", "correspondence", PLANE, 20, solve=EXPLICIT)
memory("bonds in a plate at rest", "bond-based", PLANE, 250)
memory("ordinary plate at rest", "ordinary", PLANE, 200)
memory("hybrid plate in motion", "hybrid", PLANE, 200, solve=EXPLICIT)
memory("correspondence cube at rest", "correspondence", CUBE, 24)
memory("hybrid plate that may soften, by factors", "hybrid", PLANE, 100, softens=True)
with tempfile.TemporaryDirectory() as without, tempfile.TemporaryDirectory() as folder:
    # The energy of a hybrid bond takes tens of times its share of forces; the factor allows for busy machines.
    plain = told(deck(without, "hybrid", PLANE, 60, solve="{explicit: {end time: 20 ms}}"))[1]
    judged = told(deck(folder, "hybrid", PLANE, 60, solve="{explicit: {end time: 20 ms}}",
                       more="failure: {criterion: critical bond energy, fracture energy: 100 N/m}"))[1]
    print(f"time: hybrid bonds {plain:.3g} s told, with 'critical bond energy' {judged:.3g} s")
    if judged < 5 * plain:
        failed.append("the time of 'critical bond energy'")
if failed:
    sys.exit(f"estimates: told wrongly: {', '.join(failed)}")
