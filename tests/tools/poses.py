# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of poses, and figures of doses, for tests.

    poses.py wobble FRAMES MM [TURNS]   a vial whose axis circles the rotation axis
    poses.py sink FRAMES MM             a part that sinks evenly during one turn
    poses.py seam FILE.nrrd MM MM       largest step of the mean dose from slice to slice, over the mean: within a radius
                                        of the axis, voxels of that edge, three slices away from the ends of the part
"""
import array
import math
import re
import sys


def table(frames, turns, pose):
    print("angle_deg,dx_mm,dy_mm,dz_mm,moves")
    for k in range(frames):
        angle = 360 * turns * k / frames
        print("%.9g,%s" % (angle, pose(k, math.radians(angle))))


def seam(path, radius, voxel):
    with open(path, "rb") as file:
        data = file.read()
    start = data.index(b"\n\n") + 2
    nx, ny, nz = map(int, re.search(rb"sizes: (.*)", data[:start]).group(1).split())
    dose = array.array("f")
    dose.frombytes(data[start:])
    inside = [x + nx * y for y in range(ny) for x in range(nx)
              if math.hypot((x - (nx - 1) / 2) * voxel, (y - (ny - 1) / 2) * voxel) < radius]
    means = [sum(dose[k * nx * ny + p] for p in inside) / len(inside) for k in range(nz)]
    part = [k for k in range(nz) if means[k] > 0.8 * max(means)]
    means = means[part[0] + 3:part[-1] - 2]
    print(max(abs(a - b) for a, b in zip(means, means[1:])) / (sum(means) / len(means)))


verb = sys.argv[1]
if verb == "seam":
    seam(sys.argv[2], float(sys.argv[3]), float(sys.argv[4]))
else:
    count, size = int(sys.argv[2]), float(sys.argv[3])
    if verb == "wobble":
        table(count, int(sys.argv[4]) if len(sys.argv) > 4 else 1,
              lambda k, theta: "%.9g,%.9g,0,vial" % (size * math.cos(0.5 - theta), size * math.sin(0.5 - theta)))
    else:
        table(count, 1, lambda k, theta: "0,0,%.9g,part" % (-size * k / (count - 1)))
