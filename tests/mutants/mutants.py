"""Plants small faults in changed lines, one at a time, and prints those that no test notices.

    sh tests/mutants/run.sh [--base REVISION] [--count N] [--seed N] [--minutes N] [--tests PATTERN] [FILE ...]

The working tree is copied to build/mutants/tree and built there once; each fault is compiled and tested in that copy. Faults come from
universalmutator's rules for C, in lines that differ from the base; lines and faults are drawn by the seed, one fault to a line until all
lines have had one. Faults that do not compile or give the same machine code do not count. Tests of units run first, quick ones before slow ones,
then those of the command; the first failure ends them.
"""
import argparse
import collections
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
PATIENCE = 5  # times as long as without a fault, and a few seconds
SOURCES = ("source/*.c", "source/*.h")
COMMENT = re.compile(r"/\*.*?\*/|//.*")

Fault = collections.namedtuple("Fault", "file line before after text")


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
    """All that the tool makes of these lines of a file."""
    source = pathlib.Path(file)
    text = source.read_text()
    numbers = numbers & code_lines(text)
    if not numbers:
        return []
    # The tool passes over lines that end with a comment.
    faults, before = [], [COMMENT.sub("", line).rstrip() if n in numbers else line for n, line in enumerate(text.splitlines(), 1)]
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
            if line is None or line + 1 not in numbers:
                continue
            more = len(after) - len(before)
            faults.append(Fault(file, line + 1, before[line].strip(), " ".join(" ".join(after[line : line + 1 + max(0, more)]).split()), mutant.read_text()))
    return faults


def draw(faults, seed):
    """All faults in the order in which they are tried: one of each line, then a second one, and so on."""
    lot, of_line = random.Random(seed), collections.defaultdict(list)
    for fault in faults:
        of_line[fault.file, fault.line].append(fault)
    for of_one in of_line.values():
        lot.shuffle(of_one)
    order = []
    while of_line:
        places = sorted(of_line)
        lot.shuffle(places)
        order += [of_line[place].pop() for place in places]
        of_line = {place: left for place, left in of_line.items() if left}
    return order


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


def run_tests(names, seconds):
    """The first test of these that fails or takes longer than its seconds, or None."""
    for name in names:
        call = ["ctest", "--test-dir", "build/test", "-R", f"^{name}$"]
        with subprocess.Popen(call, cwd=TREE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as test:
            try:
                if test.wait(seconds[name]):
                    return name
            except subprocess.TimeoutExpired:
                os.killpg(test.pid, signal.SIGKILL)
                return f"{name}, which does not end"
    return None


def measure_tests(pattern):
    """{test: seconds}, without a fault; quick tests first, those of units before those of the command."""
    listed = subprocess.run(["ctest", "--test-dir", "build/test", "-R", pattern, "--show-only=json-v1"], cwd=TREE, check=True, capture_output=True, text=True).stdout
    seconds = {}
    for test in json.loads(listed)["tests"]:
        begin = time.monotonic()
        if run_tests([test["name"]], {test["name"]: 1800}):
            sys.exit(f"{test['name']} fails without a fault: mend that first")
        seconds[test["name"]] = time.monotonic() - begin
    return dict(sorted(seconds.items(), key=lambda item: (not item[0].startswith("test_"), item[1])))


def try_fault(fault, seconds, whole):
    """What became of a fault: 'does not compile', 'same code', 'survives', or the test that noticed it."""
    place = TREE / fault.file
    text = place.read_text()
    try:
        place.write_text(fault.text)
        if not build("breccia_command")[0]:
            return "does not compile"
        if machine_code() == whole:
            return "same code"
        build()
        return run_tests(seconds, {name: PATIENCE * spent + 5 for name, spent in seconds.items()}) or "survives"
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
    faults = [fault for file, numbers in sorted(changed_lines(base, asked.files).items()) for fault in faults_of(file, numbers)]
    if not faults:
        sys.exit(f"no line of code differs from {base}")
    order = draw(faults, asked.seed)
    print(f"{len(faults)} faults are possible in {len({(f.file, f.line) for f in faults})} lines that differ from {base}", flush=True)
    begin = time.monotonic()
    copy_tree()
    options = ["-DBRECCIA_WARNINGS_AS_ERRORS=OFF"] + (["-DCMAKE_C_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else [])
    subprocess.run(["cmake", "--preset", "test", *options], cwd=TREE, check=True, stdout=subprocess.DEVNULL)
    built, told = build()
    if not built:
        sys.exit(told)
    seconds, whole = measure_tests(asked.tests), machine_code()
    print(f"built, and {len(seconds)} tests are good, after {time.monotonic() - begin:.0f} s", flush=True)
    tried, survivors, void = 0, [], 0
    begin = time.monotonic()
    for fault in order:
        if tried == asked.count or time.monotonic() - begin > 60 * asked.minutes:
            break
        what = try_fault(fault, seconds, whole)
        if what in ("does not compile", "same code"):
            void += 1
            continue
        tried += 1
        print(f"{fault.file}:{fault.line}: {'survives' if what == 'survives' else 'noticed by ' + what}", flush=True)
        if what == "survives":
            survivors.append(fault)
    build()  # the copy is left without a fault
    print(f"\n{tried - len(survivors)} of {tried} faults were noticed ({void} more did not compile or changed nothing)")
    for fault in sorted(survivors):
        print(f"{fault.file}:{fault.line}: no test notices\n  - {fault.before}\n  + {fault.after}")


if __name__ == "__main__":
    main()
