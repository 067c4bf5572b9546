"""Closed forms of two features at once, and cases of the tables that have found defects.

A form is a function whose docstring states the relation; it runs decks by Form.run and checks numbers by Form.near."""

import os
import random
import re
import shutil

import pair_decks

PERIOD = (
    "watch:\n  moved: {displacement of: {all: yes}, every: 1}\n  fast: {velocity of: {all: yes}, every: 1}\nresults:"
    " {number: 1, precision: double}\npictures: []\n"
)
UNITS = "units: {length: m, force: kN, time: s}\n"


class Form:
    """Runs the decks of a closed form and collects its failures."""

    def __init__(self, loop, options, name, folder):
        self.loop, self.options, self.name, self.folder = loop, options, name, folder
        self.failures, self.runs = loop.Failures(), 0

    def run(self, text, *arguments):
        self.runs += 1
        here = os.path.join(self.folder, str(self.runs))
        os.makedirs(here)
        with open(os.path.join(here, "deck.yaml"), "w") as file:
            file.write(text)
        self.loop.run(self.options, here, "--threads", "1", *arguments)
        self.here = here
        return self.loop.results_of(self.options, here)

    def near(self, found, expected, tolerance, size, what):
        self.failures.check(
            abs(found - expected) <= tolerance * abs(size), f"{self.name}: {what}: {found}, expected {expected}"
        )

    def case(self, *levels):
        """Returns the deck of a case with these levels, in the order of the factors."""
        case = dict(zip(pair_decks.FACTORS, levels, strict=True))
        return pair_decks.Deck(case, f"{self.name}: {' '.join(levels)}")

    def base(self, deck):
        """Runs a deck of a case as the base of restatements and restarts, and returns its folder."""
        self.runs += 1
        folder = os.path.join(self.folder, str(self.runs))
        self.loop.write_deck(os.path.join(folder, "base"), deck.text(), self.loop.BASE)
        self.loop.run(self.options, os.path.join(folder, "base"), "--threads", "1")
        return folder


def try_form(loop, options, folder, form):
    test = Form(loop, options, form.__name__, folder)
    try:
        form(test)
    except (ValueError, KeyError, IndexError, OSError) as error:
        test.failures.check(False, f"{test.name}: {type(error).__name__} {error}")
    if not options.keep:
        shutil.rmtree(test.folder, ignore_errors=True)
    return test.failures


def rows(found, file, name="vector", k=0):
    """Returns component k of a history."""
    return [row[k] for row in found[file + ".csv"][name].rows]


def implicit_steps_with_damping(test):
    """A rigid body on a spring with mass damping, under a constant force, moves as the scheme of an oscillator does.

    All terms of the equation of motion have their weights, damping at the start of the step among them (Hilber, Hughes,
    Taylor 1977).
    """
    rate, stiffness, force, mass, dt = 60.0, 300.0, 2.0, 4 * 2.0 * 0.1**2 * 0.2, 1e-3
    for scheme, alpha, beta, gamma in (
        ("scheme: HHT, alpha: -0.2", -0.2, 1.2**2 / 4, 0.7),
        ("gamma: 0.6, beta: 0.31", 0.0, 0.31, 0.6),
    ):
        found = test.run(
            UNITS
            + "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\nbody: {b:"
            " {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [2,"
            " 2]}}}}\nperidynamics: {formulation: ordinary, space: plane strain}\nloads:\n  - {on: {all:"
            f" yes}}, tie: {{}}}}\n  - {{on: {{all: yes}}, spring: {{stiffness: {stiffness}}}}}\n  - {{on: {{all:"
            f" yes}}, force: [{force}, 0]}}\nsolve: {{implicit: {{end time: 0.02, time step: {dt}, local error: 1e9,"
            f" residual: 1e-12, damping: {rate}, {scheme}}}}}\n"
            + PERIOD
        )
        u = v = 0.0
        a = force / mass
        moved = rows(found, "moved")
        test.failures.check(len(moved) == 21, f"{test.name}: {len(moved)} rows instead of 21")
        for n in range(1, len(moved)):
            before = force - stiffness * u - rate * mass * v
            u, v = u + dt * v + dt**2 * (0.5 - beta) * a, v + dt * (1 - gamma) * a
            a = ((1 + alpha) * (force - stiffness * u - rate * mass * v) - alpha * before) / (
                mass + (1 + alpha) * (stiffness * beta * dt**2 + rate * mass * gamma * dt)
            )
            u, v = u + dt**2 * beta * a, v + dt * gamma * a
            test.near(moved[n], u, 1e-8, force / stiffness, f"displacement of step {n}, {scheme}")


