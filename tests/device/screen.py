"""The picture on an Xvfb screen, read from its memory-mapped file (Xvfb -fbdir), without asking the X server.
usage: screen.py FILE now                 prints "black" or the number of lit pixels
       screen.py FILE watch SECONDS IDLE  prints each new picture as hex of its grey bytes; ends after SECONDS, or when
                                          the screen was lit once and then black for IDLE seconds
       screen.py FILE compare FRAMES SEEN prints "exact" or "different", and how many of the frames (a folder of PNGs or
                                          a lossless video) were seen"""

import mmap
import pathlib
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
                raise ValueError("a pixel is not grey, or half a picture was read")
            rows.append(row[0::4])
        return b"".join(rows)


def settled(screen):
    """A picture that two readings agree on: an update may be under way."""
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
        picture = settled(screen)
        if any(picture):
            lit_at = time.monotonic()
        if picture not in seen:
            seen.add(picture)
            print(picture.hex())
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
    lit = [picture for picture in seen if any(picture)]
    known = [picture for picture in lit if picture in frames]
    print("exact" if lit and len(known) == len(lit) else "different", len(known), len(lit), len(frames))


def main():
    screen = sys.argv[1]
    if sys.argv[2] == "now":
        lit = sum(1 for value in settled(Screen(screen)) if value)
        print(lit or "black")
    elif sys.argv[2] == "watch":
        watch(Screen(screen), float(sys.argv[3]), float(sys.argv[4]))
    else:
        compare(sys.argv[3], sys.argv[4])


if __name__ == "__main__":
    main()
