"""The tables of docs/performance.md for this machine: the bench on the widest vectors that it has, some of its rows on four lanes, LAMMPS, and the laws.
Those of other machines stay (about a quarter of an hour).

    python3 bench/report.py BUILD PAGE [WORD...]      WORD: only rows of the bench that have each of them (for trying this out)
"""

import csv
import os
import subprocess
import sys

import pages

WIDE = 8
NARROW_BODIES = ["cube 40", "scattered"]  # of which rows of four lanes stand beside those of eight


def program(build, name, *words, **environment):
    return subprocess.run(
        [f"{build}/{name}", *words], env={**os.environ, **environment}, stdout=subprocess.PIPE, text=True, check=True
    ).stdout.rstrip()


def bench(build, words, **environment):
    """@return what the bench says of the machine, its rows, and what its columns mean"""
    path = f"{build}/bench.csv"
    lines = program(build, "breccia_bench", path, *words, **environment).split("\n")
    with open(path) as file:
        return lines[0], list(csv.DictReader(file)), lines[-1]


def key(row):
    return row["formulation"], row["law"], row["horizon"], row["body"]


def number(row, column, digits):
    return f"{float(row[column]):.{digits}f}"


def of_plain(row, column):
    """Of formulations that have no plain rows there is nothing to tell."""
    return number(row, column, 1) if float(row["plain ns per bond"]) else "–"


def share(row):
    """Columns of the floor and of the share reached."""
    arithmetic, moved = float(row["floor by arithmetic"]), float(row["floor by bytes"])
    if not arithmetic:
        return ["–", "–", "–"]
    return [f"{arithmetic:.2f}", f"{moved:.2f}", f"{100 * max(arithmetic, moved) / float(row['force ns per bond']):.0f} %"]


def table(rows):
    yield (
        "| formulation, law | horizon / spacing | body | particles | bytes | search | plain | force | floor, arithmetic | floor, bytes | share | plain / ours "
        "| step | step, all threads | speed-up | law | bits |"
    )
    yield "|---" * 17 + "|"
    for row in rows:
        words = [
            f"{row['formulation']}, {row['law']}",
            row["horizon"],
            row["body"],
            row["particles"],
            number(row, "bytes per bond", 2),
            number(row, "search ns per bond", 0),
            of_plain(row, "plain ns per bond"),
            number(row, "force ns per bond", 2),
            *share(row),
            of_plain(row, "ratio"),
            number(row, "step ns per bond on 1 threads", 2),
            number(row, [column for column in row if column.startswith("step ns")][-1], 2),
            number(row, "speed-up", 2),
            number(row, "law ns per point", 0),
            "equal" if row["same bits"] == "1" else "DIFFER",
        ]
        yield f"| {' | '.join(words)} |"


def beside(rows, others):
    """Eight lanes and four side by side, of the rows that both have."""
    yield "| formulation, law | horizon / spacing | body " + "".join(
        f"| {lanes} lanes: force | floor, arithmetic | floor, bytes | share | step " for lanes in ("eight", "four")
    ) + "|"
    yield "|---" * 13 + "|"
    wide = {key(row): row for row in rows}
    for other in others:
        if key(other) not in wide:
            continue
        words = [f"{other['formulation']}, {other['law']}", other["horizon"], other["body"]]
        for row in (wide[key(other)], other):
            words += [
                number(row, "force ns per bond", 2),
                *share(row),
                number(row, "step ns per bond on 1 threads", 2),
            ]
        yield f"| {' | '.join(words)} |"


def main(build, page, *words):
    machine = pages.machine()
    ceilings, rows, meaning = bench(build, words)
    lines = [f"On {machine}, where the last digits of a row depend on what else runs there.", "", ceilings, "", *table(rows), "", meaning]
    if int(rows[0]["lanes"]) == WIDE:
        narrow = []
        for body in NARROW_BODIES:
            said, more, _ = bench(build, (body, *words), BRECCIA_LANES="4")
            narrow += more
        lines += ["", f"The same processor on four lanes (`BRECCIA_LANES=4`), as those work that have AVX2 only. {said}", "", *beside(rows, narrow)]
    lines += ["", program(build, "breccia_peers"), "", program(build, "breccia_bench_laws")]
    pages.write_one_of(page, "bench", machine, lines)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
