"""The dam shaken: its frequencies beside published ones and finite elements, its cracks, three spacings and three motions."""
import csv
import math
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

import record
from reporting import LINE, STYLES, Run, between, breccia, chart, picture, table, work

os.environ["OMP_NUM_THREADS"] = "1"  # two runs beside each other instead
KINK, SEED = 66.5, 1967  # height of the kink downstream, m
OPEN = 180e-6 / 1.8  # G_F / f_t, m
DRY = "materials.water.density=1e-3 kg/m3"


def width(y):
    return 70 - 50.75 * max(y, 0) / 66.5 if y < KINK else 19.25 - 4.45 * (y - KINK) / 36.5


class Dam:
    def __init__(self, columns, seed=SEED, shaken=2.4, elastic=False, rock=False, settings=()):
        self.dx = dx = 19.24 / (columns + 0.5)
        motion = os.path.join(work.name, f"{seed}")
        rows = [j * dx for j in range(math.ceil(45 / dx), int(90 / dx))]
        last = lambda y: (math.floor(width(y) / dx - 0.5 - 1e-9) + 0.5) * dx
        self.places = ([("downstream", last(y), y) for y in rows] + [("upstream", dx / 2, y) for y in rows] +
                       [("base", (i + 0.5) * dx, dx) for i in range(int(last(dx) / dx) + 1)])
        watches = "".join(f"  p{n}: {{history of: {{nearest: [{x:.9g}, {y:.9g}]}}, every: 20}}\n" for n, (_, x, y) in enumerate(self.places))
        needed = "include: dam.yaml" if rock else "file: water.csv"
        edits = [("watch:\n", "watch:\n" + watches), (needed, needed.replace(": ", f": {os.getcwd()}/")), ("name: transverse.AT2", f"name: {motion}/transverse.AT2"),
                 ("name: vertical.AT2", f"name: {motion}/vertical.AT2")]
        if elastic:
            edits.append(("- name: earthquake", "- name: earthquake\n    laws: elastic"))
        self.run = Run("rock.yaml" if rock else "dam.yaml", [f"variables.columns={columns}", f"variables.shaken={shaken} s", *settings], edits=edits)
        crest, foot = (self.run.column(watch, "x") for watch in ("crest", "foot" if rock else "crest"))
        self.crest = [(t - 1, 1000 * (x - u * rock)) for t, x, u in zip(self.run.column("crest", "time"), crest, foot)][1:]
        if not elastic:
            self.openings = {}  # by place: times and openings; the rows at both sides of a crack share it
            for n, (where, x, y) in enumerate(self.places):
                times, strains = self.run.column(f"p{n}", "time"), self.run.column(f"p{n}", "plastic strain in tension")
                self.openings[where, x, y] = [(t - 1, 2 * dx * e) for t, e in zip(times, strains)]

    def first(self, where):
        """When a crack is first open at a face."""
        times = [t for (face, _, _), rows in self.openings.items() if face == where for t, w in rows if w >= OPEN]
        return min(times, default=None)

    def widest(self, where):
        """Where a face has opened the most."""
        _, y = max((rows[-1][1], y) for (face, _, y), rows in self.openings.items() if face == where)
        return y

    def opens(self, where):
        """Where a crack is open first at a face, the upper one of the two rows that share it: which one of several cracks is the widest in the end is up to roundings."""
        time = self.first(where)
        return max((y for (face, _, y), rows in self.openings.items() if face == where for t, w in rows if t == time and w >= OPEN), default=None)

    def base(self):
        """How far the crack along the base reaches."""
        return max([x + self.dx / 2 for (face, x, _), rows in self.openings.items() if face == "base" and rows[-1][1] >= OPEN], default=0)

    def row(self, name):
        when = lambda t: "none" if t is None else f"{t:.2f} s"
        base, high, low = self.base(), self.widest("downstream"), self.opens("upstream")
        return [name, when(self.first("base")), f"{base:.0f} m", when(self.first("downstream")), when(self.first("upstream")), f"{high:.1f} m", "none" if low is None else f"{low:.1f} m"]


