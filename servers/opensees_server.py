#!/usr/bin/env python3
"""Offers the constitutive models of an unmodified OpenSees to Breccia over a socket.

The protocol stands in docs/material-server.md. Points are OpenSees objects, one tag each; NDTest (in space) and
testUniaxialMaterial (one strain) drive them, a whole batch per message. Needs the package openseespy and nothing else.
"""

import argparse
import array
import importlib
import mmap
import os
import re
import secrets
import select
import signal
import socket
import stat
import struct
import sys
import tempfile
import time
import zlib
from itertools import chain, compress, islice, repeat, starmap

MAGIC, VERSION, HEADER = b"BRMS", 1, struct.Struct("<4sHHIIIIII")
MOST_PAYLOAD = 1 << 28
SEND_ROOM = 4 << 20  # bytes
# Connections that have not greeted yet: how many are listened to, for how long, and how large a greeting may be.
GUESTS, GREETING_SECONDS, MOST_GREETING = 8, 5, 4096
FRAME_SECONDS, SILENT_SECONDS = 60, 60
LOOK_UP_SECONDS = 0.2  # a signal that comes just before a wait is seen after it only
ENDS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
BUSY = "the server is busy with another client"
MOST_POINTS = 1_000_000  # OpenSees takes a time that grows with the square to make them
HELLO, PROBE, CREATE, ATTACH, TRIAL, COMMIT, REVERT, SAVE, RESTORE, STATISTICS, BYE, LAWS = range(1, 13)
ERROR, ANSWER = 0x7F, 0x80
COMMITS_BEFORE, WANTS_TANGENT = 1, 2

# Factories that take no strain themselves: a copy inside this wrapper does.
WRAPPED = {
    "ElasticIsotropic",
    "J2Plasticity",
    "DruckerPrager",
    "ManzariDafalias",
    "SAniSandMS",
    "BoundingCamClay",
    "CycLiqCP",
    "CycLiqCPSP",
}
# Materials that have an elastic and a plastic stage (setParameter and updateParameter of SRC/material/nD in OpenSees, commit 2890cb36): the number of
# the parameter, whether it is an integer, and the stage in which a material begins. Those that begin elastically stay so until somebody
# sets their stage, so that a client has to say it. Most others keep the stage once for all points of a process, where a session
# before may have left the other one: it is always set.
STAGES = {
    "PressureIndependMultiYield": (1, True, 0),
    "PressureDependMultiYield": (1, True, 0),
    "PressureDependMultiYield02": (1, True, 0),
    "PressureDependMultiYield03": (1, True, 0),
    "CycLiqCP": (1, True, 0),
    "CycLiqCPSP": (1, True, 0),
    "J2CyclicBoundingSurface": (1, True, 1),
    "ManzariDafalias": (5, False, 1),
    "SAniSandMS": (5, False, 1),
    "BoundingCamClay": (5, False, 1),
}
# Materials that cannot be driven as they are meant, and why. Those in a plane take three strains: driven by six they write where they should not.
PLANE_ONLY = "knows plane strain only; OpenSees offers no way to drive it from outside"
PORE_PRESSURE = "takes pore pressures from elements of OpenSees, which a server has none of, and would not liquefy: take PySimple1, TzSimple1 or QzSimple1"
UNDRIVEN = {
    "PM4Sand": PLANE_ONLY,
    "PM4Silt": PLANE_ONLY,
    "VonPapaDamage": "knows plane stress only, and its damage grows by cycles that a server has none of",
    "StressDensityModel": "begins elastically, and OpenSees offers no way to set its stage from outside: take PressureDependMultiYield03 or ManzariDafalias",
    "FluidSolidPorous": "is made of another material by its tag, which a server does not have: take the command of the soil, with its undrained bulk modulus",
    "PyLiq1": PORE_PRESSURE,
    "TzLiq1": PORE_PRESSURE,
    "QzLiq1": PORE_PRESSURE,
}
# Names of kinds for planes, plates, beams and interfaces.
NOT_IN_SPACE = re.compile("plane|plate|beam|contact|2d|PM4|FSAM|Mcft|SmearedSteel", re.IGNORECASE)
PROBE_TAG, BASE_OFFSET = 2_000_000_000, 1_000_000_000
# Commands to begin with, the unit of their stresses and the stage: laws that were tried (tests/external/test_opensees.py).
TRIED = [
    ("nDMaterial ElasticIsotropic3D $tag 1.5e5 0.25 0.0", "kPa", None),
    ("nDMaterial ElasticIsotropic $tag 1.5e5 0.25", "kPa", None),
    ("nDMaterial J2Plasticity $tag 1.0e5 6.0e4 100. 150. 80. 500.", "kPa", None),
    ("nDMaterial PressureIndependMultiYield $tag 3 1.5 6.0e4 1.0e5 31.8198051534 0.1 0. 100. 0. 20", "kPa", 1),
    ("nDMaterial PressureDependMultiYield $tag 3 1.9 7.5e4 2.0e5 33. 0.1 80. 0.5 27. 0.07 0.4 2. 10. 0.01 1.0 20", "kPa", 1),
    ("nDMaterial DruckerPrager $tag 1.0e5 6.0e4 50. 0.25 0.15 0. 0. 0. 0. 2000. 0.5 1.5", "kPa", None),
    ("nDMaterial TruncatedDP $tag 3 2.0 6.0e4 1.0e5 0.2 40. -30. 1e-8", "kPa", None),
    ("nDMaterial ManzariDafalias $tag 125. 0.05 0.735 1.25 0.712 0.019 0.934 0.7 100. 0.02 7.05 0.968 1.1 0.704 3.5 5. 600. 1.5", "kPa", None),
    ("nDMaterial CapPlasticity $tag 3 2400. 1.1721e10 1.4479e10", "Pa", None),
    ("nDMaterial ASDConcrete3D $tag 36000. 0.18 -fc 45. -ft 3.5 -Kc 0.7", "MPa", None),
    ("uniaxialMaterial Steel01 $tag 400. 2.0e5 0.01", "MPa", None),
    ("uniaxialMaterial Steel02 $tag 400. 2.0e5 0.01 18. 0.925 0.15", "MPa", None),
    ("uniaxialMaterial Concrete02 $tag -30. -0.002 -6. -0.006 0.1 3. 3000.", "MPa", None),
]


