"""What the two examples with plates of concrete share (Tuniki 2012, chapter 4): failure loads found by the program, beside those of the thesis and of ACI 318."""
import os
import shutil
import tempfile
from math import floor, sqrt

from reporting import breccia, failure_load, trials, work

POUND = 4.448222  # N


def rows_of(height):
    """Rows of a hexagonal lattice of 1 in that a height (in) holds, an odd number, so that both ends are alike."""
    count = floor(height / (sqrt(3) / 2))
    return count if count % 2 else count + 1


def loaded(width):
    """Particles of the three rows at an end."""
    return 3 * width + 2


def by_code(strength, width):
    """Load on each of these that a strength (psi) gives, over the whole width and 1 in of thickness [N]."""
    return strength * width * POUND / loaded(width)


class Plate:
    def __init__(self, width, low, high, within=0.01, keys=None, **more):
        """Searches between two loads (N on a particle). keys: what else the deck is to say; more: further variables of it."""
        self.width, self.rows = width, rows_of(3 * width)
        self.variables = {"width": f"{width} in", "rows": self.rows, **more}
        self.keys = keys or {}
        self.folder = os.path.join(tempfile.mkdtemp(dir=work.name), "plate")
        self.bears, self.fails = failure_load(trials("plate.yaml", *self.settings(), "--load", f"variables.load={low} N:{high} N", "--within", f"{within}",
                                                     output=self.folder))

    def settings(self):
        return [word for key, value in {**{f"variables.{key}": value for key, value in self.variables.items()}, **self.keys}.items() for word in ("--set", f"{key}={value}")]

    def load(self):
        return (self.bears + self.fails) / 2

    def draw(self, load, pictures):
        """Runs the plate under a load and keeps pictures: (what the program calls one, its name here)."""
        folder = os.path.join(self.folder, "drawn")
        breccia("run", "plate.yaml", *self.settings(), "--set", f"variables.load={load} N", "--quiet", "--output", folder)
        os.makedirs("pictures", exist_ok=True)
        for name, here in pictures:
            shutil.copy(os.path.join(folder, "pictures", name + ".png"), f"pictures/{here}.png")
