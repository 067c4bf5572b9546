"""The slopes: of clay, its factor by halving the interval in which equilibrium ceases, for two spacings and two horizons; with friction, how far the
crest goes down as strength is divided, for two spacings."""
from math import asin, cos, radians, sin, sqrt, tan

from reporting import STYLES, Run, between, chart, picture, table

STRENGTH, WEIGHT = 50.0, 20.0  # kPa, kN/m3


def top(x):
    return min(20, max(10, 20 - (x - 20) / 2))


def circle(cx, cy, radius, parts=1000):
    """Resisting over driving moment of a slip circle without friction; where it ends at the surface."""
    width = 2 * radius / parts
    turning, ends = 0, []
    for n in range(parts):
        x = cx - radius + (n + 0.5) * width
        depth = top(x) - cy + sqrt(radius**2 - (x - cx)**2)
        if depth > 0:
            turning += WEIGHT * depth * width * (cx - x)
            ends = ends[:1] + [x]
    if turning <= 0 or len(ends) < 2 or ends[0] <= 0 or ends[1] >= 60:
        return 99
    return STRENGTH * radius**2 * (asin((ends[1] - cx) / radius) - asin((ends[0] - cx) / radius)) / turning


circles = min(circle(cx / 2, cy, cy - low) for cx in range(50, 80) for cy in range(20, 45) for low in (0, 1, 2, 4, 6, 8))


class Slope:
    def __init__(self, spacing, layers=3.015, closest=0.025):
        """Halves the interval of factors until it is no wider than `closest`."""
        self.spacing, self.layers = spacing, layers
        self.low, self.high = 1.2, 1.6
        while self.high - self.low > 1.001 * closest:
            factor = round((self.low + self.high) / 2, 6)
            run = Run("slope.yaml", [f"variables.dx={spacing} m", f"variables.factor={factor}"], results=1, edits=[
                ("space: plane strain", f"space: plane strain, horizon: {layers} spacings")])
            if run.summary["completed"]:
                self.low = factor
            else:
                assert "no equilibrium" in run.said, run.said
                self.high, self.failed = factor, run
        self.factor = round((self.low + self.high) / 2, 6)

    def row(self):
        return [f"{self.spacing:g} m", f"{self.layers:g} spacings", str(self.failed.summary["particles"]),
                f"{self.low:.3f} stands, {self.high:.3f} fails", f"{100 * (self.factor / circles - 1):+.1f} %"]


slopes = [Slope(2), Slope(1, 2.015), Slope(1)]
between("factor", table(["spacing", "horizon", "particles", "factor of safety", f"over that of slip circles, {circles:.2f}"], [s.row() for s in slopes]))
picture(slopes[-1].failed, "octahedral shear strain", "shear-strain", "--deformed", "20")


# ---- cohesion and friction ----

COHESION, FRICTION = 10.0, radians(20)


def bishop(cx, cy, radius, parts=300):
    """Factor of a slip circle by Bishop's simplified method of slices; 99 where it leaves the slope or enters the rock."""
    width, slices = 2 * radius / parts, []
    for n in range(parts):
        x = cx - radius + (n + 0.5) * width
        height = min(10, max(0, 10 - (x - 12) / 2)) - cy + sqrt(radius**2 - (x - cx)**2)
        if height > 0 and x < 0:
            return 99
        if height > 0:
            slices.append((WEIGHT * height * width, asin((cx - x) / radius)))
    drives = sum(weight * sin(angle) for weight, angle in slices)
    if len(slices) < 10 or drives <= 0:
        return 99
    factor = 1.0
    for _ in range(30):
        factor = sum((COHESION * width + weight * tan(FRICTION)) / (cos(angle) + sin(angle) * tan(FRICTION) / factor) for weight, angle in slices) / drives
    return factor


slices = min(bishop(cx, cy, cy - low / 2) for cx in range(20, 36) for cy in range(14, 36) for low in range(0, 5))
FACTORS = (1.0, 1.2, 1.3, 1.35, 1.375, 1.4, 1.425, 1.45, 1.475, 1.5, 1.525, 1.55, 1.575, 1.6, 1.65, 1.7)


class Friction:
    def __init__(self, spacing):
        """Settlements of the crest in mm, for each factor as far as there is equilibrium; the last one before they more than double."""
        self.spacing, self.settled = spacing, []
        for factor in FACTORS:
            run = Run("friction.yaml", [f"variables.dx={spacing} m", f"variables.factor={factor}"], results=1)
            assert run.summary["completed"] or "no equilibrium" in run.said, run.said
            self.settled.append(-1000 * run.last("crest", "y"))
            slides = not run.summary["completed"] or len(self.settled) > 1 and self.settled[-1] > 2 * self.settled[-2]
            self.particles, self.last = run.summary["particles"], run
            if slides:
                break
        assert slides, f"with a spacing of {spacing} m it stands at all factors"
        self.low, self.high = FACTORS[len(self.settled) - 2], FACTORS[len(self.settled) - 1]

    def row(self):
        middle = (self.low + self.high) / 2
        return [f"{self.spacing:g} m", str(self.particles), f"{self.settled[0]:.1f} mm", f"{self.settled[-2]:.1f} mm at {self.low}",
                f"{self.settled[-1]:.1f} mm at {self.high}" + ("" if self.last.summary["completed"] else ", at the last equilibrium"), f"{middle:.3f}", f"{100 * (middle / slices - 1):+.1f} %"]


soils = [Friction(0.5), Friction(0.25)]
between("friction", table(["spacing", "particles", "the crest settles, factor 1", "before it slides", "as it slides", "factor of safety", f"over Bishop's, {slices:.2f}"],
                          [soil.row() for soil in soils]))
chart("settlement", "Settlement of the crest as strength is divided", "factor", "settlement [mm]",
      [(f"spacing {soil.spacing:g} m", style, list(zip(FACTORS, soil.settled[:None if soil.last.summary["completed"] else -1]))) for soil, style in zip(soils, STYLES)],
      f"set arrow from {slices}, graph 0 to {slices}, graph 1 nohead lw 1.5 lc rgb '#555555'\nset label \"Bishop's slices\" at {slices - 0.005}, graph 0.8 right tc rgb '#555555'")
picture(soils[-1].last, "octahedral shear strain", "friction-shear-strain", "--deformed", "20")
