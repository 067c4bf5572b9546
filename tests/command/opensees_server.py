"""The servers of OpenSees: who is served, what is committed, what stays behind.

opensees_server.py WORK_FOLDER WORDS...: a command that starts the Python server or, if it is tclsh, the Tcl one, over a stand-in
"""

import os
import signal
import socket
import struct
import subprocess
import sys
import zlib

WORK, SERVER = os.path.abspath(sys.argv[1]), sys.argv[2:]
TCL = SERVER[0] == "tclsh"
HEADER = struct.Struct("<4sHHIIIIII")
HELLO, CREATE, TRIAL, COMMIT, REVERT, STATISTICS, BYE = 1, 3, 5, 6, 7, 10, 11
COMMITS_BEFORE = 1
PATIENCE = 30  # seconds, for what comes at once; half of the minute for which a served client is waited for
BARS = b"command: uniaxialMaterial Bar $tag\n" if TCL else b"command: nDMaterial Bars $tag\n"
COMPONENTS = 1 if TCL else 6
MADE = f"components: {COMPONENTS}\n"
YIELD_STRAIN, YIELD_STRESS = 1e-3, 2e5
checks = failures = 0
processes = []


def check(what, good, more=""):
    global checks, failures
    checks += 1
    if not good:
        failures += 1
        print(f"FAIL: {what}: {more}")


def stream(name):
    return "tcp://127.0.0.1:0" if TCL else f"unix:{WORK}/{name}"


def start(address):
    process = subprocess.Popen([*SERVER, "--listen", address], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    line = process.stdout.readline()
    if not line.startswith("listening at "):
        sys.exit(f"FAIL: {address}: {process.stderr.read()}")
    processes.append(process)
    return process, line.removeprefix("listening at ").rstrip("\n")


def end(process, with_signal=signal.SIGTERM):
    process.send_signal(with_signal)
    _, said = process.communicate(timeout=PATIENCE)
    if TCL:  # it leaves nothing behind, and has no signals
        return
    check(f"a quiet end by {with_signal.name}", process.returncode == 0 and said == "", f"{process.returncode}: {said}")


def pack(first, strains):
    """The payload of a trial of points that are drawn along x."""
    values = [value for strain in strains for value in [strain, 0, 0, 0, 0, 0][:COMPONENTS]]
    return struct.pack(f"<II{len(values)}d", first, 0, *values)


def frame(operation, number, body=b"", count=0, flags=0, session=0, length=None):
    head = HEADER.pack(b"BRMS", 1, operation, number, flags, count, len(body) if length is None else length, session, 0)[:28]
    return head + struct.pack("<I", zlib.crc32(body, zlib.crc32(head))) + body


class Line:
    def __init__(self, address):
        kind, _, rest = address.partition(":")
        if kind == "unix":
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.connect(rest)
        else:
            host, _, port = rest.lstrip("/").rpartition(":")
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM if kind == "tcp" else socket.SOCK_DGRAM)
            self.socket.connect((host, int(port)))
        self.socket.settimeout(PATIENCE)
        self.datagrams = kind == "udp"
        self.number = self.session = 0

    def hear(self):
        if self.datagrams:
            data = self.socket.recv(65535)
            head, body = data[:32], data[32:]
        else:
            head = self.socket.recv(32, socket.MSG_WAITALL)
            if len(head) < 32:
                return 0, b""
            size = HEADER.unpack(head)[6]
            body = self.socket.recv(size, socket.MSG_WAITALL) if size else b""
        header = HEADER.unpack(head)
        self.session = header[7] or self.session
        self.flags, self.count = header[4:6]
        return header[2], body

    def ask(self, operation, body=b"", count=0, flags=0):
        self.number += 1
        try:
            self.socket.sendall(frame(operation, self.number, body, count, flags, self.session))
            return self.hear()
        except OSError as problem:
            return 0, str(problem).encode()

    def expect(self, words, operation, body=b"", count=0):
        _, answer = self.ask(operation, body, count)
        check(f"operation {operation}", words.encode() in answer, f"expected '{words}', found {answer}")

    def pull(self, point, strain, flags=0):
        """The stress of one point along x."""
        operation, answer = self.ask(TRIAL, pack(point, [strain]), 1, flags)
        return struct.unpack_from("<d", answer)[0] if operation == TRIAL + 128 else answer

    def await_end(self, what):
        try:
            while self.socket.recv(4096):
                pass
        except ConnectionResetError:
            pass
        except TimeoutError:
            check(what, False, f"the line is still open after {PATIENCE} s")
        self.socket.close()