def modes(columns, *settings):
    folder = os.path.join(work.name, f"modes-{columns}-{len(settings)}")
    breccia("modes", "dam.yaml", "--count", "4", "--output", folder, "--set", f"variables.columns={columns}", *(a for s in settings for a in ("--set", s)))
    with open(os.path.join(folder, "modes.csv")) as file:
        rows = list(csv.reader(file))
    place = [name.split(" (")[0] for name in rows[0]].index("frequency")
    return [float(row[place]) for row in rows[1:5]]


def finite_elements():
    python = "../../.venv/opensees/bin/python"
    if not os.path.exists(python):
        return None
    said = subprocess.run([python, "elements.py"], check=True, capture_output=True, text=True).stdout
    return [[float(word) for word in line.split()] for line in said.splitlines()[:2]]


figures = lambda values: [f"{value:.2f} Hz" if value else "–" for value in values]
elements = finite_elements()
rows = [["without water, spacing 1.04 m"] + figures(modes(18, DRY)), ["without water, spacing 2.03 m"] + figures(modes(9, DRY))]
if elements:
    rows.append(["without water, finite elements (SSPquad of OpenSees)"] + figures(elements[0]))
rows += [["without water, from the damping of Sharma, Fujisawa and Murakami (2020)"] + figures([19.35 / (2 * math.pi), 0, 0, 0]),
         ["with water, spacing 1.04 m"] + figures(modes(18)), ["with water, spacing 2.03 m"] + figures(modes(9))]
if elements:
    rows.append(["with water, finite elements"] + figures(elements[1]))
between("frequencies", table(["", "first", "second", "third", "fourth"], rows))

for seed in (SEED, 1, 2):
    os.makedirs(os.path.join(work.name, f"{seed}"))
    record.write(seed, os.path.join(work.name, f"{seed}"))
cases = {"spacing 0.70 m": {"columns": 27}, "on rock, spacing 1.04 m": {"columns": 18, "rock": True}, "spacing 1.04 m": {"columns": 18}, "elastic": {"columns": 18, "elastic": True},
         "the same, 160 m of rock to each side instead of 60 m": {"columns": 9, "rock": True, "settings": ["variables.aside=${round(160 m/dx)*dx}"]},
         "on rock, spacing 2.03 m": {"columns": 9, "rock": True}, "spacing 2.03 m": {"columns": 9}, "spacing 2.03 m, another motion (seed 1)": {"columns": 9, "seed": 1},
         "spacing 2.03 m, another motion (seed 2)": {"columns": 9, "seed": 2}}
with ThreadPoolExecutor(2) as pool:
    futures = {name: pool.submit(Dam, **case) for name, case in cases.items()}
    dams = {name: future.result() for name, future in futures.items()}
order = sorted((name for name in dams if name != "elastic"), key=lambda name: ("rock" in name, "motion" in name, "same" in name))
between("cracks", table(
    ["", "heel opens", "crack along the base (± 5 m)", "neck opens downstream", "upstream", "height downstream (± 13 m)", "upstream, where it opens first (± 5 m)"],
    [dams[name].row(name) for name in order] +
    [["published, Koyna record, with water", "1.82 s", "17 m", "2.46 s", "by 2.70 s", "66.5 m, the kink", "lower"],
     ["published, Koyna record, without water's mass", "1.89 s", "13 m", "3.91 s", "4.55 s", "66.5 m, the kink", "lower"]]))

for name, file in (("spacing 1.04 m", "damage"), ("spacing 0.70 m", "damage-finer"), ("on rock, spacing 1.04 m", "damage-rock")):
    picture(dams[name].run, "material damage", file, "--deformed", "50")
chart("crest", "Crest against its foot, from the beginning of the earthquake", "time [s]", "displacement downstream [mm]",
      [(title, style.replace("linespoints pt 7 ps 0.5", "lines").replace("linespoints pt 5 ps 0.5", "lines"), dams[name].crest)
       for title, style, name in (("cracking", STYLES[0], "spacing 1.04 m"), ("elastic", LINE, "elastic"), ("cracking, on rock that gives way", STYLES[1], "on rock, spacing 1.04 m"))])
