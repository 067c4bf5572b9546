"""A cantilever of plain concrete: the load under which it cracks beside that of Tuniki 2012, section 5.3, and of ACI 318."""
from aci318 import DIRECT, cracking_moment, rupture
from beams import Beam
from reporting import between, compared

WIDTH, HEIGHT, LENGTH = 15, 20, 100  # in
YOUNG = 3.605e6  # psi


def load(strength):
    """At the end, under which the top at the wall reaches a strength [kips]."""
    return cracking_moment(strength, WIDTH, HEIGHT) / LENGTH / 1e3


def sinks(pounds):
    """Of the end, uncracked [in]."""
    return pounds * LENGTH**3 / (3 * YOUNG * WIDTH * HEIGHT**3 / 12)


beam = Beam("cantilever.yaml", "lbf")
bears, fails = beam.search(2300, 2700, 0.02)
whole = beam.run(2500)
torn = beam.run(2700, [("damage-by-sign", "before", "growing", "crack")])
between("loads", compared([
    ["load of the cracking moment by the thesis's f_t = 251 psi, kips", "2.5", f"{load(DIRECT):.2f}", "", ""],
    ["the same by ACI's modulus of rupture, 474 psi", "", f"{load(rupture(4000)):.2f}", "", ""],
    ["fails between, kips", "2.5 and 2.7", f"{load(DIRECT):.2f}", f"{bears / 1e3:.2f} to {fails / 1e3:.2f}", "2.2 to 3.0"],
    ["under 2.5 kips", "no damage, steady", "bears it", whole.verdict(), "steady"],
    ["its end sinks then by, in", "", f"{sinks(2500):.4f}", f"{-whole.history('tip')['y']:.4f}", "0.022 to 0.026"],
    ["under 2.7 kips", "a crack at the wall", "cracks", torn.verdict(), "failed"],
    ["time for one load", "27 min", "", f"{torn.seconds:.0f} s of a processor", ""]]))