def stress_is(what, found, expected):
    check(what, isinstance(found, float) and abs(found - expected) < 1e-6, f"expected {expected}, found {found}")


def partial_trials_keep_the_state_of_the_others():
    process, address = start(stream("partial"))
    line = Line(address)
    line.expect("points: 0\n", HELLO)
    line.expect(MADE, CREATE, BARS, 3)
    stress_is("drawn to three times the yield strain", line.pull(0, 3 * YIELD_STRAIN), YIELD_STRESS)
    line.ask(COMMIT)
    line.pull(1, 0.5 * YIELD_STRAIN)
    line.pull(2, 0.5 * YIELD_STRAIN, COMMITS_BEFORE)
    line.ask(COMMIT)
    stress_is("the point keeps what it was committed to", line.pull(0, 2 * YIELD_STRAIN), 0)
    # A trial that is forgotten is not committed with those of others, neither by COMMIT nor by a trial of all.
    line.pull(0, -3 * YIELD_STRAIN)
    line.ask(REVERT)
    line.expect("there is no trial to commit", COMMIT)
    line.pull(1, 0)
    line.ask(COMMIT)
    stress_is("what was forgotten is not committed", line.pull(0, 2 * YIELD_STRAIN), 0)
    line.pull(0, -3 * YIELD_STRAIN)
    line.ask(REVERT)
    line.pull(1, 0)
    _, answer = line.ask(TRIAL, pack(0, [2 * YIELD_STRAIN] * 3), 3, COMMITS_BEFORE)
    stress_is("nor by a trial of all points", struct.unpack_from("<d", answer)[0], 0)
    # The last of several trials counts.
    line.pull(0, 5 * YIELD_STRAIN)
    line.pull(0, 4 * YIELD_STRAIN)
    line.ask(COMMIT)
    stress_is("the last trial counts", line.pull(0, 2 * YIELD_STRAIN), -YIELD_STRESS)
    end(process)


def the_point_that_cannot_be_followed_is_named():
    process, address = start(stream("named"))
    line = Line(address)
    line.expect("points: 0\n", HELLO)
    line.expect(MADE, CREATE, BARS, 7)
    for failing in range(4):  # of points 2 to 5, counted from the first that is asked for
        strains = [2.0 if k == failing else 0.5 * YIELD_STRAIN for k in range(4)]
        line.expect("OpenSees cannot follow the strain of a point: too far", TRIAL, pack(2, strains), 4)
        check("the point that failed", (line.flags, line.count) == (1, failing), f"flags {line.flags}, point {line.count}")
    stress_is("the others can still be followed", line.pull(2, 0.5 * YIELD_STRAIN), 0.5 * YIELD_STRESS)
    end(process)