class Refusal(Exception):
    """What a client is told; `point` is the number of a point that failed."""

    def __init__(self, words, point=None):
        super().__init__(words)
        self.point = point


class Gone(Exception):
    """The client has left."""


class Words:
    """What OpenSees prints goes to a file, to be told if something fails. Some classes end the process when an argument is wrong:
    a child that outlives it says then what was printed last."""

    def __init__(self):
        self.file = tempfile.TemporaryFile()
        reading, self.writing = os.pipe()
        if os.fork() == 0:
            os.close(self.writing)
            for number in ENDS:
                signal.signal(number, signal.SIG_IGN)
            ended = os.read(reading, 1) == b""
            if ended and self.since(0):
                os.write(2, (self.since(0) + "\n").encode())
            os._exit(0)
        os.close(reading)
        sys.stdout.flush()
        for number in (1, 2):
            os.dup2(self.file.fileno(), number)

    def mark(self):
        """Forgets what was printed so far."""
        os.ftruncate(self.file.fileno(), 0)
        os.lseek(self.file.fileno(), 0, os.SEEK_SET)

    def since(self, start=0):
        size = os.fstat(self.file.fileno()).st_size
        text = os.pread(self.file.fileno(), 600, max(start, size - 600)).decode(errors="replace")
        return " ".join(text.split())

    def end(self):
        os.write(self.writing, b".")


def parse_lines(payload):
    lines = {}
    for line in payload.decode(errors="replace").split("\n"):
        key, colon, value = line.partition(":")
        if colon:
            lines[key.strip()] = value.strip()
    return lines


def format_lines(pairs):
    return "".join(f"{key}: {value}\n" for key, value in pairs).encode()


def number_of(word):
    """A word of a command as OpenSees wants it: whole numbers as int, others as float, the rest as text."""
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            pass
    return word


def length_of(word):
    """The length that a client tells, a finite number above 0; None: it tells none."""
    try:
        length = float(word)
    except (ValueError, OverflowError):
        return None
    return length if 0 < length < float("inf") else None


