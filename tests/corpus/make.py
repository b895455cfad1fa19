# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs of the corpus that no tool makes.

    make.py mesh KIND FILE               a test mesh by the ending of FILE (.stl .off .obj .ply .3mf); KIND: see MESHES
    make.py part KIND MM FILE.off        a part near the edge of printing; KIND: see PARTS
    make.py array KIND FILE NZ NY NX     a ball's coverage, a dose and what scatters of it, ...; KIND: see KINDS; as .npy
                                         .npz .nrrd .tif by the ending of FILE
    make.py images FOLDER COUNT ROWS COLUMNS ENDING   numbered grey images (.png, .tif) of a bar that turns
    make.py disc FILE.png PIXELS RADIUS  a bright disc beside the middle
    make.py cut FILE SHARE OUT           the first bytes of a file
    make.py flip FILE PLACE OUT          a file with one byte changed
"""
import math
import os
import struct
import sys
import zipfile
import zlib

CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
        (1, 3, 7), (1, 7, 5)]


def box(low, high):
    """Twelve triangles, outwards. The corners' x is that of the first bit of their number from the left."""
    points = [[(high if c >> (2 - a) & 1 else low)[a] for a in range(3)] for c in range(8)]
    return [[points[i] for i in reversed(t)] for t in CUBE]


def cube(low, high):
    return box([low] * 3, [high] * 3)


def moved(triangles, x=0.0, y=0.0, z=0.0):
    return [[[v[0] + x, v[1] + y, v[2] + z] for v in t] for t in triangles]


def turned(triangles):
    return [[t[0], t[2], t[1]] for t in triangles]


def rod(diameter, low, high, sides=16, x=0.0, y=0.0):
    """An upright prism."""
    ring = [(x + diameter / 2 * math.cos(2 * math.pi * (k + 0.5) / sides),
             y + diameter / 2 * math.sin(2 * math.pi * (k + 0.5) / sides)) for k in range(sides)]
    triangles = []
    for k in range(sides):
        (ax, ay), (bx, by) = ring[k], ring[(k + 1) % sides]
        triangles += [[[ax, ay, low], [bx, by, low], [bx, by, high]], [[ax, ay, low], [bx, by, high], [ax, ay, high]],
                      [[x, y, low], [bx, by, low], [ax, ay, low]], [[x, y, high], [ax, ay, high], [bx, by, high]]]
    return triangles


def tube(outer, inner, low, high, sides=24):
    """An upright ring."""
    triangles = []
    for k in range(sides):
        a, b = 2 * math.pi * k / sides, 2 * math.pi * (k + 1) / sides
        p = [[[r / 2 * math.cos(t), r / 2 * math.sin(t), z] for t in (a, b)] for r in (outer, inner) for z in (low, high)]
        (ol, oh, il, ih) = p
        for u, v in ((ol, oh), (oh, ih), (ih, il), (il, ol)):
            triangles += [[u[0], u[1], v[1]], [u[0], v[1], v[0]]]
    return triangles


MESHES = {
    "cube": lambda: cube(-2, 2),
    "inside-out": lambda: turned(cube(-2, 2)),
    "lidless": lambda: cube(-2, 2)[:2] + cube(-2, 2)[4:],
    "hollow": lambda: cube(-2, 2) + turned(cube(-1, 1)),
    "nested": lambda: cube(-2, 2) + cube(-1, 1),
    "twice": lambda: cube(-2, 2) + cube(-2, 2)[:5],
    "overlap": lambda: box([-2, -2, -2], [1, 2, 2]) + box([-1, -1.5, -2.5], [2, 1.5, 1.5]),
    "far": lambda: moved(cube(-2, 2), 100, 100, 100),
    "near": lambda: moved(cube(-2, 2), 5.5),
    "sheet": lambda: cube(-2, 2)[:2],
    "empty": lambda: [],
    "nan": lambda: [[[0, 0, 0], [1, 0, 0], [0, float("nan"), 0]]],
    "point": lambda: [[[1, 1, 1]] * 3] * 4,
    "tiny": lambda: cube(-0.02, 0.02),
    "large": lambda: cube(-200, 200),
    "l": lambda: box([-2, -2, 0], [2, 0, 2]) + box([-2, 0, 0], [0, 2, 3]),
}

