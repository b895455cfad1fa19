#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Does the estimate of vam-plan say what the print shows? Forty parts near the edge of what the printer resolves.

    python3 tests/bench/estimate.py [BUILD] [PATTERN]

Sheets, pins, gaps, bores and corners of 1 to 5 voxels, and sharp edges, which are no missing walls. The judge is the
final verdict: vam-slice, vam-optimize, vam-dose and vam-score, each on its own. The estimate decides if it says "will
print" or "will not print"; then the final verdict must begin so, too: "may print" and "not judged" are not what it said.
Exit status 1 below 32 of 40 that are decided, or for one that is contradicted.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import time

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
PATTERN = (sys.argv[2:] or [""])[0]
PRINTER = ["vial.radius_mm=5", "projector.columns=80", "projector.rows=48", "projector.pixel_mm=0.13",
           "projector.axis_column=39.5", "projector.axis_row=23.5"]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def block(low, high):
    """A box, as points and faces."""
    return [((low, high)[n & 1][0], (low, high)[n >> 1 & 1][1], (low, high)[n >> 2][2]) for n in range(8)], QUADS


def centred(x, y, low, high, at=(0, 0)):
    return block((at[0] - x / 2, at[1] - y / 2, low), (at[0] + x / 2, at[1] + y / 2, high))


def prism(ring, low, high):
    """Over a convex ring, counter-clockwise."""
    n = len(ring)
    points = [(x, y, low) for x, y in ring] + [(x, y, high) for x, y in ring]
    faces = [tuple(reversed(range(n))), tuple(range(n, 2 * n))]
    return points, faces + [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]


def circle(diameter, sides=24, at=(0, 0)):
    turns = [2 * math.pi * (k + 0.5) / sides for k in range(sides)]
    return [(at[0] + diameter / 2 * math.cos(t), at[1] + diameter / 2 * math.sin(t)) for t in turns]


def pipe(outer, inner, low, high, sides=32):
    """An upright ring."""
    points = [(x, y, z) for d in (outer, inner) for z in (low, high) for x, y in circle(d, sides)]
    rings = [(0, 1), (1, 3), (3, 2), (2, 0)]  # outside, top, inside, bottom
    return points, [(a * sides + i, a * sides + (i + 1) % sides, b * sides + (i + 1) % sides, b * sides + i)
                    for a, b in rings for i in range(sides)]


def cone(diameter, low, high, sides=24):
    ring = circle(diameter, sides)
    points = [(x, y, low) for x, y in ring] + [(0, 0, high)]
    return points, [tuple(reversed(range(sides)))] + [(i, (i + 1) % sides, sides) for i in range(sides)]


