"""A prestressed beam from release to failure beside hand calculations of its section."""
import csv
import os
import resource
from math import pi

from prestressed import Section, flexural_strength, transfer_length
from reporting import LINE, STYLES, between, breccia, chart, table, work

SPAN, OVERHANG, WIDTH, HEIGHT, DEPTH, ARM = 4.0, 0.21, 0.2, 0.4, 0.3, 1.5  # m
STEEL, CONCRETE, STRAND, TENSION, SHRINKAGE = 3 * 93e-6, 35e3, 195e3, 1100.0, 3e-4
TENSILE, COMPRESSIVE, YIELD, HARDENING = 3.5, 48.0, 1640.0, 0.04  # MPa
SPACING, HORIZON = 0.02, 3.015  # m, spacings
WEIGHT = 2.4e-3 * 9.81 * WIDTH * HEIGHT  # MN/m


def run(name, text):
    deck, folder = os.path.join(work.name, name + ".yaml"), os.path.join(work.name, name)
    with open(deck, "w") as file:
        file.write(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    breccia("run", deck, "--quiet", "--threads", "1", "--output", folder, check=False)  # the jacks end where there is no rest
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return folder, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def columns(folder, name, *wanted):
    with open(os.path.join(folder, name + ".csv")) as file:
        rows = list(csv.reader(file))
    names = [head.split(" (")[0] for head in rows[0]]
    return [[float(row[names.index(key)]) for row in rows[1:]] for key in wanted]


def at(times, values, time):
    return values[min(range(len(times)), key=lambda n: abs(times[n] - time))]


def along(folder):
    """(place, stress in MPa) of the elements of the strands."""
    with open(os.path.join(folder, "bars", "bars.csv")) as file:
        rows = list(csv.reader(file))
    names = [head.split(" (")[0] for head in rows[0]]
    return [(float(row[names.index("x")]), float(row[names.index("stress")]) / 1e3) for row in rows[1:] if row[0] == "strands"]


deck = open("beam.yaml").read()
begin, end = deck.index("  - name: shrinkage"), deck.index("watch:")
released, _ = run("released", (deck[:begin] + deck[end:]).replace("  jack: {reaction of: left jack}\n", ""))  # a load that is not there then
loaded, seconds = run("loaded", deck)

time, middle = columns(loaded, "middle", "time", "y")
left, right = columns(loaded, "left-support", "y")[0], columns(loaded, "right-support", "y")[0]
rises = [1e3 * (m - (a + b) / 2) for m, a, b in zip(middle, left, right)]  # mm
jack = [-p for p in columns(loaded, "jack", "y")[0]]  # kN
strand = [s / 1e3 for s in columns(loaded, "strand", "stress")[0]]
bottom, top = columns(loaded, "bottom", "strain xx")[0], columns(loaded, "top", "strain xx")[0]
peak = [s / 1e3 for s in columns(loaded, "strands", "largest stress")[0]]  # in a crack
slip = columns(loaded, "strands", "least slip", "largest slip")
slip = [1e3 * max(-a, b) for a, b in zip(*slip)]


half_family = [(i, j) for i in range(-3, 4) for j in range(4) if 0 < i * i + j * j <= HORIZON**2]  # of a particle at a face
# Its strain is that of the squares of distances along the face, whose middle lies deeper than the particle.
INSIDE = SPACING * (0.5 + sum(i * i * j for i, j in half_family) / sum(i * i for i, _ in half_family))


def outermost(low, high):
    """Strains of the outermost fibres, from those of the families of particles beside them: bottom, top."""
    slope = (high - low) / (HEIGHT - 2 * INSIDE)
    return low - INSIDE * slope, high + INSIDE * slope


def stresses(when, free):
    """Of the outermost fibres: bottom, top [MPa]."""
    low, high = outermost(at(time, bottom, when) + free, at(time, top, when) + free)
    return CONCRETE * low, CONCRETE * high


# ---- by hand ----
section = Section(WIDTH, HEIGHT, DEPTH, STEEL, CONCRETE, STRAND)
force = STEEL * TENSION
own = WEIGHT * SPAN**2 / 8 - WEIGHT * OVERHANG**2 / 2
sinks = (5 * WEIGHT * SPAN**4 / 384 - WEIGHT * OVERHANG**2 * SPAN**2 / 16) / (CONCRETE * section.inertia)
less = STEEL * STRAND * SHRINKAGE  # of the force, before the concrete gives way
left_over = force - less
after_release, after_shrinkage = (TENSION - section.loss(force, own), TENSION - STRAND * SHRINKAGE - section.loss(left_over, own))
camber = 1e3 * (section.camber(force, SPAN) - sinks)
camber_shrunk = 1e3 * (section.camber(left_over, SPAN) - sinks)


def load(moment):
    """Of each jack, which with the weight makes a moment in the middle [kN]."""
    return 1e3 * (moment - own) / ARM


decompressed = load(section.moment_to(0.0, left_over))
cracks = load(section.moment_to(TENSILE, left_over)), load(section.moment_to(flexural_strength(TENSILE, HEIGHT), left_over))
beside = TENSION - STRAND * SHRINKAGE  # of strands where the concrete beside them has no stress
reaches = transfer_length(3 * (4 * pi * STEEL / 3)**0.5, STEEL, STRAND, after_release, 1.25 * COMPRESSIVE**0.5, 1.8e-3)
nominal, nominal_stress = section.nominal_moment(COMPRESSIVE, beside, YIELD, HARDENING)

# ---- computed ----
begins = min(range(len(time)), key=lambda n: abs(time[n] - 2))
slopes = [(jack[n + 1] - jack[n]) / (rises[n] - rises[n + 1]) for n in range(begins, len(jack) - 1)]
first = begins + next(n for n, slope in enumerate(slopes) if slope < 0.5 * slopes[1])
lowest = [outermost(b + SHRINKAGE, t + SHRINKAGE)[0] for b, t in zip(bottom, top)]
opens = next(n for n in range(begins, len(time)) if lowest[n] > 0)
share = -lowest[opens - 1] / (lowest[opens] - lowest[opens - 1])
opened = jack[opens - 1] + share * (jack[opens] - jack[opens - 1])
most = max(range(len(jack)), key=lambda n: jack[n])
strain = peak[most] / STRAND if peak[most] < YIELD else YIELD / STRAND + (peak[most] - YIELD) / (HARDENING * STRAND)
cracked, crushed = section.cracked_moment(peak[most], strain - beside / STRAND)
yields = next((n for n in range(begins, len(peak)) if peak[n] > YIELD), None)
profile = along(released)
full = max(s for _, s in profile)
transfer = next(x for x, s in profile if s > 0.95 * full) + OVERHANG

r, s = stresses(1, 0), stresses(2, SHRINKAGE)
between("stages", table(["", "by hand", "computed", "accepted"], [
    ["stress of the strands after release, MPa", f"{after_release:.0f}", f"{at(time, strand, 1):.0f}", "1055 to 1080"],
    ["loss by elastic shortening, MPa", f"{section.loss(force, own):.1f}", f"{TENSION - at(time, strand, 1):.1f}", "28 to 38"],
    ["camber at release, less the weight, mm", f"{camber:.3f}", f"{at(time, rises, 1):.3f}", "1.22 to 1.42"],
    ["bottom and top after release, MPa", f"{section.stress(HEIGHT, force, own):.2f}, {section.stress(0, force, own):.2f}", f"{r[0]:.2f}, {r[1]:.2f}", ""],
    ["stress of the strands after shrinkage, MPa", f"{after_shrinkage:.0f}", f"{at(time, strand, 2):.0f}", "995 to 1025"],
    ["loss by shrinkage, MPa", f"{after_release - after_shrinkage:.1f}", f"{at(time, strand, 1) - at(time, strand, 2):.1f}", "54 to 60"],
    ["camber after shrinkage, mm", f"{camber_shrunk:.3f}", f"{at(time, rises, 2):.3f}", "1.14 to 1.34"],
    ["bottom and top after shrinkage, MPa", f"{section.stress(HEIGHT, left_over, own):.2f}, {section.stress(0, left_over, own):.2f}", f"{s[0]:.2f}, {s[1]:.2f}", ""],
    ["load of a jack at decompression, kN", f"{decompressed:.1f}", f"{opened:.1f}", "27 to 32"],
    ["load of a jack at the first cracks, kN", f"{cracks[0]:.1f} by f_t, {cracks[1]:.1f} by the flexural strength", f"{jack[first]:.1f}", "40 to 52"],
    ["load of a jack as the strands yield, kN", "", f"{jack[yields]:.1f}" if yields is not None else "not", ""],
    ["largest load of a jack, kN", f"{load(nominal):.1f} as the top is crushed", f"{jack[most]:.1f}", "74 to 90"],
    ["largest stress of the strands then, MPa", f"{nominal_stress:.0f}", f"{peak[most]:.0f}", "1640 to 1760"],
    ["load of a jack at that computed stress, concrete elastic, kN", f"{load(cracked):.1f}", f"{jack[most]:.1f}", "76 to 92"],
    ["stress of the top then, MPa", f"{crushed:.1f} elastic, 48 as it is crushed", f"{-stresses(time[most], SHRINKAGE)[1]:.1f}", ""],
    ["middle sinks under the largest load by, mm", "", f"{rises[begins] - rises[most]:.1f}", ""],
    ["largest slip of the strands, mm", "", f"{slip[most]:.2f}", ""],
    ["from an end to 95 % of the stress, after release, mm", f"{1e3 * reaches:.0f} in concrete at rest", f"{1e3 * transfer:.0f}", "580 to 690"],
    ["time", "", f"{seconds:.0f} s of a processor", ""]]))

curve = [(rises[begins] - d, p) for d, p in zip(rises[begins:], jack[begins:])]
farthest = max(d for d, _ in curve)
chart("load", "Load of each jack over the deflection since the jacks touch", "deflection of the middle, mm", "load of a jack, kN",
      [("computed", STYLES[0], curve),
       ("decompression, by hand", LINE, [(0, decompressed), (0.3 * farthest, decompressed)]),
       ("cracks by the flexural strength, by hand", LINE + " dt 2", [(0, cracks[1]), (0.5 * farthest, cracks[1])]),
       ("nominal moment, by hand", LINE + " dt 4", [(0, load(nominal)), (farthest, load(nominal))])])
chart("strands", "Stress of the strands", "along the beam, m", "stress, MPa",
      [("after release", STYLES[1], profile), ("in the end", STYLES[0], along(loaded)), ("after release, by hand", LINE, [(0, after_release), (SPAN, after_release)])])
breccia("plot", loaded, "--field", "damage", "--deformed", "10", "--output", "pictures/cracks.png")
