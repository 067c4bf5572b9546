#!/usr/bin/env python3
"""The long form of the tests that inject faults: each by the thousand, then the table of docs/reliability.md from their
counts.

usage: torture.py PAGE [WORDS]
  WORDS            only what has these words in its name; the other rows of the table stay
  TORTURE_MINUTES  (60) how long, about, on two quiet cores; less time means fewer of each
"""
import concurrent.futures
import datetime
import math
import os
import platform
import re
import subprocess
import sys

BUILD = "build/test"
COMMAND, COMPARE = f"{BUILD}/breccia", f"{BUILD}/tests/compare_results"
MINUTES = float(os.environ.get("TORTURE_MINUTES", 60))
SHARE = min(1.0, MINUTES / 60)
EVERY = math.ceil(1 / SHARE)  # of calls that are walked


def some(most):
    return str(max(1, round(most * SHARE)))


FAULTS, SHIM = "tests/faults", f"{BUILD}/tests/libio_faults.so"
MEMORY = ["python3", "-B", f"{FAULTS}/memory.py", COMMAND, f"{BUILD}/tests/libfailing_memory.so", COMPARE]


def unit_test(program, name):
    return ["sh", "-c", f"cd {BUILD}/tests && ./{program} {name}"]


def fuzz(name, target, pattern=r"number_of_executed_units: (\d+)", most=100000):
    environment = {"FUZZ_ONLY": target, "FUZZ_RUNS": some(most), "FUZZ_SEED": "1"}
    return name, ["sh", "tests/fuzz/run.sh", "0"], environment, pattern


# What is tried, the command, its environment, and the words of the counts in what it prints; or the count itself, where
# one mistake ends it. Those of the first list keep all cores busy by themselves; of the second as many run side by side
# as there are cores, the longest first.
WIDE = [
    ("runs killed where they write, taken up again",
     ["python3", "-B", f"{FAULTS}/kills.py", COMMAND, SHIM, COMPARE, "--count", some(1000)], {},
     r"kills: (\d+) tried, (\d+) lost"),
    ("refused memory", [*MEMORY, "--every", str(4 * EVERY)], {}, r"memory: (\d+) calls refused, (\d+) problems"),
    ("refused memory of the libraries", [*MEMORY, "--libraries", "--every", str(2003 * EVERY)], {},
     r"memory of libraries too: (\d+) calls refused, (\d+) problems"),
]
NARROW = [
    ("writes that fail, once or for good", ["bash", "tests/command/io_faults.sh", COMMAND, ".", BUILD],
     {"IO_FAULTS": str(EVERY)}, r"failing writes: (\d+) tried, (\d+) lost"),
    fuzz("random bodies, some steps", "fuzz_model", most=20000),
    ("flipped bytes of checkpoints", unit_test("tests_results", "test_checkpoint"), {"BRECCIA_FLIPS": some(10000)}, int(some(10000))),
    ("flipped bytes of results", unit_test("tests_results", "test_result_file"), {"BRECCIA_FLIPS": some(10000)}, int(some(10000))),
    fuzz("random frames to a server", "fuzz_server", r"server: (\d+) frames"),
    fuzz("random decks", "fuzz_deck"),
    fuzz("random answers to a client", "fuzz_client"),
]


def attempt(part):
    """Runs one part. Returns a row: name, tried, lost."""
    name, command, environment, counts = part
    words = [os.path.abspath(word) if word.startswith("build/") else word for word in command]
    begun = datetime.datetime.now()
    done = subprocess.run(words, env=dict(os.environ, **environment), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace")
    tried, lost = counts if isinstance(counts, int) else 0, 0
    for found in re.finditer(counts, done.stdout) if isinstance(counts, str) else []:
        tried += int(found[1])
        lost += int(found[2]) if found.re.groups > 1 else 0
    if done.returncode or not tried:
        lost = max(lost, 1)
    minutes = (datetime.datetime.now() - begun).total_seconds() / 60
    failures = [line for line in done.stdout.splitlines() if "FAIL" in line]  # wherever they stand in a long output
    said = "\n".join(["", *failures[:50], done.stdout[-2000:]]) if lost else ""
    print(f"{name}: {tried} tried, {lost} lost ({minutes:.1f} min){said}", flush=True)
    return name, tried, lost


def write_table(page, rows):
    begin, end = "<!-- torture: begin -->\n", "<!-- torture: end -->\n"
    with open(page) as file:
        before, rest = file.read().split(begin)
    old, after = rest.split(end)
    known = {row[0]: row for row in re.findall(r"^\| (.+?) \| (\d+) \| (\d+) \|$", old, re.M)}
    known.update({row[0]: row for row in rows})
    rows = [known[part[0]] for part in WIDE + NARROW if part[0] in known]
    day = datetime.date.today().strftime("%-d %B %Y")
    table = f"Counted on {day}, on {platform.system()} {platform.machine()}:\n\n"
    table += "| tried | how many | lost |\n|---|---|---|\n"
    table += "".join(f"| {name} | {tried} | {lost} |\n" for name, tried, lost in rows)
    with open(page, "w") as file:
        file.write(before + begin + table + end + after)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    words = "".join(sys.argv[2:])
    wide, narrow = ([part for part in parts if words in part[0]] for parts in (WIDE, NARROW))
    if not wide + narrow:
        sys.exit(f"none is called '{words}'")
    rows = [attempt(part) for part in wide]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows += pool.map(attempt, narrow)
    write_table(sys.argv[1], rows)
    sys.exit(any(lost for _, _, lost in rows))


main()
