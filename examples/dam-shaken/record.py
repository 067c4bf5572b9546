"""An artificial earthquake with the peak accelerations of Koyna, 1967: noise through a filter of the ground (Kanai and Tajimi), with an envelope in time.
python3 record.py [SEED] [FOLDER] writes transverse.AT2 and vertical.AT2."""
import math
import os
import random
import sys

STEP, COUNT, FINEST, DAMPING = 0.01, 1001, 0.05, 0.6  # s, values, Hz, of the ground
COMPONENTS = ("transverse", 6, 0.49), ("vertical", 10, 0.34)  # frequency of the ground in Hz, peak in g


def spectrum(f, ground):
    """Amplitude of the filter, without what is slower than half a hertz (Clough and Penzien)."""
    r, s = f / ground, f / 0.5
    passed = (1 + 4 * DAMPING**2 * r**2) / ((1 - r**2) ** 2 + 4 * DAMPING**2 * r**2)
    return math.sqrt(passed * s**4 / ((1 - s**2) ** 2 + 4 * DAMPING**2 * s**2))


def envelope(t):
    return (t / 2) ** 2 if t < 2 else 1 if t < 5.5 else math.exp(-0.6 * (t - 5.5))


def motion(chance, ground, peak):
    waves = [(2 * math.pi * k * FINEST, spectrum(k * FINEST, ground), chance.uniform(0, 2 * math.pi)) for k in range(1, 501)]
    values = [envelope(n * STEP) * sum(a * math.cos(w * n * STEP + p) for w, a, p in waves) for n in range(COUNT)]
    largest = max(map(abs, values))
    return [peak * value / largest for value in values]


def write(seed, folder):
    chance = random.Random(seed)
    for name, ground, peak in COMPONENTS:
        values = motion(chance, ground, peak)
        with open(os.path.join(folder, name + ".AT2"), "w") as file:
            file.write(f"ARTIFICIAL MOTION WITH THE PEAK OF KOYNA 1967, NO RECORD OF IT\nSEED {seed}, {name.upper()}\n"
                       f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {COUNT}, DT= {STEP:.4f} SEC\n")
            for n in range(0, COUNT, 5):
                file.write("".join(f"{value:15.7E}" for value in values[n:n + 5]) + "\n")


if __name__ == "__main__":
    write(int(sys.argv[1]) if len(sys.argv) > 1 else 1967, sys.argv[2] if len(sys.argv) > 2 else ".")
