#!/usr/bin/env python3
"""Pairs of features: runs small decks, which together contain pairs of levels of the factors of pair_decks.py.

Each deck is checked by these relations:

  energy balance  the imbalance of energies is small; internal energy is stored or dissipated
  momentum        a change of momentum equals the impulse of loads, supports and mass damping
  reactions       internal forces have no resultant and no moment; the force and moment of a prescribed motion follow
                  from the forces on its particles, about the present positions of these
  restatement     other units, other axes, lists in reverse order and a block divided into two give equal results
  restart         a run by 3 threads that is stopped half way and restarted ends in the same bits as a run by 1 thread

Closed forms of two features at once are in pair_forms.py.

usage: pairs.py COMMAND PRINT_RESULTS [--forms] [--all] [--seed N] [--only WORDS] [--stop] [--keep FOLDER] [--jobs N]
  default         closed forms and the sample: pairs of levels of the most dangerous factors; each deck is either
                  restated or restarted
  --forms         closed forms only
  --all           closed forms and three tables of the pairs of all factors; each deck is restated and restarted
  --only WORDS    decks that have all of these levels, or a closed form by its name; separated by commas
  --stop          end at the first failure
"""

import argparse
import concurrent.futures
import filecmp
import glob
import math
import os
import platform
import random
import resource
import shutil
import subprocess
import sys
import tempfile

import outputs
import pair_decks
import pair_forms
from quantities import System, determinant, turned_vector

BASE = System()
UNITS = ("mm, N, ms", "nm, nN, ns", "cm, lbf, ms", "km, GN, min")
PLANE = [((a, 0, 0), (0, b, 0), (0, 0, 1)) for a in (1, -1) for b in (1, -1)] + [
    ((0, a, 0), (b, 0, 0), (0, 0, 1)) for a in (1, -1) for b in (1, -1)
]


def space_axes(generator):
    """Returns axes that are permuted and reversed at random."""
    order = generator.sample(range(3), 3)
    return tuple(tuple(generator.choice((1, -1)) * (k == order[row]) for k in range(3)) for row in range(3))


class Failures:
    """Counts checks and collects the messages of those that fail."""

    def __init__(self):
        self.checks, self.messages = 0, []

    def check(self, holds, message):
        self.checks += 1
        if not holds:
            self.messages.append(message)


# ---- runs ----


def write_deck(folder, text, system):
    os.makedirs(folder, exist_ok=True)
    mirrored = system.axes and determinant(system.axes) < 0
    with open(os.path.join(folder, "deck.yaml"), "w") as file:
        file.write(
            system.deck(text.replace("ROTATED-", "" if mirrored else "-").replace("ROTATED", "-" if mirrored else ""))
        )


