"""A reinforced cantilever under the load of Tuniki 2012, section 5.4, and under one that it bears, beside hand calculations of ACI 318."""
from math import pi

from aci318 import DIRECT, cracking_moment, nominal_moment, shear_strength
from beams import Beam
from reporting import STYLES, between, chart, compared, table

WIDTH, HEIGHT, DEPTH, LENGTH, STEEL, YIELD, CONCRETE = 15, 20, 18.5, 100, 5 * pi * 0.5**2 / 4, 60e3, 4000  # in, psi
YOUNG, RATIO = 3.605e6, 29e6 / 3.605e6
share = RATIO * STEEL / (WIDTH * DEPTH)
axis = DEPTH * ((2 * share + share**2)**0.5 - share)  # of the cracked section, from its pressed face
inertia = WIDTH * axis**3 / 3 + RATIO * STEEL * (DEPTH - axis)**2


def stress(pounds):
    """Of the bars at the wall, by the cracked section [ksi]."""
    return pounds * LENGTH * (DEPTH - axis) / inertia * RATIO / 1e3


def sinks(pounds):
    """Of the end, cracked all along [in]."""
    return pounds * LENGTH**3 / (3 * YOUNG * inertia)


torn = Beam("cantilever.yaml", "lbf").run(7500, [("damage-by-sign", "growing", "cracks"), ("bars-stress", "bars")])
slow = Beam("cantilever.yaml", "lbf", hold=8)
held = slow.run(4500)
shares = slow.shares(3000, 12000, 6, 3)
between("loads", compared([
    ["cracks at the wall, f_t = 251 psi, kips", "", f"{cracking_moment(DIRECT, WIDTH, HEIGHT) / LENGTH / 1e3:.2f}", "", ""],
    ["load of the nominal moment, kips", "10.35", f"{nominal_moment(STEEL, YIELD, CONCRETE, WIDTH, DEPTH) / LENGTH / 1e3:.2f}", "", ""],
    ["shear strength V_c, kips", "37.94", f"{shear_strength(CONCRETE, WIDTH, HEIGHT) / 1e3:.2f} over the height", "", ""],
    ["under 7.5 kips", "fails in bending", "bears it", torn.verdict(), "failed"],
    ["largest stress of the bars then, ksi", "yields", f"{stress(7500):.1f}", f"{torn.bar()['stress_so_far'][1] / 1e3:.1f}", "0 to 60"],
    ["under 4.5 kips, held for 8 periods", "", "bears it", held.verdict(), ""],
    ["largest stress of the bars under it, ksi", "", f"{stress(4500):.1f}", f"{held.bar()['stress_so_far'][1] / 1e3:.1f}", "20 to 30"],
    ["the end sinks under it by, in", "", f"{sinks(4500):.3f}, cracked all along", f"{-held.history('tip')['y']:.3f}", ""],
    ["time under 7.5 kips", "6 min (16 processors)", "", f"{torn.seconds:.0f} s of a processor", ""]]))
between("shares", table(["loads held for 8 periods, kips", "runs", "failed (± 3)"],
                        [[f"{first / 1e3:.1f} to {last / 1e3:.1f}", str(runs), str(failed)] for first, last, runs, failed in shares]))
chart("steel", "Stress of the bars", "along the beam, in", "stress, ksi",
      [("7.5 kips at the end of the run", STYLES[0], torn.bar_stresses()), ("4.5 kips, held for 8 periods", STYLES[1], held.bar_stresses()),
       ("4.5 kips by the cracked section", "with lines lw 1.5 lc rgb '#555555'", [(0, stress(4500)), (LENGTH, 0)])])
