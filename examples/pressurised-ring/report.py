"""Lamé's pipe: four spacings, four horizons, three formulations."""
from math import atan2, cos, hypot, sin

from reporting import LINE, STYLES, Run, between, chart, picture, table

A, B, P, E, NU = 1.0, 2.0, 1000.0, 10e6, 0.25  # m, kPa


def lame(r):
    """Radial and hoop stress over the pressure, and radial displacement (plane strain). Timoshenko and Goodier, Theory of Elasticity."""
    c = A * A / (B * B - A * A)
    return c * (1 - B * B / r**2), c * (1 + B * B / r**2), (1 + NU) / E * P * c * ((1 - 2 * NU) * r + B * B / r)


class Ring:
    def __init__(self, spacing, layers=3.015, edits=()):
        """spacing: mm"""
        d = spacing / 1000
        self.horizon = layers * d
        points = []
        for degrees in (90, 67.5, 45):  # places of particles near lines from the centre
            for n in range(int((B - A) / d + 0.5)):
                r, t = A + (n + 0.5) * d, degrees * 3.141592653589793 / 180
                x, y = ((int(v / d + 1e-9) + 0.5) * d for v in (r * cos(t), r * sin(t)))
                if A < hypot(x, y) < B and (x, y) not in points:
                    points.append((x, y))
        self.run = Run("ring.yaml", [f"variables.dx={spacing} mm", f"variables.layers={layers}"], points, edits, results=1)
        xx, yy, xy = (self.run.stress(c) for c in ("xx", "yy", "xy"))
        self.r, self.hoop, self.radial, self.moved = [], [], [], []
        for n, (x, y) in enumerate(points):
            c, s = cos(atan2(y, x)), sin(atan2(y, x))
            self.r.append(hypot(x, y))
            self.radial.append((xx[n] * c * c + yy[n] * s * s + 2 * xy[n] * s * c) / P)
            self.hoop.append((xx[n] * s * s + yy[n] * c * c - 2 * xy[n] * s * c) / P)
            self.moved.append(self.run.displacement("x")[n] * c + self.run.displacement("y")[n] * s)

    def deviation(self, which, values, low, high):
        """Mean and largest deviation, over the pressure (of displacements: over that of the wall)."""
        scale = lame(A)[2] if which == 2 else 1
        e = [(v - lame(r)[which]) / scale for r, v in zip(self.r, values) if low < r < high]
        return sum(e) / len(e), max(map(abs, e))

    def row(self, name):
        d, whole = self.horizon, (A + 2 * self.horizon, B - 2 * self.horizon)
        near = [v / lame(r)[1] for r, v in zip(self.r, self.hoop) if r < A + d / 3]
        return [name, str(self.run.summary["particles"]), f"{100 * self.deviation(2, self.moved, *whole)[1]:.1f} %",
                f"{100 * self.deviation(1, self.hoop, *whole)[1]:.1f} %", f"{100 * self.deviation(0, self.radial, *whole)[1]:.1f} %",
                f"{min(near):.2f} to {max(near):.2f}"]


HEAD = ["particles", "displacement: largest deviation two horizons off both walls (of that of the wall)", "hoop stress: the same (of the pressure)",
        "radial stress: the same", "hoop stress in the first particles at the inner wall, over Lamé"]
spacings = {d: Ring(d) for d in (50, 25, 12.5)}
horizons = {m: spacings[25] if m == 3.015 else Ring(25, m) for m in (2.015, 3.015, 4.015, 6.015)}
old = "formulation: correspondence, space: plane strain, strain: small"
others = [("correspondence", spacings[25]),
          ("ordinary", Ring(25, edits=[(old, "formulation: ordinary, space: plane strain")])),
          ("bond-based, surface correction: energy",
           Ring(25, edits=[(old, "formulation: bond-based, space: plane strain, surface correction: energy"), ("model: elastic", "model: elastic-1d"),
                           (", Poisson ratio: 0.25", "")]))]
between("spacing", table(["spacing"] + HEAD, [r.row(f"{d:g} mm, a / {1000 / d:g}") for d, r in spacings.items()]))
between("horizon", table(["horizon at 25 mm"] + HEAD, [r.row(f"{m:g} spacings") for m, r in horizons.items()]))
between("formulation", table(["formulation at 25 mm"] + HEAD, [r.row(name) for name, r in others]))

picture(spacings[25].run, "displacement", "displacement")
fine = [1 + n / 100 for n in range(101)]
points = ["with points pt 7 ps 0.5 lc rgb '#c8501e'", "with points pt 5 ps 0.5 lc rgb '#21918c'"]
ring = spacings[25]
chart("stresses", "Stresses in the wall, spacing 25 mm, along three lines from the centre", "r / a", "stress over pressure",
      [("Lamé, hoop", LINE, [(r, lame(r)[1]) for r in fine]), ("Lamé, radial", LINE + " dt 2", [(r, lame(r)[0]) for r in fine]),
       ("hoop", points[0], list(zip(ring.r, ring.hoop))), ("radial", points[1], list(zip(ring.r, ring.radial)))])


def curve(values):
    return [(r.horizon, 100 * r.deviation(2, r.moved, A + 2 * r.horizon, B - 2 * r.horizon)[1]) for r in values]


chart("convergence", "Displacement: largest deviation from Lamé, two horizons off both walls", "horizon / a", "deviation [%]",
      [("spacing 50, 25 and 12.5 mm, horizon 3.015 spacings", STYLES[0], curve(spacings.values())),
       ("spacing 25 mm, horizon 2.015 to 6.015 spacings", STYLES[1], curve(horizons.values()))],
      "set logscale xy\nset xtics (0.03, 0.05, 0.1, 0.2, 0.3)\nset ytics (0.1, 0.2, 0.5, 1, 2, 5)")
