"""The panel by six models beside Winkler's test; with rows of particles turned, and without rows; writes tables and pictures of README.md.
   report.py                run everything, then write
   report.py --only-write   write from the results that are there"""
import csv
import math
import os
import random
import re
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor

from reporting import STYLES, between, breccia, chart, table

MODELS = {"bonds": "bonds that soften", "plastic-damage": "plastic damage", "damage": "damage", "hybrid": "damage, hybrid", "lattice": "lattice of beams",
          "lattice-two-lines": "lattice of beams, two lines"}
TURNS = {"along": 0, "turned": -12.5, "inclined": 30}  # degrees: with the first rows of a square lattice are as far from level as from 25 degrees; with the other those of a
# hexagonal one rise and fall by 30 degrees, and none is level
DRAWN = {"lattice-two-lines": "inclined"}  # what is not drawn along the lattice
PLACES = (0.05, 0.121, 0.208, 0.324, 0.499, 1.0)  # mm

with open("measured.csv") as file:
    MEASURED = [(float(row[0]), float(row[1])) for row in list(csv.reader(file))[1:]]


def turned(text, degrees):
    """The deck with the panel turned about the origin, on the same lattice."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = lambda pair: "[{:.6g}, {:.6g}]".format(*(float(pair[1]) * a + float(pair[2]) * b for a, b in ((c, -s), (s, c))))
    lines = [re.sub(r"\[(-?[\d.]+), (-?[\d.]+)\]", turn, line) if "corners" in line else line for line in text.split("\n")]
    return re.sub(r"(?<=direction: )\[(-?[\d.]+), (-?[\d.]+)\]", turn, "\n".join(lines))


def scattered(text, folder):
    """The deck with particles moved from their places on the lattice at random, by up to 0.3 spacings each way."""
    side, places = 250 / 21, random.Random(1)
    with open(os.path.join(folder, "particles.csv"), "w") as file:
        file.write("x (mm),y (mm),z (mm),volume (mm3)\n")
        for row in range(-3, 42):
            for column in range(42 if row >= 21 else 21):
                x, y = ((place + 0.5 + (places.uniform(-0.3, 0.3) if row >= 0 else 0)) * side for place in (column, row))
                file.write(f"{x:.4f},{y:.4f},0,{side * side * 100:.6g}\n")
    return re.sub(r"shape: \{polygon.*", "file: particles.csv}", text, count=1)


class Panel:
    def __init__(self, model, way=None, name=None, *settings):
        """way: one of TURNS or 'scattered': how the particles stand to the panel; as it is drawn when absent. name: of a run with settings of its own."""
        self.model, self.way = model, way or DRAWN.get(model, "along")
        self.folder = "-".join(filter(None, (model, way, name)))
        if "--only-write" in sys.argv:
            return
        text = open(model + ".yaml").read()
        deck = self.folder + "-deck"
        os.makedirs(deck, exist_ok=True)
        with open(os.path.join(deck, "deck.yaml"), "w") as file:
            drawn = TURNS[DRAWN.get(model, "along")]
            file.write(text if not way else scattered(text, deck) if way == "scattered" else turned(text, TURNS[way] - drawn))
        breccia("run", os.path.join(deck, "deck.yaml"), "--quiet", "--output", self.folder, *(word for setting in settings for word in ("--set", setting)))

    def read(self):
        """Displacement [mm] and force [N] along the jack, and what came of it."""
        angle = math.radians(TURNS.get(self.way, 0))
        s, c = math.sin(angle), math.cos(angle)
        rows = {}
        for watch in ("moved", "jack"):
            with open(os.path.join(self.folder, watch + ".csv")) as file:
                rows[watch] = [c * float(row[3]) - s * float(row[2]) for row in list(csv.reader(file))[1:]]
        self.curve = list(zip(rows["moved"], rows["jack"]))
        with open(os.path.join(self.folder, "summary.json")) as file:
            energies = re.findall(r'"(kinetic|external|damping)": ([^,}\s]*)', file.read())
        self.energy = {name: float(value) for name, value in energies}
        return self


def load(curve, place):
    """N, on straight lines between points."""
    for (a, f), (b, g) in zip(curve, curve[1:]):
        if a <= place <= b and a < b:
            return f + (g - f) * (place - a) / (b - a)
    raise ValueError(f"no load at {place} mm")


def work(curve, to):
    """J, of the jack up to a displacement [mm]."""
    points = [(a, f) for a, f in curve if a < to] + [(to, load(curve, to))]
    return sum((f + g) / 2 * (b - a) for (a, f), (b, g) in zip(points, points[1:])) / 1000


def row(name, curve):
    peak, tested = max(curve, key=lambda point: point[1]), max(f for _, f in MEASURED)
    away = lambda value, measured: f" ({100 * (value / measured - 1):+.1f} %)" if curve is not MEASURED else ""
    work_tested = work(MEASURED, 0.5)
    done = work(curve, 0.5)
    return [name, f"{peak[1]:.0f} N{away(peak[1], tested)}", f"{peak[0]:.3f} mm", f"{done:.2f} J{away(done, work_tested)}",
            *(f"{load(curve, place):.0f}" for place in PLACES)]


with ThreadPoolExecutor(10 if "--all-at-once" in sys.argv else 1) as pool:
    wanted = [(model,) for model in MODELS] + [(model, "turned") for model in ("bonds", "damage", "lattice")] + [("damage", "scattered"), ("lattice", "inclined")]
    bent = [("lattice-two-lines", way) for way in ("along", "turned")] + [("lattice-two-lines", None, name, *(f"materials.concrete.{word}" for word in words)) for name, *words in
        (("code", "initial fracture energy=56.25 N/m", "kink stress=0.2"), ("low", "initial fracture energy=36 N/m", "kink stress=0.25"))]
    panels = [panel.read() for panel in pool.map(lambda words: Panel(*words), wanted + bent)]
plain, others, bent = panels[:6], panels[6:-4], panels[-4:]
head = ["model", "largest load", "at", "work up to 0.5 mm", *(f"N at {place} mm" for place in PLACES[:-1]), f"N at {PLACES[-1]} mm (± 300 N)"]
between("models", table(head, [row("test", MEASURED)] + [row(MODELS[panel.model], panel.curve) for panel in plain]))
ways = {"turned": f"rows turned by {-TURNS['turned']} degrees", "scattered": "no rows", "inclined": f"rows that rise and fall by {TURNS['inclined']} degrees"}
between("rows", table(head, [row(f"{MODELS[panel.model]}, {ways[panel.way]}", panel.curve) for panel in others]))
softening = ("one line", plain[4].curve), ("one line, rows that rise and fall", others[-1].curve), ("two lines, level rows", bent[0].curve), \
    ("two lines, rows turned by 12.5 degrees", bent[1].curve), ("two lines, rows that rise and fall", plain[5].curve), \
    ("the same with G_f 0.625 G_F and the kink at 0.2 (fib Model Code 2010)", bent[2].curve), ("the same with G_f 0.4 G_F and the kink at 0.25 (Bažant 2002)", bent[3].curve)
between("lines", table(head, [row(name, curve) for name, curve in softening]))
between("quiet", "At the end the kinetic energy is {:.2f} to {:.2f} % of the work, and damping has taken {:.1f} to {:.1f} % of it.".format(
    *(end(100 * panel.energy[name] / panel.energy["external"] for panel in panels) for name in ("kinetic", "damping") for end in (min, max))))
if "--only-write" not in sys.argv:
    breccia("run", "strip.yaml", "--quiet", "--output", "strip")
with open(os.path.join("strip", "grip.csv")) as file:
    strip = max(float(row[3]) for row in list(csv.reader(file))[1:]) / (16 * 250 / 21 * 100)
between("computed", f"The test did {work(MEASURED, 1.0):.2f} J up to 1 mm. A strip of the lattice (`strip.yaml`), pulled across its rows, carries {strip:.2f} MPa.")
chart("load", "Load of the L-shaped panel", "displacement of the jack [mm]", "load [N]",
      [("test (Winkler 2001)", "with points pt 6 ps 1 lc rgb '#333333'", MEASURED)] +
      [(MODELS[panel.model], style, panel.curve[::5]) for panel, style in
       zip(plain, [style.replace("linespoints", "lines").split(" pt")[0] + " lw 1.5 " + style[style.index("lc"):] for style in STYLES] + ["with lines lw 1.5 lc rgb '#b03a8c'", "with lines lw 2 lc rgb '#000000'"])],
      "set xrange [0:1]\nset yrange [0:9000]\nset bmargin 8")
for panel, field, name in ((plain[0], "damage", "bonds"), (plain[2], "material-damage", "damage"), (plain[4], "tensile-damage", "lattice"), (plain[3], "material-damage", "hybrid"), (plain[5], "tensile-damage", "lattice-two-lines"),
                           (others[0], "damage", "bonds-turned"), (others[1], "material-damage", "damage-turned"), (others[2], "tensile-damage", "lattice-turned"), (others[3], "material-damage", "damage-scattered"), (others[4], "tensile-damage", "lattice-inclined")):
    shutil.copy(os.path.join(panel.folder, "pictures", field + ".png"), f"pictures/{name}.png")