def run(options, folder, *arguments):
    done = subprocess.run(
        [options.command, "run", "deck.yaml", "--output", "out", "--quiet", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise ValueError(f"status {done.returncode}: {(done.stderr or done.stdout).strip()}")


def tables(out):
    return sorted(glob.glob(os.path.join(out, "*.csv"))) + sorted(glob.glob(os.path.join(out, "profiles", "*.csv")))


def results_of(options, folder):
    """Returns the results of a run: groups of numbers by file."""
    out = os.path.join(folder, "out")
    found = {
        "summary": outputs.groups_of_summary(os.path.join(out, "summary.json")),
        "fields": outputs.groups_of_fields(options.reader, out, folder),
    }
    for path in tables(out):
        found[os.path.relpath(path, out)] = outputs.groups_of_table(path, path)
    return found


# ---- restatement ----

# Results that may differ: numbers of iterations, a time step estimated from a vector that depends on the numbers of
# particles, and results in the order of the deck.
MAY_DIFFER = (
    "iterations",
    "products",
    "stable_time_step",
    "loads/",
    "imbalance",
    "numerical",
    "first_broken_bond",
    "rest/",
    "between",
    "cut",
    "stages",
)


def order_of(base, other, axes):
    """Returns for each particle of the restated body the number of the same particle in the base."""

    def keys(rows):
        return [tuple(round(v / size * 1e6) for v in row) for row in rows]

    one, two = base["Points"], other["Points"]
    size = max(abs(v) for row in one.rows for v in row) * one.factor
    index = {
        key: n for n, key in enumerate(keys([[v * one.factor for v in turned_vector(axes, row)] for row in one.rows]))
    }
    return [index[key] for key in keys([[v * two.factor for v in row] for row in two.rows])]


def profile_along_x(groups, others, axes):
    """Returns a profile of a turned body as a profile along x, with its layers in the order of the base."""
    along = list(others)[0]
    backwards = axes["xyz".index(along)][0] < 0
    new = {}
    for name, group in others.items():
        rows = group.rows[::-1] if backwards else group.rows
        if name == along:
            name, rows = "x", [[-v for v in r] for r in rows] if backwards else rows
        new[name] = outputs.Group(group.kind, group.unit, rows, name)
    return new if list(new) == list(groups) else others


def compare(failures, label, base, other, system, tolerance):
    """Compares the results of a restated deck with those of the base, relative to the largest of their dimension."""
    axes = system.axes or ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    order = order_of(base["fields"], other["fields"], axes)
    largest = {}
    for groups in base.values():
        for group in groups.values():
            key = tuple(group.powers)
            largest[key] = max(
                [largest.get(key, 0.0)] + [abs(group.factor * v) for row in group.rows for v in row if math.isfinite(v)]
            )
    forces = largest.get((0, 1, 0), 0.0)
    largest[1, 1, 0] = max(largest.get((1, 1, 0), 0.0), 0.8 * forces)  # the body is 0.8 m long
    for file, groups in base.items():
        others = other.get(file, {})
        if file.startswith("profiles"):
            others = profile_along_x(groups, others, axes)
        names = [{name for name in of if not any(word in name for word in MAY_DIFFER)} for of in (groups, others)]
        if names[0] != names[1]:
            failures.check(False, f"{label}: {file} has {sorted(names[0] ^ names[1])} on one side only")
            continue
        for name, a in groups.items():
            if name not in names[0] or (file == "fields" and name == "block"):
                continue
            b = others[name]
            rows = a.turned(axes)
            if file == "fields" and name != "Values":
                count = len(order)
                rows = [rows[state * count + n] for state in range(len(rows) // count) for n in order]
            elif file.startswith("profiles") and name != "x":
                rows = [[abs(v) for v in row] for row in rows]
            if a.powers != b.powers or len(rows) != len(b.rows):
                failures.check(
                    False,
                    f"{label}: {file}, {name}: '{b.unit}' and {len(b.rows)} rows, expected '{a.unit}' and {len(rows)}",
                )
                continue
            size = max([abs(v * a.factor) for row in rows for v in row if math.isfinite(v)] + [0.0])
            allowed = tolerance * (size + largest[tuple(a.powers)])
            worst, where = 0.0, 0
            for n, (one, two) in enumerate(zip(rows, b.rows)):
                off = max(
                    (
                        abs(v * a.factor - w * b.factor)
                        if math.isfinite(v) and math.isfinite(w)
                        else 0.0 if str(v) == str(w) else math.inf
                    )
                    for v, w in zip(one, two)
                )
                if not off <= worst:
                    worst, where = off, n
            failures.check(
                worst <= allowed,
                f"{label}: {file}, {name}: row {where} is {[w * b.factor for w in b.rows[where]]}, expected "
                f"{[v * a.factor for v in rows[where]]}, off by {worst / (size or 1):.2g} of the largest",
            )


def join_copies(summary):
    """Replaces the largest compressions of material 'm' and of its copy 'n', which half of the body has, by the larger of
    the two."""
    copy = summary.pop("largest_compressions/n", None)
    if copy and copy.rows[0][0] > summary["largest_compressions/m"].rows[0][0]:
        summary["largest_compressions/m"] = copy


def restate(options, failures, deck, folder, base, generator):
    """Applies all changes of the deck at once and, if results differ, each change by itself to find the cause."""
    axes = space_axes(generator) if deck.dimensions == 3 else generator.choice(PLANE[1:])
    units = generator.choice(UNITS)
    changes = {
        "restated": (System(units, axes=axes, plain=False), True),
        "in other units": (System(units, plain=False), False),
        "along other axes": (System(axes=axes), False),
        "in another order": (System(), True),
    }
    before = len(failures.messages)
    for name, (system, restated) in changes.items():
        if name != "restated" and len(failures.messages) == before:
            return
        here = os.path.join(folder, name.replace(" ", "-"))
        try:
            write_deck(here, deck.text(restated), system)
            run(options, here, "--threads", "1")
            found = results_of(options, here)
            if restated and deck.splits and deck.case["materials"] == "one":
                join_copies(found["summary"])
            compare(
                failures,
                f"{deck.name}, {name} ({units}; {axes})",
                base,
                found,
                system,
                pair_decks.tolerance(deck.case),
            )
        except ValueError as error:
            failures.check(False, f"{deck.name}, {name}: {error}")


# ---- restart and threads ----


def restart(options, failures, deck, folder):
    """Stops a run half way, restarts it and compares all of its files with those of the base."""
    here = os.path.join(folder, "restart")
    write_deck(here, deck.text(), BASE)
    steps = pair_decks.STEPS.get(deck.case["solver"], 1)
    run(options, here, "--threads", "3", "--steps", str(steps))
    run(options, here, "--threads", "3", "--restart")
    whole, parts = os.path.join(folder, "base", "out"), os.path.join(here, "out")
    for path in tables(whole):
        name = os.path.relpath(path, whole)
        failures.check(
            filecmp.cmp(path, os.path.join(parts, name), shallow=False),
            f"{deck.name}: {name} is not the same bits after a restart with 3 threads",
        )
    printed = [
        subprocess.run([options.reader, os.path.join(out, "results.vtkhdf")], capture_output=True).stdout
        for out in (whole, parts)
    ]
    failures.check(
        printed[0] == printed[1] and printed[0],
        f"{deck.name}: fields are not the same bits after a restart with 3 threads",
    )
    one, two = (
        {name: group.rows for name, group in outputs.groups_of_summary(os.path.join(out, "summary.json")).items()}
        for out in (whole, parts)
    )
    differ = [name for name in one if one[name] != two.get(name)]
    failures.check(not differ, f"{deck.name}: {differ} of the summary are not the same after a restart with 3 threads")


# ---- balances ----


class Balance:
    """Relations between the results of one run."""

    def __init__(self, failures, deck, found):
        self.failures, self.deck, self.found, self.case = failures, deck, found, deck.case
        self.fields = {name: group.rows for name, group in found["fields"].items()}
        self.points = self.fields["Points"]
        self.count = len(self.points)

    def near(self, found, expected, size, tolerance, what):
        off = max(abs(a - b) for a, b in zip(found, expected))
        self.failures.check(
            off <= tolerance * size,
            f"{self.deck.name}: {what}: {found}, expected {expected} within {tolerance * size:.3g}",
        )

    def last(self, name):
        return self.fields[name][-self.count :]

    def volume(self, n):
        return (
            0.1**3
            if self.deck.dimensions == 3
            else 0.2 * self.deck.spacing("b" if self.points[n][0] < 0.5 else "c") ** 2
        )

    def density(self, n):
        return self.deck.density["b" if self.points[n][0] < 0.5 else "c"]

    def series(self, file, name="vector"):
        return self.found[file + ".csv"][name].rows

    def mirrors(self):
        return self.case["boundary"] == "mirror"

    def energy(self):
        """Checks the balance of energies, and that internal energy is either stored or dissipated."""
        imbalance = max(abs(r[0]) for r in self.series("energies", "imbalance"))
        self.near([imbalance], [0], 1, pair_decks.imbalance(self.case), "imbalance of energies")
        if (
            self.case["boundary"] == "spring"
            or self.case["extra"] == "prestress"
            or self.case["solver"] in pair_decks.AT_REST
        ):
            return  # stored energy includes that of springs and initial stress; increments at rest are too long
        energies = [[r[0] for r in self.series("energies", name)] for name in ("stored", "dissipated", "internal")]
        size = max(abs(v) for row in energies for v in row) or 1
        for stored, dissipated, internal in zip(*energies):
            self.near([stored + dissipated], [internal], size, 0.02, "sum of stored and dissipated energy")

    def momentum(self):
        """Checks that a step of Verlet's or Newmark's method adds dt times the mean force at its ends to momentum."""
        case = self.case
        if (
            case["solver"] not in ("explicit", "Newmark", "stages")
            or case["boundary"] in ("dashpots", "mirror", "shake")
            or case["damping"] == "local"
            or case["extra"] == "breaking"
        ):  # a bond that breaks at the end of a step acts during the step, not at its end
            return
        rate, steps = pair_decks.RATE.get(case["damping"], 0), [r[0] for r in self.series("energies", "time")]
        masses = [
            sum(self.density(n) * self.volume(n) for n, p in enumerate(self.points) if (p[0] < 0.5) == near)
            for near in (True, False)
        ]
        momentum = [
            [masses[0] * a + masses[1] * b for a, b in zip(v, w)]
            for v, w in zip(self.series("slow"), self.series("fast"))
        ]
        weight = [0.0, 0.0, 0.0]
        if case["solver"] == "stages":
            weight = [(masses[0] + masses[1]) * g for g in (0.3 * self.deck.size, -0.9 * self.deck.size, 0.0)]
        acting = []
        for row, p in enumerate(momentum):
            loads = [
                sum(
                    self.series("factor-" + name, "factor")[row][0] * f[k] if k < len(f) else 0.0
                    for name, f in self.deck.forces
                )
                for k in range(3)
            ]
            acting.append([r + l + w - rate * q for r, l, w, q in zip(self.series("held")[row], loads, weight, p)])
        size = max(abs(v) for row in acting for v in row) or 1
        first = 3 if case["solver"] == "stages" else 2
        for n in range(first, len(steps)):
            dt = steps[n] - steps[n - 1]
            gained = [a - b for a, b in zip(momentum[n], momentum[n - 1])]
            self.near(
                gained,
                [dt / 2 * (a + b) for a, b in zip(acting[n], acting[n - 1])],
                size * dt,
                1e-6,
                f"momentum gained in step {n}",
            )

    def reactions(self):
        """Checks resultant and moment of internal forces, and force and moment of a prescribed motion."""
        force = self.last("internal force")
        size = sum(math.sqrt(sum(v * v for v in row)) * self.volume(n) for n, row in enumerate(force)) or 1
        if not self.mirrors():
            total = [sum(row[k] * self.volume(n) for n, row in enumerate(force)) for k in range(3)]
            self.near(total, [0.0] * 3, size, 1e-9, "resultant of internal forces")
            if self.case["formulation"] != "small strain" and self.case["solver"] != "stages":
                self.internal_moment(force, size)
        if (
            self.case["boundary"] == "guide"
            and self.case["solver"] in ("explicit", "Newmark", *pair_decks.AT_REST)
            and self.case["damping"] in ("none", "mass")
        ):
            self.prescribed_motion(force, size)

    def internal_moment(self, force, size):
        """Checks that internal forces of finite strains have no moment about the origin, at present positions."""
        moment, u = [0.0] * 3, self.last("displacement")
        for n, f in enumerate(force):
            at = [x + d for x, d in zip(self.points[n], u[n])]
            for k in range(3):
                moment[k] += self.volume(n) * (at[(k + 1) % 3] * f[(k + 2) % 3] - at[(k + 2) % 3] * f[(k + 1) % 3])
        if "internal moment" in self.fields:
            for n, own in enumerate(self.last("internal moment")):
                moment = [m + self.volume(n) * o for m, o in zip(moment, own)]
        # Friction keeps the angular momentum but for the twist about the normal of a face (docs/theory.md, friction).
        slides = self.case["extra"] == "contact" and self.deck.dimensions == 3
        tolerance = 1e-3 if slides else 1e-9
        self.near(moment, [0.0] * 3, size, tolerance, "moment of internal forces")

    def prescribed_motion(self, force, size):
        """Checks force and moment of a prescribed motion in one direction, about the present centre of particles."""
        direction = (3, 1, -1) if self.deck.dimensions == 3 else (3, 1, 0)
        length = math.sqrt(sum(d * d for d in direction))
        direction = [d / length for d in direction]
        low = 0.9 - 2 * self.deck.spacing("c")
        u, v = self.last("displacement"), self.last("velocity")
        where = {n: [self.points[n][k] + u[n][k] for k in range(3)] for n, p in enumerate(self.points) if p[0] > low}
        middle = [sum(at[k] for at in where.values()) / len(where) for k in range(3)]
        gain = 2e-3 * self.deck.size / pair_decks.TIME**2 if self.deck.moves else 0.0
        rate, total, moment = pair_decks.RATE.get(self.case["damping"], 0), [0.0] * 3, [0.0] * 3
        for n, at in where.items():
            along = sum(-self.volume(n) * f * d for f, d in zip(force[n], direction))
            along += self.density(n) * self.volume(n) * (gain + rate * sum(a * d for a, d in zip(v[n], direction)))
            f = [along * d for d in direction]
            arm = [a - b for a, b in zip(at, middle)]
            total = [a + b for a, b in zip(total, f)]
            moment = [
                m + arm[(k + 1) % 3] * f[(k + 2) % 3] - arm[(k + 2) % 3] * f[(k + 1) % 3] for k, m in enumerate(moment)
            ]
        self.near(self.series("it")[-1], total, size, 1e-7, "force of a prescribed motion")
        self.near(
            self.series("it", "moment")[-1],
            moment,
            size * 0.4,
            1e-7,
            "moment of a prescribed motion about the present centre of its particles",
        )


# ---- the loop ----


def try_case(options, folder, number, case):
    """Checks the relations of a case: restatement and restart, or the one that its level of 'relation' names."""
    deck = pair_decks.Deck(
        case,
        " ".join(
            f"{f} {case[f]}" if f in ("damping", "extra", "size", "sign") else f"{case[f]}" for f in pair_decks.FACTORS
        ),
    )
    failures = Failures()
    here = os.path.join(folder, str(number))
    try:
        base = os.path.join(here, "base")
        write_deck(base, deck.text(), BASE)
        run(options, base, "--threads", "1", *(["--trap"] if options.traps and case["solver"] == "explicit" else []))
        found = results_of(options, base)
        balance = Balance(failures, deck, found)
        balance.energy()
        balance.momentum()
        balance.reactions()
        chosen = [case["relation"]] if "relation" in case else pair_decks.RELATIONS["relation"]
        if "restatement" in chosen and pair_decks.allowed(case, "relation", "restatement"):
            restate(options, failures, deck, here, found, random.Random(f"{options.seed} {number}"))
        if "restart" in chosen:
            restart(options, failures, deck, here)
    except (ValueError, KeyError, IndexError, OSError) as error:
        failures.check(False, f"{deck.name}: {type(error).__name__} {error}")
    if not options.keep:
        shutil.rmtree(here, ignore_errors=True)
    return failures


def try_form(options, folder, name, form):
    return pair_forms.try_form(sys.modules[__name__], options, os.path.join(folder, name), form)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("reader")
    parser.add_argument("--forms", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--stop", action="store_true")
    parser.add_argument("--keep", default="")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shown", type=int, default=4, help="number of failures that are printed of each case")
    options = parser.parse_args()
    options.command, options.reader = os.path.abspath(options.command), os.path.abspath(options.reader)
    options.traps = (
        platform.system() == "Linux" and platform.machine() == "x86_64" and platform.libc_ver()[0] == "glibc"
    )
    work = options.keep or tempfile.mkdtemp(prefix="pairs")
    os.makedirs(work, exist_ok=True)
    cases = [] if options.forms else pair_decks.sample(options.seed)
    if options.all:
        cases = [case for seed in range(options.seed, options.seed + 3) for case in pair_decks.table(seed)]
    tests = [(form.__name__, try_form, form, {form.__name__}) for form in pair_forms.FORMS]
    tests += [(number, try_case, case, set(case.values())) for number, case in enumerate(cases)]
    wanted = {name for name in options.only.split(",") if name}
    tests = [test for test in tests if wanted <= test[3]]
    outcomes = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for outcome in pool.map(lambda test: test[1](options, work, test[0], test[2]), tests):
            outcomes.append(outcome)
            for message in outcome.messages[: options.shown]:
                print("FAIL:", message, flush=True)
            if outcome.messages and options.stop:
                pool.shutdown(cancel_futures=True)
                break
    if not options.keep:
        shutil.rmtree(work, ignore_errors=True)
    failed = sum(len(outcome.messages) for outcome in outcomes)
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    seconds = sum(u.ru_utime + u.ru_stime for u in used)
    checks = sum(o.checks for o in outcomes)
    print(f"{len(outcomes)} decks, {checks} checks, {failed} failed; {seconds:.1f} s of processor time")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
