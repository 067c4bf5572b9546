"""The beams that were measured: three depths, by bonds and by plastic damage, beside the tests; the strip that the strength of the bonds is from."""
import csv
import os
import sys

from reporting import STYLES, between, breccia, chart, table

MODELS = {"bonds": "bonds that soften", "plastic-damage": "plastic damage"}
DEPTHS = (50, 100, 200)  # mm
PULLED = {50: 0.012, 100: 0.0165, 200: 0.03}  # mm, what strips of them bear
STRENGTHS = {50: 3, 100: 3.2, 200: 3.4}  # MPa, of bonds at a spacing of a twentieth of the depth
# Opening [mm]: least and largest load [N] of the tests with the smallest depth.
TESTS = {0.018: (933, 1059), 0.030: (789, 1019), 0.050: (637, 897), 0.100: (380, 644), 0.200: (170, 412)}


def column(folder, watch, place):
    with open(os.path.join(folder, watch + ".csv")) as file:
        return [float(row[place]) for row in list(csv.reader(file))[1:]]


def strength_of(model, depth):
    return ("--set", f"variables.strength={STRENGTHS[depth]} MPa") if model == "bonds" else ()


def strip(depth):
    """MPa that a strip of the bonds of a beam carries, 20 spacings wide and 50 mm thick."""
    folder = f"strip-{depth}"
    if "--only-write" not in sys.argv:
        breccia("run", "strip.yaml", "--quiet", "--output", folder, "--set", f"variables.dx={depth / 20} mm",
                "--set", f"variables.pulled={PULLED[depth]} mm", *strength_of("bonds", depth))
    return max(abs(force) for force in column(folder, "grip", 2)) / (depth * 50)


class Beam:
    def __init__(self, model, depth, initial=None):
        """initial: other initial fracture energy than that of the deck [N/m]. The folder of results is MODEL-DEPTH or MODEL-DEPTH-INITIAL."""
        self.depth, self.folder = depth, f"{model}-{depth}" + (f"-{initial}" if initial else "")
        self.name = MODELS[model] + (f", G_f {initial} N/m" if initial else "")
        setting = ["--set", f"materials.concrete.initial fracture energy={initial} N/m"] if initial else []
        if "--only-write" not in sys.argv:
            breccia("run", f"measured-{model}.yaml", "--quiet", "--output", self.folder,
                    "--set", f"variables.D={depth} mm", "--set", f"variables.dx={depth / 20} mm",
                    *setting, *strength_of(model, depth))
        self.curve = list(zip(column(self.folder, "mouth", 3), column(self.folder, "jack", 3)))
        self.peak = max(load for _, load in self.curve)
        self.at_peak = next(opening for opening, load in self.curve if load == self.peak)

    def load(self, opening):
        """N, on straight lines between the states at equilibrium."""
        for (a, f), (b, g) in zip(self.curve, self.curve[1:]):
            if a < opening < b + 1e-6:
                return f + (g - f) * (opening - a) / (b - a)
        raise ValueError(f"{self.folder} ends before an opening of {opening} mm")

    def nominal(self, load=None):
        """MPa: stress in the outermost fibre of the ligament, as if it stayed elastic: 3 F S / (2 b (D - a)^2)."""
        return 3 * (load or self.peak) * 2.5 * self.depth / (2 * 50 * (self.depth / 2)**2)


def against(load, least, largest):
    """Where a load lies beside the band of the tests."""
    if load > largest:
        return f"{load:.0f} N, {100 * (load / largest - 1):.0f} % above"
    return f"{load:.0f} N, {100 * (1 - load / least):.0f} % below" if load < least else f"{load:.0f} N, inside"


def size_effect(strengths):
    """Parameters of Bazant's law, strength = first / sqrt(1 + D / depth): 1 / strength^2 is a straight line in D, fitted by least squares."""
    values = [strength**-2 for strength in strengths]
    mean, middle = sum(DEPTHS) / 3, sum(values) / 3
    slope = sum((d - mean) * (v - middle) for d, v in zip(DEPTHS, values)) / sum((d - mean)**2 for d in DEPTHS)
    start = middle - slope * mean
    return start**-0.5, start / slope


beams = {model: [Beam(model, depth) for depth in DEPTHS] for model in MODELS}
smallest = [beams[model][0] for model in MODELS] + [Beam("plastic-damage", 50, initial) for initial in (50, 62.5)]
between("measured", table(
    ["opening", "tests", *(beam.name for beam in smallest)],
    [[f"{opening * 1000:.0f} µm", f"{least} to {largest} N", *(against(beam.load(opening), least, largest) for beam in smallest)]
     for opening, (least, largest) in TESTS.items()]))
laws = {model: size_effect([beam.nominal() for beam in beams[model]]) for model in MODELS}
between("sizes", table(
    ["depth, spacing", *(f"{name}: largest load, at an opening of, nominal strength" for name in MODELS.values()), "bonds of", "a strip of them carries"],
    [[f"{depth} mm, {depth / 20:g} mm",
      *(f"{beams[model][n].peak:.0f} N, {beams[model][n].at_peak * 1000:.0f} µm, {beams[model][n].nominal():.2f} MPa" for model in MODELS),
      f"{STRENGTHS[depth]} MPa", f"{strip(depth):.2f} MPa"] for n, depth in enumerate(DEPTHS)]) + "\n\nBažant's law fitted to them: " + "; ".join(
         f"{name} {laws[model][0]:.1f} MPa / √(1 + D / {laws[model][1]:.0f} mm)" for model, name in MODELS.items()) + ".")

bars = "".join(f"{opening} {least} {largest}\n" for opening, (least, largest) in TESTS.items())
chart("measured", "Depth 50 mm: load against opening of the notch", "opening on a gauge of 20 mm [mm]", "load [N]",
      [(beam.name, style.replace("ps 0.5", "ps 0.3"), beam.curve) for beam, style in zip(smallest, STYLES)],
      "$tests << end\n" + bars + "end\nset xrange [0:0.21]\nset yrange [0:1300]",
      ["$tests using 1:2:(0):($3-$2) with vectors nohead lw 3 lc rgb '#555555' title 'least and largest of the tests'"])
chart("sizes", "Size effect: nominal strength over depth", "depth [mm]", "3 F S / (2 b (D - a)^2) [MPa]",
      [(name, style.replace("linespoints", "points").replace("ps 0.5", "ps 1.2"), [(beam.depth, beam.nominal()) for beam in beams[model]])
       for (model, name), style in zip(MODELS.items(), STYLES)],
      "$tests << end\n50 {:.3f} {:.3f}\nend\n".format(*(smallest[0].nominal(load) for load in TESTS[0.018])) +
      "set xrange [0:250]\nset yrange [0:9]\nset xtics 50",
      [f"{laws[model][0]} / sqrt(1 + x / {laws[model][1]}) with lines lw 1.5 {style[style.index('lc'):]} title 'Bažant, fitted to them'"
       for model, style in zip(MODELS, STYLES)] +
      ["$tests using 1:2:(0):($3-$2) with vectors nohead lw 3 lc rgb '#555555' title 'tests, at an opening of 18 µm'"])
