"""Parameters found again by `breccia calibrate` from points that `breccia material` made with parameters drawn at random; the table of
docs/laboratory.md.

    python3 bench/recovery.py COMMAND PAGE
"""
import math
import os
import random
import re
import subprocess
import sys
import tempfile

TRIALS, POINTS, NOISE = 4, 80, 0.01
# law, what is given, test, columns of the curve, parameters with their ranges in mm, N, s
CASES = [
    ("j2", "Poisson ratio: 0.3", "{kind: uniaxial, strain: 0.01, cycles: 2, steps: 100}", "x",
     {"Young modulus": (50e3, 500e3), "yield stress": (100, 600), "saturation stress": (250, 900),
      "saturation rate": (2, 200), "kinematic modulus": (100, 20000)}),
    ("drucker-prager", "Poisson ratio: 0.3, dilation angle: 5 deg, friction angle: 30",
     "{kind: triaxial, strain: -0.03, confining pressure: 0.1, steps: 100}", "q",
     {"Young modulus": (5, 500), "cohesion": (0.001, 0.1), "hardening modulus": (0.01, 10)}),
    ("multi-yield-j2", "surfaces: 20, bulk modulus: 100", "{kind: simple shear, strain: 0.02, steps: 100}", "s",
     {"shear modulus": (5, 500), "octahedral strength": (0.005, 0.5)}),
    ("bounding-surface-clay", "bulk modulus: 100", "{kind: undrained shear, strain: 0.004, cycles: 2, steps: 100}", "s",
     {"shear modulus": (5, 500), "undrained strength": (0.005, 0.5), "hardening modulus": (5, 500),
      "hardening exponent": (0.5, 2)}),
    ("damage-plasticity", "Poisson ratio: 0.2, length: 50",
     "{kind: uniaxial, strain: -0.006, return strain: 0.001, cycles: 1, steps: 100}", "x",
     {"Young modulus": (10e3, 60e3), "compressive strength": (10, 80), "tensile strength": (1, 6),
      "crushing energy": (3, 30), "fracture energy": (0.06, 0.2)}),
    ("mazars", "Poisson ratio: 0.2, length: 50, fracture energy: 0.1", "{kind: uniaxial, strain: -0.005, steps: 100}", "x",
     {"Young modulus": (10e3, 60e3), "tensile strength": (1, 6), "compression share": (1, 1.5),
      "compression rate": (800, 3000)}),
    ("menegotto-pinto", "roundness fall: 0.925", "{kind: uniaxial, strain: 0.01, cycles: 2, steps: 100}", "x",
     {"Young modulus": (50e3, 500e3), "yield stress": (100, 1000), "hardening ratio": (0.001, 0.1),
      "roundness": (5, 30)}),
    ("cap", "bulk modulus: 10, shear modulus: 6, envelope strength: 0.5, envelope drop: 0.4, envelope rate: 1, "
     "envelope slope: 0.1, tension cut-off: 0.01",
     "{kind: oedometer, strain: -0.1, return strain: -0.08, cycles: 1, steps: 100}", "x",
     {"cap ratio": (1, 6), "cap position": (0.05, 2), "largest compaction": (0.05, 0.5), "compaction rate": (0.05, 5)}),
]


def deck(law, given, test, values, fit=None):
    words = ", ".join(f"{key}: {value:.8g}" for key, value in values.items())
    text = f"units: {{length: mm, force: N, time: s}}\nmaterial: {{model: {law}, density: 2e-9, {given}, {words}}}\n"
    text += f"test: {test}\n"
    if fit:
        ranges = ", ".join(f"{key}: {{from: {low}, to: {high}}}" for key, (low, high) in fit.items())
        text += f"against: points.csv\nfit: {{{ranges}}}\n"
    return text


