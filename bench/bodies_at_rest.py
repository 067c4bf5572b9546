#!/usr/bin/env python3
"""What equations of bodies at rest cost, step by step and by factors, and what `breccia check` tells of runs beside what they take; two tables of PAGE.

  bodies_at_rest.py BUILD PAGE      BUILD: folder with breccia and breccia_bench_statics; some minutes"""
import os
import re
import subprocess
import sys
import tempfile

from pages import machine, write

ALONE = 25  # MB of libraries that every run has
CUBE = """units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 1.5, Young modulus: 150 MPa, Poisson ratio: 0.25}}
peridynamics: {formulation: correspondence, space: 3-D}
body: {b: {material: m, spacing: 0.03, shape: {box: {particles: [80, 80, 80]}}}}
loads: [{on: {face: x+, layers: 3}, body force: [400, 100, 0]}, {on: {face: x-, layers: 3}, displacement: [0, 0, 0]}]
solve: {static: {increments: 1}}
pictures: []
"""
RUNS = [("plate-with-hole", "plate-with-hole/plate.yaml", []),
        ("plate-with-hole, `equations: direct`", "plate-with-hole/plate.yaml", ["solve.static.equations=direct"]),
        ("plate-with-crack, static", "plate-with-crack/static.yaml", []), ("cube 80³", None, []), ("slope", "slope/slope.yaml", []),
        ("slope, with friction", "slope/friction.yaml", []), ("footing", "footing/footing.yaml", []),
        ("notched-beam, static", "notched-beam/static.yaml", []), ("notched-beam, measured-bonds", "notched-beam/measured-bonds.yaml", []),
        ("notched-beam, measured-plastic-damage", "notched-beam/measured-plastic-damage.yaml", [])]


def number(text):
    value = float(text)
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}" if value >= 0.095 else f"{value:.2f}"


def equations(build):
    """A row for each formulation and body, from the bench's row for each way."""
    said = subprocess.run([f"{build}/breccia_bench_statics", "", str(min(2, os.cpu_count()))], check=True, capture_output=True, text=True).stdout
    rows = {}
    for line in said.splitlines()[2:]:
        cells = [cell.strip() for cell in line.strip("| ").split("|")]
        rows.setdefault((cells[0], cells[1], cells[2]), {})[cells[4]] = (cells[5], number(cells[9]), cells[12])
    lines = [f"On {machine()}, two threads:", "", "| formulation | body | unknowns | products | step by step, s | MB | by factors, s | MB |", "|---|---|---|---|---|---|---|---|"]
    for (formulation, body, unknowns), ways in rows.items():
        steps, factors = ways["conjugate gradients"], ways.get("direct", ("", "–", "–"))
        lines.append(f"| {formulation} | {body} | {int(unknowns):,} | {' | '.join(steps)} | {factors[1]} | {factors[2]} |".replace(",", " "))
    return lines


def run(build, deck, settings):
    """On one core: what check tells, and what the run takes."""
    words = [word for setting in settings for word in ("--set", setting)]
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    with tempfile.TemporaryDirectory() as folder:
        if not deck:
            deck = f"{folder}/cube.yaml"
            with open(deck, "w") as file:
                file.write(CUBE)
        checked = subprocess.run([f"{build}/breccia", "check", deck, *words], check=True, capture_output=True, text=True).stdout
        told = re.search(r"([\d.]+) MB, (about |at least )?(.*)$", checked, re.M)
        child = os.fork()
        if child == 0:
            quiet = os.open(os.devnull, os.O_WRONLY)
            os.dup2(quiet, 1)
            os.dup2(quiet, 2)
            os.execv(f"{build}/breccia", ["breccia", "run", deck, "--quiet", "--output", f"{folder}/run", *words])
        _, status, used = os.wait4(child, 0)
    if status:
        raise RuntimeError(f"{deck} failed")
    return (f"{(told[2] or '').replace('about ', '')}{told[3]}, {told[1]} MB",
            f"{number(used.ru_utime + used.ru_stime)} s, {max(0, used.ru_maxrss / 1024 - ALONE):.0f} MB")


def main(build, page):
    write(page, "equations", equations(build))
    lines = [f"On one core of {machine()}:", "", "| deck | told | taken |", "|---|---|---|"]
    for name, deck, settings in RUNS:
        told, taken = run(build, deck and f"examples/{deck}", settings)
        lines.append(f"| {name} | {told} | {taken} |")
        print(lines[-1], flush=True)
    write(page, "told", lines)


main(*sys.argv[1:])
