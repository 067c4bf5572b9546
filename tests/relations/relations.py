#!/usr/bin/env python3
"""Relations that hold for every run, whatever it computes: small decks are run as they are, in other units, with lengths, masses and times
scaled by powers of two, and along other axes, and all that they write must be the same. What is told in two ways must agree.

usage: relations.py COMMAND PRINT_RESULTS [--only WORDS] [--jobs N] [--keep FOLDER] [--shown N]
  --only WORDS    decks whose names hold these words
  --keep FOLDER   leave decks and results there
"""
import argparse
import concurrent.futures
import glob
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile

import outputs
import ways
from decks import decks
from quantities import System, determinant, turned_vector

TURN = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
MIRROR = ((0, 0, 1), (-1, 0, 0), (0, 1, 0))
SYSTEMS = {"": System(), "u": System("cm, lbf, ms", plain=False), "s": System(scale=(4.0, 16.0, 0.25)), "a": None}
NAMES = {"u": "in other units", "s": "scaled", "a": "along other axes", "=": "said otherwise"}


CHECKED = ("correspondence strain", "ordinary at rest", "micropolar at rest", "hybrid at rest", "bonds strain", "unlike blocks", "bar", "friction", "critical stretch", "fracture energy",
           "bond energy", "bond stress", "initial stress", "Rayleigh damping", "stages", "load dashpots", "load base acceleration", "load spring", "load initial velocity")


class Outcome:
    def __init__(self):
        self.checks, self.failures = 0, []

    def check(self, holds, words):
        self.checks += 1
        if not holds:
            self.failures.append(words)


def system_of(deck, variant):
    if variant != "a":
        return SYSTEMS[variant.replace("=", "")]
    return System(axes=TURN if deck["dimensions"] == 2 else MIRROR)


def run(options, folder, deck, variant):
    """What a variant of a deck writes: groups of numbers by file, and the words between those that are printed."""
    system = system_of(deck, variant)
    os.makedirs(folder)
    text = deck["text"]
    for old, new in deck["same"] if variant == "=" else ():
        if old not in text:
            raise ValueError(f"no '{old}' in the deck")
        text = text.replace(old, new)
    with open(os.path.join(folder, "deck.yaml"), "w") as file:
        file.write(system.deck(text))
    for name, text in deck["files"].items():
        with open(os.path.join(folder, name), "w") as file:
            file.write(text(system))
    # Nothing is divided by zero, too large or none where a run is as it should be; otherwise the run as it is fails.
    traps = [] if variant or not options.traps else ["--trap"]
    done = subprocess.run([options.command, "run", "deck.yaml", "--threads", "1", "--output", "out", *traps], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"status {done.returncode}: {(done.stderr or done.stdout).strip()}")
    out = os.path.join(folder, "out")
    found = {"summary": outputs.groups_of_summary(os.path.join(out, "summary.json")),
             "fields": outputs.groups_of_fields(options.reader, out, "fields")}
    for path in sorted(glob.glob(os.path.join(out, "*.csv"))) + sorted(glob.glob(os.path.join(out, "profiles", "*.csv"))):
        name = os.path.relpath(path, out)
        found[name] = outputs.groups_of_table(path, name)
    found["words"], words = outputs.groups_of_words(done.stdout + done.stderr, "words", system.names[2])
    path = os.path.join(out, "solution.txt")
    if os.path.exists(path):
        with open(path) as file:
            found["solution"], more = outputs.groups_of_words(file.read(), "solution.txt", system.names[2])
    return found, words


def order_of(found, axes):
    """For each particle of a turned body the number of the same one in the body as it is."""
    def keys(rows):
        size = max(abs(v) for r in rows for v in r)
        return {tuple(round(v / size * 1e6) for v in r): n for n, r in enumerate(rows)}
    points = found[1]["fields"]["Points"].rows
    index = keys([turned_vector(axes, r) for r in found[0]["fields"]["Points"].rows])
    size = max(abs(v) for r in points for v in r)
    return [index[tuple(round(v / size * 1e6) for v in r)] for r in points]


def along_again(groups, others, axes):
    """The profile of a turned body, which goes along another axis, perhaps backwards; peaks have no sign."""
    place = list(others)[0]
    backwards = axes["xyz".index(place)][0] < 0
    new = {}
    for name, group in others.items():
        rows = group.rows[::-1] if backwards else group.rows
        if name == place:
            name, rows = "x", [[-r[0]] for r in rows] if backwards else rows
        new[name] = outputs.Group(group.kind, group.unit, rows, name)
    return new if list(new) == list(groups) else others


