# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file of the tools says, in few figures that do not depend on the machine, for tests/corpus/run.

of_file(path) gives a list of (what, record). A record has some of
    is       facts: whole names are compared as they are, numbers to 1e-4 of their value
    values   least and greatest; the mean, the means of up to 64 blocks in the order of the file; sums of these blocks in
             which each value is added or subtracted by chance; to 1e-5 of the largest, means to 1e-6 (of a line with a
             tolerance to that over the root of the block's size, if more). What a whole block has in common moves its
             mean, a single value or what differs from row to row its sum: selftest.py
    block    the values of a block
    text     the numbers of a table as printed: to 1e-4, and to a unit of the last place
    picture  means of 12 x 12 blocks, in grey levels of 255: to 2
    levels   of each frame of a folder the sum of its grey levels, plain and with signs by chance, whole numbers: exact
Histories, seals, times and hashes are left out, and the bytes of files that are neither text nor known here.
"""
import array
import base64
import json
import math
import operator
import os
import random
import re
import struct
import subprocess
import zipfile
import zlib

LEFT_OUT = re.compile(r"(^|[._:])(history|seals?|facts_seal|version|utc|sha256.*|hash|hashes|commands?|t_monotonic_s|"
                      r"time_s|device_s|wall_s|camera[.]firmware|process(es)?|pid|uuid|host|started|computed_s|seconds|memory_.*|"
                      r"limited_by[.]\d+[.]z_mm|\d+[.](time_sigma_s|levels))$")  # of slices alike, any; of a capture
SIGNS = [1.0 if bit == "1" else -1.0 for bit in format(random.Random(49).getrandbits(32749), "032749b")]  # a prime: no row
# and no slice has this length, so that what alternates between them meets other signs
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w|\.\d)")  # neither versions nor seals


def rounded(value, digits=7):
    if not isinstance(value, float):
        return value
    return float("%.*g" % (digits, value)) if math.isfinite(value) else str(value)


def signed_sum(numbers):
    return sum(sum(map(operator.mul, SIGNS, numbers[at:at + len(SIGNS)])) for at in range(0, len(numbers), len(SIGNS)))


def lit_of(block, run=256):
    """Its values and their signs without runs of zeros, of which stacks mostly are, and whether there was none of these."""
    dark, lit, signs, count = bytes(run * block.itemsize), [], [], len(block)
    for at in range(0, count, run):
        part = block[at:at + run]
        if part.tobytes() != dark:
            first = at % len(SIGNS)
            lit += part
            signs += SIGNS[first:first + run] + SIGNS[:max(0, first + run - len(SIGNS))]
    return lit, signs, len(lit) == count


def values_of(numbers):
    """Figures of floats; their places are to 1e-7 of the largest, those of means to 1e-8."""
    count = len(numbers)
    size = max(64, -(-count // 64))
    blocks = [lit_of(numbers[start:start + size]) for start in range(0, count, size)]
    signed = [sum(map(operator.mul, signs, lit)) for lit, signs, _ in blocks]
    if not blocks or not all(map(math.isfinite, signed)):
        return {"is": {"values": count, "not_finite": count - sum(map(math.isfinite, numbers))}}
    ends = [f(lit) for lit, _, _ in blocks for f in (min, max) if lit] + [0.0] * (not all(full for _, _, full in blocks))
    low, high = min(ends), max(ends)
    largest = max(abs(low), abs(high))
    places = 7 - math.floor(math.log10(largest)) if largest > 0 else 7
    sums = [math.fsum(lit) for lit, _, _ in blocks]
    means = [math.fsum(sums) / count, *(total / len(numbers[n * size:(n + 1) * size]) for n, total in enumerate(sums))]

    def tidy(numbers, more=0):
        return [round(v, places + more) + 0.0 for v in numbers]
    return {"block": size, "values": tidy((low, high)) + tidy(means, 1) + tidy(signed)}


def flat(value, path=""):
    """{path: leaf} of parsed JSON; long lists of numbers as count, mean and block sums."""
    if isinstance(value, dict):
        for key, inner in sorted(value.items()):
            inside = path + "." + key if path else key
            if not LEFT_OUT.search(inside):
                yield from flat(inner, inside)
    elif isinstance(value, list):
        if len(value) > 24:
            yield path + ".count", len(value)
            if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in value):
                size = -(-len(value) // 8)
                for start in range(0, len(value), size):
                    yield "%s.%d" % (path, start), rounded(math.fsum(value[start:start + size]) / size, 6)
                return
            value = value[:4] + value[-4:]
        for at, inner in enumerate(value):
            yield from flat(inner, "%s.%d" % (path, at))
    elif isinstance(value, str):
        if path.split(".")[-1] == "verdict":
            yield path, value.split(":")[0]
        elif value and " " not in value and "/" not in value and not value.startswith("xxh3:"):
            yield path, value
    else:
        yield path, rounded(value, 6)


def text_of(text):
    """Numbers of a text, as printed; of a list of words, one a line, the words."""
    lines = text.split("\n")
    if all(" " not in line and "," not in line for line in lines) and not NUMBER.search(text):
        return {"is": {"words": [line for line in lines if line][:400]}}
    found = NUMBER.findall(text)
    if len(found) <= 96:
        return {"text": found}
    size = -(-len(found) // 48)
    sums = ["%.5g" % (math.fsum(map(float, found[at:at + size])) / size) for at in range(0, len(found), size)]
    return {"is": {"numbers": len(found)}, "text": sums}


def json_of(text):
    parsed = json.loads(text)
    return {"is": dict(flat(parsed))}


def json_lines_of(text):
    lines = [json.loads(line) for line in text.split("\n") if line.strip()]
    picked = {0: lines[0], len(lines) // 2: lines[len(lines) // 2], len(lines) - 1: lines[-1]} if lines else {}
    facts = {"lines": len(lines)}
    for at, line in picked.items():
        facts.update(flat(line, str(at)))
    return {"is": facts}


def settings_of(text):
    facts, room = {}, ""
    for line in text.split("\n"):
        line = line.split("#")[0].strip()
        if line.startswith("["):
            room = line.strip("[]")
        elif "=" in line:
            key, value = (part.strip() for part in line.split("=", 1))
            try:
                facts[room + "." + key] = json.loads(value)
            except ValueError:
                facts[room + "." + key] = value.strip('"')
    return {"is": facts}


def fact(value):
    try:
        return rounded(float(value), 6)
    except ValueError:
        return value if len(value) <= 240 else text_of(value)


def grids_of(path):
    """(name, facts) of the grids of an OpenVDB file."""
    return [(name, facts) for name, facts, _ in stored_of(path)]


def stored_of(path):
    """(name, facts, what follows these: transform, topology and values) of the grids, by the published format."""
    with open(path, "rb") as file:
        data = file.read()
    at = 20 + 1 + 36

    def number(kind):
        nonlocal at
        value = struct.unpack_from("<" + kind, data, at)[0]
        at += struct.calcsize(kind)
        return value

    def text():
        nonlocal at
        size = number("I")
        at += size
        return data[at - size:at].decode("utf-8", "replace")

    def metadata():
        nonlocal at
        found = {}
        for _ in range(number("I")):
            key, kind, size = text(), text(), number("I")
            found[key] = (kind, data[at:at + size])
            at += size
        return found
    offsets = data[20] != 0
    metadata()
    for _ in range(number("i")):
        name = text().split("\x1e")[0]
        text(), text()
        end = None
        if offsets:
            at, _, end = number("q"), number("q"), number("q")
        number("I")
        facts = {key[4:]: raw.decode("utf-8", "replace") for key, (kind, raw) in metadata().items()
                 if key.startswith("vam:") and kind == "string" and not LEFT_OUT.search(key)}
        yield name, facts, data[at:end]
        if end is None:
            return
        at = end


def attributes_of(path):
    """Facts of the first part of an EXR file, and the places of its last one."""
    with open(path, "rb") as file:
        data = file.read(1 << 26)
    many = struct.unpack_from("<I", data, 4)[0] & 0x1000
    at, first, last = 8, None, {}
    while data[at] != 0:
        head = {}
        while data[at] != 0:
            name = data[at:data.index(0, at)].decode()
            at = data.index(0, at) + 1
            kind = data[at:data.index(0, at)].decode()
            at = data.index(0, at) + 1
            size = struct.unpack_from("<i", data, at)[0]
            raw = data[at + 4:at + 4 + size]
            at += 4 + size
            if name.startswith("vam:") and not LEFT_OUT.search(name):
                head[name[4:]] = (struct.unpack("<" + {"double": "d", "int": "i", "float": "f"}[kind], raw)[0]
                                  if kind in ("double", "int", "float") else raw.decode("utf-8", "replace"))
        at += 1
        first, last = first or head, head
        if not many:
            break
    facts = {key: fact(str(value)) for key, value in (first or {}).items()}
    facts.update(("last." + key, float(last[key])) for key in ("z_mm", "angle_deg") if key in last)
    return {key: round(value, 3) if key.endswith("angle_deg") else rounded(value, 6) for key, value in facts.items()}


def nrrd_of(data):
    head, raw = data.split(b"\n\n", 1)
    keys = dict(re.split(r":=?\s*", line, maxsplit=1) for line in head.decode("utf-8", "replace").splitlines()
                if ":" in line and line[0] != "#")
    facts = {key: [fact(word) for word in re.split(r"[\s,()]+", keys[key]) if word]
             for key in ("sizes", "content", "spacings", "axis mins", "space directions", "space origin") if key in keys}
    return {"is": facts, **values_of(array.array("f", raw))}


def exported(path, *grid):
    data = subprocess.run(["vam-view", path, "--quiet", "--export", "/dev/stdout", *grid], check=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return nrrd_of(data)


def volumes_of(path):
    for name, facts in grids_of(path):
        record = exported(path, "--grid", name)
        record["is"].update((key, fact(value)) for key, value in facts.items())
        yield name, record


def stack_of(path):
    record = exported(path)
    record["is"].update(attributes_of(path))
    return record


def numpy_of(data):
    size = struct.unpack_from("<H", data, 8)[0]
    head = data[10:10 + size].decode().strip()
    record = values_of(array.array("f", data[10 + size:])) if "'<f4'" in head else {}
    return {"is": {"head": head}, **record}


def added(a, b):
    """Two rows of bytes, each modulo 256: the lower seven bits of all at once, then the highest."""
    low = int.from_bytes(b"\x7f" * len(a), "little")
    a, b, size = int.from_bytes(a, "little"), int.from_bytes(b, "little"), len(a)
    return bytearray((((a & low) + (b & low)) ^ ((a ^ b) & ~low)).to_bytes(size, "little"))


def rows_of_png(data):
    """Width, height, channels, the largest level, samples of all channels row by row."""
    at, head, packed, palette = 8, None, b"", b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"PLTE":
            palette = body
        at += 12 + size
    width, height, depth, colour = head[:4]
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    step, stride = max(1, depth * channels // 8), (width * depth * channels + 7) // 8
    raw, above, rows = zlib.decompress(packed), bytearray(stride), []
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if kind == 2:
            row = added(row, above)
        elif kind:
            for i in range(stride):
                left, up = row[i - step] if i >= step else 0, above[i]
                corner = above[i - step] if i >= step else 0
                guess = left + up - corner
                near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
                row[i] = (row[i] + (0, left, up, (left + up) // 2, near)[kind]) & 255
        above = row
        if depth == 16:
            rows.append(struct.unpack(">%dH" % (len(row) // 2), row))
        elif depth == 8:
            rows.append(row if not palette else bytes(v for i in row for v in palette[3 * i:3 * i + 3]))
        else:
            per, top = 8 // depth, (1 << depth) - 1
            rows.append(bytes((row[x // per] >> (8 - depth * (x % per + 1))) & top for x in range(width)))
    return width, height, 3 if palette else channels, 255 if palette else (1 << depth) - 1, rows


def blocks_of(width, height, channels, top, rows, blocks=12):
    across, down = min(blocks, width), min(blocks, height)
    means = []
    for j in range(down):
        band = rows[j * height // down:(j + 1) * height // down]
        for i in range(across):
            left, right = i * width // across * channels, (i + 1) * width // across * channels
            total = sum(sum(row[left:right]) for row in band)
            means.append(round(total * 255 / top / (len(band) * (right - left)), 1))
    return {"is": {"columns": width, "rows": height, "channels": channels}, "picture": means}


def picture_of(data, blocks=12):
    return blocks_of(*rows_of_png(data), blocks)


def frames_of(folder, names):
    """A folder of images: their number, the levels of all, the blocks of the first, the middle and the last of them."""
    picked, record, levels = {0, len(names) // 2, len(names) - 1}, None, []
    for at, name in enumerate(names):
        with open(os.path.join(folder, name), "rb") as file:
            image = rows_of_png(file.read())
        flat_levels = [level for row in image[4] for level in row]
        levels += [sum(flat_levels), int(signed_sum(flat_levels))]
        if at in picked:
            shown = blocks_of(*image, 8)
            record = record or {"is": {"images": len(names), "first": name, "last": names[-1], "top": image[3],
                                       **shown["is"]}, "picture": []}
            record["picture"] += shown["picture"]
    return {**record, "levels": levels}


def video_of(path):
    shown = subprocess.run(["vam-view", path, "--quiet", "--sheet", "4", "--title", "", "-o", "/dev/stdout"], check=True,
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return picture_of(shown)


def pdf_of(data):
    box = re.search(rb"/MediaBox *\[([^]]*)\]", data)
    return {"is": {"page": [rounded(float(v), 6) for v in box.group(1).split()],
                   "images": len(re.findall(rb"/Subtype */Image", data))}}


def svg_of(text):
    size = re.search(r'<svg[^>]* width="([^"]*)" height="([^"]*)"', text)
    return {"is": {"width": size.group(1), "height": size.group(2), "images": text.count("<image ")}}


def page_of(text):
    """An HTML page: the numbers of its text, and what is embedded."""
    inside = re.sub(r"(?s)<(script|style|code)\b.*?</\1>", " ", text)
    facts = {tag: len(re.findall("<%s[ >]" % tag, text)) for tag in ("img", "table", "tr", "svg", "canvas", "section")}
    words = re.sub(r"<[^>]*>", " ", inside)
    words = re.sub(r"\d\d:\d\d(:\d\d)?|\d{4}-\d\d-\d\d", " ", words)
    pictures = [base64.b64decode(body) for body in re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", text)]
    picked = [pictures[i] for i in sorted({0, len(pictures) // 2, len(pictures) - 1})] if pictures else []
    found = text_of(words)
    facts.update(found.get("is", {}))
    return {"is": {**facts, "pictures": len(pictures)}, "text": found.get("text", []),
            "picture": [v for picture in picked for v in picture_of(picture, 6)["picture"]]}


def binary_ply(data):
    head, body = data.split(b"end_header\n", 1)
    codes = {"float": "f", "uchar": "B", "int": "i", "double": "d", "uint": "I", "short": "h", "ushort": "H"}
    elements = []
    for line in head.decode().splitlines():
        words = line.split()
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    at, points, faces, extra = 0, [], [], {}
    for name, count, properties in elements:
        if any(words[0] == "list" for words in properties):
            for _ in range(count):
                size = body[at]
                faces.append(struct.unpack_from("<%di" % size, body, at + 1))
                at += 1 + 4 * size
            continue
        form = struct.Struct("<" + "".join(codes[words[0]] for words in properties))
        rows = list(form.iter_unpack(body[at:at + count * form.size]))
        at += count * form.size
        if name == "vertex":
            points = [row[:3] for row in rows]
            extra = {words[1]: math.fsum(row[i] for row in rows) / max(1, count)
                     for i, words in enumerate(properties) if i > 2}
    return points, faces, extra


def mesh_of(path):
    """Numbers of vertices and faces, box, area and volume."""
    extra = {}
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".ply"):
        points, faces, extra = binary_ply(data)
    elif path.endswith(".stl"):
        points, faces = [], []
        for at in range(84, len(data), 50):
            faces.append((len(points), len(points) + 1, len(points) + 2))
            points += [struct.unpack_from("<3f", data, at + 12 * k) for k in (1, 2, 3)]
    elif path.endswith(".3mf"):
        text = zipfile.ZipFile(path).read("3D/3dmodel.model").decode()
        points = [tuple(map(float, p)) for p in re.findall(r'<vertex x="([^"]*)" y="([^"]*)" z="([^"]*)"', text)]
        faces = [tuple(map(int, f)) for f in re.findall(r'<triangle v1="(\d+)" v2="(\d+)" v3="(\d+)"', text)]
    else:
        lines = data.decode().splitlines()
        points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
        faces = [tuple(int(c.split("/")[0]) - 1 for c in line.split()[1:4]) for line in lines if line.startswith("f ")]
    area = volume = 0.0
    for a, b, c in ((points[f[0]], points[f[1]], points[f[2]]) for f in faces):
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        area += math.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2) / 2
        volume += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6
    facts = {"vertices": len(points), "faces": len(faces), "area": area, "volume": volume, **extra}
    for i, axis in enumerate("xyz"):
        facts["box." + axis] = [rounded(f(p[i] for p in points), 6) for f in (min, max)] if points else []
    return {"is": {key: rounded(value, 6) for key, value in facts.items()}}


def arrays_of(path):
    """Those of an archive of NumPy, a TIFF of our own (make.py): (name, record)."""
    ending = os.path.splitext(path)[1]
    if ending == ".npz":
        with zipfile.ZipFile(path) as archive:
            return [(name, numpy_of(archive.read(name))) for name in sorted(archive.namelist())]
    with open(path, "rb") as file:
        data = file.read()
    return [("", {"is": {"bytes": len(data)}, **values_of(array.array("B", data))})]


BINARY = {".vdb": volumes_of, ".npz": arrays_of, ".tif": arrays_of,
          **dict.fromkeys((".mkv", ".mp4"), lambda path: [("", video_of(path))]),
          **dict.fromkeys((".ply", ".stl", ".3mf", ".obj"), lambda path: [("", mesh_of(path))]),
          ".exr": lambda path: [("", stack_of(path))]}
BY_BYTES = {".png": picture_of, ".pdf": pdf_of, ".npy": numpy_of, ".nrrd": nrrd_of}
BY_TEXT = {".json": json_of, ".jsonl": json_lines_of, ".toml": settings_of, ".svg": svg_of, ".html": page_of}


def of_file(path):
    """[(part, record), ...]"""
    ending = os.path.splitext(path)[1]
    if ending in BINARY:
        return list(BINARY[ending](path))
    with open(path, "rb") as file:
        data = file.read()
    if ending in BY_BYTES:
        return [("", BY_BYTES[ending](data))]
    if b"\0" in data:
        return [("", {"is": {"binary": True}})]
    return [("", BY_TEXT.get(ending, text_of)(data.decode("utf-8", "replace")))]
