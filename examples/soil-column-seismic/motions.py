"""Writes the two motions of the base, in g: ricker.AT2, a pulse of 2 Hz and 0.2 g, and record.AT2, which is made to look like a record on stiff ground: noise with the
spectrum of Kanai and Tajimi, low frequencies taken out as by Clough and Penzien, under an envelope that rises, stays and dies away. The seed makes it the same every time."""
from math import cos, exp, pi, sin
from random import Random

STEP = 0.005  # s

def ricker(duration=3, frequency=2, peak=0.2, middle=0.8):
    values = []
    for n in range(round(duration / STEP) + 1):
        a = (pi * frequency * (n * STEP - middle)) ** 2
        values.append(peak * (1 - 2 * a) * exp(-a))
    return values

def amplitude(f, ground=2.5, damping=0.6, low=0.4):
    """Of the noise at a frequency; nothing above 20 Hz."""
    r, s = f / ground, f / low
    tajimi = (1 + (2 * damping * r) ** 2) / ((1 - r * r) ** 2 + (2 * damping * r) ** 2)
    penzien = s ** 4 / ((1 - s * s) ** 2 + (2 * 0.6 * s) ** 2)
    return (tajimi * penzien * min(1, max(0, (20 - f) / 5))) ** 0.5

def envelope(t, duration, rise=1.5, fall=5):
    end = min(1, max(0, (duration - t) / 1))
    return min(1, (t / rise) ** 2) * exp(-0.55 * max(0, t - fall)) * end

def record(duration=10, peak=0.2, seed=1994):
    random, count = Random(seed), round(duration / STEP) + 1
    waves = [(amplitude(f), 2 * pi * f, random.uniform(0, 2 * pi)) for f in (0.05 + 0.07 * n for n in range(285))]
    shape = [envelope(n * STEP, duration) for n in range(count)]
    values = [e * sum(a * cos(w * n * STEP + phase) for a, w, phase in waves) for n, e in enumerate(shape)]
    return scaled(at_rest(values, shape), peak)

def ends(values):
    """Velocity and displacement at the end."""
    v = u = 0
    for before, after in zip(values, values[1:]):
        u += STEP * v + STEP ** 2 * (2 * before + after) / 6
        v += STEP * (before + after) / 2
    return v, u

def at_rest(values, shape):
    """Takes a slow wave under the envelope off, after which velocity and displacement end at nothing."""
    duration = STEP * (len(values) - 1)
    ways = [[e * wave(pi * n * STEP / duration) for n, e in enumerate(shape)] for wave in (sin, cos)]
    (v, u), (v1, u1), (v2, u2) = ends(values), ends(ways[0]), ends(ways[1])
    whole = v1 * u2 - v2 * u1
    first, second = (v * u2 - v2 * u) / whole, (v1 * u - v * u1) / whole
    return [a - first * b - second * c for a, b, c in zip(values, *ways)]

def scaled(values, peak):
    most = max(abs(a) for a in values)
    return [peak * a / most for a in values]

def write(name, title, values):
    with open(name, "w") as file:
        file.write(f"{title}\nMade by motions.py\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {len(values)}, DT= {STEP:.4f} SEC\n")
        for n in range(0, len(values), 5):
            file.write("".join(f"{a:15.7E}" for a in values[n:n + 5]) + "\n")

def read(name):
    """Accelerations in g."""
    return [float(word) for line in open(name).read().splitlines()[4:] for word in line.split()]

if __name__ == "__main__":
    write("ricker.AT2", "RICKER PULSE, 2 HZ", ricker())
    write("record.AT2", "SYNTHETIC RECORD, STIFF GROUND", record())
