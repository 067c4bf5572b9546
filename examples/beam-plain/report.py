"""A beam of plain concrete: the load under which it cracks beside that of Tuniki 2012, section 5.1, and of ACI 318."""
from aci318 import DIRECT, cracking_moment, rupture
from beams import Beam
from reporting import between, compared

WIDTH, HEIGHT, LENGTH, SPAN = 6, 11, 30, 27  # in


def load(strength):
    """Even load along the whole beam under which the middle reaches a strength [lb/in]: M = w (SPAN^2 / 8 - overhang^2 / 2)."""
    return cracking_moment(strength, WIDTH, HEIGHT) / (SPAN**2 / 8 - ((LENGTH - SPAN) / 2)**2 / 2)


beam = Beam("beam.yaml", "lbf/in")
bears, fails = beam.search(280, 316, 0.02)
torn = beam.run(300, [("damage-by-sign", "before", "growing", "crack")])
whole = beam.run(270)
between("loads", compared([
    ["cracking moment, lb in, by the thesis's f_t = 251 psi", "30 371", f"{cracking_moment(DIRECT, WIDTH, HEIGHT):.0f}", "", ""],
    ["load of it, lb/in", "270", f"{load(DIRECT):.0f}", "", ""],
    ["the same by ACI's modulus of rupture, 474 psi", "", f"{load(rupture(4000)):.0f}", "", ""],
    ["fails between, lb/in", "300 cracks it, or 1200", f"{load(DIRECT):.0f}", f"{bears:.0f} to {fails:.0f}", "240 to 370"],
    ["under 300 lb/in", "a crack at mid-span", "cracks" if load(DIRECT) < 300 else "bears it", torn.verdict(), "failed"],
    ["the middle 4 in are longer by, thousandths of an inch", "", "", f"{1e3 * torn.history('opening')['opening']:.2f}; {1e3 * whole.history('opening')['opening']:.2f} under 270 lb/in", ""],
    ["time for one load", "33 min (2 × 2.2 GHz)", "", f"{torn.seconds:.0f} s of a processor", ""]]))
