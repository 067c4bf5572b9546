"""Laws in an unmodified OpenSees: the same as ours, the same alone and in company, and its refusals in words.

test_opensees.py BRECCIA WORK_FOLDER, with breccia-opensees beside BRECCIA, and build/test/tests/compare_results
"""

import json
import os
import random
import socket
import struct
import subprocess
import sys
import zlib

BRECCIA, WORK = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
SERVER = os.path.join(os.path.dirname(BRECCIA), "breccia-opensees")
HEADER = struct.Struct("<4sHHIIIIII")
failures = 0

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
EXAMPLES = os.path.join(ROOT, "examples")
COMPARE = os.path.join(os.path.dirname(BRECCIA), "compare_results")
sys.path.insert(0, os.path.join(ROOT, "servers"))
from opensees_server import TRIED  # noqa: E402  ten laws in space that soil, rock and concrete are computed with, and three along bonds

LAWS = {command.split()[1]: command for command, _, _ in TRIED}
STAGES = {command.split()[1]: stage for command, _, stage in TRIED if stage is not None}


def check(what, good, more=""):
    global failures
    if not good:
        failures += 1
        print(f"FAIL: {what} {more}")


class Client:
    """A server of its own, the Python one at a path or, without one, the Tcl one at a port, and a line to it."""

    def __init__(self, path=None, options=()):
        self.path = path
        words = [SERVER, "--listen", f"unix:{path}"] if path else [SERVER + "-tcl", "--listen", "tcp://127.0.0.1:0"]
        self.process = subprocess.Popen([*words, *options], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().split()[-1]
        self.number = self.session = 0
        self.line = self.connect()
        if not options:
            self.ask(1, b"client: test\n")

    def connect(self):
        if self.path:
            line = socket.socket(socket.AF_UNIX)
            line.connect(self.path)
            return line
        return socket.create_connection(("127.0.0.1", int(self.address.rpartition(":")[2])))

    def ask(self, operation, body=b"", count=0, flags=0):
        self.number += 1
        head = HEADER.pack(b"BRMS", 1, operation, self.number, flags, count, len(body), self.session, 0)[:28]
        self.line.sendall(head + struct.pack("<I", zlib.crc32(body, zlib.crc32(head))) + body)
        head = self.line.recv(32, socket.MSG_WAITALL)
        if len(head) < 32:
            sys.exit(f"the server has ended at operation {operation}: {body[:200]}")
        header = HEADER.unpack(head)
        reply = self.line.recv(header[6], socket.MSG_WAITALL) if header[6] else b""
        if header[2] == 127:
            raise RuntimeError(reply.decode())
        return header, reply

    def create(self, name, points):
        text = f"command: {LAWS[name]}\n" + (f"stage: {STAGES[name]}\n" if name in STAGES else "")
        header, reply = self.ask(3, text.encode(), count=points)
        self.session = header[7]
        self.iterates = b"iterates: 1\n" in reply
        return 1 if b"components: 1\n" in reply else 6

    def trial(self, strains, components, first=0, flags=0):
        """Stresses, and after them the tangents if flag 2 wants them."""
        count = len(strains) // components
        body = struct.pack(f"<II{len(strains)}d", first, 0, *strains)
        answer = self.ask(5, body, count=count, flags=flags)[1]
        return struct.unpack(f"<{len(answer) // 8}d", answer)

    def end(self):
        self.line.close()
        self.process.terminate()
        self.process.wait()


def path_of(point, components, steps):
    """A path of strains of its own for each point: proportional, with one reversal."""
    chance = random.Random(point)
    direction = [chance.uniform(-1, 1) for _ in range(components)]
    size = 1e-4 if components == 6 else 3e-3
    if components == 6:
        direction = [d - 0.4 * (k < 3) for k, d in enumerate(direction)]
    turn = chance.randint(2, steps - 1)
    for step in range(1, steps + 1):
        along = size * (step if step <= turn else 2 * turn - step) / steps
        yield [along * d for d in direction]


def laws_do_not_hang_on_their_company(client, laws):
    """OpenSees classes share static memory: a thousand points side by side must answer as each would alone."""
    points, steps = 1000, 6
    for name in laws:
        try:
            components = client.create(name, points)
        except RuntimeError as problem:
            check(f"{name} is served", False, str(problem))
            continue
        paths = [list(path_of(point, components, steps)) for point in range(points)]
        together = []
        for step in range(steps):
            strains = [value for path in paths for value in path[step]]
            together.append(client.trial(strains, components, flags=1 if step else 0))  # commits with the next trial
        for point in random.Random(1).sample(range(points), 12):
            client.create(name, 1)
            for step in range(steps):
                alone = client.trial(paths[point][step], components)
                client.ask(6)
                seen = together[step][components * point : components * (point + 1)]
                if alone != seen:
                    check(f"{name}: point {point} alone and in company", False, f"in step {step}: {alone} {seen}")
                    break
        check(f"{name} answers", any(together[-1]))


def trials_are_repeatable(client, name, strain):
    """A trial begins at the committed state, in one that is not the first too; tangents are those of the stresses."""
    components = client.create(name, 3)
    check(f"{name}: the server says that it iterates", client.iterates)
    client.trial([0.7 * value for value in strain] * 3, components)
    strains = strain * 3
    first = client.trial(strains, components, flags=1)
    client.trial([5 * value for value in strains], components)
    again = client.trial(strains, components, flags=2)
    check(f"{name}: a trial begins at the committed state", again[: len(first)] == first)
    small = 1e-7
    moved = client.trial([value + small * (k % components == 0) for k, value in enumerate(strains)], components)
    row, change = again[len(first)], (moved[0] - first[0]) / small
    check(f"{name}: the tangent is the slope", abs(row - change) < 1e-2 * abs(change), f"{row} {change}")


def partial_trials_keep_the_state_of_the_others(client, name, strain):
    """A commit leaves points that had no trial, or whose trial was forgotten, as they were."""
    components, half = client.create(name, 1), [0.5 * value for value in strain]
    client.trial(strain, components)
    client.ask(6)
    alone = client.trial(half, components)
    client.create(name, 2)
    client.trial(strain, components)
    client.ask(6)
    client.trial([-value for value in strain], components)
    client.ask(7)
    client.trial(half, components, first=1)
    client.ask(6)
    check(f"{name}: a commit of another point", client.trial(half, components) == alone)


def a_client_at_a_time(client):
    second = client.connect()
    head = HEADER.pack(b"BRMS", 1, 1, 77, 0, 0, 0, 0, 0)[:28]
    second.sendall(head + struct.pack("<I", zlib.crc32(head)))
    answer = second.recv(4096)
    check("a second client is told", b"busy with another client" in answer and HEADER.unpack(answer[:32])[3] == 77, repr(answer))
    second.close()
    client.ask(10)


def secrets_guard(path):
    with open(f"{WORK}/a secret", "w", encoding="utf-8") as file:
        file.write("plagioclase\n")
    client = Client(path, ("--secret-file", f"{WORK}/a secret"))
    for words, good in ((b"", False), (b"secret: plagioclas\n", False), (b"secret: plagioclase\n", True)):
        try:
            client.ask(1, words)
            check("the secret is asked for", good)
        except RuntimeError as problem:
            check("a wrong secret is told", not good and "the secret is wrong" in str(problem), str(problem))
            client.line = client.connect()
    client.end()


def decks_agree(tcl):
    """A small plate with its law inside the program and in OpenSees; laws along bonds also in that of Tcl."""
    deck = """units: {{length: m, force: kN, time: s}}
materials: {{clay: {{{material}, density: 1.5}}}}
body:
  plate: {{material: clay, lattice: cubic, spacing: 0.03, shape: {{box: {{particles: [20, 18, 2], first particle: [0, 0, 0]}}}}}}
cracks: [{{remove: {{box: {{from: [0.285, -0.015, -0.015], to: [0.315, 0.2, 0.045]}}}}, cut faces: yes}}]
peridynamics: {{{formulation}, horizon: 3.015 spacings}}
loads:
  - {{on: {{face: x-, layers: 3}}, body force: [{left}, 0, 0], history: {{ramp to: 0.001}}}}
  - {{on: {{face: x+, layers: 3}}, body force: [{right}, 0, 0], history: {{ramp to: 0.001}}}}
solve: {{explicit: {{{stepping}}}}}
results: {{number: 2, precision: double}}
"""
    space = "formulation: correspondence, zero-energy control: {silling: 0.1}"
    pairs = {
        "clay": (
            "model: multi-yield-j2, shear modulus: 6e4, bulk modulus: 1e5, octahedral strength: 30",
            f"opensees: {LAWS['PressureIndependMultiYield']}, stage: 1",
            space,
            900,
            "time step: 4e-6, steps: 500",
        ),
        "elastic": (
            "model: elastic, Young modulus: 1.5e5, Poisson ratio: 0.25",
            f"opensees: {LAWS['ElasticIsotropic3D']}",
            space,
            5000,
            "time step: 4e-6, steps: 500",
        ),
        "bonds": (
            "model: kent-scott-park, compressive strength: 30e3, peak strain: 0.002, residual strength: 6e3, crushing strain: 0.006",
            "opensees: uniaxialMaterial Concrete01 $tag -30e3 -0.002 -6e3 -0.006",
            "formulation: bond-based",
            -300000,
            "time step: 5e-6, steps: 100",
        ),
    }
    for name, (home, away, formulation, force, stepping) in pairs.items():
        places = {"home": home, "away": away}
        if "uniaxialMaterial" in away:
            tcl.line.close()
            places["tcl"] = f"{away}, server: ['{tcl.address}']"
        for place, material in places.items():
            with open(f"{WORK}/{name}-{place}.yaml", "w", encoding="utf-8") as file:
                file.write(deck.format(material=material, formulation=formulation, left=-force, right=force, stepping=stepping))
            run = subprocess.run([BRECCIA, "run", f"{WORK}/{name}-{place}.yaml"], capture_output=True, text=True, timeout=1800)
            check(f"{name} {place} runs", run.returncode == 0, run.stderr)
        for place in list(places)[1:]:
            files = [f"{WORK}/{name}-{where}/results.vtkhdf" for where in ("home", place)]
            result = subprocess.run([COMPARE, *files, "1e-8", "displacement", "stress"], capture_output=True, text=True)
            check(f"{name}: inside the program and {place}", result.returncode == 0, result.stdout)


def hybrid_bodies_agree():
    """A small notched plate of hybrid bonds, pulled beyond yield in motion and at rest, its law inside the program and in OpenSees."""
    deck = """units: {{length: m, force: kN, time: s}}
materials: {{m: {{{material}, density: 1.5}}}}
body: {{plate: {{material: m, lattice: cubic, spacing: 0.03, shape: {{box: {{particles: [12, 8, 2], first particle: [0, 0, 0]}}}}}}}}
cracks: [{{remove: {{box: {{from: [0.165, -0.015, -0.015], to: [0.195, 0.07, 0.045]}}}}, cut faces: yes}}]
peridynamics: {{formulation: hybrid, horizon: 1.5 spacings}}
loads:
  - {{on: {{face: x-, layers: 2}}, displacement: [0, 0, 0]}}
  - {{on: {{face: x+, layers: 2}}, displacement: [{pull}, 0, 0], history: {{ramp to: {time}}}}}
solve: {solve}
watch: {{energy: {{energy: yes}}}}
results: {{number: 2, precision: double}}
pictures: []
"""
    pairs = {
        "j2": (
            "model: j2, bulk modulus: 1e5, shear modulus: 6e4, yield stress: 100, hardening modulus: 500",
            "opensees: nDMaterial J2Plasticity $tag 1e5 6e4 100. 100. 0. 500.",
            2e-3,
        ),
        "clay": (
            "model: multi-yield-j2, shear modulus: 6e4, bulk modulus: 1e5, octahedral strength: 30",
            f"opensees: {LAWS['PressureIndependMultiYield']}, stage: 1",
            2e-3,
        ),
        "steel": (
            "model: steel-bilinear, Young modulus: 150e3, yield stress: 1500, hardening ratio: 0.01",
            "opensees: uniaxialMaterial Steel01 $tag 1500. 150e3 0.01",
            6e-3,
        ),
    }
    # At rest both come to equilibrium within a residual. Clay there takes increments as small as those of OpenSees, which cuts larger ones; the Python
    # package cannot take a trial along a bond back.
    ways = {"explicit": ("{explicit: {end time: 0.02}}", 0.02, "1e-8"), "static": ("{static: {increments: 4}}", 1, "1e-6")}
    for name, (home, away, pull) in pairs.items():
        for way in ways if name == "j2" else ("explicit",):
            solve, time, tolerance = ways[way]
            for place, material in {"home": home, "away": away}.items():
                with open(f"{WORK}/hybrid-{name}-{way}-{place}.yaml", "w", encoding="utf-8") as file:
                    file.write(deck.format(material=material, pull=pull, time=time, solve=solve))
                run = subprocess.run([BRECCIA, "run", f"{WORK}/hybrid-{name}-{way}-{place}.yaml"], capture_output=True, text=True, timeout=1800)
                check(f"hybrid {name} {way} {place} runs", run.returncode == 0, run.stderr)
            folders = [f"{WORK}/hybrid-{name}-{way}-{place}" for place in ("home", "away")]
            result = subprocess.run([COMPARE, *(f"{folder}/results.vtkhdf" for folder in folders), tolerance, "displacement", "stress"], capture_output=True, text=True)
            check(f"hybrid {name} {way}: inside the program and in OpenSees", result.returncode == 0, result.stdout)
            works = []
            for folder in folders:
                with open(f"{folder}/summary.json", encoding="utf-8") as file:
                    works.append(json.load(file)["energy"])
            for key in ("internal", "external"):
                one, other = (work[key] for work in works)
                check(f"hybrid {name} {way}: {key} energy", one > 0 and abs(one - other) < 1e-6 * one, f"{one} {other}")
            check(f"hybrid {name} yields", works[0]["dissipated"] > 0.2 * works[0]["external"], str(works[0]))


def bars_agree(tcl):
    """Bars whose steel is that of OpenSees: in motion by the Python package; at rest, in perfect bond and slipping, by that of Tcl, which takes trials back."""
    deck = """units: {{length: m, force: kN, time: s}}
materials: {{soft: {{model: elastic-1d, density: 2, Young modulus: 1e5}}, steel: {{{material}, density: 7}}}}
body: {{b: {{material: soft, spacing: 0.1, shape: {{box: {{from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}}}}}
peridynamics: {{formulation: bond-based, horizon: 2.015 spacings}}
bars: {{bar: {{points: [[0.02, 0.14, 0.21], [1.18, 0.14, 0.21]], area: 1e-4, material: steel{bond}}}}}
loads:
  - {{on: {{face: x-, layers: 3}}, displacement: [0, 0, 0]}}
  - {{on: {{face: x+, layers: 3}}, displacement: [12 mm, 0, 0], history: {{table: [[0, 0], [0.1, 1], [0.2, -0.2]]}}}}
solve: {solve}
results: {{number: 2, precision: double}}
pictures: []
"""
    laws = {
        "bilinear": ("model: steel-bilinear, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01", "opensees: uniaxialMaterial Steel01 $tag 5e5 2e8 0.01"),
        "rounded": ("model: menegotto-pinto, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01, roundness: 18", "opensees: uniaxialMaterial Steel02 $tag 5e5 2e8 0.01 18. 0.925 0.15"),
    }
    bond = ", bond: {compressive strength: 30 MPa, rib spacing: 8 mm}"
    for law, (home, away) in laws.items():
        for way, keys, solve in (("motion", "", "{explicit: {end time: 0.2, damping: 20 1/s}}"), ("rest", "", "{static: {increments: 8, end time: 0.2}}"), ("slip", bond, "{static: {increments: 8, end time: 0.2}}")):
            there = away if way == "motion" else f"{away}, server: ['{tcl.address}']"
            folders, stresses = [], []
            for place, material in {"home": home, "away": there}.items():
                folders.append(f"{WORK}/bars-{law}-{way}-{place}")
                with open(f"{folders[-1]}.yaml", "w", encoding="utf-8") as file:
                    file.write(deck.format(material=material, bond=keys, solve=solve))
                run = run_when_free(f"{folders[-1]}.yaml")
                check(f"bars {law} {way} {place} run", run.returncode == 0, run.stderr)
                with open(f"{folders[-1]}/summary.json", encoding="utf-8") as file:
                    stresses.append(json.load(file)["bars"][0]["stress_so_far"])
            check(f"bars {law} {way} yield both ways", stresses[0][1] > 5e5 and (way == "slip" or stresses[0][0] < -4e5), str(stresses))
            same = subprocess.run([COMPARE, *(f"{folder}/results.vtkhdf" for folder in folders), "1e-7", "displacement", "stress"], capture_output=True, text=True)
            check(f"bars {law} {way}: inside the program and in OpenSees", same.returncode == 0, same.stdout)
    for keys, solve, words in ((bond, "{explicit: {end time: 0.2}}", "bond: slips are found by trying strains several times"), ("", "{static: {increments: 8}}", "static: it tries strains several times")):
        with open(f"{WORK}/bars-refused.yaml", "w", encoding="utf-8") as file:
            file.write(deck.format(material=away, bond=keys, solve=solve))
        run = subprocess.run([BRECCIA, "run", f"{WORK}/bars-refused.yaml"], capture_output=True, text=True, timeout=1800)
        check("what cannot take a trial back is refused", run.returncode == 2 and words in run.stderr and run.stderr.count("\n") == 1, run.stderr)


def the_plate_agrees():
    """The plate of clay of the examples, all 8910 particles, 500 steps of it."""
    for name in ("clay", "clay-opensees"):
        with open(os.path.join(EXAMPLES, "plate-with-crack", f"{name}.yaml"), encoding="utf-8") as file:
            text = file.read().replace("steps: 23000", "steps: 500").replace("results: {", "results: {precision: double, ")
        with open(f"{WORK}/plate-{name}.yaml", "w", encoding="utf-8") as file:
            file.write(text)
        run = subprocess.run([BRECCIA, "run", f"{WORK}/plate-{name}.yaml"], capture_output=True, text=True, timeout=1800)
        check(f"plate of {name} runs", run.returncode == 0 and "step 500 of 500" in run.stdout, run.stdout + run.stderr)
    files = [f"{WORK}/plate-{name}/results.vtkhdf" for name in ("clay", "clay-opensees")]
    result = subprocess.run([COMPARE, *files, "1e-8", "displacement"], capture_output=True, text=True)
    check("the plate inside the program and in OpenSees", result.returncode == 0, result.stdout)


def refusals_are_told(client):
    for command, words in {
        f"nDMaterial {WORK}/evil $tag 1": "a command is",
        "nDMaterial Nonsense $tag 1": "material type Nonsense is unknown",
        "nDMaterial ElasticIsotropic3D $tag": "ElasticIsotropic3D",
        "nDMaterial PM4Sand $tag 0.5 500. 0.5 1.7": "knows plane strain only",
        "nDMaterial ElasticIsotropic3D 7 1. 0.": "a command is",
        LAWS["PressureIndependMultiYield"]: "PressureIndependMultiYield stays elastic until its stage is set: give 'stage: 1'",
        "nDMaterial FluidSolidPorous $tag 3 1 2.2e6": "is made of another material by its tag",
        "__import__('os') x $tag": "a command is",
        "nDMaterial ElasticIsotropic3D $tag 1. 0.\nstage: plastic": "a stage is 0 (elastic) or 1 (plastic)",
        "nDMaterial ElasticIsotropic3D $tag 1. 0.\nstage: 1": "ElasticIsotropic3D has no stages",
        "uniaxialMaterial Steel01 $tag $length 2e5 0.01\nlength: long": "asks for $length",
    }.items():
        refusal_is_told(client, command, words)


def refusals_of_tcl_are_told(client):
    for command, words in {
        "uniaxialMaterial Nonsense $tag 1": "Could not create uniaxialMaterial Nonsense",
        "uniaxialMaterial Steel01 $tag": "it said:",
        "uniaxialMaterial Steel01 $tag 400. 2e5 [exit]": "invalid b.",
        "uniaxialMaterial Steel01 $tag 400. 2e5 $length": "asks for $length",
        "uniaxialMaterial ../evil $tag 1": "a command is",
        "nDMaterial ElasticIsotropic3D $tag 1. 0.": "offers no way to drive",
        "exec touch x": "a command is",
    }.items():
        refusal_is_told(client, command, words)


def staged_materials_yield(client):
    """At 5 % of shear no stress is beyond the strength, which a material that stayed elastic would exceed twenty times."""
    for name, command in {
        "PressureIndependMultiYield": LAWS["PressureIndependMultiYield"],
        "PressureDependMultiYield03": "nDMaterial PressureDependMultiYield03 $tag 3 1.7 6e4 1.3e5 33. 0.1 101. 0.5 26. 0.03 3. 0.2 0. 0. 0.15 3. 0. 20",
        "SAniSandMS": "nDMaterial SAniSandMS $tag 110. 0.05 0.7 1.27 0.712 0.049 0.845 0.27 101.3 0.01 5.95 1.01 2. 1.06 1.17 0.0005 260. 1. 1.6",
        "MultiYieldSurfaceClay": "nDMaterial MultiYieldSurfaceClay $tag 3 1.5 6e4 1e5 37. 0.1 0. 100. 0. 20",
    }.items():
        stage = "stage: 1\n" if name.startswith("Pressure") else ""
        header, _ = client.ask(3, f"command: {command}\n{stage}".encode(), count=1)
        client.session = header[7]
        for step in range(1, 51):
            pressed = 0 if "Clay" in name or "Indep" in name else -1e-3
            stress = client.trial([pressed] * 3 + [step * 1e-3, 0, 0], 6, flags=int(step > 1))
        pressure = -sum(stress[:3]) / 3
        check(f"{name} yields", abs(stress[3]) < 60 + 1.5 * pressure, f"{stress}")


def refusal_is_told(client, command, words):
    try:
        client.ask(3, f"command: {command}\n".encode(), count=1)
        check(f"'{command}' is refused", False)
    except RuntimeError as problem:
        check(f"'{command}' is refused in words", words in str(problem), str(problem))


def runs_tell_what_opensees_said():
    """A command that OpenSees refuses, and one that makes it end its process."""
    with open(f"{WORK}/clay-away.yaml", encoding="utf-8") as file:
        text = file.read()
    for command, words in {
        "nDMaterial PressureIndependMultiYield $tag 3 1.5, stage: 1": "it said: WARNING insufficient arguments",
        "nDMaterial TruncatedDP $tag 1 1.5 1.0e5 6.0e4 50. 0.2": "its last words:",
    }.items():
        with open(f"{WORK}/refused.yaml", "w", encoding="utf-8") as file:
            file.write(text.replace(LAWS["PressureIndependMultiYield"] + ", stage: 1", command))
        run = subprocess.run([BRECCIA, "run", f"{WORK}/refused.yaml"], capture_output=True, text=True, timeout=1800)
        check(f"'{command}'", run.returncode == 2 and words in run.stderr and run.stderr.count("\n") == 1, run.stderr)


def offers_are_told():
    """What `breccia models --opensees` lists: every law that is served here, with its moduli, and kinds that OpenSees knows."""
    run = subprocess.run([BRECCIA, "models", "--opensees"], capture_output=True, text=True, timeout=1800)
    check("laws are listed", run.returncode == 0, run.stderr)
    head, _, kinds = run.stdout.partition("Kinds of nDMaterial")
    for name, command in LAWS.items():
        check(f"{name} is among the commands to begin with", f"  {command}\n" in head)
        check(f"{name} is among the kinds", name in kinds.split())
    check("all of them are made", head.count("modul") == len(LAWS), head)
    check("moduli are those of the command", "moduli: bulk 1.448e+10 Pa, shear 1.172e+10 Pa" in head and "Young modulus 3e+04 MPa" in head, head)
    check("others are listed", {"Simplified3DJ2", "ElasticPP", "Hysteretic", "Masonry"} <= set(kinds.split()))
    check("nothing else is", not {"PlaneStress", "PM4Sand", "Nonsense", "Domain", "Concrete"} & set(kinds.split()))


def material(name, text):
    """`breccia material` of a file: status, rows, words."""
    with open(f"{WORK}/{name}.yaml", "w", encoding="utf-8") as file:
        file.write("units: {length: m, force: kN, time: s}\n" + text)
    run = subprocess.run([BRECCIA, "material", f"{WORK}/{name}.yaml"], capture_output=True, text=True, timeout=1800)
    rows = [[float(word) for word in line.split(",")] for line in run.stdout.splitlines()[1:]]
    return run.returncode, rows, run.stderr


def the_laboratory_agrees():
    """One point through laboratory tests, its stresses prescribed in part: Newton's method with tangents of OpenSees."""
    cap = """material: {{{model}, density: 2.4 t/m3}}\n{test}\n"""
    home = (
        "model: cap, shear modulus: 11721092, bulk modulus: 14478996, cap position: 110320, compaction rate: 4.6412e-7, largest compaction: 0.42,"
        "cap ratio: 4.43, envelope drop: 7997.9, envelope slope: 0.11, envelope rate: 6.3816e-5, envelope strength: 26614, tension cut-off: 2068.4"
    )
    away = "opensees: nDMaterial CapPlasticity $tag 3 2400. 1.1721092e10 1.4478996e10, stress unit: Pa"
    test = "test: {kind: triaxial, strain: -0.02, return strain: 0.0, cycles: 1, confining pressure: 5000}"
    curves = [material(name, cap.format(model=model, test=test)) for name, model in (("cap-home", home), ("cap-away", away))]
    rows = [rows for _, rows, _ in curves]
    top = max(abs(row[6]) for row in rows[0])
    check("laboratory runs", [status for status, _, _ in curves] == [0, 0], str([words for _, _, words in curves]))
    most = max(abs(a - b) for one, two in zip(*rows) for a, b in zip(one[6:], two[6:]))
    check("laboratory: the same stresses", len(rows[0]) == len(rows[1]) == 401 and top > 3e4 and most < 1e-7 * top, f"{most} of {top}")
    status, rows, words = material("isotropic", cap.format(model=away, test="test: {kind: isotropic, strain: -0.01}"))
    check("no number is told", status == 1 and "returned a stress that is not a number" in words and len(rows) > 5, words)
    bond = "material: {opensees: uniaxialMaterial Concrete02 $tag -30e3 -0.002 -6e3 -0.006 0.1 3e3 3e6, density: 2.4}\n"
    home = "material: {model: concrete02, compressive strength: 30e3, peak strain: 0.002, residual strength: 6e3, crushing strain: 0.006, unloading ratio: 0.1, tensile strength: 3e3, tension softening: 3e6, density: 2.4}\n"
    test = "test: {kind: uniaxial, strain: -0.004, return strain: 0.001, cycles: 2}\n"
    curves = [material("bond-home", home + test), material("bond-away", bond + test)]
    check("laboratory along a bond", [status for status, _, _ in curves] == [0, 0], str([words for _, _, words in curves]))
    check("the same stresses", all(abs(a[1] - b[1]) < 1e-8 * 3e4 for a, b in zip(curves[0][1], curves[1][1])) and len(curves[1][1]) == 801)
    status, _, words = material("bond-stress", bond + "stages: [{stress xx: -100}]\n")
    check("what cannot iterate is refused", status == 2 and "its server cannot repeat a trial" in words, words)


def chance_does_no_harm(path):
    """Random frames and bytes: the server answers in frames or closes the line, and serves the next client."""
    chance = random.Random(3)
    client = Client(path)
    client.line.close()
    for n in range(150):
        line = client.connect()
        line.settimeout(300)
        body = bytes(chance.randrange(256) for _ in range(chance.randrange(80)))
        if n % 3:
            texts = [b"command: uniaxialMaterial Elastic $tag 1.\n", b"command: nDMaterial ElasticIsotropic3D $tag 1. 0.2\n", b"client: x\n", b"command: " + body, body]
            for number in range(1, 6):
                body = chance.choice(texts)
                head = HEADER.pack(
                    b"BRMS", chance.choice((1, 1, 1, 2)), chance.randrange(13), number, chance.randrange(4), chance.choice((0, 1, 3, 2**32 - 1)), len(body), 0, 0
                )[:28]
                try:
                    line.sendall(head + struct.pack("<I", zlib.crc32(body, zlib.crc32(head))) + body)
                    if not line.recv(65536):
                        break
                except (BrokenPipeError, ConnectionResetError):
                    break
        else:
            line.sendall(body)
        line.close()
        check("the server still runs", client.process.poll() is None)
    client.line = client.connect()
    client.ask(1, b"")
    client.create("Steel01", 1)
    check("and serves", client.trial([1e-4], 1) == (20.0,))
    client.end()


def run_when_free(deck, *options):
    """Runs a deck, again while its server has not yet seen that the client before has left."""
    while True:
        run = subprocess.run([BRECCIA, "run", deck, *options], capture_output=True, text=True, timeout=1800)
        if "busy with another client" not in run.stderr:
            return run


def a_server_keeps_its_points():
    """A run that was stopped goes on with the server that still holds its points, and only with that."""
    path = f"{WORK}/keeps"
    client = Client(path)
    client.line.close()
    with open(f"{WORK}/clay-away.yaml", encoding="utf-8") as file:
        text = file.read().replace("stage: 1", f"stage: 1, server: ['unix:{path}']")
    deck = f"{WORK}/kept.yaml"
    with open(deck, "w", encoding="utf-8") as file:
        file.write(text)
    run = run_when_free(deck, "--steps", "200")
    check("first part runs", run.returncode == 0, run.stderr)
    run = subprocess.run([BRECCIA, "run", deck, "--restart"], capture_output=True, text=True, timeout=1800)
    check("the run is taken up", run.returncode == 0, run.stderr)
    same = subprocess.run([COMPARE, f"{WORK}/clay-away/results.vtkhdf", f"{WORK}/kept/results.vtkhdf"], capture_output=True, text=True, timeout=1800)
    check("to the same bits", same.returncode == 0, same.stdout)
    subprocess.run([BRECCIA, "run", deck, "--steps", "100"], capture_output=True, text=True, timeout=1800)
    client.process.terminate()
    client.process.wait()
    client = Client(path)
    client.line.close()
    run = run_when_free(deck, "--restart")
    check("a fresh server is told of", run.returncode == 2 and "it cannot restore them" in run.stderr, run.stderr)
    client.process.terminate()
    client.process.wait()


def main():
    client = Client(f"{WORK}/socket")
    laws_do_not_hang_on_their_company(client, LAWS)
    trials_are_repeatable(client, "J2Plasticity", [2e-3, -1e-3, -1e-3, 1e-3, 0, 0])
    partial_trials_keep_the_state_of_the_others(client, "J2Plasticity", [2e-3, -1e-3, -1e-3, 1e-3, 0, 0])
    client.create("Steel01", 1)
    check("the Python package cannot iterate along bonds, and says so", not client.iterates)
    refusals_are_told(client)
    staged_materials_yield(client)
    a_client_at_a_time(client)
    client.end()
    client = Client()
    laws_do_not_hang_on_their_company(client, [name for name in LAWS if LAWS[name].startswith("uniaxial")])
    trials_are_repeatable(client, "Steel02", [2.5e-3])
    partial_trials_keep_the_state_of_the_others(client, "Steel02", [4e-3])
    trials_are_repeatable(client, "Concrete02", [-2.5e-3])
    refusals_of_tcl_are_told(client)
    a_client_at_a_time(client)
    decks_agree(client)
    bars_agree(client)
    client.end()
    hybrid_bodies_agree()
    the_plate_agrees()
    runs_tell_what_opensees_said()
    offers_are_told()
    the_laboratory_agrees()
    for path in (f"{WORK}/chance", None):
        chance_does_no_harm(path)
        secrets_guard(path)
    a_server_keeps_its_points()
    print(f"OpenSees: {len(LAWS)} laws, {failures} failures")
    sys.exit(failures > 0)


main()