def ties_of_two_densities(test):
    """Bodies of two densities that are tied while they move keep their momentum, in any order of the loads."""
    loads = [
        "{on: {block: b}, initial velocity: {translation: [1, 0.4]}}",
        "{on: {block: c}, initial velocity: {translation: [-0.5, 0.1]}}",
        "{on: {all: yes}, tie: {}}",
    ]
    body = (
        "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n  n: {model: elastic,"
        " density: 7, Young modulus: 4e4, Poisson ratio: 0.2}\nbody:\n  b: {material: m, lattice: square, spacing: 0.1,"
        " thickness: 0.2, shape: {box: {particles: [2, 2]}}}\n  c: {material: n, lattice: square, spacing: 0.1,"
        " thickness: 0.2, shape: {box: {from: [0.2, 0], to: [0.5, 0.2]}}}\nperidynamics: {formulation: ordinary, space:"
        " plane strain}\n"
    )
    masses = (4 * 2.0, 6 * 7.0)
    for solve in (
        "explicit: {time step: 1e-4, steps: 4}",
        "implicit: {end time: 4e-4, time step: 1e-4, local error: 1}",
    ):
        for order in (loads, loads[::-1]):
            found = test.run(
                UNITS
                + body
                + "loads:\n"
                + "".join(f"  - {load}\n" for load in order)
                + f"solve: {{{solve}}}\n"
                + PERIOD
            )
            for k, (one, two) in enumerate(((1, -0.5), (0.4, 0.1))):
                for value in rows(found, "fast", k=k):
                    test.near(
                        value,
                        (masses[0] * one + masses[1] * two) / sum(masses),
                        1e-9,
                        1,
                        f"common velocity along {'xy'[k]}, {solve}",
                    )


def a_force_on_tied_bodies(test):
    """Bodies of two densities that are tied gain the speed of a constant force over both masses from the first step on,
    in explicit and in implicit steps."""
    masses, force, dt = (4 * 2.0 * 2e-3, 6 * 7.0 * 2e-3), 3.0, 1e-4
    for order in ("bc", "cb"):
        blocks = {
            "b": (
                "  b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [2,"
                " 2]}}}\n"
            ),
            "c": (
                "  c: {material: n, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0.2, 0], to:"
                " [0.5, 0.2]}}}\n"
            ),
        }
        for solve in (
            f"explicit: {{time step: {dt}, steps: 4}}",
            f"implicit: {{end time: {4 * dt}, time step: {dt}, local error: 1e9, residual: 1e-11}}",
            f"implicit: {{end time: {4 * dt}, time step: {dt}, local error: 1e9, residual: 1e-11, scheme: HHT}}",
        ):
            found = test.run(
                UNITS
                + "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n"
                "  n: {model: elastic, density: 7, Young modulus: 4e4, Poisson ratio: 0.2}\nbody:\n"
                + "".join(blocks[name] for name in order)
                + "peridynamics: {formulation: ordinary, space: plane strain}\n"
                f"loads:\n  - {{on: {{all: yes}}, tie: {{}}}}\n  - {{on: {{block: c}}, force: [{force}, 0]}}\n"
                f"solve: {{{solve}}}\n" + PERIOD
            )
            for n, value in enumerate(rows(found, "fast")):
                speed = force / sum(masses) * n * dt
                test.near(value, speed, 1e-8, force / sum(masses) * dt, f"velocity after {n} steps, {solve}")


