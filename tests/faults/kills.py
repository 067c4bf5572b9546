#!/usr/bin/env python3
"""Kills a run at the calls by which it writes into its folder, and takes it up again.

A run is killed (SIGKILL) just before its Nth such call, or in the middle of what the call writes; io_faults.c, preloaded, does it. What is
left is taken up with --restart, or begun again where there was no checkpoint yet, and must end in the same bits as a run that nobody
disturbed: results, histories and the state at the end. Runs that are taken up are killed again, up to three times. Of every three runs one takes
its results for large ones, which are written in place with a journal, and one goes through stages of all solvers.

usage: kills.py COMMAND SHIM COMPARE_RESULTS [--count N] [--seconds S] [--seed K]
  --count N    so many runs that are killed (24); first one of each kind of call, then all calls in a random order, then several in a row
  --seconds S  no more are begun after so many seconds
  --seed K     of the order (1)
"""
import argparse
import collections
import concurrent.futures
import filecmp
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

BODY = """\
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.25, yield stress: 2 MPa, hardening modulus: 1 GPa}
body:
  left: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {particles: [9, 5], first particle: [0, 0]}}}
  right: {material: s, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {particles: [9, 5], first particle: [0.09, 0]}}}
peridynamics: {space: plane strain, regions: {fibres: {blocks: [left], formulation: bond-based}}}
failure: {critical stretch: 3e-4, near grips: break}
pictures: []
"""
MOTION = """\
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, free]}
  - {on: {face: x+, layers: 2}, velocity: [0.5, free]}
solve: {explicit: {steps: 140}}
watch: {end: {displacement of: {face: x+}, every: 3}, energy: {energy: yes, every: 20}}
results: {number: 4, checkpoint steps: 30, precision: double, fields: [displacement, damage, stress]}
"""
STAGES = """\
cracks: [{cut: {line: [[0.045, -1], [0.045, 0.015]]}}]
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, displacement: [2e-5, free], history: {ramp to: 1}}
solve:
  - {name: pull, static: {increments: 12}}
  - {name: swing, implicit: {end time: 1e-4, time step: 1e-5}}
  - {name: shake, explicit: {steps: 20}}
  - {name: rest, static: {method: relaxation, increments: 4}}
watch: {end: {displacement of: {face: x+}, every: 1}, energy: {energy: yes, every: 2}}
results: {number: 4, checkpoint steps: 3, precision: double, fields: [displacement, damage, stress]}
"""
BEFORE, WITHIN = 1, 2
WORDS = {BEFORE: "before", WITHIN: "within"}
SAME = ("end.csv", "energy.csv", "results.xdmf", "solution.txt")  # byte by byte
ALIKE = ("results.vtkhdf", "checkpoint.h5")  # by what is in them


