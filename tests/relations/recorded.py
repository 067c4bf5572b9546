#!/usr/bin/env python3
"""Recorded results: small decks that contain all keys of the deck language, and tests of material points
(recorded_decks.py), give the results in recorded.txt.

Relations and closed forms say what is right; this test says that a change moves no result, message or refusal that it
does not mean to move. After an intended change of results run it with --record, read the difference of
recorded.txt, and name the results that moved in the commit.

A figure is a sum over all entries of a field, or over the columns of a file, with a weight of its own for each entry,
so that any entry moves it.

usage: recorded.py COMMAND PRINT_RESULTS [--record] [--only NUMBER] [--jobs N] [--shown N]
  --record        writes recorded.txt anew
  --only NUMBER   prints this deck and its figures, and compares these
"""

import argparse
import concurrent.futures
import glob
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import zlib

import outputs
import recorded_decks

HERE = os.path.dirname(os.path.abspath(__file__))
RECORD = os.path.join(HERE, "recorded.txt")
# Numbers of the cases that --record tries, and the largest number of recorded cases that run, by kind: decks, wide
# decks, tests of material points, pictures, other verbs (recorded_decks.py). Pictures and verbs are all recorded.
NUMBERS = {
    range(900): 300,
    range(recorded_decks.WIDE, 1066): 50,
    range(recorded_decks.LABORATORY, 2104): 104,
    range(recorded_decks.PICTURE, recorded_decks.PICTURE + len(recorded_decks.PICTURES)): 9,
    range(recorded_decks.VERB, recorded_decks.VERB + len(recorded_decks.VERBS)): 99,
}
# Cases left out because their results depend on the compiler.
UNSTABLE = (1001, 1020, 1022, 1023, 1043, 1059, 2078, 2080)
DIGITS, TOLERANCE = 7, 2e-6
# Decks in which round-off decides, as whether an increment comes to rest: other versions of libraries or compilers lead
# to other results. They are compared only where the libraries are those of the record. The kernels of the BLAS follow the
# processor unless they are fixed.
ROUND_OFF = (
    22, 35, 38, 49, 65, 66, 76, 99, 100, 103, 107, 109, 112, 125, 176, 182, 211, 213, 228, 261, 262, 265,
    306, 343, 394, 431, 447,
)  # fmt: skip
KERNELS = {"OPENBLAS_CORETYPE": "Prescott"}
WORDS, LAST_DIGIT = "numbers of the words", 0.015  # printed numbers have three digits or more

# Keys that no deck of this test has, and the test that has them.
ELSEWHERE = {
    "material": ("opensees", "remote", "server", "processes", "stage", "stress unit", "timeout"),  # servers.sh
    "deck": ("include", "variables", "title", "pictures", "fields"),  # pictures: picture.sh; fields: test_strength_field
    "fields": ("strength",),
    "strength": ("weibull", "expression", "on", "least"),
    "weibull": ("shape", "seed"),
    "block": ("file",),  # bodies from files: relations and unit tests of the body
    "selection": ("group", "outside"),
    "file history": ("channel",),  # records of several channels: unit tests of loading
    "results": ("every", "times", "checkpoint steps", "checkpoint seconds"),
}
KEYLESS = ("picture", "correspondence", "bond-based", "ordinary", "hybrid", "micropolar", "critical stretch",
           "critical bond energy", "critical bond stress")  # fmt: skip


class Outcome:
    """Outcome of one deck: status, printed lines with '#' for numbers, and figures with their names."""

    def __init__(self, status, words, figures, names):
        self.status, self.words, self.figures, self.names = status, words, figures, names


def deck_of(number):
    return json.dumps(recorded_decks.deck(number).text)


def digest(group):
    """Returns a weighted sum of a group's entries and the sum of their sizes, in base units."""
    total, size, count = 0.0, 0.0, 0
    for row in group.rows:
        for value in row:
            count += 1
            if math.isfinite(value):
                weight = 0.5 + (count * 0.6180339887498949) % 1.0
                total += weight * value * group.factor
                size += abs(value * group.factor)
            else:
                total += count * 1e-3
    return total, size


