# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes and stacks of VAM tools as arrays: NumPy's where it is installed, else flat array.array('f').

    values, facts = vam.read("part.vdb", "target")     # needs vam-view in the PATH
    values, facts = vam.read("projector.exr")
    vam.write_volume("mine.vdb", values, voxel_mm=0.1)  # values[z][y][x], coverage 0...1, z upwards
    vam.write_stack("mine.exr", values, pixel_mm=0.065, row_mm=0.065)  # values[slice][angle][column]

facts: shape, spacing and origin of the axes, in the order of the array (slowest first), in mm or degrees; content;
stretch_z of a volume, the factor by which it is higher than its print (1 where none is stated): z / stretch_z is mm in
the print. Give it to write_volume with arrays that are stretched already, as those that were read: vam-slice stretches
its targets by 1/M_vp of the printer, as prints come out lower, and `vam-convert --stretch-z` does so with arrays.
A volume written without origin_mm (x, y, z of its first voxel's centre) has its middle on the axis, at z = 0. A flat
array needs shape=(slices, rows, columns). The files are checked with `vam-check FILE`, their keys are in vam-formats(7).
"""
import array
import math
import struct
import subprocess

try:
    import numpy
except ImportError:
    numpy = None

VERSION = "1"  # of volumes, stacks and NRRD, in vam-formats(7)


def read(path, grid=""):
    """The grid of a volume (VDB; the only one when grid is empty) or a stack (EXR), and its facts."""
    data = subprocess.run(["vam-view", path, "--export", "/dev/stdout"] + (["--grid", grid] if grid else []),
                          check=True, stdout=subprocess.PIPE).stdout
    head, raw = data.split(b"\n\n", 1)
    version = next((line.split(":=", 1)[1] for line in head.decode().splitlines()
                    if line.startswith("vam:version:=")), VERSION)
    if not version.isdecimal() or not 1 <= int(version) <= int(VERSION):
        raise ValueError(f"{path}: is of version {version} of NRRD, this vam.py reads up to {VERSION}; get a newer one")
    keys = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line and line[0] != "#")
    facts = {"shape": tuple(int(n) for n in reversed(keys["sizes"].split())), "content": keys["content"]}
    if "space directions" in keys:
        facts["spacing"] = 3 * (float(keys["space directions"].split(",")[0].strip("(")),)
        facts["origin"] = tuple(float(n) for n in reversed(keys["space origin"].strip("()").split(",")))
        facts["stretch_z"] = float(next((line.split(":=", 1)[1] for line in head.decode().splitlines()
                                         if line.startswith("vam:stretch_z:=")), 1))
    else:
        facts["spacing"] = tuple(float(n) for n in reversed(keys["spacings"].split()))
        facts["origin"] = tuple(float(n) for n in reversed(keys["axis mins"].split()))
    values = array.array("f", raw)
    return (values if numpy is None else numpy.array(values).reshape(facts["shape"])), facts


def _flat(values, shape):
    """Row-major floats, and their shape."""
    if numpy is not None and not isinstance(values, array.array):
        values = numpy.asarray(values)
        shape = values.shape
        values = array.array("f", values.astype("<f4").tobytes())
    if shape is None or len(shape) != 3 or len(values) != math.prod(shape):
        raise ValueError("shape=(slices, rows, columns) of all the values is needed")
    return values, shape


def _text(value):
    return struct.pack("<I", len(value)) + value.encode()


def write_volume(path, values, voxel_mm, origin_mm=None, name="target", units="relative", shape=None,
                 stretch_z=1):
    """One grid as an OpenVDB file, format 224, leaf by leaf; zero is background. Up to 4096 voxels a side."""
    if not 0.1 <= stretch_z <= 10:
        raise ValueError("stretch_z is a factor of 0.1 to 10")
    values, (nz, ny, nx) = _flat(values, shape)
    leaves = {}  # block of 8 x 8 x 8 voxels -> its values, z fastest
    for at, value in enumerate(values):
        if value:
            x, y, z = at % nx, at // nx % ny, at // (nx * ny)
            leaf = leaves.setdefault((x >> 3, y >> 3, z >> 3), array.array("f", bytes(2048)))
            leaf[(x & 7) << 6 | (y & 7) << 3 | z & 7] = value
    nodes = {}  # block of 128 -> its leaves by place
    for (x, y, z), leaf in leaves.items():
        place = (x & 15) << 8 | (y & 15) << 4 | z & 15
        nodes.setdefault((x >> 4) << 10 | (y >> 4) << 5 | z >> 4, {})[place] = leaf

    def masks(places, size):  # children, active tiles; then the values of all tiles
        return sum(1 << p for p in places).to_bytes(size // 8, "little") + bytes(size // 8) + b"\6" + bytes(4 * size)
    ordered = [sorted(node.items()) for _, node in sorted(nodes.items())]
    active = {id(leaf): sum(1 << i for i, v in enumerate(leaf) if v).to_bytes(64, "little")
              for node in ordered for _, leaf in node}
    topology = struct.pack("<ifII3i", 1, 0.0, 0, 1, 0, 0, 0) + masks(nodes, 32768)
    for node in ordered:
        topology += masks([place for place, _ in node], 4096) + b"".join(active[id(leaf)] for _, leaf in node)
    buffers = b"".join(active[id(leaf)] + b"\6" + leaf.tobytes() for node in ordered for _, leaf in node)
    if origin_mm is None:
        origin_mm = [-0.5 * (n - 1) * voxel_mm for n in (nx, ny, nz)]
    scale = [voxel_mm, voxel_mm, 1 / voxel_mm, voxel_mm ** -2, 0.5 / voxel_mm]
    facts = {"name": ("string", name.encode()), "vam:units": ("string", units.encode()),
             "vam:version": ("string", VERSION.encode()),
             "vam:shape": ("vec3i", struct.pack("<3i", nx, ny, nz)), "vam:history": ("string", b"vam.py write_volume")}
    if stretch_z != 1:
        facts["vam:stretch_z"] = ("string", b"%.9g" % stretch_z)
    meta = struct.pack("<I", len(facts)) + b"".join(
        _text(key) + _text(kind) + struct.pack("<I", len(data)) + data for key, (kind, data) in facts.items())
    transform = _text("UniformScaleTranslateMap") + struct.pack("<3d", *origin_mm) + b"".join(
        struct.pack("<3d", s, s, s) for s in scale)
    head = struct.pack("<qIIIB", 0x56444220, 224, 10, 0, 1) + b"00000000-0000-0000-0000-000000000000"
    head += struct.pack("<Ii", 0, 1) + _text(name) + _text("Tree_float_5_4_3") + _text("")
    grid = struct.pack("<I", 0) + meta + transform + topology
    start = len(head) + 24
    with open(path, "wb") as out:
        out.write(head + struct.pack("<3q", start, start + len(grid), start + len(grid) + len(buffers)) + grid + buffers)


def write_stack(path, values, pixel_mm, row_mm, kind="sinogram", space="projector", z_start_mm=None,
                angle_step_deg=None, units="relative", shape=None):
    """One EXR part for each slice (angles x columns); an angle is a row. The slices' middle is z = 0."""
    values, (count, height, width) = _flat(values, shape)
    step = 360 / height if angle_step_deg is None else angle_step_deg
    first = -0.5 * (count - 1) * row_mm if z_start_mm is None else z_start_mm

    def attribute(key, kind, data):
        return key.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    heads = []
    for k in range(count):
        texts = {"name": "z%04d" % k, "type": "scanlineimage", "vam:kind": kind, "vam:space": space,
                 "vam:version": VERSION, "vam:units": units, "vam:history": "vam.py write_stack"}
        numbers = {"vam:pixel_mm": pixel_mm, "vam:row_mm": row_mm, "vam:z_mm": first + k * row_mm,
                   "vam:angle_start_deg": 0, "vam:angle_step_deg": step}
        heads.append(b"".join([
            attribute("channels", "chlist", b"Y\0" + struct.pack("<i4B2i", 2, 0, 0, 0, 0, 1, 1) + b"\0"),
            attribute("compression", "compression", b"\0"), attribute("lineOrder", "lineOrder", b"\0"),
            attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
            attribute("screenWindowCenter", "v2f", bytes(8)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
            attribute("chunkCount", "int", struct.pack("<i", height)),
            attribute("vam:count", "int", struct.pack("<i", count)), attribute("vam:index", "int", struct.pack("<i", k)),
            *[attribute(key, "string", text.encode()) for key, text in texts.items()],
            *[attribute(key, "double", struct.pack("<d", number)) for key, number in numbers.items()], b"\0"]))
    chunk, chunks = 12 + 4 * width, count * height
    start = 9 + sum(map(len, heads)) + 8 * chunks
    with open(path, "wb") as out:
        out.write(struct.pack("<2i", 20000630, 0x1002) + b"".join(heads) + b"\0")
        out.write(struct.pack("<%dQ" % chunks, *range(start, start + chunk * chunks, chunk)))
        for at in range(chunks):
            row = values[at * width:(at + 1) * width].tobytes()
            out.write(struct.pack("<3i", at // height, at % height, len(row)) + row)
