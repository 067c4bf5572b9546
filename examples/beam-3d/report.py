"""The reinforced beam of Tuniki 2012, section 5.2, in space, beside hand calculations of ACI 318 and the beam in the plane."""
import sys
from math import pi

from aci318 import DIRECT, cracking_moment, nominal_moment, shear_strength
from beams import Beam
from reporting import between, compared

WIDTH, HEIGHT, DEPTH, SPAN, STEEL, YIELD, CONCRETE = 20, 15, 13.5, 100, 7 * pi * 0.5**2 / 4, 60e3, 4000  # in, psi


def load(moment):
    """Even load whose moment at mid-span this is [lb/in]."""
    return 8 * moment / SPAN**2


parts = [int(word) for word in sys.argv[1:]] or [3, 7]  # of 4 in, the last one for the pictures
coarse = Beam("beam.yaml", "lbf/in", parts=parts[0])
bears, fails = coarse.search(100, 700, 0.1)
runs = [Beam("beam.yaml", "lbf/in", parts=n).run(700, [("damage-by-sign", "growing", "cracks"), ("bars-stress", "bars")]) for n in parts]
rows = [
    ["cracks at mid-span, f_t = 251 psi, lb/in", "", f"{load(cracking_moment(DIRECT, WIDTH, HEIGHT)):.0f}", "", ""],
    ["load of the shear strength V_c, lb/in", "683", f"{2 * shear_strength(CONCRETE, WIDTH, DEPTH) / SPAN:.0f}", "", ""],
    ["load of the nominal moment, lb/in", "", f"{load(nominal_moment(STEEL, YIELD, CONCRETE, WIDTH, DEPTH)):.0f}", "", ""],
    [f"not at rest after one period, {runs[0].summary['particles']} particles, from a load between, lb/in", "", "", f"{bears:.0f} to {fails:.0f}", ""]]
for run in runs:
    name = f"{run.summary['particles']} particles"
    rows += [[f"under 700 lb/in, {name}", "diagonal cracks", "fails in shear", run.verdict(), "failed"],
             ["largest stress of the bars then, ksi", "", "below 60: they do not yield", f"{run.bar()['stress_so_far'][1] / 1e3:.1f}", "0 to 60"],
             ["the middle has sunk by, in", "", "", f"{-run.history('middle')['z']:.3f}", ""],
             [f"time, {name}", "an hour in the plane (2 × 2.2 GHz)", "", f"{run.seconds:.0f} s of a processor", ""]]
between("loads", compared(rows))
