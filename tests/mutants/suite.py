"""The tests as ctest knows them, run some at a time until one fails, and which of them run a line."""
import collections
import functools
import json
import os
import pathlib
import re
import signal
import subprocess
import time

from tree import TREE

PATIENCE, LEAST = 5, 60  # times as long as without a fault, and seconds more: others may use the machine too
SLOWER = {"test": 1, "coverage": 1, "asan-ubsan": 10}
DATA = TREE.parent / "coverage"

Test = collections.namedtuple("Test", "command folder environment alone")


def tests(kind, pattern="."):
    """{name: Test} of a build. With one library for all rooms there is nothing to install, and traps tell another place."""
    call = ["ctest", "--test-dir", f"build/{kind}", "-R", pattern, "-E", "^(install|test_trap)$", "--show-only=json-v1"]
    listed = json.loads(subprocess.run(call, cwd=TREE, check=True, capture_output=True, text=True).stdout)["tests"]
    found = {}
    for test in listed:
        told = {p["name"]: p["value"] for p in test["properties"]}
        environment = dict(word.split("=", 1) for word in told.get("ENVIRONMENT", []))
        found[test["name"]] = Test(test["command"], told["WORKING_DIRECTORY"], preset_environment(kind) | environment, bool(told.get("RUN_SERIAL")))
    return found


def preset_environment(kind):
    """What the presets of tests give their processes."""
    for preset in json.loads((TREE / "CMakePresets.json").read_text())["testPresets"]:
        if preset["name"] == kind:
            return {name: value.replace("${sourceDir}", str(TREE)) for name, value in preset.get("environment", {}).items()}
    return {}


def begin(test, more=None):
    return subprocess.Popen(test.command, cwd=test.folder, env=os.environ | test.environment | (more or {}), stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def end(process):
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def fails(test, seconds):
    """@return None, or how it fails when it runs alone"""
    process = begin(test)
    try:
        return "fails" if process.wait(seconds) else None
    except subprocess.TimeoutExpired:
        return "does not end"
    finally:
        end(process)


def first_failure(known, names, seconds, kind):
    """@return None, or the first test that fails twice: with others beside it, and alone. What fails once fails for lack of time."""
    waiting, running = list(names), {}
    patience = {name: (PATIENCE * seconds.get(name, 10) + LEAST) * SLOWER[kind] for name in names}
    try:
        while waiting or running:
            while waiting and len(running) < os.cpu_count():
                if running and (known[waiting[0]].alone or any(known[name].alone for name in running)):
                    break
                name = waiting.pop(0)
                running[name] = begin(known[name]), time.monotonic()
            for name, (process, since) in list(running.items()):
                late = time.monotonic() - since > patience[name]
                if process.poll() is None and not late:
                    continue
                end(process)
                del running[name]
                if late or process.returncode:
                    how = fails(known[name], patience[name])
                    if how:
                        return f"{name}, which does not end" if how == "does not end" else name
            time.sleep(0.02)
        return None
    finally:
        for process, _ in running.values():
            end(process)


def collect(test, name):
    """Runs a test of the build that counts lines."""
    process = begin(test, {"GCOV_PREFIX": str(DATA / name)})
    try:
        process.wait(1800)
    finally:
        end(process)


@functools.lru_cache(None)
def lines_of(file, names):
    """(lines of a file that can run, {line: names of the tests that run it})"""
    able, found = set(), collections.defaultdict(set)
    for notes in (TREE / "build/coverage").rglob(f"{pathlib.Path(file).name}.gcno"):
        if not str(notes).endswith(f"{file}.gcno"):
            continue
        for name in names:
            counts = pathlib.Path(f"{DATA / name}{notes.with_suffix('.gcda')}")
            if not counts.is_file():
                continue
            beside = counts.with_suffix(".gcno")
            if not beside.exists():
                beside.symlink_to(notes)
            told = subprocess.run(["gcov", "--json-format", "--stdout", counts], capture_output=True, text=True).stdout
            for part in (p for row in told.splitlines() if row for p in json.loads(row)["files"] if p["file"].endswith(file)):
                for line in part["lines"]:
                    able.add(line["line_number"])
                    if line["count"]:
                        found[line["line_number"]].add(name)
    return able, found


def that_run(file, line, names):
    """Those of these tests that run a line, and all where the compiler counts none near it: tables, types, headers."""
    able, found = lines_of(file, names)
    near = [line] if line in able else [n for n in range(line - 2, line + 3) if n in able]
    return set().union(*(found[n] for n in near)) if near else set(names)


def in_order(names, seconds, file):
    """Quick tests first, and among them those that include headers of the fault's room."""

    def rank(name):
        source = TREE / "tests/unit" / f"{name}.c"
        near = source.is_file() and re.search(f'#include "{file.split("/")[1]}/', source.read_text())
        return seconds.get(name, 1) / (4 if near else 1)

    return sorted(names, key=rank)