def dashpots_with_damping(test):
    """A column of particles that moves sideways against dashpots and mass damping: a step dt multiplies its velocity by
    (1 - r dt / 2) / (1 + r dt / 2), where r is the sum of both rates."""
    rate, dt, impedance = 80.0, 2e-4, 3.0 * 40.0
    found = test.run(
        UNITS
        + "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\nbody: {b: {material: m, lattice:"
        " square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [1, 5]}}}}\nperidynamics:"
        " {formulation: bond-based, space: plane strain}\nloads:\n  - {on: {all: yes}, initial velocity:"
        " {translation: [1, 0]}}\n  - {on: {face: x+}, dashpots: {density: 3, compression wave speed: 40,"
        f" shear wave speed: 10}}}}\nsolve: {{explicit: {{time step: {dt}, steps: 20, damping: {rate}}}}}\n"
        + PERIOD
    )
    both = rate + impedance / (2.0 * 0.1)
    for n, value in enumerate(rows(found, "fast")):
        test.near(value, ((1 - both * dt / 2) / (1 + both * dt / 2)) ** n, 1e-9, 1, f"velocity after {n} steps")


def reversed_slip(test):
    """A bar in a body under uniform cyclic strain slips by the same amount at both ends, forward at one and backward at
    the other. Reversed slip leaves friction: 0.4 of the peak stress 2.5 sqrt(f_cm) (fib Model Code 2010)."""
    found = test.run(
        UNITS
        + "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n  s: {model:"
        " elastic-1d, density: 7, Young modulus: 2e8}\nbody: {b: {material: m, lattice: square, spacing: 0.1,"
        " thickness: 0.2, shape: {box: {from: [0, 0], to: [1, 0.4]}}}}\nperidynamics: {formulation: ordinary, space:"
        " plane strain}\nbars: {long: {material: s, points: [[0.1, 0.2], [0.9, 0.2]], diameter: 0.02, bond:"
        " {compressive strength: 25 MPa, rib spacing: 8 mm}}}\nloads: [{name: pull, on: {all: yes}, field:"
        " {displacement: ['0.01 * (x - 0.5 m)', 0]}, history: {table: [[0, 0], [2e-3, 1], [6e-3, -1], [10e-3,"
        " 1]]}}]\nsolve: {explicit: {time step: 1e-4, steps: 100}}\n"
        + PERIOD.replace(
            "watch:\n",
            "watch:\n  bar: {bar: long, every: 1}\n  begin: {bar: long, at: [0.1, 0.2], every: 1}\n  end: {bar: long,"
            " at: [0.9, 0.2], every: 1}\n",
        )
    )
    least, largest = rows(found, "bar", "least slip"), rows(found, "bar", "largest slip")
    top = max(largest)
    test.failures.check(top > 2.5e-3, f"{test.name}: the bar slips by {top} m only")
    for n, (low, high) in enumerate(zip(least, largest)):
        test.near(-low, high, 1e-6, top, f"slips of the two ends in step {n}")
    ends = [rows(found, end, "bond stress") for end in ("begin", "end")]
    for n, (one, other) in enumerate(zip(*ends)):
        test.near(-one, other, 1e-6, 12.5e3, f"bond stresses of the two ends in step {n}")
    factor = 0.4 * 12.5e3
    test.near(abs(ends[0][40]), factor, 1e-6, factor, "friction of reversed slip at the start of the bar")
    test.near(abs(ends[1][40]), factor, 1e-6, factor, "friction of reversed slip at the end of the bar")


