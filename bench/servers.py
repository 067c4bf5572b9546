"""What laws in other processes cost: the plate of the first example with its law inside the program, in `breccia serve` and in OpenSees.

servers.py BRECCIA PAGE   writes a table between the marks of a Markdown page (needs breccia-opensees beside BRECCIA)
"""

import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
import zlib

BRECCIA = os.path.abspath(sys.argv[1])
OPENSEES = os.path.join(os.path.dirname(BRECCIA), "breccia-opensees")
EXAMPLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "plate-with-crack", "clay.yaml")
STEPS, REPEATS, POINTS = 100, 3, 8910
INSIDE = "model: multi-yield-j2, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30 kPa"
SERVED = "remote: multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral strength=30"
IN_OPENSEES = "opensees: nDMaterial PressureIndependMultiYield $tag 3 1.5 6.0e4 1.0e5 31.8198051534 0.1 0. 100. 0. 20, stage: 1"
HEADER = struct.Struct("<4sHHIIIIII")


def start(program, address, *options):
    words = ([program, "serve"] if program == BRECCIA else [program]) + ["--listen", address, *options]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return process, process.stdout.readline().split()[-1]


def run(folder, material):
    """Seconds per step, and the servers of the summary."""
    with open(EXAMPLE, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"(?s)materials:.*?\n\n", f"materials: {{clay: {{{material}, density: 1.5}}}}\n\n", text, count=1)
    text = re.sub(r"(?s)\nwatch:.*", "\nresults: {number: 1}\n", text)
    text = text.replace("23000", str(STEPS))
    deck = os.path.join(folder, "plate.yaml")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(text)
    subprocess.run([BRECCIA, "run", deck], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(os.path.join(folder, "plate", "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return summary["wall_seconds"] / STEPS, summary.get("servers", [])


def one_by_one(address, command, requests=3000):
    """Seconds per request of one point, as the first example's paper sent them."""
    kind, _, rest = address.partition(":")
    if kind == "unix":
        line = socket.socket(socket.AF_UNIX)
        line.connect(rest)
    else:
        host, _, port = rest.strip("/").rpartition(":")
        line = socket.create_connection((host, int(port)))
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    number = session = 0

    def ask(operation, body=b"", count=0, flags=0):
        nonlocal number
        number += 1
        head = HEADER.pack(b"BRMS", 1, operation, number, flags, count, len(body), session, 0)[:28]
        line.sendall(head + struct.pack("<I", zlib.crc32(body, zlib.crc32(head))) + body)
        header = HEADER.unpack(line.recv(32, socket.MSG_WAITALL))
        if header[6]:
            line.recv(header[6], socket.MSG_WAITALL)
        return header

    ask(1, b"client: bench\n")
    session = ask(3, f"command: {command}\nstage: 1\nlength unit: m\nforce unit: kN\ntime unit: s\n".encode(), count=1)[7]
    begin = time.perf_counter()
    for k in range(requests):
        ask(5, struct.pack("<II6d", 0, 0, 1e-8 * k, 0, 0, 0, 0, 0), count=1, flags=1 if k else 0)
    seconds = (time.perf_counter() - begin) / requests
    line.close()
    return seconds


def write(page, lines):
    """Puts lines between the marks of a page."""
    with open(page, encoding="utf-8") as file:
        before, mark, rest = file.read().partition("<!-- bench -->\n")
        _, end, after = rest.partition("<!-- end of bench -->\n")
    if not mark or not end:
        sys.exit(f"{page}: the marks '<!-- bench -->' and '<!-- end of bench -->' are missing")
    with open(page, "w", encoding="utf-8") as file:
        file.write("\n".join([before + mark, *lines, "", end + after]))


def main():
    lines = []
    with tempfile.TemporaryDirectory(prefix="breccia-bench-") as folder:
        seconds = {}
        ways = {
            "inside the program": INSIDE,
            "breccia serve, zeros, unix": None,
            "breccia serve, unix": None,
            "breccia serve, tcp": None,
            "OpenSees, 1 process": f"{IN_OPENSEES}, processes: 1",
            "OpenSees, 2 processes": f"{IN_OPENSEES}, processes: 2",
        }
        kept = []
        for name, options in (("zeros, unix", ["--zeros"]), ("unix", []), ("tcp", [])):
            address = "tcp://127.0.0.1:0" if name == "tcp" else f"unix:{folder}/{len(kept)}"
            process, address = start(BRECCIA, address, *options)
            kept.append((process, address))
            ways[f"breccia serve, {name}"] = f"{SERVED}, server: ['{address}']"
        waited = {}
        for _ in range(REPEATS):
            for name, material in ways.items():
                taken, servers = run(folder, material)
                seconds.setdefault(name, []).append(taken)
                waited.setdefault(name, []).append(sum(s["waiting_share"] for s in servers))
        lines.append("| where the law runs | ms per step | µs per point and step more than inside the program | part of the time waited for servers | 23000 steps |")
        lines.append("|---|---|---|---|---|")
        median = {name: sorted(values)[REPEATS // 2] for name, values in seconds.items()}
        for name, value in median.items():
            beyond = 1e6 * (value - median["inside the program"]) / POINTS
            share = sorted(waited[name])[REPEATS // 2]
            lines.append(f"| {name} | {1e3 * value:.2f} | {beyond:.2f} | {100 * share:.0f} % | {23000 * value / 60:.1f} min |")
        alone, address = start(OPENSEES, f"unix:{folder}/alone")
        for name, where, command in (
            ("one point per request, breccia serve, unix", kept[1][1], "multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral strength=30"),
            ("one point per request, breccia serve, tcp", kept[2][1], "multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral strength=30"),
            ("one point per request, OpenSees, unix", address, "nDMaterial PressureIndependMultiYield $tag 3 1.5 6.0e4 1.0e5 31.8198051534 0.1 0. 100. 0. 20"),
        ):
            each = one_by_one(where, command)
            lines.append(f"| {name} | {1e3 * each * POINTS:.0f} | {1e6 * each:.0f} | | {23000 * each * POINTS / 3600:.1f} h |")
        lines += ["", f"8910 points, medians of {REPEATS} runs of {STEPS} steps, taken in turn; requests of one point: 3000 of them."]
        for process, _ in kept + [(alone, None)]:
            process.terminate()
    write(sys.argv[2], lines)


main()
