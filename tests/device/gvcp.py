# SPDX-License-Identifier: GPL-3.0-or-later
"""A GigE Vision client of a few lines, after the control protocol of the standard (GigE Vision: GVCP and the
bootstrap registers), without Aravis. usage: gvcp.py ADDRESS. Prints what a camera that nobody has set up
says of itself as JSON."""

import json
import socket
import struct
import sys
import time

READ_REGISTER, WRITE_REGISTER, READ_MEMORY = 0x80, 0x82, 0x84
PRIVILEGE, CONTROL = 0x0A00, 2
MAKER, MODEL = 0x0048, 0x0068
TICKS_HIGH, TICKS_LOW, TIMESTAMP_CONTROL, LATCH, TIMESTAMP = 0x093C, 0x0940, 0x0944, 2, 0x0948
GAIN_RAW, GAIN_AUTO = 0x110, 0x114  # of this model's own description


class Camera:
    def __init__(self, address):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((address, 3956))
        self.socket.settimeout(2)
        self.count = 0

    def ask(self, command, payload):
        self.count += 1
        self.socket.send(struct.pack(">BBHHH", 0x42, 0x01, command, len(payload), self.count) + payload)
        answer = self.socket.recv(1024)
        status, _, _, number = struct.unpack(">HHHH", answer[:8])
        assert number == self.count
        return status, answer[8:]

    def register(self, place):
        return struct.unpack(">I", self.ask(READ_REGISTER, struct.pack(">I", place))[1])[0]

    def write(self, place, value):
        return self.ask(WRITE_REGISTER, struct.pack(">II", place, value))[0]

    def memory(self, place, size):
        return self.ask(READ_MEMORY, struct.pack(">IHH", place, 0, size))[1][4:]

    def text(self, place):
        return self.memory(place, 32).split(b"\0")[0].decode()

    def latched_s(self):
        """The camera's clock, and half the time that asking took."""
        rate = self.register(TICKS_HIGH) << 32 | self.register(TICKS_LOW)
        before = self.memory(TIMESTAMP, 8)
        start = time.monotonic()
        self.write(TIMESTAMP_CONTROL, LATCH)
        while self.memory(TIMESTAMP, 8) == before:
            pass
        now = struct.unpack(">Q", self.memory(TIMESTAMP, 8))[0]
        return now / rate, start, time.monotonic()


def main():
    camera = Camera(sys.argv[1])
    camera.write(PRIVILEGE, CONTROL)
    first, begin, _ = camera.latched_s()
    time.sleep(0.3)
    still = camera.memory(TIMESTAMP, 8) == camera.memory(TIMESTAMP, 8)
    second, _, end = camera.latched_s()
    print(json.dumps({"maker": camera.text(MAKER), "model": camera.text(MODEL),
                      "gain_auto": camera.register(GAIN_AUTO) != 1, "latched_until_next": still,
                      "since_power_on_s": first, "clock": 0.3 <= second - first <= end - begin}))
    camera.write(PRIVILEGE, 0)


main()
