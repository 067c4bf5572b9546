"""Kirsch's plate: three spacings, four horizons, three formulations."""
from math import atan2, cos, hypot, sin

from reporting import LINE, STYLES, Run, between, chart, picture, table

RADIUS, MODULUS, RATIO = 0.1, 210e6, 0.3  # m, kPa; stresses over the 1000 kPa that pull


def kirsch(x, y):
    """Stress xx over the pull, and displacement along x times E over pull and radius (plane stress); x and y in radii. Timoshenko and
    Goodier, Theory of Elasticity, on the effect of circular holes."""
    r, t = hypot(x, y), atan2(y, x)
    q, c2, s2, k = 1 / r**2, cos(2 * t), sin(2 * t), (3 - RATIO) / (1 + RATIO)
    radial = (1 - q + (1 - 4 * q + 3 * q * q) * c2) / 2
    hoop = (1 + q - (1 + 3 * q * q) * c2) / 2
    shear = -(1 + 2 * q - 3 * q * q) * s2 / 2
    out = r * ((k - 1) / 2 + c2) + (1 + (1 + k) * c2) / r - c2 / r**3
    around = (-r + (1 - k) / r - 1 / r**3) * s2
    return (radial * cos(t)**2 + hoop * sin(t)**2 - 2 * shear * sin(t) * cos(t),
            (1 + RATIO) / 2 * (out * cos(t) - around * sin(t)))


def solve3(rows, right):
    """Least squares of three unknowns, by normal equations."""
    m = [[sum(r[a] * r[b] for r in rows) for b in range(3)] + [sum(r[a] * f for r, f in zip(rows, right))] for a in range(3)]
    for a in range(3):
        for b in range(3):
            if b != a:
                m[b] = [v - m[b][a] / m[a][a] * w for v, w in zip(m[b], m[a])]
    return [m[a][3] / m[a][a] for a in range(3)]


class Plate:
    def __init__(self, spacing, layers=3.015, edits=()):
        """spacing: mm"""
        d = spacing / 1000
        self.horizon = layers * d / RADIUS
        points = [(d / 2, RADIUS + (n + 0.5) * d) for n in range(int(0.4 / d + 0.5))] + [(RADIUS + d / 2, d / 2)]
        self.run = Run("plate.yaml", [f"variables.dx={spacing} mm", f"variables.layers={layers}"], points, edits, results=1)
        self.stress = [s / 1000 for s in self.run.stress("xx")[:-1]]
        self.exact = [kirsch(x / RADIUS, y / RADIUS) for x, y in points]
        self.y = [y / RADIUS for _, y in points[:-1]]
        moved = self.run.displacement("x")[-1] * MODULUS / 1000 / RADIUS
        self.side = moved / self.exact[-1][1]
        beyond = [n for n, y in enumerate(self.y) if y > 1 + self.horizon]
        self.largest = max(abs(self.stress[n] / self.exact[n][0] - 1) for n in beyond if self.y[n] < 4)
        near = [n for n in beyond if self.y[n] < 3]  # stress = c0 + c1 / r^2 + c2 / r^4, drawn on to the edge
        self.factor = sum(solve3([(1, self.y[n]**-2, self.y[n]**-4) for n in near], [self.stress[n] for n in near]))

    def row(self, name):
        return [name, str(self.run.summary["particles"]), f"{self.stress[0]:.2f} ({self.exact[0][0]:.2f})", f"{100 * self.largest:.1f} %",
                f"{self.factor:.2f} (3.00)", f"{100 * (self.side - 1):+.1f} %"]


HEAD = ["particles", "stress in the first particle above the hole (Kirsch there)", "largest deviation, from a horizon above the hole to 4 a",
        "stress drawn on to the edge (Kirsch)", "displacement of the edge at (a, 0), deviation"]
spacings = {d: Plate(d) for d in (10, 5, 2.5)}
horizons = {m: spacings[5] if m == 3.015 else Plate(5, m) for m in (2.015, 3.015, 4.015, 6.015)}
correspondence = "formulation: correspondence", "formulation: ordinary"
others = [("correspondence", spacings[5]),
          ("ordinary", Plate(5, edits=[correspondence, ("strain: small, ", "")])),
          ("bond-based, surface correction: energy",
           Plate(5, edits=[("formulation: correspondence", "formulation: bond-based, surface correction: energy"), ("strain: small, ", ""),
                           ("model: elastic", "model: elastic-1d"), (", Poisson ratio: 0.3", "")]))]
between("spacing", table(["spacing"] + HEAD, [p.row(f"{d:g} mm, a / {100 / d:g}") for d, p in spacings.items()]))
between("horizon", table(["horizon at 5 mm"] + HEAD, [p.row(f"{m:g} spacings") for m, p in horizons.items()]))
between("formulation", table(["formulation at 5 mm"] + HEAD, [p.row(name) for name, p in others]))

picture(spacings[5].run, "stress", "stress", "--component", "xx", "--range", "-1000:3000")
fine = [1 + n / 100 for n in range(301)]
chart("ligament", "Stress along the pull, above the hole", "y / a", "stress xx over the pull",
      [("Kirsch", LINE, [(y, kirsch(0, y)[0]) for y in fine])] +
      [(f"spacing {d:g} mm", style, [(y, s) for y, s in zip(p.y, p.stress) if y < 4]) for (d, p), style in zip(spacings.items(), STYLES)])
chart("convergence", "Largest deviation from Kirsch, from a horizon above the hole to 4 a", "horizon / a", "deviation [%]",
      [("spacing 10, 5 and 2.5 mm, horizon 3.015 spacings", STYLES[0], [(p.horizon, 100 * p.largest) for p in spacings.values()]),
       ("spacing 5 mm, horizon 2.015 to 6.015 spacings", STYLES[1], [(p.horizon, 100 * p.largest) for p in horizons.values()])],
      "set logscale xy\nset xtics (0.05, 0.1, 0.2, 0.3)\nset ytics (0.5, 1, 2, 5, 10)")
