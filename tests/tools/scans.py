# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders of images as a camera would take them in a calibration scan, for tests, by formulas of their own.

    scans.py sweep DIR axis=511.5 radius=12.7 columns=1024 pitch=8 width=4    a lit line across a vial in air
    scans.py ramp DIR gamma=2.2 each=4 full=50000                             17 levels, clipped at 65535
    scans.py flat DIR                                                        an even scene, vignetted
    scans.py beam DIR                                                        a line on a sensor, plane by plane
    scans.py turn DIR axis=60 wobble=2 phase=40                               a vial that runs out of true
"""
import math
import os
import random
import struct
import sys
import zlib


def write_png(path, rows, bits=16):
    kind, full = ">%d" + ("H" if bits == 16 else "B"), (1 << bits) - 1
    raw = b"".join(b"\0" + struct.pack(kind % len(row), *[min(full, max(0, round(v))) for v in row]) for row in rows)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 1)) + chunk(b"IEND", b""))


def enter(x, lens, radius, turn, n=1.53):
    """A chief ray in a vial in air: where it enters it, its direction there, how much of it goes in; by vectors."""
    along = math.hypot(x, lens)
    dx, dy = x / along, lens / along
    b = -lens * dy
    s = -b - math.sqrt(b * b - lens * lens + radius * radius)
    px, py = dx * s, dy * s - lens
    nx, ny = px / radius, py / radius
    before = -(dx * nx + dy * ny)
    after = math.sqrt(1 - (1 - before * before) / (n * n))
    k = before / n - after
    dx, dy = dx / n + k * nx, dy / n + k * ny
    across = (before - n * after) / (before + n * after)
    level = (n * before - after) / (n * before + after)
    c, s = math.cos(turn), math.sin(turn)
    return c * px - s * py, s * px + c * py, c * dx - s * dy, s * dx + c * dy, 1 - (across ** 2 + level ** 2) / 2


def seen(sheet, sights):
    """What all lines of sight of a camera get of a sheet of light, each where the two cross, if that is in the vial."""
    px, py, dx, dy, passed = sheet
    length = -2 * (px * dx + py * dy)
    light = 0
    for qx, qy, ex, ey, weight in sights:
        slant = dx * ey - dy * ex
        u = ((qx - px) * ey - (qy - py) * ex) / slant
        v = ((qx - px) * dy - (qy - py) * dx) / slant
        if 0 < u < length and 0 < v < -2 * (qx * ex + qy * ey):
            light += weight / abs(slant)
    return passed * light


def glow(job, nodes=150, views=600):
    """A function of the column, from the axis: the image's light, from a camera at 90 degrees, 200 mm away."""
    radius, lens, camera = job["radius"], 1.8 * job["columns"] * 0.065, 200
    tangent = lambda distance: radius / math.sqrt(1 - (radius / distance) ** 2) * (1 - 1e-9)
    sights = []
    for i in range(views):
        angle = math.pi * (i + 0.5) / views
        *ray, passed = enter(-tangent(camera) * math.cos(angle), camera, radius, math.pi / 2)
        sights.append((*ray, passed * math.sin(angle) * math.pi / views / 2))
    edge = tangent(lens)
    table = {side: [seen(enter(side * edge * (1 - (i / nodes) ** 2), lens, radius, 0), sights)
                    for i in range(nodes + 1)] for side in (-1, 1)}

    def at(x_px):
        depth = 1 - abs(x_px) * 0.065 / edge
        if depth <= 0:
            return 0
        side, place = (1 if x_px > 0 else -1), min(math.sqrt(depth) * nodes, nodes - 1e-9)
        i = int(place)
        return (i + 1 - place) * table[side][i] + (place - i) * table[side][i + 1]
    return at


def sweep(job):
    at = glow(job)
    for n in range(0, (job["columns"] + job["pitch"] - 1) // job["pitch"]):
        light = 0
        for k in range(40):
            for z in (-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2):
                light += math.exp(-z * z / 2) * at(n * job["pitch"] - 0.5 + job["width"] * (k + 0.5) / 40 + 1.2 * z -
                                                   job["axis"])
        yield [[3000 + 60 * light + random.gauss(0, 300) for _ in range(40)] for _ in range(20)]


def ramp(job):
    for level in range(17):
        for _ in range(job["each"]):
            light = 500 + job["full"] * (round(level / 16 * 255) / 255) ** job["gamma"] * random.gauss(1, 0.003)
            yield [[light + random.gauss(0, 100) for _ in range(12)] for _ in range(8)]


def flat(job):
    for _ in range(8):
        yield [[40000 * (1 - 0.2 * ((x - 16) ** 2 + (y - 12) ** 2) / 400) + random.gauss(0, 300) for x in range(32)]
               for y in range(24)]


def edge(x, at, blur):
    return 0.5 * math.erfc((at - x) / blur / math.sqrt(2))


def beam(job):
    for plane in range(-5, 6):
        half = 0.5 * math.hypot(0.06, 0.0112 * 1.27 * plane) / 0.0035
        yield [[2000 + 40000 * (edge(x, 80 - half, 1.5) - edge(x, 80 + half, 1.5)) + random.gauss(0, 400)
                for x in range(160)] for _ in range(32)]


def turn(job):
    for n in range(36):
        middle = job["axis"] + job["wobble"] * math.cos(math.radians(10 * n - job["phase"]))
        yield [[2000 + 40000 * (edge(x, middle - 30, 1) - edge(x, middle + 30, 1)) + random.gauss(0, 400)
                for x in range(130)] for _ in range(20)]


def main(verb, folder, *rest):
    random.seed(1)
    job = dict(axis=511.5, radius=12.7, columns=1024, pitch=8, width=4, gamma=2.2, each=4, wobble=2.0, phase=40.0, full=50000.0)
    for pair in rest:
        key, value = pair.split("=")
        job[key] = int(value) if key in ("columns", "pitch", "width", "each") else float(value)
    os.makedirs(folder)
    for n, rows in enumerate({"sweep": sweep, "ramp": ramp, "flat": flat, "beam": beam, "turn": turn}[verb](job)):
        write_png(os.path.join(folder, "%05d.png" % n), rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
