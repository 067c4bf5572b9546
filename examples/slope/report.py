"""The slope: its factor by halving the interval in which equilibrium ceases, for two spacings and two horizons."""
from math import asin, sqrt

from reporting import Run, between, picture, table

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
