"""The column: four spacings, three formulations."""
from reporting import LINE, STYLES, Run, between, chart, picture, table

HEIGHT, MODULUS, WEIGHT = 10.0, 100e3 + 4 * 60e3 / 3, 2 * 9.81  # m, kPa (K + 4 G / 3), kN/m3


def settlement(y):
    """Of a height over the base: weight (H y - y^2 / 2) / M."""
    return WEIGHT * (HEIGHT * y - y * y / 2) / MODULUS


class Column:
    def __init__(self, spacing, edits=(), layers=3.015):
        """spacing: m"""
        self.spacing = spacing
        self.y = [(n + 0.5) * spacing for n in range(int(HEIGHT / spacing + 0.5))]
        self.run = Run("column.yaml", [f"variables.dx={spacing} m", f"peridynamics.horizon={layers} spacings"], [(1 + spacing / 2, y) for y in self.y], edits, results=1)
        self.moved, self.stress = self.run.displacement("y"), self.run.stress("yy")
        self.top = -self.moved[-1] / settlement(self.y[-1]) - 1
        error = [abs(s / WEIGHT + HEIGHT - y) / HEIGHT for s, y in zip(self.stress, self.y)]
        self.below = max(e for e, y in zip(error, self.y) if y < HEIGHT - layers * spacing)

    def row(self, name):
        return [name, str(self.run.summary["particles"]), f"{-1000 * self.moved[-1]:.3f} mm ({1000 * settlement(self.y[-1]):.3f})",
                f"{100 * self.top:+.2f} %", f"{-self.stress[0]:.2f} kPa ({WEIGHT * (HEIGHT - self.y[0]):.2f})", f"{100 * self.below:.2f} %"]


HEAD = ["particles", "settlement of the uppermost particles (closed form there)", "deviation", "vertical stress in the lowest (closed form there)",
        "largest deviation of vertical stresses deeper than a horizon (of that of the base)"]
spacings = {d: Column(d) for d in (0.5, 0.25, 0.125)}
horizons = {m: spacings[0.25] if m == 3.015 else Column(0.25, layers=m) for m in (2.015, 3.015, 4.015, 6.015)}
old = "formulation: correspondence, space: plane strain, strain: small"
others = [("correspondence", spacings[0.25]),
          ("ordinary", Column(0.25, [(old, "formulation: ordinary, space: plane strain")])),
          ("bond-based, surface correction: energy",
           Column(0.25, [(old, "formulation: bond-based, space: plane strain, surface correction: energy"),
                         ("model: elastic", "model: elastic-1d"), ("shear modulus: 60 MPa, bulk modulus: 100 MPa", "Young modulus: 150 MPa")]))]
KEPT = ["deviation (accepted -1 to 1)" if head == "deviation" else head for head in HEAD]  # by correspondence
between("spacing", table(["spacing"] + KEPT, [c.row(f"{d:g} m") for d, c in spacings.items()]))
between("horizon", table(["horizon at 0.25 m"] + KEPT, [c.row(f"{m:g} spacings") for m, c in horizons.items()]))
between("formulation", table(["formulation at 0.25 m"] + HEAD, [c.row(name) for name, c in others]))

picture(spacings[0.25].run, "stress", "stress", "--component", "yy")
chart("convergence", "Settlement: deviation from the closed form", "horizon [m]", "deviation [%]",
      [("spacing 0.5, 0.25 and 0.125 m, horizon 3.015 spacings", STYLES[0], [(3.015 * d, 100 * abs(c.top)) for d, c in spacings.items()]),
       ("spacing 0.25 m, horizon 2.015 to 6.015 spacings", STYLES[1], [(m * 0.25, 100 * abs(c.top)) for m, c in horizons.items()])], "set logscale xy")
