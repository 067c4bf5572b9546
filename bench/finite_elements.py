#!/usr/bin/env python3
"""Elastic squares and cubes at rest, held at one face and loaded at the other: Breccia, and finite elements of OpenSees whose nodes stand where its particles do
(four-node quadrilaterals, eight-node bricks, its direct solver UmfPack). Processor seconds, memory and the mean displacement of the loaded face, side by side.

  .venv/opensees/bin/python bench/finite_elements.py build/release/breccia [PAGE]

writes a Markdown table, into PAGE between its marks where one is given. Each program has one thread and a process of its own."""
import csv, os, re, shutil, subprocess, sys, tempfile

from pages import machine, write

SPACING, YOUNG, POISSON, LAYERS, FORCE = 0.03, 150e3, 0.25, 3, (400.0, 100.0)
BODIES = [(2, 40), (2, 80), (2, 160), (3, 8), (3, 12), (3, 16), (3, 24)]


def deck(dimensions, n):
    count = ", ".join([str(n)] * dimensions)
    plane = "lattice: square, thickness: 1, " if dimensions == 2 else ""
    still = "[0, 0]" if dimensions == 2 else "[0, 0, 0]"
    force = "[400, 100]" if dimensions == 2 else "[400, 100, 0]"
    return f"""title: elements
units: {{length: m, force: kN, time: s}}
materials: {{m: {{model: elastic, density: 1.5, Young modulus: {YOUNG}, Poisson ratio: {POISSON}}}}}
peridynamics: {{formulation: correspondence, space: {"plane strain" if dimensions == 2 else "3-D"}}}
body: {{b: {{material: m, {plane}spacing: {SPACING}, shape: {{box: {{particles: [{count}]}}}}}}}}
loads: [{{on: {{face: x+, layers: {LAYERS}}}, body force: {force}}}, {{on: {{face: x-, layers: {LAYERS}}}, displacement: {still}}}]
solve: {{static: {{increments: 1}}}}
watch: {{end: {{displacement of: {{face: x+, layers: 1}}, every: 1}}}}
results: {{number: 1}}
pictures: []
"""


def breccia(program, dimensions, n):
    folder = tempfile.mkdtemp()
    with open(folder + "/deck.yaml", "w") as f:
        f.write(deck(dimensions, n))
    subprocess.run([program, "run", "--quiet", folder + "/deck.yaml", "--output", folder + "/out"], check=True,
                   stdout=subprocess.DEVNULL, env=dict(os.environ, OMP_NUM_THREADS="1"))
    with open(folder + "/out/end.csv") as f:
        rows = [row for row in csv.reader(f) if row and not row[0].startswith("#")]
    column = next(k for k, name in enumerate(rows[0]) if re.match(r"(end\.)?x\b", name))
    shutil.rmtree(folder)
    return float(rows[-1][column])


def opensees(dimensions, n):
    import openseespy.opensees as ops
    ops.model("basic", "-ndm", dimensions, "-ndf", dimensions)
    ops.nDMaterial("ElasticIsotropic", 1, YOUNG, POISSON)
    size = [n, n, n if dimensions == 3 else 1]
    number = lambda i, j, k: 1 + i + n * (j + n * k)
    for k in range(size[2]):
        for j in range(n):
            for i in range(n):
                ops.node(number(i, j, k), *[SPACING * x for x in (i, j, k)[:dimensions]])
                if i < LAYERS:
                    ops.fix(number(i, j, k), *[1] * dimensions)
    element = 0
    for k in range(max(1, size[2] - 1)):
        for j in range(n - 1):
            for i in range(n - 1):
                element += 1
                ring = [number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)]
                if dimensions == 2:
                    ops.element("quad", element, *ring, 1.0, "PlaneStrain", 1)
                else:
                    ops.element("stdBrick", element, *ring, *[node + n * n for node in ring], 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    # Particles stand for a body that reaches half a spacing beyond them: its stress on the cross-section of the elements.
    volume = SPACING ** dimensions * ((n - 1) / n) ** (dimensions - 1)
    for k in range(size[2]):
        for j in range(n):
            for i in range(n - LAYERS, n):
                ops.load(number(i, j, k), *([f * volume for f in FORCE] + [0.0])[:dimensions])
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.integrator("LoadControl", 1.0)
    ops.algorithm("Linear")
    ops.analysis("Static")
    if ops.analyze(1):
        raise RuntimeError("OpenSees finds no answer")
    end = [ops.nodeDisp(number(n - 1, j, k), 1) for j in range(n) for k in range(size[2])]
    return sum(end) / len(end)


def measured(work):
    """Answer, processor seconds and megabytes of work in a process of its own, and of what it starts."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        os.write(write, repr(work()).encode())
        os._exit(0)
    os.close(write)
    _, status, used = os.wait4(child, 0)
    with os.fdopen(read) as f:
        answer = f.read()
    if status or not answer:
        raise RuntimeError("failed")
    return float(answer), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main(program, page=None):
    lines = ["| body | unknowns | Breccia s | MB | end, mm | OpenSees s | MB | end, mm | time over ours |", "|---|---|---|---|---|---|---|---|---|"]
    for dimensions, n in BODIES:
        # The child's own peak is that of Python; what it starts is larger only where the body is.
        ours = measured(lambda: breccia(program, dimensions, n))
        theirs = measured(lambda: opensees(dimensions, n))
        name = f"{n}{'²' if dimensions == 2 else '³'}, {'quadrilaterals' if dimensions == 2 else 'bricks'}"
        lines.append(f"| {name} | {dimensions * n ** (dimensions - 1) * (n - LAYERS)} | {ours[1]:.2f} | {ours[2]:.0f} | {1e3 * ours[0]:.5g} | "
                     f"{theirs[1]:.2f} | {theirs[2]:.0f} | {1e3 * theirs[0]:.5g} | {theirs[1] / ours[1]:.1f} |")
        print(lines[-1], flush=True)
    if page:
        write(page, "elements", [f"On one core of {machine()}:", "", *lines])


main(*sys.argv[1:])
