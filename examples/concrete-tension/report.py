"""Plates of concrete in tension: table 4.1 of Tuniki 2012 found again, and the crack of the smaller one."""
from plates import Plate, by_code, loaded
from reporting import between, table

STRENGTH = 251  # psi, the direct tensile strength of the thesis
PUBLISHED = {5: 365, 15: 360, 20: 360, 30: 358, 40: 355, 60: 355, 80: 355}  # N on a particle; README.md on two exchanged columns

plates = {width: Plate(width, 300, 420) for width in PUBLISHED}
rows = [[f"{w} × {3 * w}", f"{loaded(w)}", f"{p.rows}", f"{p.bears:.0f} to {p.fails:.0f}", f"{PUBLISHED[w]}", f"{100 * (p.load() / PUBLISHED[w] - 1):+.1f} %",
         f"{by_code(STRENGTH, w):.1f}", f"{100 * (p.load() / by_code(STRENGTH, w) - 1):+.1f} %"] for w, p in plates.items()]
between("loads", table(["plate, in", "loaded particles at an end", "rows", "fails between, N a particle", "thesis, N", "beside the thesis (accepted -5 to 5)", "ACI 318, N", "beside ACI"], rows))
plate = plates[15]
plate.draw(plate.fails, [("tensile-damage", "crack")])
plate.draw(plate.bears, [("tensile-damage", "before")])
