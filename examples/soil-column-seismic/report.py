"""The column in two motions and by two laws beside finite elements and a beam in shear: displacement, strain, stress, hysteresis, acceleration and spectra."""
import csv
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from motions import STEP, read
from reporting import Run, between, breccia, chart, table, work

os.environ["OMP_NUM_THREADS"] = "1"  # two runs beside each other instead
SIDE, GRAVITY, PLACES = 0.25, 9.81, {"base": 0.1, "quarter": 5.1, "middle": 10.1}
DURATIONS = {"ricker": 3, "record": 10}
MULTI_YIELD = """{model: multi-yield-j2, density: 1.5 t/m3, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30 kPa,
         peak octahedral strain: 0.1, surfaces: 20}"""
# Of the same strength in simple shear, 2 s_u / sqrt(3).
BOUNDING = 'model: bounding-surface-clay, density: 1.5 t/m3, shear modulus: 60 MPa, bulk modulus: 100 MPa, undrained strength: "${30 kPa*sqrt(9/8)}", hardening modulus: 60 MPa'
LAWS = {"multi-yield": [], "bounding-surface": [(MULTI_YIELD, "{" + BOUNDING + "}")],
        "elastic": [(MULTI_YIELD, "{model: elastic, density: 1.5 t/m3, shear modulus: 60 MPa, bulk modulus: 100 MPa}")]}
TIES = "  - {on: {except: corner}, tie: {to: corner}}\n"
PERIODIC = [(TIES, "  - {on: {face: x-}, support: {held: periodic}}\n  - {on: {face: y-}, support: {held: periodic}}\n"),
            ('["${2*dx}", "${2*dx}", "${height}"]', '["${dx}", "${dx}", "${height}"]')]
OPENSEES = "../../.venv/opensees/bin/python"


class History:
    """What a column did, at every step of the motion."""

    def __init__(self, name, motion, top, velocity, strains, stresses):
        self.top, self.strains, self.stresses = top, strains, stresses
        ground = [GRAVITY * a for a in read(motion + ".AT2")]
        self.accelerations = [(v1 - v0) / STEP + (a0 + a1) / 2 for v0, v1, a0, a1 in zip(velocity, velocity[1:], ground, ground[1:])]  # between steps, seen from outside
        file = os.path.join(work.name, f"{name}-{motion}.txt".replace(" ", "-"))
        with open(file, "w") as out:
            out.writelines(f"{(n + 0.5) * STEP:.6g} {a:.12g}\n" for n, a in enumerate(self.accelerations))
        self.spectrum = spectrum(file, file + "-spectrum", "--unit", "m/s2")

    def energy(self, place):
        """Area of the loops."""
        g, t = self.strains[place], self.stresses[place]
        return sum((t0 + t1) / 2 * (g1 - g0) for g0, g1, t0, t1 in zip(g, g[1:], t, t[1:]))


def spectrum(file, folder, *words):
    """Periods and pseudo-accelerations at 5 % of critical damping."""
    breccia("spectrum", file, "--periods", "0.1:3", "--count", "30", "--output", folder, *words)
    rows = list(csv.reader(open(os.path.join(folder, "response-spectrum.csv"))))
    return [(float(row[0]), float(row[3])) for row in rows[1:]]


def hybrid(law, motion, name="hybrid", edits=(), parts=1):
    """parts: steps in each of the motion's"""
    run = Run("column.yaml", [f"variables.motion={os.path.abspath(motion)}.AT2", f"variables.duration={DURATIONS[motion]} s", f"variables.step={STEP / parts} s"],
              edits=LAWS[law] + list(edits))
    assert run.summary["completed"], run.said
    column = lambda watch, what: run.column(watch, what)[::parts]
    strains, stresses = ({p: column(p, what + " zx") for p in PLACES} for what in ("strain", "stress"))
    return History(f"{name}-{law}-{parts}", motion, column("top", "x"), column("surface", "x"), strains, stresses)


def judged(python, program, law, motion, step):
    words = [motion + ".AT2", law, SIDE, step, DURATIONS[motion], *PLACES.values()]
    said = subprocess.run([python, program, *map(str, words)], check=True, capture_output=True, text=True).stdout
    _, top, velocity, _, *rest = zip(*([float(word) for word in line.split()] for line in said.splitlines() if line[:1].isdigit()))
    return History(f"{program}-{law}", motion, top, velocity, dict(zip(PLACES, rest[::2])), dict(zip(PLACES, rest[1::2])))


most = lambda values: max(abs(x) for x in values)
share = lambda found, expected: f"{100 * (found / expected - 1):+.2f} %"


def compare(found, expected, loops=True):
    """Rows of a table: what, found, expected, difference, the band of it in per cent."""
    rows = []

    def row(what, value, unit, factor, band):
        a, b = value(found), value(expected)
        rows.append([what, f"{factor * a:.4g} {unit}", f"{factor * b:.4g} {unit}", share(a, b), f"{band} %"])

    row("displacement of the top, largest", lambda h: most(h.top), "mm", 1000, 2)
    for place, height in PLACES.items():
        where = f"{(int(height / SIDE) + 0.5) * SIDE:g} m above the rock"
        row(f"strain {where}, largest", lambda h: most(h.strains[place]), "%", 100, 2)
        row(f"stress {where}, largest", lambda h: most(h.stresses[place]), "kPa", 1, 2)
        if loops:
            row(f"area of the loops {where}", lambda h: h.energy(place), "kJ/m³", 1, 2)
    row("acceleration of the top, largest", lambda h: most(h.accelerations), "m/s²", 1, 5)
    ratios = [(abs(a / b - 1), period, a, b) for (period, a), (_, b) in zip(found.spectrum, expected.spectrum)]
    _, period, a, b = max(ratios)
    rows.append([f"spectrum of the top, at the worst of periods from 0.1 to 3 s, {period:.2g} s", f"{a:.4g} m/s²", f"{b:.4g} m/s²", share(a, b), "5 %"])
    return rows


