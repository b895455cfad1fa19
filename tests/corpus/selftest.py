# SPDX-License-Identifier: GPL-3.0-or-later
"""That the figures see small changes wherever they are, and that they do not see rounding: asked by each run."""
import array
import math
import os
import random
import struct
import tempfile
import zlib

import figures
from differences import differences

TOLERANCE = [1e-5, 1e-4, 0]


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(rows, depth):
    width, code = len(rows[0]), {8: "B", 16: "H"}[depth]
    raw = b"".join(b"\0" + struct.pack(">%d%s" % (width, code), *row) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), depth, 0, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def seen(before, after):
    return any(True for _ in differences(before, after, TOLERANCE))


def changes(nx, ny, nz):
    """{what: the change of the value at (x, y, z), in parts of the largest, neither of the least nor of the greatest}"""
    flat = {"every other %s" % word: lambda at, i=i: 1e-4 if at[i] % 2 else -1e-4
            for i, word in enumerate(("column", "row or angle", "slice"))}
    pairs = {"every other pair of %s" % word: lambda at, i=i: 1e-5 if at[i] // 2 % 2 else -1e-5
             for i, word in enumerate(("columns", "rows or angles", "slices"))}
    return {**flat, **pairs, "all values": lambda at: 3e-6, "one slice": lambda at: 1e-5 if at[2] == nz // 2 else 0,
            "one value": lambda at: 2e-5 if at == (nx // 3, ny // 3, nz // 3) else 0,
            "a shift to the next column": lambda at: 1e-4 * (at[0] == nx // 3) - 1e-4 * (at[0] == nx // 3 + 1)}


def volume_blind(nx, ny, nz):
    places = [(x, y, z) for z in range(nz) for y in range(ny) for x in range(nx)]
    dose = [math.exp(-((x - nx / 2) ** 2 + (y - ny / 2) ** 2) / (nx * ny / 9)) * (1 + 0.2 * math.sin(z)) for x, y, z in places]
    largest, before = max(dose), figures.values_of(array.array("f", dose))
    between = [all(0.2 < v / largest < 0.9 for v in dose[i // 2 * 2:i // 2 * 2 + 2]) for i in range(len(dose))]
    for what, change in changes(nx, ny, nz).items():
        after = array.array("f", (v + largest * change(at) * free for v, at, free in zip(dose, places, between)))
        if not seen(before, figures.values_of(after)):
            return "%s of %d x %d x %d values" % (what, nx, ny, nz)
    chance = random.Random(7)
    after = array.array("f", (v * (1 + 1e-7 * chance.uniform(-1, 1)) for v in dose))
    if seen(before, figures.values_of(after)):
        return "rounding of %d x %d x %d values as such" % (nx, ny, nz)
    return ""


def frames_blind(depth):
    """Of one level of one pixel, and of one more in every pixel."""
    with tempfile.TemporaryDirectory() as folder:
        def record(change):
            for n in range(4):
                with open("%s/%d.png" % (folder, n), "wb") as out:
                    out.write(png([[10 + 40 * n + x + (change(n, x, y)) for x in range(30)] for y in range(20)], depth))
            return figures.frames_of(folder, sorted(os.listdir(folder)))
        before = record(lambda *at: 0)
        for what, change in (("one level of one pixel", lambda *at: at == (1, 7, 9)), ("a level more", lambda *at: 1),
                             ("every other row a level", lambda n, x, y: 1 if y % 2 else -1)):
            if not seen(before, record(change)):
                return "%s in frames of %d bits" % (what, depth)
    return ""


def blind():
    """What the figures do not see; empty, as it should be."""
    return volume_blind(32, 32, 12) or volume_blind(84, 84, 4) or volume_blind(64, 64, 8) or frames_blind(8) or frames_blind(16)
