"""The plate on load paths 4a, 4b and 4c by five models; writes the table and pictures of README.md.
   report.py                run everything, then write
   report.py --only-write   write from the results that are there"""
import csv
import os
import shutil
import sys

from reporting import STYLES, between, breccia, chart, table

MODELS = {"bonds": "bonds that soften", "plastic-damage": "plastic damage", "damage": "damage", "hybrid": "damage, hybrid", "lattice": "lattice of beams"}
FIELDS = {"bonds": "damage", "lattice": "tensile-damage"}
PATHS = ("4a", "4b", "4c")


def deck(model, path):
    """The deck of a path. In 4c the frame is moved along, free across, until the plate bears no more."""
    text = open(model + ".yaml").read()
    if path == "4a":
        return text.replace("shear: 10 kN}", "shear: 5 kN}")
    if path == "4c":
        lines = text.split("\n")
        first, last = (next(n for n, line in enumerate(lines) if line.startswith(key)) for key in ("solve:", "watch:"))
        lines[first:last] = ["  - {on: upper, tie: {directions: y}}", "solve: {explicit: {end time: 10 ms, damping: 300 1/s}}"]
        text = "\n".join(line.replace("pull: {reaction of: pull}", "pull: {reaction of: shear}") for line in lines)
        text = text.replace('force: ["${shear}", 0], history: {ramp to: 3 ms}', "velocity: [6 mm/s, free], platen: fixed, history: {ramp to: 1 ms}")
    return text


class Plate:
    def __init__(self, model, path):
        self.model, self.folder = model, f"{model}-{path}"
        if "--only-write" not in sys.argv:
            os.makedirs(self.folder + "-deck", exist_ok=True)
            with open(os.path.join(self.folder + "-deck", "deck.yaml"), "w") as file:
                file.write(deck(model, path))
            breccia("run", os.path.join(self.folder + "-deck", "deck.yaml"), "--quiet", "--output", self.folder)
        along = 2 if path == "4c" else 3
        rows = {}
        for watch in ("moved", "pull"):
            with open(os.path.join(self.folder, watch + ".csv")) as file:
                rows[watch] = [row for row in list(csv.reader(file))[1:]]
        begin = 0 if path == "4c" else next(n for n, row in enumerate(rows["pull"]) if float(row[1]) > 0.00401)
        self.curve = [(float(moved[along]), float(pull[along]) / 1000) for moved, pull in zip(rows["moved"][begin:], rows["pull"][begin:])]
        self.place, self.largest = max(self.curve, key=lambda point: point[1])

    def said(self):
        grows = self.curve.index((self.place, self.largest)) > 0.97 * len(self.curve)
        return f"{self.largest:.1f} kN at {self.place:.3f} mm" + (", where the run ends" if grows else "")

    def draw(self, name):
        shutil.copy(os.path.join(self.folder, "pictures", FIELDS.get(self.model, "material-damage") + ".png"), f"pictures/{name}.png")


plates = {(model, path): Plate(model, path) for path in PATHS for model in MODELS}
between("loads", table(["model", "4a: largest pull after 5 kN of shear", "4b: after 10 kN", "4c: largest shear without pull"],
                       [["test", "", "", "27.5 kN"]] +
                       [[name] + [plates[model, path].said() for path in PATHS] for model, name in MODELS.items()]))
styles = [style.replace("linespoints", "lines").split(" pt")[0] + " lw 1.5 " + style[style.index("lc"):] for style in STYLES] + ["with lines lw 1.5 lc rgb '#b03a8c'"]
chart("pull", "Load path 4b: pull after 10 kN of shear", "displacement of the upper frame [mm]", "pull [kN]",
      [(name, style, plates[model, "4b"].curve[::5]) for (model, name), style in zip(MODELS.items(), styles)], "set xrange [0:0.05]\nset yrange [0:25]\nset bmargin 8")
for model in ("lattice", "plastic-damage", "damage", "bonds"):
    for path in ("4a", "4b"):
        plates[model, path].draw(f"{model}-{path}")
