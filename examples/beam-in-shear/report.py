"""Beam OA1 by four formulations beside the test and hand calculations of ACI 318."""
import csv
import sys

from aci318 import nominal_moment, shear_strength
from loaded_beam import Model
from reporting import LINE, Run, between, chart, compared, table

INCH, PSI, POUND = 25.4, 6894.757e-6, 4.448222e-3  # in mm, MPa, kN
SPAN, HEIGHT, WIDTH, CONCRETE, YIELD = 3660, 552, 305, 22.6, 440  # mm, MPa
BARS = ((1400, 64), (1000, 128))  # mm2, mm above the bottom
LOAD, DEFLECTION = 332, 9.2  # of the test, kN and mm
MODELS = (("beam", "lattice of beams", "damage by sign"), ("bonds", "bonds that soften", "damage"),
          ("hybrid", "plastic damage, hybrid", "material damage"), ("correspondence", "plastic damage, correspondence", "damage"))

steel = sum(area for area, _ in BARS)
depth = HEIGHT - sum(area * above for area, above in BARS) / steel
by_shear = 2 * shear_strength(CONCRETE / PSI, WIDTH / INCH, depth / INCH) * POUND
by_bending = 4 * nominal_moment(steel / INCH**2, YIELD / PSI, CONCRETE / PSI, WIDTH / INCH, depth / INCH) * POUND * INCH / SPAN


def spent_by_a_pulled_bar(strength, rows, height):
    """What a crack across a bar of concrete of a strength (MPa) spends, over G_F, at the spacing of so many rows over a height (mm)."""
    spacing = height / rows
    energy = Run("pulled-bar.yaml", [f"variables.fc={strength} MPa", f"variables.spacing={spacing:.9g} mm"]).summary["energy"]
    return (energy["dissipated"] + energy["fracture"]) / (8 * spacing * 1e-3 * 73e-3 * strength ** 0.18)


models = [Model(*model) for model in MODELS if not sys.argv[1:] or model[0] in sys.argv[1:]]
measured = [(float(x), float(y)) for x, y in list(csv.reader(open("measured.csv")))[1:]]
for model in models:
    print(f"{model.words}: {model.load:.0f} kN at {model.at:.1f} mm, {model.seconds:.0f} s")
if len(models) == len(MODELS):
    within = [model for model in models if model.deck != "bonds"]  # those that keep to their bands
    least = {"hybrid": 0.7}
    stress = LOAD * SPAN / 4 / (0.9 * depth) / steel * 1e3
    between("loads", compared([
        *([f"{model.words}: largest load, kN", f"{LOAD}", f"{by_shear:.0f} by V_c, {by_bending:.0f} by the nominal moment", f"{model.load:.0f}", f"{least.get(model.deck, 0.85) * LOAD:.0f} to {1.15 * LOAD:.0f}"] for model in within),
        *([f"{model.words}: largest stress of the lower bars, MPa", "", f"{stress:.0f} under the load of the test, below {YIELD}", f"{model.bar:.0f}", f"0 to {YIELD}"] for model in within)]))
    bars = (("this beam", CONCRETE, HEIGHT, 24), ("this beam", CONCRETE, HEIGHT, 16), ("the beam in bending", 36.2, 304.8, 18), ("the beam in bending", 36.2, 304.8, 12))
    between("pulled bars", table(["bar of the concrete of", "spacing of", "crack spends, of G_F"],
                                 [[words, f"{rows} rows, {height / rows:.1f} mm", f"{spent_by_a_pulled_bar(strength, rows, height):.2f}"] for words, strength, height, rows in bars]))
    at = (1, 2, 4, 6, 8)
    between("models", table(["model", "largest load, kN (± 5 kN)", "at, mm (± 1 mm)", *(f"kN at {mm} mm (± 5 kN)" for mm in at), "time, s of a processor"],
                            [["test", f"{LOAD}", f"{DEFLECTION}", *(f"{dict(measured)[mm]:.0f}" for mm in at), ""]] +
                            [[model.words, f"{model.load:.0f} ({100 * (model.load / LOAD - 1):+.0f} %)", f"{model.at:.1f}",
                              *("failed" if mm > model.lost else f"{model.carried(mm):.0f}" for mm in at), f"{model.seconds:.0f}"] for model in models]))
    chart("load", "Load at mid-span", "deflection, mm", "load, kN",
          [("test", LINE, measured)] + [(model.words, LINE.replace("#555555", colour), model.curve[::5]) for model, colour in zip(models, ("#c8501e", "#21918c", "#3b3f87", "#b5367a"))], more="set xrange [0:10]\nset yrange [0:400]")
