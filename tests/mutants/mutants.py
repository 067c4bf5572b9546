"""Plants small faults in changed lines, one at a time, and prints those that no test notices.

    sh tests/mutants/run.sh [--base REVISION] [--count N] [--seed N] [--minutes N] [--tests PATTERN] [FILE ...]

The working tree is copied to build/mutants/tree and built there once; each fault is compiled and tested in that copy. Faults come from
universalmutator's rules for C, in lines that differ from the base; lines and faults are drawn by the seed, one fault to a line until all
lines have had one. Faults that do not compile or give the same machine code do not count. Tests of units run first, then those of the
command; among them those that include headers of the fault's room, quick ones before slow ones. The first failure ends them. How long they
take without a fault is kept for the next call, as long as no file changes.
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

TREE = pathlib.Path("build/mutants/tree")
BUILD = TREE / "build/test"
MUTATE = pathlib.Path(sys.executable).with_name("mutate")
PATIENCE, LEAST = 5, 30  # times as long as without a fault, and seconds more: others may use the machine too
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


def copy_tree():
    """The working tree as it is, and nothing that git ignores. Files that have not changed keep their times."""
    files = set(git("ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")) - {""}
    for name in files:
        here, there = pathlib.Path(name), TREE / name
        if not here.is_file():
            continue
        if there.is_file() and there.read_bytes() == here.read_bytes():
            continue
        there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(here, there)
    for there in TREE.rglob("*"):
        name = there.relative_to(TREE)
        if name.parts[0] != "build" and there.is_file() and str(name) not in files:
            there.unlink()


def build(*targets):
    """@return whether it could be built, and what was said"""
    call = ["cmake", "--build", "build/test", "--parallel", str(os.cpu_count())]
    done = subprocess.run(call + (["--target", *targets] if targets else []), cwd=TREE, capture_output=True, text=True)
    return done.returncode == 0, done.stdout + done.stderr


def machine_code():
    """Of the command, which holds all rooms; without what debuggers are told of lines and columns."""
    with tempfile.NamedTemporaryFile() as bare:
        subprocess.run(["objcopy", "--strip-all", "--remove-section=.note.gnu.build-id", BUILD / "breccia", bare.name], check=True)
        return pathlib.Path(bare.name).read_bytes()


def run_test(name, seconds):
    """@return None, or how it failed"""
    call = ["ctest", "--test-dir", "build/test", "-R", f"^{name}$"]
    with subprocess.Popen(call, cwd=TREE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as test:
        try:
            return name if test.wait(seconds) else None
        except subprocess.TimeoutExpired:
            os.killpg(test.pid, signal.SIGKILL)
            return f"{name}, which does not end"


def measure_tests(pattern):
    """{test: seconds} without a fault."""
    digest = hashlib.sha256(pattern.encode())
    for there in sorted(TREE.rglob("*")):
        if there.is_file() and there.relative_to(TREE).parts[0] != "build":
            digest.update(str(there).encode() + there.read_bytes())
    kept = pathlib.Path("build/mutants/seconds.json")
    if kept.is_file() and (known := json.loads(kept.read_text()))["of"] == digest.hexdigest():
        return known["seconds"]
    listed = subprocess.run(["ctest", "--test-dir", "build/test", "-R", pattern, "--show-only=json-v1"], cwd=TREE, check=True, capture_output=True, text=True).stdout
    seconds = {}
    for test in json.loads(listed)["tests"]:
        begin = time.monotonic()
        if run_test(test["name"], 1800):
            sys.exit(f"{test['name']} fails without a fault: mend that first")
        seconds[test["name"]] = time.monotonic() - begin
    kept.write_text(json.dumps({"of": digest.hexdigest(), "seconds": seconds}))
    return seconds


def in_order(seconds, file):
    """Tests as they are run for a fault in this file."""

    def rank(name):
        source = TREE / "tests/unit" / f"{name}.c"
        room = file.split("/")[1]
        return not source.is_file(), not (source.is_file() and f'#include "{room}/' in source.read_text()), seconds[name]

    return sorted(seconds, key=rank)


def try_fault(fault, seconds, whole):
    """What became of a fault: 'does not compile', 'same code', 'survives', or the test that noticed it."""
    place = TREE / fault.file
    text = place.read_text()
    rows = text.splitlines()
    rows[fault.line - 1] = fault.after
    try:
        place.write_text("\n".join(rows) + "\n")
        if not build("breccia_command")[0]:
            return "does not compile"
        if machine_code() == whole:
            return "same code"
        for name in in_order(seconds, fault.file):
            if not build(*([name] if name.startswith("test_") else []))[0]:
                return "does not compile"
            if failed := run_test(name, PATIENCE * seconds[name] + LEAST):
                return failed
        return "survives"
    finally:
        place.write_text(text)


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--base", help="what lines are compared with (where the branch left main; on main the commit before)")
    words.add_argument("--count", type=int, default=20, help="faults at most (20)")
    words.add_argument("--seed", type=int, default=1, help="of the draw (1)")
    words.add_argument("--minutes", type=float, default=30, help="after which no further fault is begun (30)")
    words.add_argument("--tests", default=".", help="pattern of the tests that may notice them (all)")
    words.add_argument("files", nargs="*", help="only lines of these files")
    asked = words.parse_args()
    base = asked.base or default_base()
    lines = {file: numbers & code_lines(pathlib.Path(file).read_text()) for file, numbers in changed_lines(base, asked.files).items()}
    if not any(lines.values()):
        sys.exit(f"no line of code differs from {base}")
    print(f"{sum(map(len, lines.values()))} lines of code differ from {base}", flush=True)
    begin = time.monotonic()
    copy_tree()
    options = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    subprocess.run(["cmake", "--preset", "test", *options], cwd=TREE, check=True, stdout=subprocess.DEVNULL)
    built, told = build()
    if not built:
        sys.exit(told)
    seconds, whole = measure_tests(asked.tests), machine_code()
    print(f"built, and {len(seconds)} tests are good, after {time.monotonic() - begin:.0f} s", flush=True)
    tried, survived, void = 0, 0, 0
    begin = time.monotonic()
    for fault in draw(lines, asked.seed):
        if tried == asked.count or time.monotonic() - begin > 60 * asked.minutes:
            break
        what = try_fault(fault, seconds, whole)
        if what in ("does not compile", "same code"):
            void += 1
            continue
        tried += 1
        survived += what == "survives"
        told = "no test notices" if what == "survives" else f"noticed by {what}"
        change = f"\n  - {fault.before.strip()}\n  + {' '.join(fault.after.split())}"
        print(f"{tried}. {fault.file}:{fault.line}: {told}{change}", flush=True)
    build()  # the copy is left without a fault
    print(f"\n{tried - survived} of {tried} faults were noticed ({void} more did not compile or changed nothing)")


if __name__ == "__main__":
    main()