PARTS = {  # a base on which thin things stand, or what is between two bodies
    "sheet": lambda t: box([-1.6, -1.6, 0], [1.6, 1.6, 0.8]) + box([-t / 2, -1.2, 0.8], [t / 2, 1.2, 2.4]),
    "disc": lambda t: rod(2.4, 0, 0.8) + rod(3.2, 0.8, 0.8 + t) + rod(2.4, 0.8 + t, 1.6 + t),
    "pins": lambda d: box([-1.6, -1.6, 0], [1.6, 1.6, 0.8]) + [
        t for x in (-1, 0, 1) for y in (-0.8, 0.8) for t in rod(d, 0.8, 2.4, 12, x, y)],
    "gap": lambda g: box([-1.6, -1.6, 0], [1.6, 1.6, 1]) + box([-1.6, -1.6, 1 + g], [1.6, 1.6, 2 + g]),
    "slot": lambda g: box([-1.6, -1.6, 0], [1.6, 1.6, 0.8]) + box([-1.6, -1.6, 0.8], [-g / 2, 1.6, 2.4]) + box(
        [g / 2, -1.6, 0.8], [1.6, 1.6, 2.4]),
    "bore": lambda d: tube(3.2, d, 0, 1.6),
    "window": lambda w: box([-1.6, -0.5, 0], [1.6, 0.5, 0.7]) + box([-1.6, -0.5, 0.7], [-w / 2, 0.5, 0.7 + w]) + box(
        [w / 2, -0.5, 0.7], [1.6, 0.5, 0.7 + w]) + box([-1.6, -0.5, 0.7 + w], [1.6, 0.5, 1.4 + w]),
    "corner": lambda o: box([-1.4, -1.4, 0], [o, o, 1.4]) + box([0, 0, 1.4 - o], [1.4, 1.4, 2.8 - o]),
    "edge": lambda o: box([-1.4, -1, 0], [o, 1, 1.4]) + box([0, -1, 1.4 - o], [1.4, 1, 2.8 - o]),
    "neck": lambda d: rod(2.6, 0, 1) + rod(d, 1, 1.8, 12) + rod(2.6, 1.8, 2.8),
    "comb": lambda t: box([-1.6, -1.2, 0], [1.6, 1.2, 0.6]) + [
        v for k in range(4) for v in box([-1.4 + k * 0.8, -1.2, 0.6], [-1.4 + k * 0.8 + t, 1.2, 2])],
    "bridge": lambda t: box([-1.6, -0.7, 0], [-0.9, 0.7, 2]) + box([0.9, -0.7, 0], [1.6, 0.7, 2]) + box(
        [-1.6, -0.7, 2 - t], [1.6, 0.7, 2]),
    "tube": lambda t: tube(3, 3 - 2 * t, 0, 2),
}


def welded(triangles):
    points, faces = {}, []
    for t in triangles:
        faces.append([points.setdefault(tuple(v), len(points)) for v in t])
    return list(points), faces