class Command:
    """The words of 'nDMaterial KIND $tag ...' or 'uniaxialMaterial KIND $tag ...'; never evaluated."""

    def __init__(self, lines):
        words = lines.get("command", "").split()
        known = len(words) >= 3 and words[0] in ("nDMaterial", "uniaxialMaterial") and words[2] == "$tag"
        if not known or not re.fullmatch("[A-Za-z0-9_]+", words[1]):  # no path: OpenSees may look for kinds in shared libraries
            raise Refusal("a command is 'nDMaterial KIND $tag ...' or 'uniaxialMaterial KIND $tag ...'")
        self.uniaxial = words[0] == "uniaxialMaterial"
        self.kind = words[1]
        if self.kind in UNDRIVEN:
            raise Refusal(f"{self.kind} {UNDRIVEN[self.kind]}")
        length = length_of(lines.get("length", ""))
        if "$length" in words and length is None:
            raise Refusal("the command asks for $length, and the client told none that is a finite number above 0")
        self.arguments = [length if word == "$length" else number_of(word) for word in words[3:]]
        self.stage = number_of(lines["stage"]) if "stage" in lines else None
        if self.stage not in (None, 0, 1):
            raise Refusal("a stage is 0 (elastic) or 1 (plastic)")
        if self.kind not in STAGES:
            if self.stage is not None:
                raise Refusal(f"{self.kind} has no stages: leave 'stage' out")
        elif self.stage is None:
            self.stage = STAGES[self.kind][2]
            if not self.stage:
                raise Refusal(
                    f"{self.kind} stays elastic until its stage is set: give 'stage: 1' (plastic) beside the command, or 'stage: 0' (elastic)"
                )


