"""Which lines differ from a revision, and the faults that universalmutator makes of them, in the order of a draw."""
import collections
import pathlib
import random
import re
import subprocess
import sys
import tempfile

MUTATE = pathlib.Path(sys.executable).with_name("mutate")
SOURCES = ("source/*.c", "source/*.h")
COMMENT = re.compile(r"/\*.*?\*/|//.*")

Fault = collections.namedtuple("Fault", "file line before after")  # the whole line, and what takes its place


def git(*words):
    return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout


def default_base():
    """Where this branch left main; on main itself the commit before the last."""
    if subprocess.run(["git", "rev-parse", "--verify", "--quiet", "main"], capture_output=True).returncode:
        return "HEAD~1"
    base = git("merge-base", "main", "HEAD").strip()
    return base if git("diff", "--name-only", base, "--", *SOURCES) else "HEAD~1"


def changed_lines(base, files):
    """{file: numbers of the lines that differ from the base}, those of the working tree."""
    lines, name = collections.defaultdict(set), None
    for row in git("diff", "--unified=0", "--no-color", "--no-ext-diff", base, "--", *(files or SOURCES)).splitlines():
        if row.startswith("+++ "):
            name = row[6:] if row.startswith("+++ b/") else None
        hunk = re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", row)
        if hunk and name:
            first = int(hunk[1])
            lines[name].update(range(first, first + int(hunk[2] or 1)))
    return lines


def code_lines(text):
    """Numbers of lines that do or say something: no comments, brackets, words of the preprocessor, heads of functions and declarations."""
    found, inside = set(), False
    for number, line in enumerate(text.splitlines(), 1):
        rest = line
        if inside:
            if "*/" not in rest:
                continue
            rest, inside = rest.split("*/", 1)[1], False
        rest = COMMENT.sub("", rest)
        if "/*" in rest:
            rest, inside = rest.split("/*", 1)[0], True
        heading = not rest[:1].isspace() and "=" not in rest
        if rest.strip("{}; \t") and not heading and not rest.lstrip().startswith("#"):
            found.add(number)
    return found


def faults_of(file, numbers):
    """{line: all faults that the tool makes of it}, of these lines of a file."""
    source = pathlib.Path(file)
    # The tool passes over lines that end with a comment.
    before = [COMMENT.sub("", line).rstrip() if n in numbers else line for n, line in enumerate(source.read_text().splitlines(), 1)]
    faults = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        wanted, bare = pathlib.Path(folder) / "lines", pathlib.Path(folder) / source.name
        bare.write_text("\n".join(before) + "\n")
        wanted.write_text("".join(f"{n}\n" for n in sorted(numbers)))
        made = subprocess.run([MUTATE, bare, "c", "--noCheck", "--lines", wanted, "--mutantDir", folder], capture_output=True, text=True)
        if made.returncode:
            sys.exit(f"{MUTATE} failed on {file}:\n{made.stdout[-2000:]}{made.stderr[-2000:]}")
        for mutant in sorted(pathlib.Path(folder).glob(f"{source.stem}.mutant.*")):
            after = mutant.read_text().splitlines()
            line = next((n for n, (a, b) in enumerate(zip(before, after)) if a != b), None)
            if line is not None and line + 1 in numbers:
                more = len(after) - len(before)
                faults[line + 1].append(Fault(file, line + 1, before[line], "\n".join(after[line : line + 1 + more])))
    return faults


def draw(lines, seed, at_once=40):
    """Yields the faults in the order in which they are tried: one of each line, then a second one, and so on."""
    lot = random.Random(seed)
    places = sorted((file, number) for file, numbers in lines.items() for number in numbers)
    lot.shuffle(places)
    left = {}
    for first in range(0, len(places), at_once):
        of_file = collections.defaultdict(set)
        for file, number in places[first : first + at_once]:
            of_file[file].add(number)
        made = {file: faults_of(file, numbers) for file, numbers in of_file.items()}
        for file, number in places[first : first + at_once]:
            faults = made[file][number]
            lot.shuffle(faults)
            if faults:
                yield faults.pop()
            left[file, number] = faults
    while any(left.values()):
        for place in places:
            if left[place]:
                yield left[place].pop()
