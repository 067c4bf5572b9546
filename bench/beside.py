"""Speed beside another commit: both programs measure the same bodies and laws in turn, row by row; what has become slower is told, and nothing fails.

    python3 bench/beside.py PROGRAM [COMMIT]      PROGRAM: build/release/breccia_bench, beside which breccia_bench_laws stands; COMMIT: HEAD~1
"""

import csv
import os
import statistics
import subprocess
import sys

BODIES = ["cube 32", "scattered"]
ROUNDS = 3
WARN = 1.05  # of the time before
COLUMNS = {"forces": "force ns per bond", "step": "step ns per bond on 1 threads"}
LAWS = ["elastic", "half plastic", "all plastic", "few, elastic", "few, plastic"]
COARSE = 1  # ns a point: laws whose columns are whole numbers may be off by as much
FOLDER = "build/beside"


def run(*words, **more):
    return subprocess.run(words, check=True, **more)


def build(commit):
    """The bench of a commit. Its tree stays, so that the next commit compiles what differs."""
    tree, made = f"{FOLDER}/tree", f"{FOLDER}/build"
    if not os.path.isdir(tree):
        run("git", "worktree", "prune")
        run("git", "worktree", "add", "--quiet", "--force", "--detach", tree, commit)
    run("git", "-C", tree, "checkout", "--quiet", "--force", "--detach", commit)
    quiet = {"stdout": subprocess.DEVNULL}
    run("cmake", "-S", tree, "-B", made, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", **quiet)
    run("cmake", "--build", made, "--target", "breccia_bench", "breccia_bench_laws", **quiet)
    return f"{made}/breccia_bench"


def measure(program, body):
    """Times of each row, by its words."""
    path = f"{FOLDER}/rows.csv"
    run(program, path, body, stdout=subprocess.DEVNULL)
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {
        (row["formulation"], row["law"], row.get("horizon", ""), row["body"]): {
            name: float(row[column]) for name, column in COLUMNS.items()
        }
        for row in rows
    }


def measure_laws(program):
    """Times of each law in each column, by their names."""
    lines = run(f"{program}_laws", stdout=subprocess.PIPE, text=True).stdout.splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| ")]
    names = rows[0]
    return {row[0]: {name: float(row[names.index(name)]) for name in LAWS} for row in rows[1:]}


def compare(old, new):
    """How many times as long the new program takes. Of few rounds beside other programs either may be off by chance: both ways have to say that it takes longer."""
    return min(statistics.median(b / a for a, b in zip(old, new)), statistics.median(new) / statistics.median(old))


def tell(times, heads, commit, coarse):
    """The table of some rows. @return lines on those that take longer"""
    print(f"| {heads} | | {commit} | now | ratio |\n|{'---|' * (heads.count('|') + 5)}")
    slower = []
    for (row, name), (old, new) in times.items():
        if not old or not new or min(old) <= 0:
            continue
        before, now, ratio = statistics.median(old), statistics.median(new), compare(old, new)
        print(f"| {row} | {name} | {before:.2f} | {now:.2f} | {ratio:.2f} |")
        if ratio > WARN and now - before > coarse:
            slower.append(f"{row}, {name}: {ratio:.2f} times".replace(" | ", ", "))
    return slower


def main(program, commit="HEAD~1"):
    try:
        commit = subprocess.check_output(["git", "rev-parse", "--short", commit], text=True).strip()
        before = build(commit)
    except subprocess.CalledProcessError as error:
        print(f"warning: the bench of {commit} cannot be built, so nothing is compared: {error}")
        return
    bodies, laws = {}, {}
    for body in BODIES:
        for _ in range(ROUNDS):
            for of, which in ((before, 0), (program, 1)):
                for row, values in measure(of, body).items():
                    for name, value in values.items():
                        words = f"{row[0]}, {row[1]} | {row[2]} | {row[3]}"
                        bodies.setdefault((words, name), ([], []))[which].append(value)
    for _ in range(ROUNDS):
        for of, which in ((before, 0), (program, 1)):
            for law, values in measure_laws(of).items():
                for name, value in values.items():
                    laws.setdefault((law, name), ([], []))[which].append(value)
    slower = tell(bodies, "formulation, law | horizon / spacing | body", commit, 0)
    print()
    slower += tell(laws, "law", commit, COARSE)
    print(
        f"\nns a bond and ns a point on one thread, medians of {ROUNDS} rounds in turn; ratio: the median of theirs or that of the medians, whichever is less."
    )
    for line in slower:
        print(f"warning: slower than {commit}: {line}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
