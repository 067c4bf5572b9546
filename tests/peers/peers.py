#!/usr/bin/env python3
"""Peers: small problems of other programs, run here and compared with the values that those programs' own tests hold.

problems.py has the problems as decks, values.csv what the other program found, by problem, watch, column and time, with
the relative difference that is allowed, and sources.csv the program and the file of its repository that the values come
from. Every value must have a source.

usage: peers.py COMMAND [--only WORDS] [--keep FOLDER] [--print]
  --only WORDS   problems whose names hold these words
  --keep FOLDER  leave decks and results there
  --print        print the largest difference of each problem beside its tolerance
"""

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

from problems import problems

MOST_TOLD = 4  # failures of a problem
HERE = os.path.dirname(os.path.abspath(__file__))


def table(name):
    with open(os.path.join(HERE, name), newline="") as file:
        return list(csv.DictReader(file))


def histories(folder):
    """Histories of a run, by name: the names of columns without units, and rows of numbers."""
    found = {}
    for name in os.listdir(folder):
        if name.endswith(".csv"):
            with open(os.path.join(folder, name), newline="") as file:
                heading, *rows = csv.reader(file)
            columns = [re.sub(r" \([^()]*\)$", "", column) for column in heading]
            found[name[:-4]] = columns, [[float(cell) for cell in row] for row in rows]
    return found


def run(command, folder, name):
    """Runs a problem. Returns its histories and the words of a failure."""
    deck, files = problems[name]
    os.makedirs(folder)
    for file_name, text in {"deck.yaml": deck, **files}.items():
        with open(os.path.join(folder, file_name), "w") as file:
            file.write(text)
    done = subprocess.run([command, "run", "deck.yaml", "--threads", "1", "--quiet", "--output", "out"],
                          cwd=folder, capture_output=True, text=True)
    if done.returncode:
        return {}, f"status {done.returncode}: {(done.stderr or done.stdout).strip()}"
    return histories(os.path.join(folder, "out")), ""


def value_at(found, row):
    """The value of a history that a row of values.csv tells, at the time that is nearest to the row's."""
    columns, rows = found[row["watch"]]
    column, time, when = columns.index(row["column"]), columns.index("time"), float(row["time"])
    nearest = min(rows, key=lambda r: abs(r[time] - when))
    if abs(nearest[time] - when) > 1e-6 * abs(when):
        raise ValueError(f"no row at time {when}")
    return nearest[column]


def check(command, folder, name, rows):
    """Compares a problem with its values. Returns failures and the largest difference over its tolerance."""
    found, words = run(command, folder, name)
    if words:
        return [f"{name}: {words}"], float("nan"), float("nan")
    failures, largest, share = [], 0.0, 0.0
    for row in rows:
        expected, tolerance = float(row["value"]), float(row["tolerance"])
        value = value_at(found, row)
        difference = abs(value - expected) / abs(expected)
        largest, share = max(largest, difference), max(share, difference / tolerance)
        if not difference <= tolerance:
            failures.append(f"{name}: {row['watch']} {row['column']} at time {row['time']}: {value:.17g} instead of "
                            f"{row['value']}, {difference:.2g} off instead of {row['tolerance']}")
    more = [f"{name}: and {len(failures) - MOST_TOLD} more"] if len(failures) > MOST_TOLD else []
    return failures[:MOST_TOLD] + more, largest, share


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("command")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep")
    parser.add_argument("--print", action="store_true")
    options = parser.parse_args()
    values, sources = table("values.csv"), {row["problem"] for row in table("sources.csv")}
    failures = [f"{name}: no source" for name in problems if name not in sources]
    failures += [f"{name}: no problem" for name in {row["problem"] for row in values} | sources if name not in problems]
    folder, checks = options.keep or tempfile.mkdtemp(prefix="breccia-peers-"), 0
    for number, name in enumerate(problems):
        rows = [row for row in values if row["problem"] == name]
        if options.only not in name:
            continue
        checks += len(rows)
        if not rows:
            failures.append(f"{name}: no values")
        found, largest, share = check(os.path.abspath(options.command), os.path.join(folder, str(number)), name, rows)
        failures += found
        if options.print:
            print(f"{name}: {len(rows)} values, off by {largest:.2g} at most, {share:.2g} of the tolerance")
    if not options.keep:
        shutil.rmtree(folder)
    for words in failures:
        print("FAIL:", words)
    print(f"{checks} values of {len(problems)} problems of other programs, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
