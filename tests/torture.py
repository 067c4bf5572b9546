#!/usr/bin/env python3
"""The long form of the tests that inject faults: each by the thousand, then the table of docs/reliability.md from their counts.

usage: torture.py PAGE   TORTURE_MINUTES (60): how long, about, on two quiet cores; less time means fewer of each
"""
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


# What is tried, the command, its environment, and the words of each count in what it prints; or the count itself, where one mistake ends it.
PARTS = [
    ("runs killed where they write, taken up again", ["python3", "-B", "tests/faults/kills.py", COMMAND, f"{BUILD}/tests/libio_faults.so", COMPARE, "--count", some(1000)], {},
     [r"kills: (\d+) tried, (\d+) lost"]),
    ("writes that fail, once or for good", ["bash", "tests/command/io_faults.sh", COMMAND, ".", BUILD], {"IO_FAULTS": str(EVERY)},
     [r"failing writes: (\d+) tried, (\d+) lost"]),
    ("flipped bytes of checkpoints", ["sh", "-c", f"cd {BUILD}/tests && ./test_checkpoint"], {"BRECCIA_FLIPS": some(10000)}, int(some(10000))),
    ("flipped bytes of results", ["sh", "-c", f"cd {BUILD}/tests && ./test_result_file"], {"BRECCIA_FLIPS": some(10000)}, int(some(10000))),
    ("refused memory", ["python3", "-B", "tests/faults/memory.py", COMMAND, f"{BUILD}/tests/libfailing_memory.so", COMPARE, "--every", str(EVERY)], {},
     [r"memory: (\d+) calls refused, (\d+) problems"]),
    ("refused memory of the libraries", ["python3", "-B", "tests/faults/memory.py", COMMAND, f"{BUILD}/tests/libfailing_memory.so", COMPARE, "--libraries", "--every", str(1009 * EVERY)], {},
     [r"memory of libraries too: (\d+) calls refused, (\d+) problems"]),
] + [
    (name, ["sh", "tests/fuzz/run.sh", "0"], {"FUZZ_ONLY": target, "FUZZ_RUNS": some(100000), "FUZZ_SEED": "1"}, [r"number_of_executed_units: (\d+)"])
    for name, target in (("random decks", "fuzz_deck"), ("random bodies, some steps", "fuzz_model"), ("random frames to a server", "fuzz_server"), ("random answers to a client", "fuzz_client"))
]


def attempt(name, command, environment, counts):
    """Runs one part. Returns a row: name, tried, lost."""
    words = [os.path.abspath(word) if word.startswith("build/") else word for word in command]
    begun = datetime.datetime.now()
    done = subprocess.run(words, env=dict(os.environ, **environment), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    tried = lost = 0
    if isinstance(counts, int):
        tried, lost = counts, int(done.returncode != 0)
    for pattern in counts if isinstance(counts, list) else []:
        for found in re.findall(pattern, done.stdout):
            found = (found,) if isinstance(found, str) else found
            tried += int(found[0])
            lost += int(found[1]) if len(found) > 1 else 0
    if done.returncode and not lost:
        lost = 1
    minutes = (datetime.datetime.now() - begun).total_seconds() / 60
    print(f"{name}: {tried} tried, {lost} lost ({minutes:.1f} min)", flush=True)
    if lost or not tried:
        print(done.stdout[-6000:], flush=True)
    return name, tried, lost if tried else 1


def write_table(page, rows):
    begin, end = "<!-- torture: begin -->\n", "<!-- torture: end -->\n"
    with open(page) as file:
        before, rest = file.read().split(begin)
    after = rest.split(end)[1]
    day = datetime.date.today().strftime("%-d %B %Y")
    table = f"Counted on {day}, on {platform.system()} {platform.machine()}:\n\n| tried | how many | lost |\n|---|---|---|\n"
    table += "".join(f"| {name} | {tried} | {lost} |\n" for name, tried, lost in rows)
    with open(page, "w") as file:
        file.write(before + begin + table + end + after)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    rows = [attempt(*part) for part in PARTS]
    write_table(sys.argv[1], rows)
    sys.exit(any(lost for _, _, lost in rows))


main()