def strength_of_a_joint(test):
    """A joint of two materials in series breaks when the traction is its strength, in any order of the blocks: in
    equilibrium, where the softer material has more of the strain, and in uniform strain, where of all bonds the ones
    with three quarters of their length in the stiffer material carry most."""
    blocks = [
        (
            "  b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0, 0], to: [0.5,"
            " 0.4]}}}\n"
        ),
        (
            "  c: {material: n, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0.5, 0], to: [1,"
            " 0.4]}}}\n"
        ),
    ]
    strength, traction = 60, 150  # traction at the end of the ramp
    for soft, stiff in ((1e4, 5e4), (5e4, 1e4)):
        even = 60 / (0.01 / (0.75 / max(soft, stiff) + 0.25 / min(soft, stiff)))
        for order in (blocks, blocks[::-1]):
            for name, loads, share in (
                (
                    "equilibrium",
                    [("{block: b}", f"{traction / soft} * (x - 0.5 m)"), ("{block: c}", f"{traction / stiff} * (x - 0.5 m)")],
                    strength / traction,
                ),
                ("uniform strain", [("{all: yes}", "0.01 * x")], even),
            ):
                found = test.run(
                    UNITS
                    + f"materials:\n  m: {{model: elastic, density: 2, Young modulus: {soft}, Poisson ratio: 0}}\n"
                    f"  n: {{model: elastic, density: 6, Young modulus: {stiff}, Poisson ratio: 0}}\nbody:\n"
                    + "".join(order)
                    + "peridynamics: {formulation: hybrid, strain: small, space: plane strain}\nfailure: {criterion:"
                    f" critical bond stress, bond tensile strength: {strength}, near grips: break, no failure within:"
                    f" {{of: {{block: {'c' if stiff > soft else 'b'}}}}}}}\nloads:\n"
                    + "".join(
                        f"  - {{on: {on}, field: {{displacement: ['{field}', 0]}}, history: {{ramp to: 10e-3}}}}\n"
                        for on, field in loads
                    )
                    + "solve: {explicit: {time step: 2e-5, steps: 220}}\n"
                    + PERIOD
                )
                when = found["summary"]["first_broken_bond/time"].rows[0][0]
                words = f"time at which the joint of {soft} and {stiff} breaks in {name}"
                test.near(when, share * 10e-3, 1, 4.1e-5, words)


def tolerances_in_all_units(test):
    """Increments that converge by the energy tolerance take the same iterations in small and in large units."""
    seen = []
    for units in (
        "{length: m, force: kN, time: s}",
        "{length: nm, force: nN, time: s}",
        "{length: km, force: GN, time: s}",
    ):
        found = test.run(
            f"units: {units}\n"
            + "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 1e4 kPa, Poisson ratio: 0.2}}\nbody: {b:"
            " {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {particles: [8,"
            " 4]}}}}\nperidynamics: {space: plane strain}\nloads:\n  - {on: {face: x-, layers: 2}, displacement: [0,"
            " 0]}\n  - {on: {face: x+}, force: [0, 2e-3 kN]}\nsolve: {static: {increments: 2, residual: 0.1, energy"
            " tolerance: 1e-20}}\n"
            + PERIOD
        )
        group = found["moved.csv"]["vector"]
        with open(os.path.join(test.here, "out", "solution.txt")) as file:
            seen.append((group.rows[-1][1] * group.factor, len(re.findall("iteration ", file.read()))))
    for moved, iterations in seen[1:]:
        test.near(moved, seen[0][0], 1e-10, seen[0][0], "displacement in other units")
        test.near(iterations, seen[0][1], 0, 1, "iterations in other units")


def moments_at_present_positions(test):
    """The moment of a prescribed motion of a body that moves far is about the present centre of its particles."""
    for formulation, space, solver in (
        ("ordinary", "strain", "Newton"),
        ("hybrid", "3-D", "explicit"),
        ("bonds", "stress", "Newmark"),
    ):
        deck = test.case(formulation, space, "contrast", solver, "none", "guide", "none", "large", "+")
        found = test.run(test.loop.BASE.deck(deck.text()))
        test.loop.Balance(test.failures, deck, found).reactions()


