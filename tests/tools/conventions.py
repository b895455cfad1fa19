# SPDX-License-Identifier: GPL-3.0-or-later
"""Three blobs as other programs keep them, by the formulas of their sources, and where they come out.

    conventions.py make PROGRAM     volume.npy and projections.npy
    conventions.py high FILE X,Y    of [z][y][x] with its first voxel there in mm: is it highest at the blobs?
"""
import struct
import sys
from math import cos, dist, exp, pi, prod, sin

H, W, NZ, N = 0.25, 28, 12, 36  # mm, columns, slices, angles
BLOBS = ((2.0, 0.5, 0.375, 1.0), (-1.0, 1.75, -0.625, 0.9), (0.25, -1.5, 0.625, 0.8))  # x, y, z, weight


def save(path, shape, value):
    text = "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }" % (shape,)
    text += " " * (63 - (10 + len(text)) % 64) + "\n"
    places = [(a, b, c) for a in range(shape[0]) for b in range(shape[1]) for c in range(shape[2])]
    values = [value(*place) for place in places]
    with open(path, "wb") as out:
        out.write(b"\x93NUMPY\1\0" + struct.pack("<H", len(text)) + text.encode())
        out.write(struct.pack("<%df" % len(values), *values))


def load(path):
    data = open(path, "rb").read()
    size = struct.unpack("<H", data[8:10])[0]
    shape = eval(data[10:10 + size])["shape"]
    return shape, struct.unpack("<%df" % prod(shape), data[10 + size:])


def at(x, y, z):
    return sum(w * exp(-dist((x, y, z), p) ** 2 / 0.18) for *p, w in BLOBS)


def seen(t, z, column):  # column(x, y): where a line through the blob meets the columns
    return sum(w * exp(-((t - column(x, y)) ** 2 + (z - p) ** 2) / 0.18) for x, y, p, w in BLOBS)


def make(program):
    middle, half, rows_are_x = (W - 1) / 2, W // 2, "stl" in program
    z = lambda k: (k - (NZ - 1) / 2) * H
    if program in ("drtvam", "swissvamyknife"):  # columns along (-sin a, cos a)
        across = lambda n: lambda x, y: y * cos(2 * pi * n / N) - x * sin(2 * pi * n / N)
        c, last = (middle, (1,)) if program == "drtvam" else (half, ())
        save("volume.npy", (NZ, W, W) + last, lambda k, j, i: at((i - c) * H, (j - c) * H, z(k)))
        if program == "drtvam":
            save("projections.npy", (N, NZ, W), lambda n, row, i: seen((i - middle) * H, -z(row), across(n)))
        else:  # Julia's [t][angle][z] in the order of HDF5
            save("projections.npy", (NZ, N, W), lambda k, n, i: seen((i - middle) * H, z(k), across(n)))
        return
    c = middle if program.endswith(("astra", "cuda")) else half

    def column(n):
        def of(x, y):
            row, col = (x, y) if rows_are_x else (y, x)
            if program.endswith("cuda"):
                return row * cos(2 * pi * n / N) + col * sin(2 * pi * n / N)
            return col * cos(2 * pi * n / N) - row * sin(2 * pi * n / N)
        return of
    place = lambda j, i: ((j - c) * H, (i - c) * H) if rows_are_x else ((i - c) * H, (j - c) * H)
    save("volume.npy", (W, W, NZ), lambda j, i, k: at(*place(j, i), z(k)))
    save("projections.npy", (W, N, NZ), lambda i, n, k: seen((i - c) * H, z(k), column(n)))


def high(path, corner):
    (_, ny, nx), values = load(path)
    x, y = (float(mm) for mm in corner.split(","))
    places = [(x + H * (n % nx), y + H * (n // nx % ny), H * (n // (nx * ny) - (NZ - 1) / 2))
              for n in range(len(values))]
    least = min(max(v for p, v in zip(places, values) if dist(p, blob[:3]) < H) for blob in BLOBS)
    print(least > max(v for p, v in zip(places, values) if all(dist(p, blob[:3]) > 3 * H for blob in BLOBS)))


{"make": make, "high": high}[sys.argv[1]](*sys.argv[2:])