def write_mesh(path, triangles):
    ending = os.path.splitext(path)[1]
    points, faces = welded(triangles)
    if ending == ".stl":
        with open(path, "wb") as out:
            out.write(bytes(80) + struct.pack("<I", len(triangles)))
            for t in triangles:
                out.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0))
        return
    if ending == ".3mf":
        body = '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>' \
            '<object id="1"><mesh><vertices>%s</vertices><triangles>%s</triangles></mesh></object></resources><build>' \
            '<item objectid="1"/></build></model>' % (
                "".join('<vertex x="%.9g" y="%.9g" z="%.9g"/>' % p for p in points),
                "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(f) for f in faces))
        with zipfile.ZipFile(path, "w") as out:
            out.writestr("3D/3dmodel.model", body)
        return
    with open(path, "w") as out:
        if ending == ".off":
            out.write("OFF\n%d %d 0\n" % (len(points), len(faces)))
            out.writelines("%.9g %.9g %.9g\n" % p for p in points)
            out.writelines("3 %d %d %d\n" % tuple(f) for f in faces)
        elif ending == ".obj":
            out.writelines("v %.9g %.9g %.9g\n" % p for p in points)
            out.writelines("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces)
        elif ending == ".ply":
            out.write("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (len(points), len(faces)))
            out.writelines("%.9g %.9g %.9g\n" % p for p in points)
            out.writelines("3 %d %d %d\n" % tuple(f) for f in faces)
        else:  # .ast: STL in words
            out.write("solid it\n")
            for t in triangles:
                out.write("facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n" % "".join(
                    "vertex %.9g %.9g %.9g\n" % tuple(v) for v in t))
            out.write("endsolid it\n")


def ball(k, j, i, nz, ny, nx):
    """Coverage of a ball in the middle, whose surface is two voxels wide."""
    r = math.dist((k, j, i), ((nz - 1) / 2, (ny - 1) / 2, (nx - 1) / 2))
    return min(1.0, max(0.0, (0.36 * min(nz, ny, nx) - r) / 2 + 0.5))


def ripple(k, j, i, *sizes):
    """A dose about a critical one of 50."""
    return 50 + 15 * math.sin(0.6 * i) * math.cos(0.5 * j) * math.sin(0.5 * k)


KINDS = {
    "ball": lambda *at: ball(*at),
    "ramp": lambda k, j, i, nz, ny, nx: (k * ny * nx + j * nx + i) % 101,
    "dose": lambda *at: ripple(*at),
    "scatter": lambda *at: 0.08 / (1 + math.exp((50 - 0.9 * ripple(*at)) / 4)),
    "uneven": lambda k, *at: 0.08 / (1 + math.exp((50 - (0.85 + 0.15 * k / at[2]) * ripple(k, *at)) / 4)),
    "stairs": lambda k, *at: 20 + 6 * (k // 6),
    "risen": lambda k, *at: 0.08 / (1 + math.exp((50 - 20 - 6 * (k // 6)) / 4)),
    "peak": lambda k, j, i, nz, ny, nx: max(0.0, 100 - 3 * math.dist((k, j, i), ((nz - 1) / 2, (ny - 1) / 2, (nx - 1) / 2))),
    "band": lambda *at: 0.3,
}


def write_array(kind, path, nz, ny, nx):
    values = [KINDS[kind](k, j, i, nz, ny, nx) for k in range(nz) for j in range(ny) for i in range(nx)]
    raw, ending = struct.pack("<%df" % len(values), *values), os.path.splitext(path)[1]
    text = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, %d), }" % (nz, ny, nx)
    text += " " * (63 - (10 + len(text)) % 64) + "\n"
    npy = b"\x93NUMPY\1\0" + struct.pack("<H", len(text)) + text.encode() + raw
    if ending == ".npz":
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
            for name, data in (("part.npy", npy), ("other.npy", npy[:-4] + struct.pack("<f", 0.5))):
                out.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)  # which has no time of today
        return
    with open(path, "wb") as out:
        if ending == ".nrrd":
            out.write(("NRRD0004\ntype: float\ndimension: 3\nencoding: raw\nendian: little\nsizes: %d %d %d\n"
                       "spacings: 0.25 0.25 0.25\n\n" % (nx, ny, nz)).encode() + raw)
        elif ending == ".tif":
            out.write(tiff([values[k * ny * nx:(k + 1) * ny * nx] for k in range(nz)], ny, nx))
        else:
            out.write(npy)


def tiff(pages, rows, columns):
    """Pages of 8 bits, of values from 0 to 1."""
    data, at = b"II*\0" + struct.pack("<I", 8), 8
    for number, page in enumerate(pages):
        entries = [(256, 3, 1, columns), (257, 3, 1, rows), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1),
                   (273, 4, 1, at + 2 + 12 * 9 + 4), (277, 3, 1, 1), (278, 3, 1, rows), (279, 4, 1, rows * columns)]
        size = 2 + 12 * len(entries) + 4 + rows * columns
        size += size & 1
        head = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries)
        head += struct.pack("<I", at + size if number + 1 < len(pages) else 0)
        data += (head + bytes(max(0, min(255, round(255 * v))) for v in page)).ljust(size, b"\0")
        at += size
    return data


def png(rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def write_images(folder, count, rows, columns, ending):
    os.mkdir(folder)
    for n in range(count):
        turn = 2 * math.pi * n / count
        image = []
        for y in range(rows):
            v = (y - (rows - 1) / 2) / rows * 2
            middle, half = columns / 2 + 0.25 * columns * math.cos(turn), columns / 10 * (1.2 - v * v)
            image.append([round(255 * max(0.0, min(1.0, half - abs(x - middle) + 0.5))) for x in range(columns)])
        with open("%s/%04d%s" % (folder, n, ending), "wb") as out:
            out.write(png(image) if ending == ".png" else tiff([[v / 255 for row in image for v in row]], rows, columns))


def main(verb, *words):
    if verb == "mesh":
        write_mesh(words[1], MESHES[words[0]]())
    elif verb == "part":
        write_mesh(words[2], PARTS[words[0]](float(words[1])))
    elif verb == "array":
        write_array(words[0], words[1], *map(int, words[2:]))
    elif verb == "images":
        write_images(words[0], *map(int, words[1:4]), words[4])
    elif verb == "disc":
        count, radius = int(words[1]), float(words[2])
        with open(words[0], "wb") as out:
            out.write(png([[200 if math.hypot(x - count / 2 - 2, y - count / 2 + 3) < radius else 20 for x in range(count)]
                           for y in range(count)]))
    elif verb in ("cut", "flip"):
        data = bytearray(open(words[0], "rb").read())
        place = int(float(words[1]) * len(data))
        if verb == "cut":
            data = data[:place]
        else:
            data[place] ^= 0x5A
        open(words[2], "wb").write(data)
    else:
        raise SystemExit("make.py: no verb " + verb)


main(*sys.argv[1:])