def restarts_under_strains(test):
    """Elastic bodies under free strains and initial stresses end in the same bits after a restart.

    The factored matrix of an implicit step serves no other step while free strains grow. The last bits of the strain
    across plane stress do not depend on earlier evaluations.
    """
    for levels in (
        ("ordinary", "strain", "contrast", "Newmark", "none", "force", "swelling", "small", "+"),
        ("small strain", "stress", "one", "Newmark", "mass", "shake", "prestress", "large", "-"),
        ("correspondence", "stress", "fine", "Newmark", "stiffness", "set", "prestress", "small", "+"),
        ("micropolar", "strain", "one", "explicit", "stiffness", "force", "none", "small", "+"),
    ):
        deck = test.case(*levels)
        test.loop.restart(test.options, test.failures, deck, test.base(deck))


def results_in_all_units(test):
    """Histories at the middle of a bar, and results after bonds have broken, are equal in all units and axes.

    The middle of a bar lies between two of its elements, of which the first one has the history. The share of its
    stress that a family carries after bonds have broken does not depend on units beyond round-off.
    """
    for levels in (
        ("mixed", "stress", "fine", "Newton", "none", "pull", "slip", "small", "-"),
        ("mixed", "strain", "fine", "stages", "both", "shake", "breaking", "small", "-"),
    ):
        deck = test.case(*levels)
        folder = test.base(deck)
        found = test.loop.results_of(test.options, os.path.join(folder, "base"))
        test.loop.restate(test.options, test.failures, deck, folder, found, random.Random(1))


def blocks_under_traps(test):
    """SIMD lanes without a bond raise no floating-point trap in bonds between two blocks."""
    deck = test.case("bonds", "strain", "contrast", "Newton", "none", "pull", "none", "small", "+")
    if test.options.traps:
        test.run(test.loop.BASE.deck(deck.text()), "--trap")


def spin_at_present_positions(test):
    """An initial velocity of a later stage turns particles about an axis at their present positions."""
    found = test.run(
        UNITS + "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [6, 4]}}}}\n"
        "peridynamics: {formulation: ordinary, space: plane strain}\n"
        "loads: [{name: stretch, on: {all: yes}, field: {displacement: ['0.5 * x', '-0.2 * y']}}]\n"
        "solve:\n  - {static: {increments: 1}}\n"
        "  - {explicit: {time step: 1e-9, steps: 1}, without: [stretch], loads: [{on: {all: yes}, initial velocity: "
        "{rotation: [0, 0, 3], about: [0, 0]}}]}\n"
        + PERIOD.replace("watch:\n", "watch:\n  corner: {velocity of: {nearest: [10, 10]}, every: 1}\n")
    )
    x, y = max(found["fields"]["Points"].rows)[:2]
    test.near(rows(found, "corner")[-1], -3 * 0.8 * y, 1e-3, 1, "velocity along x of the corner")
    test.near(rows(found, "corner", k=1)[-1], 3 * 1.5 * x, 1e-3, 1, "velocity along y of the corner")


def breaking_under_free_strain(test):
    """Bonds of a body with a free strain break at the sum of this strain and the critical stretch, even where this sum
    is negative, so that the bonds are shorter than at first."""
    for free, stretch, begin in ((0.005, 0.004, 0), (-0.002, 0.008, 0), (-0.008, 0.004, -0.4)):
        found = test.run(
            UNITS + "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
            "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, "
            "shape: {box: {particles: [6, 4]}}}}\n"
            "peridynamics: {formulation: ordinary, space: plane stress}\n"
            f"failure: {{critical stretch: {stretch}, near grips: break}}\nloads:\n"
            f"  - {{on: {{all: yes}}, initial strain: {free}}}\n"
            "  - {on: {all: yes}, field: {displacement: ['0.02 * x', '0.02 * y']}, "
            f"history: {{table: [[0, {begin}], [10e-3, {begin + 1}]]}}}}\n"
            "solve: {explicit: {time step: 2e-5, steps: 300}}\n" + PERIOD
        )
        when = found["summary"]["first_broken_bond/time"].rows[0][0]
        due = (free + stretch) / 2 - 0.01 * begin
        test.near(when, due, 1, 4.1e-5, f"time at which bonds with a free strain of {free} break")


