"""A deep beam of plain concrete: the load under which it fails beside that of Tuniki 2012 and of ACI 318."""
from aci318 import DIRECT, cracking_moment, deep_shear_limit
from beams import Beam
from reporting import between, breccia, compared

WIDTH, HEIGHT, LENGTH = 12, 10, 20  # in

limit = 2 * deep_shear_limit(4000, WIDTH, HEIGHT) / LENGTH
simple = 8 * cracking_moment(DIRECT, WIDTH, HEIGHT) / LENGTH**2
beam = Beam("beam.yaml", "lbf/in")
bears, fails = beam.search(3500, 5300, 0.05)
whole = beam.run(bears, [("damage-by-sign", "before")])
torn = beam.run(5000)
breccia("plot", torn.folder, "--field", "damage by sign", "--deformed", "50", "--time", "2.56e-3", "--output", "pictures/crack.png")
reaction = whole.history("left")
between("loads", compared([
    ["particles", "3703", "", f"{whole.summary['particles']}", "3703"],
    ["shear that a deep beam may bear, 10 √f_c b h, as a load, lb/in", "7580", f"{limit:.0f}", "", ""],
    ["cracks at mid-span if a support can slide, lb/in", "", f"{simple:.0f}", "", ""],
    ["fails between, lb/in", "4750 to 5000", "", f"{bears:.0f} to {fails:.0f}", "4000 to 6000"],
    ["under the largest load that it bears", "a small crack, at rest", "", whole.verdict(), "steady"],
    ["energy lost in links under it, share of the work", "", "", f"{whole.summary['energy']['dissipated'] / whole.summary['energy']['external']:.2f}", ""],
    ["each support bears across and along, lb", "", f"{bears * LENGTH / 2:.0f} across", f"{reaction['y']:.0f} and {reaction['x']:.0f}", ""],
    ["under 5000 lb/in", "cracks from the supports", "", torn.verdict(), "failed"],
    ["time for one load", "4 min (8 processors)", "", f"{torn.seconds:.0f} s of a processor", ""]]))
