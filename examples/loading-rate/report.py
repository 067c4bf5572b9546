"""How the failure load of a plate of concrete depends on the rate of loading and on damping (Tuniki 2012, figures 5.1 and 5.2)."""
import csv
import os
import re

from reporting import between, breccia, chart, failure_load, table, trials, work

RAMPS = (0.25, 0.5, 1, 2)  # periods
COLOURS = ("#c8501e", "#21918c")
LOAD = 380                 # N, above what the plate bears at rest


def settings(ramp, hold, ratio):
    return [w for key, value in (("ramp", ramp), ("hold", hold), ("ratio", ratio)) for w in ("--set", f"variables.{key}={value}")]


def fails(ramp, hold, ratio):
    """The two loads a hundredth apart."""
    folder = os.path.join(work.name, f"search-{ramp}-{ratio}")
    return failure_load(trials("plate.yaml", "--load", "variables.load=150 N:420 N", "--within", "0.01", *settings(ramp, hold, ratio), output=folder))


def history(ramp):
    """Of one load on the plate as in the thesis, up to three periods: period, and (time in periods, movement of the upper end in mm)."""
    folder = os.path.join(work.name, f"run-{ramp}")
    said = breccia("run", "plate.yaml", *settings(ramp, 3 - ramp, 1), "--set", f"variables.load={LOAD} N", "--output", folder).stdout
    period = float(re.search(r"a period of ([0-9.e+-]+) s", said).group(1))
    with open(os.path.join(folder, "end.csv")) as file:
        rows = list(csv.reader(file))[1:]
    os.makedirs("pictures", exist_ok=True)
    os.replace(os.path.join(folder, "pictures", "tensile-damage.png"), f"pictures/ramp-{ramp}.png")
    return [(float(row[1]) / period, 1e3 * float(row[3])) for row in rows]


rows = []
for ratio in (1, 0.1):
    loads = [fails(ramp, 3 - ramp if ratio == 1 else 12, ratio) for ramp in RAMPS]
    rows.append([f"{ratio:g}", *(f"{low:.0f} to {high:.0f}" for low, high in loads)])
between("loads", table(["damping ratio", *(f"ramp {ramp:g} T" for ramp in RAMPS)], rows))
curves = [(f"load grows over {ramp:g} T", f"with lines lw 2 lc rgb '{COLOURS[k]}'", history(ramp)) for k, ramp in enumerate((1, 2))]
for k, (label, style, values) in enumerate(curves):
    print(label, "moves beyond 0.06 mm at", next((f"{t:.2f} T" for t, u in values if u > 0.06), "no time"), "ends at", values[-1])
chart("end", f"Plate under {LOAD} N a particle, critical damping", "time, periods T", "movement of the upper end, mm", curves, more="set yrange [0:0.8]")