class Walk:
    def __init__(self, options, work, solve=MOTION, large=False):
        self.options, self.work = options, work
        self.faults = {"FAULT_LARGER": "300000000"} if large else {}
        os.makedirs(work)
        with open(f"{work}/deck.yaml", "w") as deck:
            deck.write(BODY + solve)
        self.run("whole")
        if not os.path.exists(f"{work}/whole/checkpoint.h5"):
            sys.exit("the whole run leaves no checkpoint")
        with open(f"{work}/whole/summary.json") as summary:
            if '"broken_bonds": 0,' in summary.read():
                sys.exit("no bond breaks, the walk is too tame")
        self.calls = self.count("counted")
        problem = self.compare("counted")
        if problem:
            sys.exit(f"a run that is only watched: {problem}")
        if len(self.calls) < 200 or set("wsrcou") - set(self.calls):
            sys.exit(f"the walk does not see how files are written: {collections.Counter(self.calls)}")

    def run(self, folder, restart=False, **faults):
        """Returns the status and what was said; a status below zero is a signal."""
        environment = dict(os.environ, LC_ALL="C", **self.faults)
        if faults or self.faults:
            environment.update(LD_PRELOAD=self.options.shim, FAULT_FOLDER=f"{self.work}/{folder}", FAULT_EXCEPT="run.lock")
            environment.update({f"FAULT_{key.upper()}": str(value) for key, value in faults.items()})
        words = [self.options.command, "run", "deck.yaml", "--quiet", "--threads", "1", "--output", folder] + ["--restart"] * restart
        done = subprocess.run(words, cwd=self.work, env=environment, capture_output=True, text=True, errors="replace")
        if not faults and done.returncode:
            raise RuntimeError(f"status {done.returncode}: {done.stderr.strip() or done.stdout.strip()}")
        return done.returncode, done.stderr.strip()

    def count(self, folder):
        """The calls of a whole run, a letter for the kind of each."""
        path = f"{self.work}/{folder}.calls"
        self.run(folder, kills=BEFORE, count=path)
        with open(path) as letters:
            return letters.read()

    def compare(self, folder):
        """What is not as in the whole run, in words; none if all is."""
        for name in SAME:
            if not os.path.exists(f"{self.work}/whole/{name}"):
                continue
            if not filecmp.cmp(f"{self.work}/whole/{name}", f"{self.work}/{folder}/{name}", shallow=False):
                return f"{name} differs"
        for name in ALIKE:
            done = subprocess.run([self.options.compare, f"{self.work}/whole/{name}", f"{self.work}/{folder}/{name}"],
                                  capture_output=True, text=True)
            if done.returncode:
                return f"{name} differs: {done.stdout.strip()[:300]}"
        names = sorted(os.listdir(f"{self.work}/whole"))
        return "" if names == sorted(os.listdir(f"{self.work}/{folder}")) else f"other files: {os.listdir(f'{self.work}/{folder}')}"

    def kill(self, number, plan):
        """Runs, kills and takes up again; plan: (call, BEFORE or WITHIN) one after the other. Returns kills, restarts from checkpoints, problem."""
        folder, kills, restarts = f"killed-{number}", 0, 0
        for call, how in plan + [(0, BEFORE)]:
            restart = os.path.exists(f"{self.work}/{folder}/checkpoint.h5")
            restarts += restart
            try:
                status, said = self.run(folder, restart, at=call, kills=how) if call else self.run(folder, restart)
            except RuntimeError as problem:
                return kills, restarts, f"cannot be taken up: {problem}"
            if status not in (0, -signal.SIGKILL):
                return kills, restarts, f"status {status}: {said}"
            kills += status != 0
            if call and status == 0:  # it had fewer calls than that, and is done
                break
        problem = self.compare(folder)
        if not problem:
            shutil.rmtree(f"{self.work}/{folder}")
        return kills, restarts, problem

    def plans(self, chance):
        """Without an end: one call of each kind, all calls in both ways, several in a row."""
        kinds = collections.defaultdict(list)
        for number, letter in enumerate(self.calls, 1):
            kinds[letter].append(number)
        for letter in sorted(kinds):
            for how in (BEFORE, WITHIN) if letter in "wf" else (BEFORE,):
                yield [(chance.choice(kinds[letter]), how)]
        every = [(number, how) for number, letter in enumerate(self.calls, 1) for how in ((BEFORE, WITHIN) if letter in "wf" else (BEFORE,))]
        chance.shuffle(every)
        for one in every:
            yield [one]
        while True:
            yield [(chance.randint(1, len(self.calls)), chance.choice((BEFORE, WITHIN))) for _ in range(chance.randint(2, 3))]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("command", "shim", "compare"):
        parser.add_argument(name, type=os.path.abspath)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    work = os.path.realpath(tempfile.mkdtemp(prefix="breccia-kills-"))
    options.shim = shutil.copy(options.shim, work)  # LD_PRELOAD ends a name at a blank
    end = time.monotonic() + options.seconds
    tried = kills = restarts = 0
    lost = []
    try:
        chance = random.Random(options.seed)
        walks = [Walk(options, f"{work}/small"), Walk(options, f"{work}/large", large=True), Walk(options, f"{work}/stages", STAGES)]
        plans = [walk.plans(chance) for walk in walks]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            while kills < options.count and time.monotonic() < end:
                batch = [(number, walks[number % 3], next(plans[number % 3])) for number in range(tried, tried + min(16, options.count - kills))]
                done = pool.map(lambda one: one[1].kill(one[0], one[2]), batch)
                for (_, walk, plan), (k, r, problem) in zip(batch, done):
                    kills, restarts = kills + k, restarts + r
                    if problem:
                        calls = " then ".join(f"{WORDS[how]} call {call} ({walk.calls[call - 1]})" for call, how in plan)
                        lost.append(f"{os.path.basename(walk.work)}, {calls}: {problem}")
                tried += len(batch)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    for words in lost[:20]:
        print(f"LOST: {words}")
    if not restarts and kills > 10:
        sys.exit("no run was taken up from a checkpoint, the walk is too tame")
    print(f"kills: {kills} tried, {len(lost)} lost")
    sys.exit(1 if lost else 0)


main()