def materials_are_in_the_stage_that_was_asked_for():
    process, address = start(stream("stages"))
    line = Line(address)
    line.expect("points: 0\n", HELLO)
    for kind in ("PressureIndependMultiYield", "PressureDependMultiYield03"):
        command = f"command: nDMaterial {kind} $tag 3\n"
        line.expect(f"{kind} stays elastic until its stage is set: give 'stage: 1' (plastic)", CREATE, command.encode(), 1)
        for stage, stress in ((0, 3 * YIELD_STRESS), (1, YIELD_STRESS)):
            line.expect(MADE, CREATE, f"{command}stage: {stage}\n".encode(), 1)
            stress_is(f"{kind} in stage {stage}", line.pull(0, 3 * YIELD_STRAIN), stress)
    command = b"command: nDMaterial ManzariDafalias $tag 3\n"
    for stage, stress in ((b"stage: 0\n", 3 * YIELD_STRESS), (b"", YIELD_STRESS)):  # the stage of a session before does not stay
        line.expect(MADE, CREATE, command + stage, 1)
        stress_is(f"ManzariDafalias, {stage}", line.pull(0, 3 * YIELD_STRAIN), stress)
    line.expect("Bars has no stages: leave 'stage' out", CREATE, BARS + b"stage: 1\n", 1)
    for kind, words in (
        ("PressureIndependMultiYield", "stays elastic until its stage is set"),
        ("PressureDependMultiYield", "stays elastic until its stage is set"),
        ("PressureDependMultiYield02", "stays elastic until its stage is set"),
        ("PressureDependMultiYield03", "stays elastic until its stage is set"),
        ("CycLiqCP", "stays elastic until its stage is set"),
        ("CycLiqCPSP", "stays elastic until its stage is set"),
        ("PM4Sand", "knows plane strain only"),
        ("PM4Silt", "knows plane strain only"),
        ("VonPapaDamage", "knows plane stress only"),
        ("StressDensityModel", "OpenSees offers no way to set its stage from outside"),
        ("FluidSolidPorous", "is made of another material by its tag"),
        ("MultiYieldSurfaceClay", "is unknown"),  # plastic from the beginning in OpenSees: its parameter 1 is a modulus
    ):
        line.expect(f"{kind}", CREATE, f"command: nDMaterial {kind} $tag 3\n".encode(), 1)
        line.expect(words, CREATE, f"command: nDMaterial {kind} $tag 3\n".encode(), 1)
    line.expect("PyLiq1 takes pore pressures from elements", CREATE, b"command: uniaxialMaterial PyLiq1 $tag 1\n", 1)
    end(process)


def materials_that_need_elements_are_refused():
    process, address = start(stream("elements"))
    line = Line(address)
    line.expect("points: 0\n", HELLO)
    line.expect("QzLiq1 takes pore pressures from elements", CREATE, b"command: uniaxialMaterial QzLiq1 $tag 1\n", 1)
    line.expect("Bar has no stages", CREATE, BARS + b"stage: 1\n", 1)
    end(process)


def lengths_that_are_none_are_refused():
    process, address = start(stream("lengths"))
    line = Line(address)
    line.expect("points: 0\n", HELLO)
    command = BARS.rstrip() + b" $length\n"
    for length in (b"1" * 400, b"1e400", b"nan", b"-1", b"0", b"long", b""):
        line.expect("the client told none that is a finite number above 0", CREATE, command + b"length: " + length + b"\n", 1)
    line.expect(MADE, CREATE, command + b"length: 0.1\n", 1)
    stress_is("a client with a length is served", line.pull(0, YIELD_STRAIN), YIELD_STRESS)
    end(process)


def strangers_cannot_speak_for_a_client():
    process, address = start("udp://127.0.0.1:0")
    client, stranger = Line(address), Line(address)
    stranger.expect("a client says HELLO first", CREATE, BARS, 1)
    client.expect("points: 0\n", HELLO)
    client.expect(MADE, CREATE, BARS, 2)
    client.pull(0, 3 * YIELD_STRAIN)
    stranger.session, stranger.number = client.session, client.number
    for operation in (COMMIT, CREATE, BYE):
        stranger.expect("a client says HELLO first", operation, BARS, 1)
    stranger.expect("the server is busy with another client", HELLO)
    client.number -= 1
    stress_is("the last answer once more", client.pull(0, 3 * YIELD_STRAIN), YIELD_STRESS)
    client.expect("evaluations: 1\n", STATISTICS)
    client.ask(COMMIT)
    client.expect("points: 2\ncommits: 1\n", HELLO)
    client.ask(BYE)
    client.expect("a client says HELLO first", COMMIT)
    stranger.expect("points: 2\ncommits: 1\n", HELLO)
    end(process)


