"""The footing: three spacings, two horizons, two formulations."""
from reporting import STYLES, Run, between, chart, picture, table

PRANDTL = 5.1416  # (2 + pi) s_u


class Footing:
    def __init__(self, spacing, layers=2.015, formulation="ordinary"):
        """spacing: mm; formulation: with its keys"""
        self.spacing, self.horizon = spacing, layers * spacing / 1000
        self.run = Run("footing.yaml", [f"variables.dx={spacing:.9g} mm"], edits=[
            ("horizon: 2.015 spacings", f"horizon: {layers} spacings"), ("formulation: ordinary", f"formulation: {formulation}")], results=1)
        self.settled = [-1000 * u for u in self.run.column("settlement", "y")]
        self.carried = [f / 100 for f in self.run.column("footing", "y")]  # kN on 1 m x 1 m over s_u
        self.limit = max(self.carried)

    def row(self, name):
        at = self.settled[self.carried.index(self.limit)]
        still = ", still growing" if self.limit == self.carried[-1] else ""
        return [name, str(self.run.summary["particles"]), f"{self.limit:.2f} s_u at {at:.1f} mm{still}", f"{100 * (self.limit / PRANDTL - 1):+.1f} %"]


HEAD = ["particles", "largest load over the width", "over Prandtl's 5.142 s_u"]
spacings = {d: Footing(d) for d in (100, 200 / 3, 50)}
horizons = {m: spacings[50] if m == 2.015 else Footing(50, m) for m in (2.015, 3.015)}
between("spacing", table(["spacing"] + HEAD, [f.row(f"{d:.3g} mm") for d, f in spacings.items()]))
between("horizon", table(["horizon at 50 mm"] + HEAD, [f.row(f"{m:g} spacings") for m, f in horizons.items()]))
KEPT, FADES = ("correspondence, zero-energy control: {silling: 0.2%s}" % fades for fades in ("", ", fades: yielding"))
formulations = [("ordinary, 100 mm", spacings[100]), ("correspondence, control kept, 100 mm", Footing(100, formulation=KEPT)),
                ("correspondence, control fades with yielding, 100 mm", Footing(100, formulation=FADES)),
                ("ordinary, 50 mm", spacings[50]), ("correspondence, control fades with yielding, 50 mm", Footing(50, formulation=FADES))]
between("formulation", table(["formulation and spacing"] + HEAD, [f.row(name) for name, f in formulations]))

picture(spacings[50].run, "displacement", "displacement", "--deformed", "10")
chart("load-settlement", "Load on the footing against its settlement", "settlement [mm]", "load over width and s_u",
      [(f"spacing {d:.3g} mm", style, list(zip(f.settled, f.carried))) for (d, f), style in zip(spacings.items(), STYLES)],
      f"set arrow from graph 0, first {PRANDTL} to graph 1, first {PRANDTL} nohead lw 1.5 lc rgb '#555555'\n"
      f"set label '2 + π' at graph 0.02, first {PRANDTL + 0.15} tc rgb '#555555'\nset yrange [0:6.5]")
chart("convergence", "Limit load over Prandtl's", "horizon over half the width", "deviation [%]",
      [("spacing 100, 66.7 and 50 mm, horizon 2.015 spacings", STYLES[0], [(f.horizon, 100 * (f.limit / PRANDTL - 1)) for f in spacings.values()]),
       ("spacing 50 mm, horizon 2.015 and 3.015 spacings", STYLES[1], [(f.horizon, 100 * (f.limit / PRANDTL - 1)) for f in horizons.values()])],
      "set xrange [0:0.35]")
