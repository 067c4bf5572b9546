"""A plate of concrete pressed between walls: no damage under 16 times its load in tension (Tuniki 2012, figures 4.11 and 4.12)."""
import csv
import json
import os
import shutil
from math import sqrt

from reporting import between, breccia, failure_load, table, trials, work

UNIT = 356  # N on a particle: 251 psi over the width, as in the thesis
LOADED, GAPS, INCH = 47, 50, 0.0254

folder = os.path.join(work.name, "pressed")
breccia("run", "plate.yaml", "--quiet", "--output", folder)
summary = json.load(open(os.path.join(folder, "summary.json")))
with open(os.path.join(folder, "end.csv")) as file:
    moved = -1e3 * float(list(csv.reader(file))[-1][3])
stress = LOADED * 16 * UNIT / (15 * INCH**2)
closed = 1e3 * stress * (1 - 0.2**2) / (3.605e6 * 6894.757) * GAPS * INCH * sqrt(3) / 2 / 2
bears, fails = failure_load(trials("plate.yaml", "--load", "variables.load=5696 N:22784 N", "--within", "0.02", output=os.path.join(work.name, "search")))
even = os.path.join(work.name, "even")
breccia("run", "plate.yaml", "--set", "variables.edges=0.5", "--set", f"variables.load={64 * UNIT} N", "--quiet", "--output", even)
with open(os.path.join(even, "summary.json")) as file:
    summary_even = json.load(file)
lost, verdict = summary["energy"]["dissipated"], summary["rest"]["quasi-static"]
rows = [["damage under 16 f_t (5696 N a particle)", "none", f"{'none' if lost == 0 else 'some'}: {lost:.3g} J dissipated, {verdict}", "none"],
        ["each end moves by, mm", "-", f"{moved:.3f}", f"{closed:.3f}"],
        ["fails between, N a particle", "not tried", f"{bears:.0f} to {fails:.0f}, {bears / UNIT:.1f} to {fails / UNIT:.1f} f_t", "no load"],
        ["damage under 64 f_t where particles at the walls take half a load", "-", f"{summary_even['energy']['dissipated']:.3g} J dissipated, {summary_even['rest']['quasi-static']}", "none"],
        ["without walls (concrete-compression), N a particle", "3600", "3556 to 3574", "3563"]]
between("loads", table(["", "thesis", "computed", "closed form"], rows))
os.makedirs("pictures", exist_ok=True)
for name, here in (("displacement-y", "pressed"), ("tensile-damage", "damage")):
    shutil.copy(os.path.join(folder, "pictures", name + ".png"), f"pictures/{here}.png")
