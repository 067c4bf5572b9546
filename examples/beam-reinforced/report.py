"""A reinforced beam under the load of Tuniki 2012, section 5.2, and loads under which it comes to rest, beside hand calculations of ACI 318."""
from math import pi

from aci318 import DIRECT, cracking_moment, nominal_moment, shear_strength
from beams import Beam
from reporting import STYLES, between, chart, compared, table

WIDTH, HEIGHT, DEPTH, SPAN, STEEL, YIELD, CONCRETE = 20, 15, 13.5, 100, 7 * pi * 0.5**2 / 4, 60e3, 4000  # in, psi


def load(moment):
    """Even load whose moment at mid-span this is [lb/in]."""
    return 8 * moment / SPAN**2


def sinks(pounds):
    """Of the middle under an even load, by the cracked section [in]."""
    young, ratio = 3.605e6, 29e6 / 3.605e6
    share = ratio * STEEL / (WIDTH * DEPTH)
    axis = DEPTH * ((2 * share + share**2)**0.5 - share)
    inertia = WIDTH * axis**3 / 3 + ratio * STEEL * (DEPTH - axis)**2
    return 5 * pounds * SPAN**4 / (384 * young * inertia)


torn = Beam("beam.yaml", "lbf/in").run(700, [("damage-by-sign", "growing", "cracks")])
slow = Beam("beam.yaml", "lbf/in", hold=12)
held = slow.run(400)
shares = slow.shares(500, 900, 5, 5)
by_hand = load(nominal_moment(STEEL, YIELD, CONCRETE, WIDTH, DEPTH))
between("loads", compared([
    ["cracks at mid-span, f_t = 251 psi, lb/in", "", f"{load(cracking_moment(DIRECT, WIDTH, HEIGHT)):.0f}", "", ""],
    ["shear strength V_c, kips", "34.2", f"{shear_strength(CONCRETE, WIDTH, DEPTH) / 1e3:.1f}", "", ""],
    ["load of it, lb/in", "683", f"{2 * shear_strength(CONCRETE, WIDTH, DEPTH) / SPAN:.0f}", "", ""],
    ["load of the nominal moment, lb/in", "", f"{by_hand:.0f}", "", ""],
    ["under 700 lb/in", "diagonal cracks", "fails in shear", torn.verdict(), "failed"],
    ["largest stress of the bars then, ksi", "", "below 60: they do not yield", f"{torn.bar()['stress_so_far'][1] / 1e3:.1f}", "0 to 60"],
    ["under 400 lb/in, held for 12 periods", "", "bears it", held.verdict(), "steady"],
    ["the middle sinks under it by, in", "", f"{sinks(400):.3f}, cracked section", f"{-held.history('middle')['y']:.3f}", ""],
    ["largest stress of the bars under it, ksi", "", f"{YIELD * 400 / by_hand / 1e3:.1f}", f"{held.bar()['stress_so_far'][1] / 1e3:.1f}", ""],
    ["time under 700 lb/in", "an hour (2 × 2.2 GHz)", "", f"{torn.seconds:.0f} s of a processor", ""]]))
between("shares", table(["loads held for 12 periods, lb/in", "runs", "failed (± 5)"],
                        [[f"{first:.0f} to {last:.0f}", str(runs), str(failed)] for first, last, runs, failed in shares]))
chart("steel", "Stress of the bars", "along the beam, in", "stress, ksi",
      [("700 lb/in at the end of the run", STYLES[0], torn.bar_stresses()), ("400 lb/in, held for 12 periods", STYLES[1], held.bar_stresses())])
