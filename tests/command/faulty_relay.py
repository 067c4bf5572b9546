"""A relay between a client and a material server that spoils the answer to the N-th trial.

faulty_relay.py OWN_SOCKET SERVER_SOCKET FAULT N
"""

import os
import signal
import socket
import struct
import sys
import time
import zlib

HEADER = struct.Struct("<4sHHIIIIII")
TRIAL = 5


def read(connection, size):
    data = b""
    while len(data) < size:
        piece = connection.recv(size - len(data))
        if not piece:
            raise ConnectionResetError
        data += piece
    return data


def seal(header, body):
    head = HEADER.pack(*header[:8], 0)[:28]
    return head + struct.pack("<I", zlib.crc32(body, zlib.crc32(head))) + body


def spoil(fault, header, body):
    header = list(header)
    if fault == "close":
        sys.exit(0)
    if fault == "hang":
        time.sleep(1000)
    if fault == "late":
        time.sleep(0.5)
    if fault == "length":
        header[6] = 1 << 30
        return HEADER.pack(*header[:8], 0)
    if fault == "short":
        body = body[:-8]
        header[6] -= 8
    if fault == "sequence":
        header[3] += 7
    if fault == "version":
        header[1] = 9
    if fault == "nan":
        body = struct.pack("<d", float("nan")) + body[8:]
    if fault == "garbage":
        return b"HTTP/1.0 200 OK\r\nContent-Length: 20\r\n\r\n"
    frame = seal(header, body)
    if fault == "damage":
        frame = frame[:-1] + bytes([frame[-1] ^ 1])
    return frame


def relay(client, own, server, fault, wanted):
    """Until one of them leaves. @return how many trials are still to come before the wanted one"""
    target = socket.socket(socket.AF_UNIX)
    target.connect(server)
    open(own + ".connected", "w").close()
    try:
        while True:
            head = read(client, HEADER.size)
            asked = HEADER.unpack(head)
            target.sendall(head + read(client, asked[6]))
            head = read(target, HEADER.size)
            header = HEADER.unpack(head)
            frame = head + read(target, header[6])
            wanted -= asked[2] == TRIAL
            if asked[2] == TRIAL and wanted == 0:
                frame = spoil(fault, header, frame[HEADER.size :])
            client.sendall(frame)
    except OSError:
        pass
    client.close()
    target.close()
    return wanted


def main():
    own, server, fault, wanted = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
    signal.alarm(1500)
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(own + ".new")
    listener.listen(1)
    os.rename(own + ".new", own)  # whoever sees it can connect
    while True:
        client, _ = listener.accept()
        if fault in ("close", "hang"):  # whoever comes later finds nobody
            os.unlink(own)
        wanted = relay(client, own, server, fault, wanted)


main()
