"""Speed beside another commit: both programs measure the same bodies in turn, row by row; what has become slower is told, and nothing fails.

    python3 bench/beside.py PROGRAM [COMMIT]      PROGRAM: build/release/breccia_bench; COMMIT: HEAD~1
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
    run("cmake", "--build", made, "--target", "breccia_bench", **quiet)
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


def main(program, commit="HEAD~1"):
    try:
        commit = subprocess.check_output(["git", "rev-parse", "--short", commit], text=True).strip()
        before = build(commit)
    except subprocess.CalledProcessError as error:
        print(f"warning: the bench of {commit} cannot be built, so nothing is compared: {error}")
        return
    times = {}
    for body in BODIES:
        for _ in range(ROUNDS):
            for of, which in ((before, 0), (program, 1)):
                for row, values in measure(of, body).items():
                    for name, value in values.items():
                        times.setdefault((row, name), ([], []))[which].append(value)
    print(f"| formulation, law | horizon / spacing | body | | {commit} | now | ratio |\n|---|---|---|---|---|---|---|")
    slower = []
    for (row, name), (old, new) in times.items():
        if not old or not new:
            continue
        # Of few rounds beside other programs either may be off by chance: both have to say that it takes longer.
        ratio = min(statistics.median(b / a for a, b in zip(old, new)), statistics.median(new) / statistics.median(old))
        words = f"{row[0]}, {row[1]} | {row[2]} | {row[3]} | {name}"
        print(f"| {words} | {statistics.median(old):.2f} | {statistics.median(new):.2f} | {ratio:.2f} |")
        if ratio > WARN:
            slower.append(f"{words.replace(' | ', ', ')}: {ratio:.2f} times")
    print(f"\nns a bond on one thread, medians of {ROUNDS} rounds in turn; ratio: the median of theirs or that of the medians, whichever is less.")
    for line in slower:
        print(f"warning: slower than {commit}: {line}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
