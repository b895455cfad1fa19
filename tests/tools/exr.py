# SPDX-License-Identifier: GPL-3.0-or-later
"""Multi-part EXR stacks, plain or run-length coded, by the published format alone, for tests: an independent writer and
reader.

    exr.py make FILE [key=value...]   a sinogram stack; keys: count width height pixel row space kind step value reach
                                      printer (vam:printer; none) full_scale shown_turns (vam:...)
    exr.py image FILE width height LEVEL   one image alone, as other programs write it; LEVEL is an expression of x and y
    exr.py sum FILE                   "parts width height sum" of a stack written to a pipe
    exr.py get FILE part column row   one pixel
    exr.py attr FILE name             one attribute of part 0
"""
import math
import struct
import sys


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def text(name, value):
    return attribute(name, "string", value.encode())


def number(name, value):
    return attribute(name, "double", struct.pack("<d", value))


def printer(job):
    """One with the axis in its middle."""
    return "projector.columns=%d projector.pixel_mm=%g projector.axis_column=%g" % (
        job["width"], job["pixel"], (job["width"] - 1) / 2)


def plain(width, height):
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"Y\0" + struct.pack("<i4B2i", 2, 0, 0, 0, 0, 1, 1) + b"\0"
    return b"".join([
        attribute("channels", "chlist", channels),
        attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))])


def image(path, width, height, level):
    rows = [struct.pack("<2i%df" % width, y, 4 * width, *[eval(level, {"x": x, "y": y}) for x in range(width)])
            for y in range(height)]
    head = struct.pack("<2i", 20000630, 2) + plain(width, height) + b"\0"
    places = [len(head) + 8 * height + y * len(rows[0]) for y in range(height)]
    open(path, "wb").write(head + struct.pack("<%dQ" % height, *places) + b"".join(rows))


def header(index, job):
    return b"".join([
        plain(job["width"], job["height"]),
        text("name", "%s%04d" % ("z" if job["kind"] == "sinogram" else "a", index)),
        text("type", "scanlineimage"),
        attribute("chunkCount", "int", struct.pack("<i", job["height"])),
        text("vam:kind", job["kind"]), text("vam:space", job["space"]), text("vam:history", "made by a test"),
        attribute("vam:count", "int", struct.pack("<i", job["count"])),
        attribute("vam:index", "int", struct.pack("<i", index)),
        *(text("vam:" + key, "%g" % job[key]) for key in ("full_scale", "shown_turns") if job[key]),
        b"" if job["printer"] == "none" else text("vam:printer", job["printer"] or printer(job)),
        number("vam:pixel_mm", job["pixel"]), number("vam:row_mm", job["row"]),
        number("vam:z_mm", index * job["row"]), number("vam:angle_start_deg", 0),
        number("vam:angle_step_deg", job["step"] or 360 / job["height"]), b"\0"])


def blob_row(job, index, a):
    """Line integrals of a Gaussian off the axis, scaled by the slice's number; or a constant."""
    if job["value"] is not None:
        return struct.pack("<%df" % job["width"], *[job["value"]] * job["width"])
    theta = 2 * math.pi * a / job["height"]
    middle = (job["width"] - 1) / 2
    place = job["reach"] * job["width"] * math.cos(theta)
    sigma = job["width"] / 12
    return struct.pack("<%df" % job["width"], *[
        (1 + index % 7) * math.exp(-0.5 * ((c - middle - place) / sigma) ** 2) for c in range(job["width"])])


def make(path, job):
    with (sys.stdout.buffer if path == "-" else open(path, "wb")) as out:
        heads = [header(i, job) for i in range(job["count"])]
        start = 8 + sum(map(len, heads)) + 1
        chunk = 12 + 4 * job["width"]
        out.write(struct.pack("<2i", 20000630, 2 | 0x1000) + b"".join(heads) + b"\0")
        chunks = job["count"] * job["height"]
        first = start + 8 * chunks
        out.write(struct.pack("<%dQ" % chunks, *range(first, first + chunk * chunks, chunk)))
        kinds = {}
        for i in range(job["count"]):
            if i % 7 not in kinds:
                kinds[i % 7] = [blob_row(job, i, a) for a in range(job["height"])]
            for a, row in enumerate(kinds[i % 7]):
                out.write(struct.pack("<3i", i, a, len(row)) + row)