def compare(outcome, deck, variant, base, other):
    system = system_of(deck, variant)
    tell = f"{deck['name']} {NAMES[variant]}"
    order = order_of((base[0], other[0]), system.axes) if variant == "a" else None
    largest = {}
    for groups in base[0].values():
        for group in groups.values():
            for row in group.rows:
                key = tuple(group.powers)
                largest[key] = max([largest.get(key, 0.0)] + [abs(group.factor * v) for v in row if math.isfinite(v)])
    for file, groups in base[0].items():
        others = other[0].get(file)
        if variant == "=" and file in ("words", "value.csv"):
            continue
        if variant == "a" and file.startswith("profiles"):
            others = along_again(groups, others, system.axes)
        if others is None or (list(groups) != list(others) and file not in ("words", "solution")):
            outcome.check(False, f"{tell}: {file} has {list(others or [])} instead of {list(groups)}")
            continue
        if file == "solution" and len(groups) != len(others):
            continue  # how many iterations there are may hang on roundings
        if file == "words" and len(groups) != len(others):
            outcome.check(False, f"{tell}: {file} are others: {other[1]} instead of {base[1]}")
            continue
        for (name, a), b in zip(groups.items(), others.values()):
            compare_group(outcome, deck, variant, system, f"{tell}: {file}, {name}", file, name, a, b, order, largest[tuple(a.powers)])


