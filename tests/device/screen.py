# SPDX-License-Identifier: GPL-3.0-or-later
"""The image on an Xvfb screen: now from its memory-mapped file (Xvfb -fbdir), which tells how late it is, without
asking the X server; to watch it by the X server of $DISPLAY, which never shows half an update.
usage: screen.py FILE now                 prints "black" or the number of lit pixels
       screen.py FILE watch SECONDS IDLE  prints each new image as hex of its grey bytes; ends after SECONDS, or when
                                          the screen was lit once and then black for IDLE seconds
       screen.py FILE compare FRAMES SEEN prints "exact" or "different", and how many of the frames (a folder of PNGs or
                                          a lossless video) were seen"""

import mmap
import os
import pathlib
import socket
import struct
import subprocess
import sys
import time


class Screen:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        header = struct.unpack(">25I", self.memory[:100])
        self.width, self.height, self.line = header[4], header[5], header[12]
        self.offset = header[0] + 12 * header[19]  # header and colour map

    def grey(self):
        """Row-major bytes; raises when a pixel is not grey."""
        rows = []
        for y in range(self.height):
            start = self.offset + y * self.line
            row = self.memory[start:start + 4 * self.width]
            if row[0::4] != row[1::4] or row[1::4] != row[2::4]:
                raise ValueError("a pixel is not grey, or half an image was read")
            rows.append(row[0::4])
        return b"".join(rows)


class Server:
    """The same image by way of the X server (X protocol 11, GetImage), which answers between two updates: never half
    an image, however late it is itself."""

    def __init__(self, display):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect("/tmp/.X11-unix/X" + display.lstrip(":").split(".")[0])
        self.socket.sendall(struct.pack("<BxHHHHxx", ord("l"), 11, 0, 0, 0))
        status, length = struct.unpack("<BxxxxxH", self.receive(8))
        if status != 1:
            raise ConnectionError("the X server refuses the connection")
        facts = self.receive(4 * length)
        vendor, formats = struct.unpack_from("<H", facts, 16)[0], facts[21]
        root = 32 + (vendor + 3) // 4 * 4 + 8 * formats  # of the first screen
        self.root, = struct.unpack_from("<I", facts, root)
        self.width, self.height = struct.unpack_from("<HH", facts, root + 20)

    def receive(self, count):
        data = b""
        while len(data) < count:
            more = self.socket.recv(count - len(data))
            if not more:
                raise ConnectionError("the X server has gone")
            data += more
        return data

    def grey(self):
        self.socket.sendall(struct.pack("<BBHIhhHHI", 73, 2, 5, self.root, 0, 0, self.width, self.height, 0xFFFFFFFF))
        kind, length = struct.unpack_from("<BxxxI", self.receive(32))
        if kind != 1:
            raise ValueError("the X server shows no image")
        pixels = self.receive(4 * length)
        if pixels[0::4] != pixels[1::4] or pixels[1::4] != pixels[2::4]:
            raise ValueError("a pixel is not grey")
        return pixels[0::4]


def settled(screen):
    """An image that two readings agree on: an update may be under way."""
    while True:
        try:
            first = screen.grey()
            if first == screen.grey():
                return first
        except ValueError:
            pass


def watch(screen, seconds, idle):
    seen = set()
    end = time.monotonic() + seconds
    lit_at = None
    while time.monotonic() < end and (lit_at is None or time.monotonic() < lit_at + idle):
        image = screen.grey()
        if any(image):
            lit_at = time.monotonic()
        if image not in seen:
            seen.add(image)
            print(image.hex())
        time.sleep(0.004)


def raw_grey(path):
    return subprocess.run(["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                          check=True, capture_output=True).stdout


def compare(path, seen_path):
    seen = [bytes.fromhex(line) for line in open(seen_path)]
    if pathlib.Path(path).is_dir():
        frames = {raw_grey(file) for file in pathlib.Path(path).glob("*.png")}
    else:
        video, size = raw_grey(path), len(seen[0])
        frames = {video[at:at + size] for at in range(0, len(video), size)}
    lit = [image for image in seen if any(image)]
    known = [image for image in lit if image in frames]
    print("exact" if lit and len(known) == len(lit) else "different", len(known), len(lit), len(frames))


def main():
    screen = sys.argv[1]
    if sys.argv[2] == "now":
        lit = sum(1 for value in settled(Screen(screen)) if value)
        print(lit or "black")
    elif sys.argv[2] == "watch":
        watch(Server(os.environ["DISPLAY"]), float(sys.argv[3]), float(sys.argv[4]))
    else:
        compare(sys.argv[3], sys.argv[4])


if __name__ == "__main__":
    main()