def unpacked(packed, size):
    """A run-length coded line: runs, then differences, then the bytes' halves one after the other."""
    if len(packed) == size:
        return packed
    out, at = bytearray(), 0
    while at < len(packed):
        count = struct.unpack_from("b", packed, at)[0]
        if count < 0:
            out += packed[at + 1:at + 1 - count]
            at += 1 - count
        else:
            out += packed[at + 1:at + 2] * (count + 1)
            at += 2
    for i in range(1, len(out)):
        out[i] = (out[i] + out[i - 1] - 128) & 255
    line = bytearray(size)
    line[0::2], line[1::2] = out[:(size + 1) // 2], out[(size + 1) // 2:]
    return bytes(line)


def opened(path):
    """All bytes, headers as dictionaries of raw bytes, where the chunks of values begin."""
    file = sys.stdin.buffer if path == "-" else open(path, "rb")
    data = file.read()
    assert struct.unpack_from("<2i", data) == (20000630, 2 | 0x1000), "not a multi-part EXR"
    at, parts = 8, []
    while data[at] != 0:
        head = {}
        while data[at] != 0:
            name = data[at:data.index(0, at)]
            at += len(name) + 1
            at = data.index(0, at) + 1
            size = struct.unpack_from("<i", data, at)[0]
            head[name.decode()] = data[at + 4:at + 4 + size]
            at += 4 + size
        at += 1
        parts.append(head)
    return data, parts, at + 1 + 8 * sum(struct.unpack("<i", head["chunkCount"])[0] for head in parts)


def read(path):
    """Headers, and an iterator of (part, row, floats)."""
    data, parts, at = opened(path)
    assert all(head["compression"] in (b"\0", b"\1") for head in parts), "compressed otherwise than by run lengths"

    def rows():
        where = at
        for _ in range(sum(struct.unpack("<i", head["chunkCount"])[0] for head in parts)):
            part, row, size = struct.unpack_from("<3i", data, where)
            width = struct.unpack("<4i", parts[part]["dataWindow"])[2] + 1
            yield part, row, struct.unpack("<%df" % width, unpacked(data[where + 12:where + 12 + size], 4 * width))
            where += 12 + size
    return parts, rows()


def main(verb, path, *rest):
    if verb == "make":
        job = dict(count=3, width=64, height=60, pixel=0.26, row=0.26, space="virtual", kind="sinogram", step=None,
                   printer=None, value=None, reach=0.2, full_scale=None, shown_turns=None)
        for pair in rest:
            key, value = pair.split("=", 1)
            whole = key in ("count", "width", "height")
            job[key] = value if key in ("space", "kind", "printer") else int(value) if whole else float(value)
        make(path, job)
    elif verb == "image":
        image(path, *map(int, rest[:2]), rest[2])
    elif verb == "sum":
        parts, rows = read(path)
        total, width, height = 0.0, 0, 0
        for _, row, values in rows:
            total, width, height = total + math.fsum(values), len(values), max(height, row + 1)
        print(len(parts), width, height, "%.6g" % total)
    elif verb == "get":
        part, column, row = map(int, rest)
        print("%.7g" % next(v[column] for p, r, v in read(path)[1] if (p, r) == (part, row)))
    elif verb == "attr":
        raw = read(path)[0][0][rest[0]]
        is_number = rest[0].endswith(("_mm", "_deg"))
        print("%.10g" % struct.unpack("<d", raw)[0] if is_number else raw.decode())


if __name__ == "__main__":
    main(*sys.argv[1:])