class Points:
    """The points of a session in OpenSees."""

    def __init__(self, ops, words):
        self.ops, self.words = ops, words
        self.session = 0
        self.clear()

    def clear(self):
        self.command, self.tags = None, []
        self.forget_trials()
        self.commits, self.seconds, self.evaluations = 0, 0.0, 0

    def forget_trials(self):
        self.tried = bytearray(len(self.tags))  # of each point, 1 if it has a trial that could be committed

    def build(self, command, tag):
        ops = self.ops
        if command.uniaxial:
            ops.uniaxialMaterial(command.kind, tag, *command.arguments)
            return
        base = tag
        if command.kind in WRAPPED:
            base = tag - 1 if tag >= PROBE_TAG else tag + BASE_OFFSET
        ops.nDMaterial(command.kind, base, *command.arguments)
        if base != tag:
            ops.nDMaterial("InitStrain", tag, base, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if command.stage is not None:
            number, whole, _ = STAGES[command.kind]
            if whole:
                ops.NDTest("UpdateIntegerParameter", base, number, command.stage)
            else:
                ops.NDTest("UpdateDoubleParameter", base, number, float(command.stage))

    def probe(self, command):
        """Components and moduli of what the command makes, from its tangent before any strain."""
        ops = self.ops
        ops.model("basic", "-ndm", 3, "-ndf", 3)
        self.words.mark()
        try:
            self.build(command, PROBE_TAG)
            if command.uniaxial:
                ops.testUniaxialMaterial(PROBE_TAG)
                young = ops.getTangent()
                bulk, shear = young / 1.5, young / 2.5
            else:
                ops.NDTest("SetStrain", PROBE_TAG, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
                if len(ops.NDTest("GetStress", PROBE_TAG)) != 6:
                    raise Refusal(f"{command.kind} does not take six strains")
                tangent = ops.NDTest("GetTangentStiffness", PROBE_TAG)
                bulk = sum(tangent[6 * row + column] for row in range(3) for column in range(3)) / 9
                shear = (tangent[21] + tangent[28] + tangent[35]) / 3
        except Exception as problem:  # openseespy raises its own kinds
            said = self.words.since()
            raise Refusal(f"OpenSees refuses '{command.kind}': {'it said: ' + said if said else problem}") from None
        if not (bulk > 0 and shear > 0):
            raise Refusal(f"OpenSees tells no stiffness of '{command.kind}' (bulk {bulk:g}, shear {shear:g})")
        self.forget_probe()
        return bulk, shear

    def forget_probe(self):
        """Tags cannot be removed one by one: while nothing is held all go; otherwise the spare tags move on."""
        global PROBE_TAG
        if not self.tags:
            self.ops.wipe()
        else:
            PROBE_TAG += 2

    def create(self, command, count):
        if count > MOST_POINTS:
            raise Refusal(f"{count} points are more than a server takes ({MOST_POINTS})")
        self.clear()
        self.ops.wipe()
        bulk, shear = self.probe(command)
        self.ops.model("basic", "-ndm", 3, "-ndf", 3)
        self.command, self.tags = command, list(range(1, count + 1))
        self.forget_trials()
        for tag in self.tags:
            self.build(command, tag)
        self.words.mark()
        self.session = secrets.randbits(32) | 1
        return bulk, shear

    def begin_commit(self):
        """Tags of the points whose last trial is their state from now on."""
        if not any(self.tried):
            raise Refusal("there is no trial to commit")
        tried = compress(self.tags, self.tried)
        self.forget_trials()
        self.commits += 1
        return tried

    def commit(self):
        tried = self.begin_commit()
        if not self.command.uniaxial:  # of one strain, setStrain has committed already
            commit = self.ops.NDTest
            for tag in tried:
                commit("CommitState", tag)

    def pull_bonds(self, tags, strains, wanted):
        """Stresses, and tangents if wanted, of laws of one strain."""
        stresses, tangents = array.array("d"), array.array("d")
        choose, strain = self.ops.testUniaxialMaterial, self.ops.setStrain
        stress, tangent = self.ops.getStress, self.ops.getTangent
        for tag, (value,) in zip(tags, struct.iter_unpack("<d", strains)):
            choose(tag)
            strain(value)
            stresses.append(stress())
            if wanted:
                tangents.append(tangent())
        return stresses, tangents

    def strain_points(self, tags, strains, commits, wanted):
        """The same in space. All calls of a point stand side by side: its memory is touched once, which takes a fifth less time than
        a pass for commits; and no line of Python runs per point, which takes another tenth."""
        values = array.array("d")
        values.frombytes(strains)
        calls = [zip(repeat("CommitState"), tags)] if commits else []
        calls.append(zip(repeat("SetStrain"), tags, *(values[k::6] for k in range(6))))
        calls.append(zip(repeat("GetStress"), tags))
        if wanted:
            calls.append(zip(repeat("GetTangentStiffness"), tags))
        answers, every = starmap(self.ops.NDTest, chain.from_iterable(zip(*calls))), len(calls)
        if not wanted:
            return array.array("d", chain.from_iterable(islice(answers, every - 1, None, every))), b""
        answers = list(answers)
        return tuple(array.array("d", chain.from_iterable(answers[k::every])) for k in (every - 2, every - 1))

    def trial(self, flags, first, count, strains):
        """Stresses, and tangents if wanted, of strains given point after point."""
        if first + count > len(self.tags):
            raise Refusal(f"points {first} to {first + count - 1} were asked for; there are {len(self.tags)}")
        start = time.perf_counter()
        together = flags & COMMITS_BEFORE and count == len(self.tags) == self.tried.count(1) and not self.command.uniaxial
        if together:
            self.begin_commit()
        elif flags & COMMITS_BEFORE:
            self.commit()
        tags, wanted = self.tags[first : first + count], bool(flags & WANTS_TANGENT)
        self.tried[first : first + count] = bytes(count)  # one that fails leaves the points without
        if self.command.uniaxial:
            stresses, tangents = self.pull_bonds(tags, strains, wanted)
        else:
            stresses, tangents = self.strain_points(tags, strains, together, wanted)
        self.tried[first : first + count] = b"\1" * count
        self.seconds += time.perf_counter() - start
        self.evaluations += count
        return bytes(stresses) + bytes(tangents)


# ---- which laws there are ----


def in_a_child(work):
    """What work(write) wrote in a process of its own, which OpenSees may end in the middle."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        try:
            work(lambda text: os.write(writing, text.encode()))
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as pipe:
        written = pipe.read()
    os.waitpid(child, 0)
    return written


def constants_of(path):
    """The section .rodata of a shared library (ELF, 64 bits, little-endian), where its texts stand."""
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        (table,) = struct.unpack_from("<Q", data, 40)
        size, count, names = struct.unpack_from("<3H", data, 58)
        sections = [struct.unpack_from("<IIQQQQ", data, table + size * k) for k in range(count)]
        for name, _, _, _, offset, length in sections:
            start = sections[names][4] + name
            if data[start : start + 8] == b".rodata\0":
                return data[offset : offset + length]
    return b""


def candidates():
    """Words among the texts of the OpenSees library; linkers share tails of texts, so that tails are words too."""
    with open("/proc/self/maps", encoding="utf-8") as file:
        paths = {line.split(maxsplit=5)[5].strip() for line in file if "opensees" in line.rpartition("/")[2]}
    words = set()
    for path in paths:
        for found in re.findall(rb"[A-Za-z0-9_]{2,40}(?=\0)", constants_of(path)):
            text = found.decode()
            words.add(text)
            words.update(text[k:] for k in range(1, len(text) - 1) if not text[k].islower())
    return sorted(word for word in words if word[0] != "_")


def known_kinds(ops, words, command):
    """The kinds that a command knows: OpenSees is asked for each candidate, without arguments, and says which are unknown to it."""
    names, known, start = candidates(), [], 0

    def ask(write):
        ops.model("basic", "-ndm", 3, "-ndf", 3)
        for number in range(start, len(names)):
            words.mark()
            write(f"{number} ")  # the last to be written ends the process, or all are through
            try:
                getattr(ops, command)(names[number], 1)
            except Exception:  # openseespy raises its own kinds
                pass
            if "is unknown" not in words.since():
                write(f"{number}! ")

    while start < len(names):
        told = in_a_child(ask).split()
        known += [names[int(word[:-1])] for word in told if word[-1] == "!"]
        last = int(told[-1].rstrip("!")) if told else len(names)
        if last < len(names) - 1 and told[-1][-1] != "!":
            known.append(names[last])
        start = last + 1
    words.mark()
    return known


def offered_laws(points, program):
    """Pairs for an answer to LAWS: commands to begin with, with what OpenSees makes of them, and the names of all kinds."""
    yield "program", program
    for text, unit, stage in TRIED:
        command = Command({"command": text} if stage is None else {"command": text, "stage": str(stage)})

        def probe(write):
            try:
                bulk, shear = points.probe(command)
                young = 9 * bulk * shear / (3 * bulk + shear)
                write(f"Young modulus {young:.4g} {unit}" if command.uniaxial else f"moduli: bulk {bulk:.4g} {unit}, shear {shear:.4g} {unit}")
            except Refusal as refusal:
                write(str(refusal))

        made = in_a_child(probe) or "it ends the process of OpenSees"
        yield "tried", f"{text}; {'' if stage is None else f'stage: {stage}; '}stress unit: {unit}; {made}"
    space, uniaxial = (known_kinds(points.ops, points.words, command) for command in ("nDMaterial", "uniaxialMaterial"))
    yield "space", " ".join(kind for kind in space if kind not in UNDRIVEN and not NOT_IN_SPACE.search(kind))
    yield "uniaxial", " ".join(kind for kind in uniaxial if kind not in UNDRIVEN)


class Server:
    def __init__(self, points, secret, program):
        self.points, self.secret, self.program = points, secret, program
        self.begin()

    def begin(self):
        """With a new client."""
        self.last = None  # sequence number and answer of the frame answered last
        self.leaving = False

    def check_greeting(self, header, payload):
        """Refuses a first frame that does not greet as it should."""
        if header[1] != VERSION:
            raise Refusal(f"this server speaks version {VERSION} of the protocol, the client version {header[1]}")
        if header[2] != HELLO:
            raise Refusal("a client says HELLO first")
        given = parse_lines(payload).get("secret", "")
        if self.secret and not secrets.compare_digest(given.encode(), self.secret.encode()):
            raise Refusal("the secret is wrong")

    def answer(self, header, payload):
        """The frame that answers a frame."""
        _, version, operation, sequence, flags, count, _, session, _ = header
        if self.last and self.last[0] == sequence and operation != HELLO:
            return self.last[1]
        try:
            if version != VERSION:
                raise Refusal(f"this server speaks version {VERSION} of the protocol, the client version {version}")
            if operation == HELLO:
                self.leaving = True
                self.check_greeting(header, payload)
                self.leaving = False
            points, body = self.obey(operation, flags, count, session, payload)
            frame = self.seal(operation | ANSWER, sequence, 0, points, body)
        except Refusal as refusal:
            point = refusal.point
            frame = self.seal(ERROR, sequence, int(point is not None), point or 0, str(refusal).encode())
        self.last = (sequence, frame)
        return frame

    def seal(self, operation, sequence, flags, count, body):
        head = HEADER.pack(MAGIC, VERSION, operation, sequence, flags, count, len(body), self.points.session, 0)
        checksum = zlib.crc32(body, zlib.crc32(head[:28]))
        return head[:28] + struct.pack("<I", checksum) + body

    def obey(self, operation, flags, count, session, payload):
        points = self.points
        if operation == HELLO:
            return 0, format_lines(
                [("program", self.program), ("session", points.session), ("points", len(points.tags)), ("commits", points.commits)]
            )
        if operation == PROBE:
            command = Command(parse_lines(payload))
            return 0, self.law(command, *points.probe(command))
        if operation == CREATE:
            command = Command(parse_lines(payload))
            return 0, self.law(command, *points.create(command, count))
        if operation == STATISTICS:
            return 0, format_lines(
                [("seconds", f"{points.seconds:.6f}"), ("evaluations", points.evaluations), ("commits", points.commits)]
            )
        if operation == LAWS:
            return 0, format_lines(offered_laws(points, self.program))
        if operation == BYE:
            self.leaving = True
            return 0, b""
        if not points.session or session != points.session:
            raise Refusal(f"session {session} is not held here")
        if operation == ATTACH:
            return 0, b""
        if operation == REVERT:
            points.forget_trials()
            return 0, b""
        if operation == COMMIT:
            points.commit()
            return 0, b""
        if operation == TRIAL:
            components = 1 if points.command.uniaxial else 6
            if len(payload) != 8 + 8 * components * count:
                raise Refusal(f"{count} strains were announced, and {len(payload)} bytes came")
            (first,) = struct.unpack_from("<I", payload)
            return count, points.trial(flags, first, count, memoryview(payload)[8:])
        if operation in (SAVE, RESTORE):
            raise Refusal("OpenSees can neither save nor restore the state of a material")
        raise Refusal(f"operation {operation} is unknown")

    def law(self, command, bulk, shear):
        return format_lines(
            [
                ("components", 1 if command.uniaxial else 6),
                ("bulk", repr(float(bulk))),
                ("shear", repr(float(shear))),
                ("state", 0),
                ("iterates", 0 if command.uniaxial else 1),
                ("saves", 0),
                ("session", self.points.session),
            ]
        )


# ---- sockets ----


def read_exactly(connection, size):
    data = bytearray(size)
    view, done = memoryview(data), 0
    while done < size:
        n = connection.recv_into(view[done:])
        if n == 0:
            raise Gone
        done += n
    return data


def check(head, body):
    header = HEADER.unpack(head)
    return zlib.crc32(body, zlib.crc32(head[:28])) == header[8]


def read_header(head, most):
    header = HEADER.unpack(head)
    if header[0] != MAGIC:
        raise Refusal("what came is no frame of this protocol")
    if header[6] > most:
        raise Refusal(f"a frame of {header[6]} bytes was announced; the most is {most}{' before a greeting' if most < MOST_PAYLOAD else ''}")
    return header


def check_whole(head, body):
    if not check(head, body):
        raise Refusal("a frame came damaged (its checksum does not hold)")


def read_frame(connection):
    connection.settimeout(FRAME_SECONDS)
    head = bytes(read_exactly(connection, HEADER.size))
    header = read_header(head, MOST_PAYLOAD)
    body = read_exactly(connection, header[6])
    check_whole(head, body)
    return header, body


class Guest:
    """A connection that has not greeted yet. Nothing of it is waited for, and little is kept."""

    def __init__(self, connection):
        connection.setblocking(False)
        self.connection, self.bytes = connection, b""
        self.end = time.monotonic() + GREETING_SECONDS
        self.dismissed = False  # told why not; what else it sends is dropped, or closing would take the words away again

    def fileno(self):
        return self.connection.fileno()

    def collect(self, size):
        """Whether so many bytes have come."""
        while len(self.bytes) < size:
            try:
                piece = self.connection.recv(size - len(self.bytes))
            except BlockingIOError:
                return False
            if not piece:
                raise Gone
            self.bytes += piece
        return True

    def hear(self):
        """Header and body of its first frame once it is whole, or None."""
        if self.dismissed:
            self.bytes = b""
            self.collect(MOST_GREETING)
            return None
        if not self.collect(HEADER.size):
            return None
        head = self.bytes[: HEADER.size]
        header = read_header(head, MOST_GREETING)
        if not self.collect(HEADER.size + header[6]):
            return None
        body = self.bytes[HEADER.size :]
        check_whole(head, body)
        return header, body

    def dismiss(self, frame):
        if self.connection.send(frame) != len(frame):
            raise Gone
        self.connection.shutdown(socket.SHUT_WR)
        self.dismissed = True


def serve_guest(server, guest, occupied):
    """Header and body of the greeting if the guest may be the client now, or None; Gone when it has left."""
    sequence = 0
    try:
        heard = guest.hear()
        if heard:
            sequence = heard[0][3]
            server.check_greeting(*heard)
            if occupied:
                raise Refusal(BUSY)
        return heard
    except Refusal as refusal:
        try:
            guest.dismiss(server.seal(ERROR, sequence, 0, 0, str(refusal).encode()))
        except OSError:
            raise Gone from None
    except OSError:
        raise Gone from None
    return None


def accept_guest(listener, guests):
    try:
        connection, _ = listener.accept()
    except OSError:  # it has left already
        return
    if connection.family == socket.AF_UNIX:  # else both ends take turns over one batch
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_ROOM)
    else:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if len(guests) == GUESTS:  # the one that has been here longest goes
        guests.pop(0).connection.close()
    guests.append(Guest(connection))


def attend(server, listener, guests, client):
    """Waits for the client, which is returned as it is, or for a greeting: a new client, and header and body of it."""
    while True:
        ready, _, _ = select.select([listener, *guests] + ([client] if client else []), [], [], LOOK_UP_SECONDS)
        if client in ready:  # if it has just left, whoever knocks is the next one
            return client, None
        for guest in list(guests):
            try:
                greeting = serve_guest(server, guest, client is not None) if guest in ready else None
                if not greeting and guest.end <= time.monotonic():
                    raise Gone
            except Gone:
                guests.remove(guest)
                guest.connection.close()
                continue
            if greeting:
                guests.remove(guest)
                return guest.connection, greeting
        if listener in ready:
            accept_guest(listener, guests)


def serve_stream(server, listener, once):
    client, guests = None, []
    listener.setblocking(False)
    while True:
        client, greeting = attend(server, listener, guests, client)
        if greeting:
            server.begin()
            client.settimeout(FRAME_SECONDS)
        try:
            client.sendall(server.answer(*(greeting or read_frame(client))))
            if not server.leaving:
                continue
        except Refusal as refusal:
            try:
                client.sendall(server.seal(ERROR, 0, 0, 0, str(refusal).encode()))
            except OSError:
                pass
        except (OSError, Gone):
            pass
        client.close()
        client = None
        if once:
            return


def serve_datagrams(server, listener, once):
    listener.settimeout(LOOK_UP_SECONDS)
    client, heard = None, 0.0  # where its greeting came from, and when something came last
    while True:
        try:
            data, sender = listener.recvfrom(65535)
        except socket.timeout:
            continue
        if len(data) < HEADER.size:
            continue
        header, body = HEADER.unpack_from(data), data[HEADER.size :]
        if header[0] != MAGIC or header[6] != len(body) or not check(data[: HEADER.size], body):
            continue  # as if it had been lost
        now = time.monotonic()
        if sender != client:
            try:
                server.check_greeting(header, body)
                if client and now - heard < SILENT_SECONDS:
                    raise Refusal(BUSY)
            except Refusal as refusal:
                send_datagram(listener, server.seal(ERROR, header[3], 0, 0, str(refusal).encode()), sender)
                continue
            client = sender
            server.begin()
        heard = now
        frame = server.answer(header, body)
        if len(frame) > 65507:
            frame = server.seal(ERROR, header[3], 0, 0, b"the answer does not fit a datagram; use tcp:// or unix:")
        send_datagram(listener, frame, sender)
        if server.leaving:
            client = None
            if once:
                return


def send_datagram(listener, frame, receiver):
    try:
        listener.sendto(frame, receiver)
    except OSError:  # as if it had been lost
        pass


def is_loopback(host):
    return host in ("localhost", "::1") or re.fullmatch(r"127(\.\d+){3}", host) is not None


class SocketFile:
    """The file of a Unix socket; only the one that was made here is removed."""

    def __init__(self):
        self.path = self.known = None

    def bind(self, listener, path):
        remove_stale(path)
        mask = os.umask(0o177)
        signal.pthread_sigmask(signal.SIG_BLOCK, ENDS)  # the file and that it is known belong together
        try:
            listener.bind(path)
            self.path, self.known = path, self.identity(path)
        finally:
            os.umask(mask)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDS)

    @staticmethod
    def identity(path):
        try:
            status = os.lstat(path)
        except OSError:
            return None
        return status.st_dev, status.st_ino

    def remove(self):
        if self.path and self.known and self.identity(self.path) == self.known:
            os.unlink(self.path)


def remove_stale(path):
    """Removes a socket that a killed server left behind: nobody answers there."""
    try:
        if not stat.S_ISSOCK(os.lstat(path).st_mode):
            return
        with socket.socket(socket.AF_UNIX) as probe:
            probe.connect(path)
    except ConnectionRefusedError:
        os.unlink(path)
    except OSError:
        pass


def parse_address(address, open_to_all):
    """Kind, host and port of an address of the network."""
    kind, _, rest = address.partition("://")
    host, _, port = rest.rpartition(":")
    host = host.strip("[]")
    if kind not in ("tcp", "udp") or not host or not port:
        raise ValueError("an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH")
    if not re.fullmatch("[0-9]{1,5}", port) or int(port) > 65535:
        raise ValueError(f"'{port[:20]}' is no port: expected a number from 0 to 65535")
    if not is_loopback(host) and not open_to_all:
        raise ValueError("a server listens on this machine only, unless a secret guards it (--secret-file)")
    return kind, host, int(port)


def open_listener(address, open_to_all, file):
    """The socket that listens at an address, and where it listens in words."""
    if address.startswith("unix:"):
        if address == "unix:":  # Linux would choose a name that no file has
            raise ValueError("the path of a socket is missing")
        listener = socket.socket(socket.AF_UNIX)
        file.bind(listener, address[5:])
        listener.listen(GUESTS)
        return listener, address
    kind, host, port = parse_address(address, open_to_all)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM if kind == "tcp" else socket.SOCK_DGRAM)
    if kind == "tcp":
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind((host, port))
    if kind == "tcp":
        listener.listen(GUESTS)
    where = listener.getsockname()
    return listener, f"{kind}://{'[' + where[0] + ']' if ':' in where[0] else where[0]}:{where[1]}"


def read_secret(path):
    """The first line of a file; of a device or pipe nothing is read, which might never end."""
    with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK), encoding="utf-8") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise ValueError("it is no file")
        secret = file.readline(MOST_GREETING).strip()
    if not secret:
        raise ValueError("its first line is empty")
    return secret


def main():
    parser = argparse.ArgumentParser(prog="breccia-opensees", description=__doc__.split("\n")[0])
    parser.add_argument("--listen", required=True, metavar="ADDRESS", help="tcp://127.0.0.1:PORT, unix:/PATH or udp://127.0.0.1:PORT")
    parser.add_argument("--secret-file", metavar="FILE", help="clients must know the words in this file; then any interface may be listened to")
    parser.add_argument("--once", action="store_true", help="end when the first client has gone")
    options = parser.parse_args()
    secret = None
    if options.secret_file:
        try:
            secret = read_secret(options.secret_file)
        except (OSError, ValueError) as problem:  # of bytes that are no UTF-8 too
            parser.exit(2, f"breccia-opensees: {options.secret_file}: no secret can be read there: {problem}\n")
    for number in ENDS:
        if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # nohup keeps it running
            signal.signal(number, lambda *_: sys.exit(0))
    try:
        ops = importlib.import_module("openseespy.opensees")
    except ImportError as problem:
        sys.exit(f"breccia-opensees: the package openseespy is not there: {problem}")
    file, words = SocketFile(), None
    try:
        try:
            listener, where = open_listener(options.listen, secret is not None, file)
        except (OSError, ValueError) as problem:
            parser.exit(2, f"breccia-opensees: {options.listen}: cannot be listened to: {problem}\n")
        print(f"listening at {where}", flush=True)
        words = Words()
        server = Server(Points(ops, words), secret, f"OpenSees {ops.version()}")
        serve = serve_datagrams if listener.type == socket.SOCK_DGRAM else serve_stream
        serve(server, listener, options.once)
    finally:
        if words:
            words.end()
        file.remove()


if __name__ == "__main__":
    main()