with ThreadPoolExecutor(2) as pool:
    halves = pool.submit(hybrid, "bounding-surface", "record", parts=2)
    periodic = pool.submit(hybrid, "multi-yield", "ricker", "periodic", PERIODIC)
    runs = {(law, motion): pool.submit(hybrid, law, motion) for motion in ("record", "ricker") for law in ("multi-yield", "bounding-surface")}
    runs["elastic", "record"] = pool.submit(hybrid, "elastic", "record")
    elements = {motion: pool.submit(judged, OPENSEES, "elements.py", "multi-yield", motion, STEP) for motion in ("record", "ricker")} if os.path.exists(OPENSEES) else {}
    beams = {key: pool.submit(judged, sys.executable, "beam.py", *key, STEP / 10) for key in runs}
    modes = pool.submit(breccia, "modes", "column.yaml", "--count", "1", "--output", os.path.join(work.name, "modes"))
    runs, beams, elements = ({key: future.result() for key, future in several.items()} for several in (runs, beams, elements))
    halves, periodic, modes = halves.result(), periodic.result(), modes.result()

frequency = float(list(csv.reader(open(os.path.join(work.name, "modes/modes.csv"))))[1][1])
linear = [["first frequency", f"{frequency:.5g} Hz", "2.5 Hz, V_s / 4 H", share(frequency, 2.5), "0.2 %"]] + compare(runs["elastic", "record"], beams["elastic", "record"], loops=False)
between("linear", table(["elastic, the record", "hybrid", "beam in shear", "difference", "band"], linear))

TITLES = {"ricker": "the pulse", "record": "the record"}
HEAD = ["hybrid", "finite elements", "difference", "band", "beam in shear", "difference"]
for motion, title in TITLES.items():
    rows = compare(runs["multi-yield", motion], beams["multi-yield", motion])
    if elements:
        besides = compare(runs["multi-yield", motion], elements[motion])
        rows = [a + (b[2:4] if a[0] == b[0] else [b[2], f"{b[3]}, at {b[0].split(', ')[-1]}"]) for a, b in zip(besides, rows)]  # the worst period may be another one
        between(f"multi-yield, {title}", table([f"`multi-yield-j2`, {title}", *HEAD], rows))
    rows = compare(runs["bounding-surface", motion], beams["bounding-surface", motion])
    name, head = f"bounding-surface, {title}", [f"`bounding-surface-clay`, {title}", "hybrid", "beam in shear", "difference", "band"]
    if motion == "record":
        finer = compare(halves, beams["bounding-surface", motion])
        rows = [a[:4] + [b[1], b[3] if a[0] == b[0] else f"{b[3]}, at {b[0].split(', ')[-1]}", a[4]] for a, b in zip(rows, finer)]
        head[4:4] = ["hybrid, steps of 2.5 ms", "difference"]  # to which the band belongs
    between(name, table(head, rows))
between("sides", table(["`multi-yield-j2`, the pulse", "sides periodic", "levels tied", "difference", "band"], compare(periodic, runs["multi-yield", "ricker"])))

OURS, THEIRS = "with lines lw 2 lc rgb '#c8501e'", "with lines lw 1.5 dt 2 lc rgb '#222222'"
judge, judges = (elements, "finite elements") if elements else ({m: beams["multi-yield", m] for m in TITLES}, "beam in shear")
percent = lambda h, place: [(100 * g, t) for g, t in zip(h.strains[place], h.stresses[place])]
for place in ("base", "middle"):
    chart(f"loops-{place}", f"multi-yield-j2, the pulse, {PLACES[place]:g} m above the rock", "shear strain [%]", "shear stress [kPa]",
          [("hybrid", OURS, percent(runs["multi-yield", "ricker"], place)), (judges, THEIRS, percent(judge["ricker"], place))])
chart("loops-clay", "bounding-surface-clay, the record, 10.1 m above the rock", "shear strain [%]", "shear stress [kPa]",
      [("hybrid", OURS, percent(halves, "middle")), ("beam in shear", THEIRS, percent(beams["bounding-surface", "record"], "middle"))])
chart("displacement", "Displacement of the top in the record, multi-yield-j2", "time [s]", "displacement [mm]",
      [(name, style, [(n * STEP, 1000 * u) for n, u in enumerate(h.top)]) for name, style, h in (("hybrid", OURS, runs["multi-yield", "record"]), (judges, THEIRS, judge["record"]))])
below = spectrum("record.AT2", os.path.join(work.name, "below"))
chart("spectrum", "Spectra of the record, 5 % of critical damping", "period [s]", "pseudo-acceleration [m/s²]",
      [("top, multi-yield-j2", OURS, runs["multi-yield", "record"].spectrum), (f"top, {judges}", THEIRS, judge["record"].spectrum),
       ("top, elastic", "with lines lw 1.5 lc rgb '#21918c'", runs["elastic", "record"].spectrum), ("base", "with lines lw 1.5 lc rgb '#888888'", below)], "set logscale x\nset xrange [0.1:3]")
