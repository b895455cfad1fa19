"""Folders of pictures as a camera would take them in a calibration scan, for tests, by formulas of their own.

    scans.py sweep DIR axis=511.5 radius=12.7 columns=1024 pitch=8 width=4    a lit line across a vial in air
    scans.py ramp DIR gamma=2.2 each=4                                        17 levels
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


def write_png(path, rows):
    raw = b"".join(b"\0" + struct.pack(">%dH" % len(row), *[min(65535, max(0, round(v))) for v in row]) for row in rows)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 16, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 1)) + chunk(b"IEND", b""))


def glow(x_px, job):
    """Transmittance times chord of one ray into a vial of n = 1.53 in air, both polarisations, angles by Snell."""
    x, lens, n, radius = x_px * 0.065, 1.8 * job["columns"] * 0.065, 1.53, job["radius"]
    b = abs(x) * math.cos(math.atan(x / lens))
    if b >= radius:
        return 0
    outside, inside = math.asin(b / radius), math.asin(b / radius / n)
    if outside < 1e-9:
        return 1 - ((n - 1) / (n + 1)) ** 2
    s = (math.sin(outside - inside) / math.sin(outside + inside)) ** 2
    p = (math.tan(outside - inside) / math.tan(outside + inside)) ** 2
    return (1 - (s + p) / 2) * math.cos(inside)


def sweep(job):
    table = [glow(0.1 * i, job) for i in range(int(14 * job["radius"] / 0.065))]
    for n in range(0, (job["columns"] + job["pitch"] - 1) // job["pitch"]):
        light = 0
        for k in range(40):
            for z in (-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2):
                x = abs(n * job["pitch"] - 0.5 + job["width"] * (k + 0.5) / 40 + 1.2 * z - job["axis"])
                i = int(10 * x)
                if i + 1 < len(table):
                    light += math.exp(-z * z / 2) * ((i + 1 - 10 * x) * table[i] + (10 * x - i) * table[i + 1])
        yield [[3000 + 60 * light + random.gauss(0, 300) for _ in range(40)] for _ in range(20)]


def ramp(job):
    for level in range(17):
        for _ in range(job["each"]):
            light = 500 + 50000 * (round(level / 16 * 255) / 255) ** job["gamma"] * random.gauss(1, 0.003)
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
    job = dict(axis=511.5, radius=12.7, columns=1024, pitch=8, width=4, gamma=2.2, each=4, wobble=2.0, phase=40.0)
    for pair in rest:
        key, value = pair.split("=")
        job[key] = int(value) if key in ("columns", "pitch", "width", "each") else float(value)
    os.makedirs(folder)
    for n, rows in enumerate({"sweep": sweep, "ramp": ramp, "flat": flat, "beam": beam, "turn": turn}[verb](job)):
        write_png(os.path.join(folder, "%05d.png" % n), rows)


main(*sys.argv[1:])
