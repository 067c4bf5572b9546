"""The same column as a beam in shear of one dimension, a program of its own: linear elements with the law in simple shear, lumped masses, Rayleigh damping on the first stiffness, and
central differences. Writes what elements.py writes, by the same words; LAW is elastic, multi-yield or bounding-surface."""
import sys
from math import pi, sqrt

from motions import STEP, read

HEIGHT, DENSITY, SHEAR, STRENGTH = 20.0, 1.5, 60e3, 30.0  # octahedral strength


class Elastic:
    now = 0.0

    def stress(self, change):
        self.now += SHEAR * change
        return self.now


class MultiYield:
    """Iwan's: elastic, perfectly plastic springs side by side, whose sum has the corners of the backbone; in simple shear nested surfaces do the same."""

    def __init__(self, surfaces=20, peak=0.1):
        reference = peak * STRENGTH / (SHEAR * peak - STRENGTH)
        stresses = [sqrt(1.5) * STRENGTH * n / surfaces for n in range(1, surfaces + 1)]
        strains = [t * reference / (SHEAR * reference - t / sqrt(1.5)) for t in stresses]
        slopes = [SHEAR] + [(t1 - t0) / (g1 - g0) for t0, t1, g0, g1 in zip(stresses, stresses[1:], strains, strains[1:])] + [0]
        early = strains[0] - stresses[0] / SHEAR
        self.springs = [(a - b, (a - b) * (g - early)) for a, b, g in zip(slopes, slopes[1:], strains)]
        self.stresses = [0.0] * surfaces

    def stress(self, change):
        stresses = self.stresses
        for n, (stiffness, most) in enumerate(self.springs):
            t = stresses[n] + stiffness * change
            stresses[n] = most if t > most else -most if t < -most else t
        return sum(stresses)


class BoundingSurface:
    """Borja and Amies: the rate is G / (1 + 3 G / H) with H = h k, where k = (R - t) / (t - t0) tells how far the bounding shear stress R is from t, seen from the last reversal t0, and
    all counts along the rate. Its strength is that of the other law. By Heun's rule."""
    bound, hardening = sqrt(1.5) * STRENGTH, SHEAR

    def __init__(self):
        self.now = self.reversal = 0.0
        self.way = 0

    def slope(self, t):
        left, gone = self.bound - self.way * t, self.way * (t - self.reversal)
        if left <= 0:
            return 0.0
        return SHEAR * self.hardening * left / (self.hardening * left + 3 * SHEAR * max(gone, 0))

    def stress(self, change):
        if change * self.way <= 0 and change:
            self.way, self.reversal = (1 if change > 0 else -1), self.now
        first = self.slope(self.now)
        self.now += change * (first + self.slope(self.now + first * change)) / 2
        return self.now


LAWS = {"elastic": Elastic, "multi-yield": MultiYield, "bounding-surface": BoundingSurface}


def main(motion, law, side, step, duration, *heights):
    rows = round(HEIGHT / side)
    low, high = 2 * pi * 2.5, 2 * pi * 12.5
    by_mass, by_stiffness = 0.02 * 2 * low * high / (low + high), 0.02 * 2 / (low + high)
    laws = [LAWS[law]() for _ in range(rows)]
    masses = [DENSITY * side] * (rows - 1) + [DENSITY * side / 2]
    moved, speed, strains, stresses = ([0.0] * rows for _ in range(4))
    ground = read(motion) + [0.0]
    watched, each = [int(h / side) for h in heights], round(STEP / step)
    for n in range(round(duration / step) + 1):
        place, share = divmod(n, each)
        before, after = ground[min(place, len(ground) - 1)], ground[min(place + 1, len(ground) - 1)]
        shaken = 9.81 * (before + (after - before) * share / each)
        forces, u, v = [], 0.0, 0.0
        for k in range(rows):
            strain = (moved[k] - u) / side
            stresses[k] = laws[k].stress(strain - strains[k])
            strains[k] = strain
            forces.append(stresses[k] + by_stiffness * SHEAR * (speed[k] - v) / side)
            u, v = moved[k], speed[k]
        forces.append(0.0)
        was = speed[-1]
        for k in range(rows):
            speed[k] += step * ((forces[k + 1] - forces[k]) / masses[k] - by_mass * speed[k] - shaken)
        if share == 0:
            print(n * step, moved[-1], (was + speed[-1]) / 2, shaken, *(x for k in watched for x in (strains[k], stresses[k])))
        for k in range(rows):
            moved[k] += step * speed[k]


main(sys.argv[1], sys.argv[2], *map(float, sys.argv[3:]))