def fold(digests, floors):
    """Returns one figure of several: a sum of logarithms with signs, to which large and small ones contribute alike."""
    total = 0.0
    for count, (value, floor) in enumerate(zip(digests, floors), 1):
        weight = 0.5 + (count * 0.6180339887498949) % 1.0
        total += weight * math.copysign(math.log10(1 + abs(value) / floor), value) if floor else 0.0
    return total


# Names of figures that are round-off, and of an estimate by an iteration.
NOISE = re.compile(r"imbalance|/left|between|numerical|stable_time_step|iterations|products|wall")


def figures_of(groups):
    """Returns a figure for each field, for each file of histories, and for parts of the summary, with their names."""
    digests = {name: digest(group) for name, group in groups.items() if not NOISE.search(name)}
    largest, names = {}, {}
    for name, (_, size) in digests.items():
        key = tuple(groups[name].powers)
        largest[key] = max(largest.get(key, 0.0), size)
        file, _, rest = name.partition(", ")
        part = (
            name
            if file == "fields"
            else "summary, " + rest.split("/")[0] if file == "summary" and "/" in rest else file
        )
        names.setdefault(part, []).append(name)
    figures = []
    for parts in names.values():
        floors = [1e-7 * largest[tuple(groups[name].powers)] for name in parts]
        figures.append(fold([digests[name][0] for name in parts], floors))
    return list(names), figures


def run_test(options, number):
    """Runs a test of a material point. Figures are sums over the columns of strains, stresses and tangents."""
    path = os.path.join(options.work, f"{number}.csv")
    words = recorded_decks.Laboratory(number).words + ["--output", path]
    done = subprocess.run([options.command] + words, capture_output=True, text=True, timeout=120)
    text, names, figures = done.stderr.replace(path, "FILE"), [], []
    if done.returncode == 0:
        names, figures = figures_of(outputs.groups_of_table(path, str(number)))
    return Outcome(done.returncode, words_of(text)[0], figures, names)


# A path of an SVG file: its style, which has the colour, and its points.
PATH = re.compile(r'<path style="([^"]*)" d="([^"]*)"')


def run_pictures(options, folder, number):
    """Runs a deck and draws its results. Figures are sums over the colours and over the coordinates of the drawn lines,
    without letters, for each picture."""
    pictures = recorded_decks.Pictures(number)
    write_files(folder, json.dumps(pictures.deck.text))
    calls = [["run", "deck.yaml", "--threads", "1", "--output", "out"]]
    calls += [["plot", "out", *words, "--output", f"{n}.svg"] for n, words in enumerate(pictures.words)]
    words, groups = [], {}
    for n, call in enumerate(calls, -1):
        done = subprocess.run([options.command, *call], cwd=folder, capture_output=True, text=True, timeout=120)
        words += words_of(done.stderr)[0]
        if n >= 0 and done.returncode == 0:
            with open(os.path.join(folder, f"{n}.svg")) as file:
                paths = PATH.findall(file.read().split("</defs>")[-1])
            groups[f"colours {n}"], groups[f"lines {n}"] = groups_of_picture(paths)
    names, figures = figures_of(groups)
    return Outcome(0, words, figures, names)


def groups_of_picture(paths):
    """Returns the groups of colours and of lines of a picture.

    paths: pairs of style and points of the paths of an SVG file."""
    colours, lines = ([[float(n) for n in re.findall(outputs.NUMBER, path[k])] for path in paths] for k in (0, 1))
    for line in lines[1:]:  # relative to the first drawn point, because the width of margins depends on the font
        line[::2], line[1::2] = [x - lines[0][0] for x in line[::2]], [y - lines[0][1] for y in line[1::2]]
    return outputs.Group("number", "", colours, "colours"), outputs.Group("number", "", lines[1:], "lines")