def compare_group(outcome, deck, variant, system, tell, file, name, a, b, order, largest):
    if variant == "=" and (name.startswith("loads/") or "numerical" in name):
        return
    if a.powers != b.powers:
        outcome.check(False, f"{tell}: of unit '{b.unit}', expected one like '{a.unit}'")
        return
    rows = a.turned(system.axes) if variant == "a" else a.rows
    if order and file == "fields" and name not in ("Values",):
        count = len(order)
        rows = [rows[state * count + n] for state in range(len(rows) // count) for n in order]
    if len(rows) != len(b.rows):
        outcome.check(False, f"{tell}: {len(b.rows)} rows, expected {len(rows)}")
        return
    growth = system.growth(a.powers)
    expected = [[v * a.factor * growth for v in row] for row in rows]
    found = [[v * b.factor for v in row] for row in b.rows]
    if file.startswith("profiles"):
        expected, found = ([[abs(v) for v in r] for r in rows] for rows in (expected, found)) if name != "x" else (expected, found)
    if file in ("words", "solution") and a.kind == "number" and len(expected[0]) > 1:
        expected, found = [sorted(r) for r in expected], [sorted(r) for r in found]
    size = max([abs(v) for r in expected for v in r if math.isfinite(v)] + [0.0])
    if file == "words" and variant == "a" and (", near" in tell or name.endswith("(at time)") or (("stable" in tell or ", 12" in tell) and ("pairwise" in deck["text"] or "regions" in deck["text"]))):
        return
    if file in ("words", "solution"):
        share = 1.1e-2 if a.unit != "%" else 0.1
        noise = 1e-7 * largest * growth if a.powers != [0, 0, 0] else 1e-6
        share, noise = (share, noise) if file == "words" else (0.2, noise)
    elif variant == "s":
        share, noise = (0.0 if a.digits > 10 else 2e-9), 0.0
        if name == "time":
            share = 2e-9
    else:
        share = max(deck["tolerance"], 2e-9)
        noise = (share if file == "summary" else 1e-9) * largest * growth
        if name == "stable_time_step":  # from a vector that goes by numbers of particles (docs/theory.md 8); pairwise bonds have no symmetric stiffness
            share = 0.1 if "pairwise" in deck["text"] else 0.02 if "regions" in deck["text"] else 5e-3
        if name in ("first_broken_bond/at", "first_broken_bond/value") and variant == "a":
            return  # of those that break together the first one goes by numbers of particles, too
        if "imbalance" in name or "/left" in name or name.startswith("rest/") or "between" in name or "numerical" in name:
            noise, share = noise + 1e-6 * (1 if not any(a.powers) else largest * growth), max(share, 1e-3)
        if file == "books.csv":
            noise = share * largest * growth
    worst, where = 0.0, 0
    for n, (one, two) in enumerate(zip(expected, found)):
        for v, w in zip(one, two):
            off = abs(v - w) if math.isfinite(v) and math.isfinite(w) else 0.0 if str(v) == str(w) else math.inf
            if off > worst:
                worst, where = off, n
    outcome.check(worst <= share * size + noise,
                  f"{tell}: {found[where]} is not {expected[where]}, off by {worst / size if size else math.inf:.2g} of the largest (row {where})")


def try_deck(options, folder, deck):
    outcome = Outcome()
    try:
        base = run(options, os.path.join(folder, "0"), deck, "")
        ways.check(outcome, deck, base[0])
        for variant in deck["variants"]:
            compare(outcome, deck, variant, base, run(options, os.path.join(folder, variant), deck, variant))
        if deck["same"]:
            compare(outcome, deck, "=", base, run(options, os.path.join(folder, "same"), deck, "="))
    except (ValueError, KeyError, IndexError, OSError) as error:
        outcome.check(False, f"{deck['name']}: {type(error).__name__} {error}")
        if not isinstance(error, ValueError):
            import traceback
            traceback.print_exc()
    if not options.keep:
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def printed(options, folder, arguments):
    done = subprocess.run([options.command, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"{' '.join(arguments)}: status {done.returncode}: {(done.stderr or done.stdout).strip()}")
    return done.stdout + done.stderr


def try_material(options, folder, path):
    """A laboratory test in two systems of units."""
    outcome, name = Outcome(), os.path.basename(path)
    deck = {"name": f"material {name}", "tolerance": 1e-5 if name.startswith("mohr") else 1e-7, "text": "", "variants": "u"}  # roundings choose how sand in a cell flows to its two sides
    os.makedirs(folder)
    found = []
    try:
        for units in ("{length: m, force: kN, time: s}", "{length: cm, force: lbf, time: ms}"):
            with open(path) as file:
                text = re.sub(r"units: \{.*\}", "units: " + units, file.read())
            with open(os.path.join(folder, "test.yaml"), "w") as file:
                file.write(text)
            words = printed(options, folder, ["material", "test.yaml", "--output", "out.csv"] + ([] if name.startswith(("damage", "mohr")) else ["--tangent"]))  # at equal principal stresses roundings choose
            found.append(({"out.csv": outputs.groups_of_table(os.path.join(folder, "out.csv"), name), "words": outputs.groups_of_words(words, name, "")[0]}, []))
        compare(outcome, deck, "u", *found)
    except (ValueError, KeyError, OSError) as error:
        outcome.check(False, f"{deck['name']}: {type(error).__name__} {error}")
    return outcome


def try_verbs(options, folder, deck):
    """What 'check' says, and modes."""
    outcome = Outcome()
    found = {}
    deck = dict(deck, name=deck["name"] + ": check and modes", tolerance=1e-6)
    try:
        for variant in ["", "u"] + (["a"] if "a" in deck["variants"] else []):
            system, here = system_of(deck, variant), os.path.join(folder, variant or "0")
            os.makedirs(here)
            with open(os.path.join(here, "deck.yaml"), "w") as file:
                file.write(system.deck(deck["text"]).replace("pictures: []", ""))
            groups, words = {}, []
            if variant != "a":
                groups["words"], words = outputs.groups_of_words(printed(options, here, ["check", "deck.yaml"]), "check", system.names[2])
            if options.modes in deck["name"]:
                printed(options, here, ["modes", "deck.yaml", "--count", "3", "--output", "out"])
                groups["modes.csv"] = outputs.groups_of_table(os.path.join(here, "out", "modes.csv"), "modes.csv")
                for row in groups["modes.csv"]["mass share"].rows:
                    row[:] = [math.sqrt(abs(v)) if v > 1e-12 else 0.0 for v in row]
            found[variant] = (groups, words)
            if variant == "u":
                compare(outcome, deck, "u", found[""], found["u"])
            elif variant == "a" and groups:
                for one, two in zip(found[""][0]["modes.csv"]["mass share"].rows, groups["modes.csv"]["mass share"].rows):
                    turned = [abs(v) for v in turned_vector(system.axes, one)]
                    outcome.check(all(abs(v - w) < 1e-6 for v, w in zip(turned, two)), f"{deck['name']}: roots of shares of mass {two} are not {turned}")
                for one, two in zip(found[""][0]["modes.csv"]["frequency"].rows, groups["modes.csv"]["frequency"].rows):
                    outcome.check(abs(one[0] / two[0] - 1) < 1e-6, f"{deck['name']}: frequency {two} is not {one}")
    except (ValueError, KeyError, OSError) as error:
        outcome.check(False, f"{deck['name']}: {type(error).__name__} {error}")
    if not options.keep:
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("reader")
    parser.add_argument("--stop", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", default="")
    parser.add_argument("--shown", type=int, default=40)
    options = parser.parse_args()
    options.modes = "at rest"
    options.traps = platform.system() == "Linux" and platform.machine() == "x86_64" and platform.libc_ver()[0] == "glibc"
    options.command, options.reader = os.path.abspath(options.command), os.path.abspath(options.reader)
    work = options.keep or tempfile.mkdtemp(prefix="relations")
    os.makedirs(work, exist_ok=True)
    chosen = []
    for name, deck in decks.items():
        deck["name"] = name
        if options.only in name:
            chosen.append(deck)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        tests = [(try_deck, deck) for deck in chosen]
        tests += [(try_verbs, deck) for deck in chosen if deck["name"] in CHECKED]
        tests += [(try_material, path) for path in sorted(glob.glob(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../examples/materials/*.yaml")))
                  if options.only in path]
        outcomes = list(pool.map(lambda item: item[1][0](options, os.path.join(work, str(item[0])), item[1][1]), enumerate(tests)))
    if not options.keep:
        shutil.rmtree(work, ignore_errors=True)
    failures = [words for outcome in outcomes for words in outcome.failures]
    for words in failures[:options.shown]:
        print("FAIL:", words)
    print(f"{len(chosen)} decks, {sum(o.checks for o in outcomes)} checks, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