def stiffness_damping_of_rigid_motion(test):
    """Damping in proportion to stiffness dissipates nothing in a rigid body: a rigid body on a spring, under any other
    damping too, moves as without stiffness damping."""
    for damping, extra in (
        ("local damping: 0.3", ""),
        ("damping: 60, local damping: 0.3", ""),
        ("damping: 60", ""),
        ("damping: 60", ", local error: 1e9, residual: 1e-12"),
        ("damping: 60, scheme: HHT", ", local error: 1e9, residual: 1e-12"),
    ):
        seen = []
        solver = "implicit: {end time: 4e-3, time step: 2e-4" if extra else "explicit: {time step: 2e-4, steps: 20"
        for stiffness in ("", ", stiffness damping: 1e-4"):
            found = test.run(
                UNITS + "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, "
                "shape: {box: {particles: [3, 2]}}}}\n"
                "peridynamics: {formulation: ordinary, space: plane strain}\n"
                "loads:\n  - {on: {all: yes}, tie: {}}\n  - {on: {all: yes}, spring: {stiffness: 300}}\n"
                "  - {on: {all: yes}, initial velocity: {translation: [1, 0.3]}}\n"
                f"solve: {{{solver}, {damping}{stiffness}{extra}}}}}\n" + PERIOD
            )
            seen.append(rows(found, "fast"))
        test.failures.check(len(seen[0]) == 21 and seen[0][-1] < 0.97, f"{test.name}: {damping} does nothing")
        for n, (plain, damped) in enumerate(zip(*seen)):
            test.near(damped, plain, 1e-8, 1, f"velocity after {n} steps with {damping}")


def loads_divided_by_blocks(test):
    """A load on a face of two blocks of unlike materials acts as one load on the face of each block."""
    bodies = (
        "  b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, "
        "shape: {box: {from: [0, 0], to: [0.4, 0.3]}}}\n"
        "  c: {material: n, lattice: square, spacing: 0.1, thickness: 0.2, "
        "shape: {box: {from: [0, 0.3], to: [0.4, 0.6]}}}\n"
    )
    faces = ("block: b, face: x+", "block: c, face: x+")
    for load in (
        "dashpots: {}",
        "dashpots: {outcrop velocity: [0.2, 0.1]}",
        "pressure: 3",
        "traction: [2, 1]",
        "water pressure: {surface: 0.7}",
    ):
        seen = []
        for parts in (("face: x+",), faces, faces[::-1]):
            found = test.run(
                UNITS + "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n"
                "  n: {model: elastic, density: 6, Young modulus: 5e4, Poisson ratio: 0.1}\nbody:\n"
                + bodies
                + "peridynamics: {formulation: ordinary, space: plane strain}\nloads:\n  - {on: {all: yes}, initial"
                " velocity: {translation: [1, 0.4]}}\n"
                + "".join(f"  - {{on: {{{part}}}, {load}}}\n" for part in parts)
                + "solve: {explicit: {time step: 2e-4, steps: 20}}\n"
                + PERIOD
            )
            seen.append([(a, b) for a, b in zip(rows(found, "fast"), rows(found, "fast", k=1))])
        gained = max(abs(row[0] - 1) for row in seen[0])
        test.failures.check(gained > 1e-3, f"{test.name}: {load} changes the velocity by {gained} only")
        for other in seen[1:]:
            for n, (whole, divided) in enumerate(zip(seen[0], other)):
                for k in range(2):
                    test.near(divided[k], whole[k], 1e-9, 1, f"velocity along {'xy'[k]} after {n} steps, {load}")


FORMS = (
    implicit_steps_with_damping,
    ties_of_two_densities,
    a_force_on_tied_bodies,
    dashpots_with_damping,
    reversed_slip,
    strength_of_a_joint,
    tolerances_in_all_units,
    moments_at_present_positions,
    restarts_under_strains,
    results_in_all_units,
    blocks_under_traps,
    spin_at_present_positions,
    breaking_under_free_strain,
    stiffness_damping_of_rigid_motion,
    loads_divided_by_blocks,
)