def turned(body, degrees, axes=(0, 2)):
    """About the third axis."""
    a, b = axes
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turn(p):
        q = list(p)
        q[a], q[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
        return tuple(q)
    return [turn(p) for p in body[0]], body[1]


def shell(side, wall):
    inner = centred(side - 2 * wall, side - 2 * wall, wall, side - wall)
    return [centred(side, side, 0, side), (inner[0], [tuple(reversed(f)) for f in inner[1]])]


def leaning(t, degrees):
    return [centred(3, 3, 0, 0.9), turned(centred(t, 2.4, 0.4, 3), degrees)]


def fins(t, gap):
    return [centred(3.6, 2.4, 0, 0.8)] + [centred(t, 2.4, 0.7, 2.2, (x * (t + gap), 0)) for x in (-1, 0, 1)]


def pins(d, lean=0):
    return [centred(3, 3, 0, 0.8)] + [turned(prism(circle(d, 16, (x, y)), 0.5, 2.4), lean)
                                      for x in (-0.8, 0.8) for y in (-0.8, 0.8)]


def slit(g, deep):
    """A block with a slit from above."""
    return [block((-1.6, -1.4, 0), (1.6, 1.4, 2.2 - deep)), block((-1.6, -1.4, 2.1 - deep), (-g / 2, 1.4, 2.2)),
            block((g / 2, -1.4, 2.1 - deep), (1.6, 1.4, 2.2))]


def sleeves(g):
    return [centred(3.4, 3.4, 0, 0.8), pipe(3.2, 2.2, 0.7, 2.4), prism(circle(2.2 - 2 * g), 0.7, 2.4)]


def window(w):
    """A bar with a square hole across."""
    return [block((-1.6, -0.7, 0), (1.6, 0.7, 0.8)), block((-1.6, -0.7, 0.7), (-w / 2, 0.7, 0.8 + w)),
            block((w / 2, -0.7, 0.7), (1.6, 0.7, 0.8 + w)), block((-1.6, -0.7, 0.79 + w), (1.6, 0.7, 1.6 + w))]


def stairs(t):
    return [block((-1.6 + 0.8 * k, -1, 0), (1.6, 1, 0.5 + 0.5 * k)) for k in range(3)] + [
        block((0.2, -1, 1.45), (1.6, 1, 1.5 + t))]


def touch(o):
    """Two blocks that share an edge, but for an overlap."""
    return [block((-1.5, -1, 0), (o, 1, 1.5)), block((0, -1, 1.5 - o), (1.5, 1, 3))]


def beam(t):
    return [block((-1.7, -0.8, 0), (-1, 0.8, 2)), block((1, -0.8, 0), (1.7, 0.8, 2)), block((-1.2, -t / 2, 1.6 - t), (1.2, t / 2, 1.6))]


PARTS = [  # a mesh, or a shape of vam-slice
    *[("sheet %.2f, leaning by %d" % (t, a), leaning(t, a)) for t, a in
      ((0.1, 20), (0.2, 0), (0.25, 35), (0.32, 20), (0.4, 35), (0.5, 20))],
    *[("fins %.2f, gaps %.2f" % f, fins(*f)) for f in ((0.2, 0.6), (0.35, 0.45))],
    *[("pins %.2f, leaning by %d" % p, pins(*p)) for p in ((0.15, 0), (0.25, 0), (0.35, 15), (0.45, 0), (0.6, 15))],
    *[("slit %.2f" % g, slit(g, 1.2)) for g in (0.1, 0.2, 0.35, 0.5)],
    *[("sleeves, gap %.2f" % g, sleeves(g)) for g in (0.15, 0.3, 0.45)],
    *[("bore %.2f" % d, [pipe(3, d, 0, 1.8)]) for d in (0.25, 0.4, 0.55, 0.8)],
    *[("window %.2f" % w, window(w)) for w in (0.2, 0.4, 0.6)],
    *[("box of walls %.2f" % t, shell(2.8, t)) for t in (0.2, 0.35, 0.5)],
    *[("edge contact %.2f" % o, touch(o)) for o in (0, 0.35)],
    *[("beam %.2f" % t, beam(t)) for t in (0.25, 0.4)],
    ("cone", [cone(3.6, 0, 3)]),
    ("wedge of 30 degrees", [prism([(-1.8, 0), (1.8, -0.96), (1.8, 0.96)], 0, 2)]),
    ("stairs, tread 0.30", stairs(0.3)),
    ("gyroid, sheet 0.30", "gyroid:diameter=6,height=2.5,cell=4,sheet=0.3"),
    ("gyroid, sheet 0.50", "gyroid:diameter=6,height=2.5,cell=3,sheet=0.5"),
    ("ring, 0.35", "torus:outer=5,tube=0.35"),
]


def write_off(path, bodies):
    points, faces = [], []
    for body in bodies:
        faces += [tuple(len(points) + i for i in face) for face in body[1]]
        points += body[0]
    with open(path, "w", encoding="utf-8") as out:
        out.write("OFF\n%d %d 0\n" % (len(points), len(faces)))
        out.writelines("%.9g %.9g %.9g\n" % p for p in points)
        out.writelines("%d %s\n" % (len(f), " ".join(map(str, f))) for f in faces)


def run(tool, *words):
    ended = subprocess.run([os.path.join(BUILD, "bin", tool), *words, "--quiet"], capture_output=True, text=True)
    return ended.returncode, ended.stderr.strip()


def beginning(verdict):
    return next((known for known in ("will print", "will not print", "may print") if verdict.startswith(known)), "not judged")


def estimate(part, *more):
    start = time.monotonic()
    status, problem = run("vam-plan", *part, "--report", "plan.json", *more)
    if status:
        sys.exit(problem)
    with open("plan.json", encoding="utf-8") as file:
        plan = json.load(file)
    return plan, time.monotonic() - start


def final(part):
    for tool, *words in (("vam-slice", *part, "-o", "part.vdb"), ("vam-optimize", "part.vdb", "-o", "frames.exr"),
                         ("vam-dose", "frames.exr", "--like", "part.vdb", "-o", "dose.vdb"),
                         ("vam-score", "dose.vdb", "--target", "part.vdb", "--report", "score.json")):
        status, problem = run(tool, *words)
        if status:
            return "not judged: " + problem
    with open("score.json", encoding="utf-8") as file:
        return json.load(file)["verdict"]


def main():
    os.chdir(tempfile.mkdtemp())
    run("vam-slice", "--print-printer", *(word for setting in PRINTER for word in ("--set", setting)), "-o", "printer.toml")
    os.environ["VAM_PRINTER"] = "printer.toml"
    decided = contradicted = total = 0
    print("| part | estimate | voxels | time | final verdict |\n|---|---|---|---|---|")
    for name, shape in PARTS:
        if PATTERN not in name:
            continue
        part = ["--shape", shape] if isinstance(shape, str) else ["part.off"]
        if not isinstance(shape, str):
            write_off("part.off", shape)
        plan, seconds = estimate(part)
        verdict = final(part)
        says = plan["verdict"].split(":")[0]
        is_decided = plan["prints"] is not None
        wrong = is_decided and beginning(verdict) != beginning(says)
        total += 1
        decided += is_decided
        contradicted += wrong
        print("| %s | %s%s | %.2f mm | %.1f s | %s |" % (name, says, " (WRONG)" if wrong else "", plan["estimate_voxel_mm"],
                                                       seconds, verdict.split(": ")[0]), flush=True)
        if says.startswith("unknown") and "--voxel" in says:
            finer, seconds = estimate(part, "--voxel", says.split("--voxel ")[1].split()[0])
            print("| | %s | %.3f mm | %.1f s | |" % (finer["verdict"].split(":")[0], finer["estimate_voxel_mm"], seconds))
        if os.environ.get("DETAIL"):
            print("    ", plan["verdict"], "\n    ", verdict)
    print("\n%d of %d decided, %d contradicted" % (decided, total, contradicted))
    return 0 if contradicted == 0 and decided >= 0.8 * total else 1


if __name__ == "__main__":
    sys.exit(main())