def run_verb(options, folder, number):
    """Calls another verb. Figures are those of the tables that the call writes, and the numbers that it prints."""
    deck, words = recorded_decks.VERBS[number - recorded_decks.VERB]
    write_files(folder, deck_of(deck))
    os.makedirs(os.path.join(folder, "out"), exist_ok=True)
    done = subprocess.run([options.command, *words.split()], cwd=folder, capture_output=True, text=True, timeout=120)
    groups = {}
    for path in sorted(glob.glob(os.path.join(folder, "out", "*.csv"))) if done.returncode == 0 else ():
        name = os.path.basename(path)
        groups.update({f"{name}, {key}": g for key, g in outputs.groups_of_table(path, name).items()})
    names, figures = figures_of(groups)
    lines, numbers = words_of(re.sub(" +", " ", done.stdout + done.stderr))  # columns are as wide as their numbers
    return Outcome(done.returncode, lines, figures + [fold(numbers, [1e-6] * len(numbers))], names + [WORDS])


def write_files(folder, deck):
    os.makedirs(folder)
    for name, text in {"deck.yaml": deck, **recorded_decks.FILES}.items():
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)


def run(options, folder, number):
    if number >= recorded_decks.VERB:
        return run_verb(options, folder, number)
    if number >= recorded_decks.PICTURE:
        return run_pictures(options, folder, number)
    if number >= recorded_decks.LABORATORY:
        return run_test(options, number)
    write_files(folder, deck_of(number))
    command = [options.command, "run", "deck.yaml", "--threads", "1", "--output", "out"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
    out = os.path.join(folder, "out")
    text = done.stderr if done.returncode else done.stdout + done.stderr
    groups, figures, names = {}, [], []
    if done.returncode == 0:
        checked = subprocess.run([options.command, "check", "deck.yaml"], cwd=folder, capture_output=True, text=True)
        text += checked.stdout + checked.stderr
        summary = outputs.groups_of_summary(os.path.join(out, "summary.json"))
        groups.update({f"summary, {name}": group for name, group in summary.items()})
        fields = outputs.groups_of_fields(options.reader, out, "fields")
        groups.update({f"fields, {name}": group for name, group in fields.items() if name not in ("Points", "Values")})
        for path in sorted(glob.glob(os.path.join(out, "*.csv")) + glob.glob(os.path.join(out, "profiles", "*.csv"))):
            name = os.path.basename(path)
            groups.update({f"{name}, {key}": g for key, g in outputs.groups_of_table(path, name).items()})
        names, figures = figures_of(groups)
    words, numbers = words_of(text)
    if done.returncode == 0:
        names.append(WORDS)
        figures.append(fold(numbers, [1e-6] * len(numbers)))
    return Outcome(done.returncode, words, figures, names)


TIMES = re.compile(r"took [\d.]+ (?:s|min|h)\b[^\n]*|[^\n]*(?:memory|MB|computing)[^\n]*|[^\n]*\bns\b[^\n]*")


def words_of(text):
    """Returns the lines that are printed, with '#' for numbers, and the numbers; without what depends on the machine."""
    text = TIMES.sub("", outputs.IDLE.sub("", text))
    text = re.sub(r"^energy: .*", "energy: in the summary", text, flags=re.M)  # an energy of round-off has any unit
    numbers = []

    def take(match):
        number = float(match.group(0))
        numbers.append(number)
        return "#"

    words = re.sub(outputs.NUMBER, take, text)
    return [line.strip() for line in words.splitlines() if line.strip()], numbers


def shortest(number):
    text = f"{number:.{DIGITS}g}"
    return text.replace("e+0", "e").replace("e-0", "e-").replace("e+", "e")


def try_deck(options, number):
    folder = os.path.join(options.work, str(number))
    try:
        return run(options, folder, number)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def name_of(line):
    """Returns a short name for a line of words, which does not depend on other lines."""
    digits, number = "0123456789abcdefghijklmnopqrstuvwxyz", zlib.crc32(line.encode())
    return "".join(digits[number // 36**k % 36] for k in range(5))


def record(options, outcomes):
    """Writes the record: each line of words once, behind its name; then for each deck status, names of the words, a sum
    of the names of the figures, and the figures."""
    lines, seen, kept, keys = {}, set(), [], set()
    ran = dict.fromkeys(NUMBERS, 0)
    schema = read_schema(options)
    for number, outcome in outcomes:
        if outcome.status not in (0, 1, 2):
            raise SystemExit(f"deck {number} ends with status {outcome.status}")
        kind = next(numbers for numbers in NUMBERS if number in numbers)
        if outcome.status:
            gist = {re.sub(r"'[^']*'|#[a-z.]*|\[.*\]", "", line)[:60] for line in outcome.words}
            if gist <= seen:
                continue
            seen |= gist
        elif ran[kind] >= NUMBERS[kind] and schema_keys(schema, [number]) <= keys:
            continue
        else:
            keys |= schema_keys(schema, [number])
        ran[kind] += outcome.status == 0
        kept.append((number, outcome))
        for line in outcome.words:
            if lines.setdefault(name_of(line), line) != line:
                raise SystemExit(f"two lines have one name: '{line}' and '{lines[name_of(line)]}'")
    with open(RECORD, "w") as file:
        file.write(f"{libraries_of(options)}\n\n")
        file.writelines(f"{name} {line}\n" for name, line in sorted(lines.items(), key=lambda item: item[1]))
        file.write("\n")
        for number, outcome in kept:
            words = ",".join(name_of(line) for line in outcome.words)
            names = zlib.crc32("\n".join(outcome.names).encode())
            figures = " ".join(shortest(figure) for figure in outcome.figures)
            file.write(f"{number} {outcome.status} {words} {names} {figures}".strip() + "\n")
    good = sum(ran.values())
    print(f"{good} cases that run and {len(kept) - good} that do not are recorded")


def libraries_of(options):
    said = subprocess.run([options.command, "--version"], capture_output=True, text=True, check=True).stdout
    return next(line for line in said.splitlines() if line.startswith("libraries: "))


def recorded():
    with open(RECORD) as file:
        libraries, lines, decks = file.read().split("\n\n")
    lines, found = dict(line.split(" ", 1) for line in lines.splitlines()), {}
    for deck in decks.splitlines():
        number, status, words, names, *figures = deck.split(" ")
        said = [lines[n] for n in words.split(",") if n]
        found[int(number)] = (int(status), said, int(names), [float(figure) for figure in figures])
    return libraries, found


def compare(number, outcome, expected):
    """Returns messages about what is not as recorded."""
    status, words, names, figures = expected
    if outcome.status != status:
        return [f"deck {number}: status {outcome.status}, recorded {status}: {' / '.join(outcome.words)[:300]}"]
    messages = []
    if outcome.words != words:
        new = [line for line in outcome.words if line not in words] or outcome.words
        old = [line for line in words if line not in outcome.words] or words
        messages.append(f"deck {number}: words '{(new or [''])[0]}', recorded '{(old or [''])[0]}'")
    elif zlib.crc32("\n".join(outcome.names).encode()) != names or len(figures) != len(outcome.figures):
        messages.append(f"deck {number}: results have other names than those recorded")
    else:
        for name, a, b in zip(outcome.names, outcome.figures, figures):
            allowed = TOLERANCE * (1 + abs(b)) if name != WORDS else LAST_DIGIT
            if abs(a - b) > allowed:
                messages.append(f"deck {number}: {name}: {a:.9g}, recorded {b:.9g}")
    return messages


# ---- coverage of keys


def keys_of(schema, definition, value, found):
    """Gathers pairs of definition and key of a part of a deck."""
    if "$ref" in definition:
        name = definition["$ref"].split("/")[-1]
        return keys_of(schema, schema["$defs"][name], value, found) if isinstance(value, (dict, list)) else None
    names = [name for name, known in schema["$defs"].items() if known is definition]
    for part in definition.get("anyOf", []) + [
        o for o in definition.get("oneOf", []) if "$ref" in o or "properties" not in o
    ]:
        keys_of(schema, part, value, found)
    if isinstance(value, list):
        for item in value:
            keys_of(schema, definition.get("items", {}), item, found)
    if not isinstance(value, dict):
        return None
    properties = dict(definition.get("properties", {}))
    for one in definition.get("oneOf", []):
        if one.get("properties", {}).get("model", {}).get("const", value.get("model")) == value.get("model"):
            properties.update(one.get("properties", {}))
    for key, item in value.items():
        if key in properties:
            found.update((name, key) for name in names)
            keys_of(schema, properties[key], item, found)
        elif isinstance(definition.get("additionalProperties"), dict):
            keys_of(schema, definition["additionalProperties"], item, found)
    return None


def read_schema(options):
    return json.loads(subprocess.run([options.command, "schema"], capture_output=True, text=True, check=True).stdout)


def schema_keys(schema, numbers):
    """Returns pairs of definition and key that these decks have."""
    found = set()
    for number in numbers:
        if number < recorded_decks.LABORATORY:
            keys_of(schema, schema["$defs"]["deck"], json.loads(deck_of(number)), found)
    return found


def missing_keys(options, numbers):
    """Returns keys of the language that no recorded deck has."""
    schema = read_schema(options)
    found, wanted = schema_keys(schema, numbers), set()
    for name, definition in schema["$defs"].items():
        parts = [definition] + definition.get("oneOf", [])
        wanted |= {(name, key) for part in parts for key in part.get("properties", {}) if key != "include"}
    return sorted(
        (name, key) for name, key in wanted - found if name not in KEYLESS and key not in ELSEWHERE.get(name, ())
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("reader")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--only", type=int)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shown", type=int, default=30)
    options = parser.parse_args()
    options.command, options.reader = os.path.abspath(options.command), os.path.abspath(options.reader)
    os.environ.update(KERNELS)
    libraries, expected = ("", {}) if options.record else recorded()
    tried = [number for numbers in NUMBERS for number in numbers if number not in UNSTABLE]
    numbers = tried if options.record else list(expected)
    if libraries and libraries != libraries_of(options):
        numbers = [n for n in numbers if n not in ROUND_OFF and not recorded_decks.PICTURE <= n < recorded_decks.VERB]
        print(f"recorded with other {libraries}: {len(expected) - len(numbers)} decks of round-off are left out")
    if options.only is not None:
        numbers = [options.only]
        if options.only < recorded_decks.LABORATORY:
            print(json.dumps(recorded_decks.deck(options.only).text, indent=1))
        elif options.only < recorded_decks.PICTURE:
            print("breccia", *recorded_decks.Laboratory(options.only).words)
        elif options.only < recorded_decks.VERB:
            print("\n".join(" ".join(words) for words in recorded_decks.Pictures(options.only).words))
        else:
            print(*recorded_decks.VERBS[options.only - recorded_decks.VERB])
    options.work = tempfile.mkdtemp(prefix="recorded")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        outcomes = list(zip(numbers, pool.map(lambda number: try_deck(options, number), numbers)))
    shutil.rmtree(options.work, ignore_errors=True)
    if options.record:
        record(options, outcomes)
        return 0
    if options.only is not None:
        for name, figure in zip(outcomes[0][1].names, outcomes[0][1].figures):
            print(f"{name}: {figure:.9g}")
    messages = []
    for number, outcome in outcomes:
        found = compare(number, outcome, expected[number])
        messages += found[:3] + ([f"deck {number}: {len(found) - 3} further differences"] if len(found) > 3 else [])
    if options.only is None:
        ran = [number for number in expected if expected[number][0] == 0]
        messages += [f"no recorded deck that runs has '{key}' of '{name}'" for name, key in missing_keys(options, ran)]
    for message in messages[: options.shown]:
        print("FAIL:", message)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{len(numbers)} decks, {len(messages)} differences; {used.ru_utime + used.ru_stime:.1f} s of processor time")
    if messages:
        print(
            "Where results are meant to move: recorded.py COMMAND PRINT_RESULTS --record, and name what moved in the commit."
        )
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