def curve(command, path, which):
    """The points of a test's curve, or None where the parameters drawn are inadmissible."""
    done = subprocess.run([command, "material", path], capture_output=True, text=True)
    if done.returncode:
        return None
    lines = done.stdout.splitlines()
    column = {name.split(" (")[0]: k for k, name in enumerate(lines[0].split(","))}
    rows = [[float(cell) for cell in line.split(",")] for line in lines[1:]]
    if which == "s":
        return [(row[column["strain xy"]], row[column["stress xy"]]) for row in rows]
    less = column["stress yy"] if which == "q" else None
    return [(row[column["strain xx"]], row[column["stress xx"]] - (row[less] if less else 0)) for row in rows]


def trial(command, folder, case, number, noise):
    law, given, test, which, ranges = case
    numbers = random.Random(f"{law} {number}")
    points = None
    while points is None:
        true = {key: math.exp(numbers.uniform(math.log(1.15 * low), math.log(high / 1.15)))
                for key, (low, high) in ranges.items()}
        with open(f"{folder}/true.yaml", "w") as file:
            file.write(deck(law, given, test, true))
        points = curve(command, f"{folder}/true.yaml", which)
    points = points[::max(1, len(points) // POINTS)]
    size = max(y for _, y in points) - min(y for _, y in points)
    with open(f"{folder}/points.csv", "w") as file:
        for x, y in points:
            file.write(f"{x:.10g},{y + numbers.gauss(0, noise * size) if noise else y:.10g}\n")
    middle = {key: math.sqrt(low * high) for key, (low, high) in ranges.items()}
    with open(f"{folder}/fit.yaml", "w") as file:
        file.write(deck(law, given, test, middle, ranges))
    before = os.times().children_user
    words = subprocess.run([command, "calibrate", f"{folder}/fit.yaml"], capture_output=True, text=True, check=True).stdout
    seconds = os.times().children_user - before
    misfit = float(re.search(r"lie ([0-9.e+-]+) %", words).group(1))
    errors, within = [], [0, 0]
    for key, value in true.items():
        found = re.search(rf"^  {key}: ([0-9.e+-]+).*", words, re.M)
        errors.append(abs(float(found.group(1)) / value - 1))
        deviation = re.search(r"standard deviation ([0-9.e+-]+) %", found.group(0))
        if deviation:
            within[1] += 1
            within[0] += abs(float(found.group(1)) - value) < 0.02 * float(deviation.group(1)) * float(found.group(1))
    return misfit, errors, within, seconds


def main():
    command, page = sys.argv[1:3]
    rows, counted = [], [0, 0]
    for case in CASES:
        cells, longest = [], 0
        for noise in (0, NOISE):
            with tempfile.TemporaryDirectory() as folder:
                trials = [trial(command, folder, case, number, noise) for number in range(TRIALS)]
            errors = sorted(error for _, found, _, _ in trials for error in found)
            near = sum(error < 0.01 for error in errors)
            cells += [f"{max(misfit for misfit, _, _, _ in trials):.2f} %", f"{near} of {len(errors)}",
                      f"{100 * errors[len(errors) // 2]:.2g} %"]
            longest = max([longest] + [seconds for _, _, _, seconds in trials])
            if noise:
                counted = [counted[k] + sum(within[k] for _, _, within, _ in trials) for k in range(2)]
        kind = re.search("kind: ([a-z ]+)", case[2]).group(1) + (", cycles" if "cycles" in case[2] else "")
        rows.append(f"| {case[0]} | {kind} | {len(case[4])} | " + " | ".join(cells) + f" | {longest:.1f} s |")
        print(rows[-1], flush=True)
    share = f"{counted[0]} of {counted[1]} parameters lie within two standard deviations of the true ones"
    print(share)
    with open(page) as file:
        text = file.read()
    begin, end = text.index("| law | test |"), text.index("\n\n", text.index("| law | test |"))
    heading = text[begin:].split("\n")[:2]
    text = text[:begin] + "\n".join(heading + rows) + text[end:]
    text = re.sub(r"\d+ of \d+ parameters lie within two\s+standard deviations of the true ones", share, text)
    with open(page, "w") as file:
        file.write(text)


if __name__ == "__main__":
    main()
