"""Plants small faults in changed lines, one at a time, and prints those that no test notices.

    sh tests/mutants/run.sh [--base REVISION] [--count N] [--seed N] [--minutes N] [--tests PATTERN] [FILE ...]

The working tree is copied to build/mutants/tree and built there: as it is, with counts of lines, and under the sanitizers, as all tests run
before anything lands. Faults come from universalmutator's rules for C, in lines that differ from the base; lines and faults are drawn by the
seed, one fault to a line until all lines have had one. Faults that do not compile or give the same machine code do not count. Of the tests
those are asked that run the line, quick ones first, and what they do not notice is asked of them again under the sanitizers. The first
failure ends it. Which lines a test runs is kept as long as neither it nor the sources change, and what became of a fault as long as no test
changes either: a call that was stopped goes on where it was.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import sys
import time

import faults
import suite
import tree

KEPT = pathlib.Path("build/mutants/kept.json")  # {test: what it is of, and its seconds}
TRIED = pathlib.Path("build/mutants/tried.jsonl")  # faults, a line each
VOID = ("does not compile", "same code")


def say(words):
    print(words, flush=True)


def run_one(name, plain, counting):
    """A test as it is, which it must stand, and with counts. @return its seconds"""
    since = time.monotonic()
    if how := suite.fails(plain[name], 1800) and suite.fails(plain[name], 1800):
        sys.exit(f"{name} {how} without a fault: mend that first")
    seconds = time.monotonic() - since
    if name in counting:
        suite.collect(counting[name], name)
    return seconds


def run_all(pattern):
    """Runs the tests that have changed. @return {test: seconds}, and those whose lines were counted"""
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    plain, counting = suite.tests("test", pattern), suite.tests("coverage", pattern)
    sources = tree.digest("source", "include", "CMakeLists.txt")
    of = {name: sources + tree.digest(f"tests/unit/{name}.c", f"tests/command/{name}.sh") for name in plain}
    changed = [name for name in plain if kept.get(name, {}).get("of") != of[name]]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        running = {pool.submit(run_one, name, plain, counting): name for name in changed}
        for done, run in enumerate(concurrent.futures.as_completed(running), 1):
            name = running[run]
            kept[name] = {"of": of[name], "seconds": run.result(), "counted": name in counting}
            KEPT.write_text(json.dumps(kept))
            say(f"{done} of {len(changed)}: {name}, {kept[name]['seconds']:.1f} s")
    return {name: kept[name]["seconds"] for name in plain}, tuple(name for name in plain if kept[name]["counted"])


def try_fault(fault, seconds, counted, whole):
    """What became of a fault: 'does not compile', 'same code', 'survives', or the test that noticed it."""
    place = tree.TREE / fault.file
    text = place.read_text()
    rows = text.splitlines()
    rows[fault.line - 1] = fault.after
    targets = ["breccia_objects", "breccia_command", "breccia", *(f"tests_of_{name}" for name in seconds)]
    asked = suite.that_run(fault.file, fault.line, counted) | (seconds.keys() - set(counted))
    asked = suite.in_order(asked, seconds, fault.file)
    try:
        place.write_text("\n".join(rows) + "\n")
        if not tree.build("test", *targets)[0]:
            return "does not compile"
        if tree.machine_code() == whole:
            return "same code"
        if failed := suite.first_failure(suite.tests("test"), asked, seconds, "test"):
            return failed
        if not tree.build("asan-ubsan")[0]:  # whole: programs that tests call are known once they are there
            return "does not compile"
        known = suite.tests("asan-ubsan")
        failed = suite.first_failure(known, [name for name in asked if name in known], seconds, "asan-ubsan")
        return f"{failed}, under the sanitizers" if failed else "survives"
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
    base = asked.base or faults.default_base()
    lines = {file: numbers & faults.code_lines(pathlib.Path(file).read_text()) for file, numbers in faults.changed_lines(base, asked.files).items()}
    if not any(lines.values()):
        sys.exit(f"no line of code differs from {base}")
    say(f"{sum(map(len, lines.values()))} lines of code differ from {base}")
    begin = time.monotonic()
    tree.copy_tree()
    for kind in tree.KINDS:
        tree.configure(kind)
        built, told = (True, "") if kind == "asan-ubsan" else tree.build(kind)  # it is built when something has survived
        if not built:
            sys.exit(told)
    say(f"built after {time.monotonic() - begin:.0f} s")
    seconds, counted = run_all(asked.tests)
    whole, of = tree.machine_code(), tree.digest("source", "tests") + asked.tests
    known = {tuple(row[:4]): row[4] for row in map(json.loads, TRIED.read_text().splitlines())} if TRIED.is_file() else {}
    say(f"{len(seconds)} tests are good, after {time.monotonic() - begin:.0f} s")
    tried, survived, void = 0, 0, 0
    begin = time.monotonic()
    for fault in faults.draw(lines, asked.seed):
        if tried == asked.count or time.monotonic() - begin > 60 * asked.minutes:
            break
        key = of, fault.file, fault.line, fault.after
        what = known.get(key) or try_fault(fault, seconds, counted, whole)
        if key not in known:
            with TRIED.open("a") as log:
                log.write(json.dumps([*key, what]) + "\n")
        if what in VOID:
            void += 1
            continue
        tried += 1
        survived += what == "survives"
        told = "no test notices" if what == "survives" else f"noticed by {what}"
        change = f"\n  - {fault.before.strip()}\n  + {' '.join(fault.after.split())}"
        say(f"{tried}. {fault.file}:{fault.line}: {told}{change}")
    tree.build("test")  # the copy is left without a fault
    say(f"\n{tried - survived} of {tried} faults were noticed ({void} more did not compile or changed nothing)")


if __name__ == "__main__":
    main()