def silent_and_slow_clients_hold_nobody_up():
    process, address = start(stream("silent"))
    idle = []
    for k in range(12):  # more than a server listens to at a time
        idle.append(Line(address))
        idle[-1].socket.sendall(frame(HELLO, 1, b"client: x\n")[: 20 * (k % 3)])
    client = Line(address)
    client.expect("points: 0\n", HELLO)
    client.expect(MADE, CREATE, BARS, 1)
    late = Line(address)
    late.expect("the server is busy with another client", HELLO)
    late.await_end("one that is told that the server is busy")
    for line in idle:
        line.await_end("one that does not greet")
    stress_is("the client is served all the time", client.pull(0, YIELD_STRAIN), YIELD_STRESS)
    for announced, words in ((1 << 28, "268435456 bytes was announced; the most is 4096"), (2**32 - 1, "the most is 4096")):
        line = Line(address)
        line.socket.sendall(frame(HELLO, 1, length=announced))
        _, answer = line.hear()
        check("a greeting is bounded", words.encode() in answer, repr(answer))
        line.await_end("one that announces too much")
    line = Line(address)
    line.expect("a client says HELLO first", TRIAL)
    line.await_end("one that does not say HELLO")
    end(process)


def addresses_are_refused_in_one_line():
    with open(f"{WORK}/ordinary", "w", encoding="utf-8") as file:
        file.write("results")
    table = [
        ("tcp://127.0.0.1:65536", "'65536' is no port: expected a number from 0 to 65535"),
        ("udp://127.0.0.1:99999", "'99999' is no port: expected a number from 0 to 65535"),
        ("tcp://127.0.0.1:-1", "'-1' is no port: expected a number from 0 to 65535"),
        ("tcp://127.0.0.1:", "an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH"),
        ("gopher://x", "an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH"),
        ("tcp://0.0.0.0:0", "a server listens on this machine only, unless a secret guards it (--secret-file)"),
        (f"unix:{WORK}/ordinary", "Address already in use"),
        ("unix:", "the path of a socket is missing"),
    ]
    if TCL:
        table = [row for row in table if row[0] in ("tcp://127.0.0.1:65536", "tcp://0.0.0.0:0")]
    for address, words in table:
        run = subprocess.run([*SERVER, "--listen", address], capture_output=True, text=True, timeout=PATIENCE)
        check(address, run.returncode == 2 and words in run.stderr and run.stderr.count("\n") == 1, f"{run.returncode}: {run.stderr}")
    empty, latin, pipe = (f"{WORK}/{name}" for name in ("empty", "latin", "pipe"))
    for path, words in ((empty, b"\nsesame\n"), (latin, b"s\xe9same\n")):
        with open(path, "wb") as file:
            file.write(words)
    if not os.path.exists(pipe):
        os.mkfifo(pipe)
    for path in (f"{WORK}/nowhere", WORK, pipe, "/dev/zero", empty) + (() if TCL else (latin,)):  # Tcl reads any bytes
        words = [*SERVER, "--listen", "tcp://127.0.0.1:0", "--secret-file", path]
        run = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE)
        told = path in run.stderr and "secret" in run.stderr and run.stderr.count("\n") == 1
        check(f"a secret in {path}", run.returncode == 2 and told, f"{run.returncode}: {run.stderr}")
    with open(f"{WORK}/ordinary", encoding="utf-8") as file:
        check("an ordinary file stays", file.read() == "results")


def only_sockets_of_their_own_are_removed():
    path = f"{WORK}/ended"
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        process, _ = start(f"unix:{path}")
        end(process, number)
        check(f"the socket's file goes after {number.name}", not os.path.exists(path))
    process, _ = start(f"unix:{path}")
    process.kill()
    process.wait()
    process, _ = start(f"unix:{path}")  # over the one that was left behind
    os.unlink(path)
    with open(path, "w", encoding="utf-8") as file:
        file.write("results")
    end(process)
    check("a file that took its place stays", os.path.isfile(path))


def main():
    try:
        partial_trials_keep_the_state_of_the_others()
        silent_and_slow_clients_hold_nobody_up()
        addresses_are_refused_in_one_line()
        if TCL:  # no point of the other stand-in fails
            the_point_that_cannot_be_followed_is_named()
            materials_that_need_elements_are_refused()
        if not TCL:  # it listens over TCP only
            lengths_that_are_none_are_refused()
            strangers_cannot_speak_for_a_client()
            materials_are_in_the_stage_that_was_asked_for()
            only_sockets_of_their_own_are_removed()
    finally:
        for process in processes:
            process.kill()
    print(f"{checks} checks, {failures} failed")
    sys.exit(failures > 0)


main()
