#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the latitude that any light could have do the methods reach, and in what time?

    python3 tests/bench/latitude.py [BUILD [PART...]]

Flat parts of 128 voxels across in parallel light of 180 angles. For each: the largest latitude of any light within the limit that auto
ends with, by the proof of minimax, and of any light at all, by --certify; what auto reaches, its share of both, seconds
of processor time, iterations, and its limit as a multiple of the even intensity; without a limit; and the latitude of
the other methods within that limit in the time that auto takes. Exit status 1 where auto is
below 0.6 of what its limit allows, or another method is ahead by more than 0.02.
"""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
import vam  # noqa: E402

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
NAMES = sys.argv[2:]
SIDE, FINE = 128, 4  # voxels across, and samples a voxel along each axis
OTHERS = ["cal", "osmo", "pm", "apg", "minimax"]


def ring(x, y):
    return 0.62 <= math.hypot(x, y) <= 0.9


def flower(x, y):
    r, a = math.hypot(x, y), math.atan2(y, x)
    return 0.2 <= r <= 0.6 + 0.28 * math.cos(6 * a)


def boat(x, y):
    """The outline of a hull, a cabin with a door, and a funnel."""
    def hull(u, v):
        return u >= -0.8 and abs(v) <= 0.42 * (1 - ((u + 0.1) / 0.95) ** 2)
    room = -0.47 <= x <= 0.02 and abs(y) <= 0.18 or x > 0 and abs(y) < 0.07
    cabin = -0.55 <= x <= 0.1 and abs(y) <= 0.26 and not room
    inside = x >= -0.72 and hull(1.14 * x + 0.01, 1.3 * y)
    return hull(x, y) and not inside or cabin or 0.05 <= math.hypot(x + 0.25, y) <= 0.13


def chart(x, y):
    """Bars and gaps of 2 to 8 voxels in a frame."""
    side, left = max(abs(x), abs(y)), -0.48
    if side > 0.54:
        return side <= 0.62
    for width in (2 * voxels / SIDE for voxels in (2, 3, 4, 6, 8)):
        for bar in range(3):
            if left <= x < left + width:
                return y < -0.04 or y > 0.1 + 0.02 * bar
            left += 2 * width if bar < 2 else 1.2 * width
    return False


PARTS = {"boat": boat, "ring": ring, "flower": flower, "chart": chart}


def slice_of(inside):
    steps = [(i + 0.5) / (FINE * SIDE) * 2 - 1 for i in range(FINE * SIDE)]
    hits = [[inside(x, y) for x in steps] for y in steps]
    return vam.array.array("f", [sum(sum(row[FINE * i:FINE * (i + 1)]) for row in hits[FINE * j:FINE * (j + 1)]) / FINE ** 2
                                 for j in range(SIDE) for i in range(SIDE)])


def optimise(*words, build=BUILD):
    """The report, with latitude and seconds of processor time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = subprocess.run([os.path.join(build, "bin", "vam-optimize"), "part.vdb", "--geometry", "parallel",
                            "--angles", "180", "-o", "out.exr", "--quiet", "--report", "report.json", *words], stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if ended.returncode != 0:
        sys.exit(ended.stderr)
    with open("report.json", encoding="utf-8") as file:
        report = json.load(file)
    report["seconds"] = after.ru_utime - before.ru_utime
    report["latitude"] = latitude(report["max_void"] / report["min_part"])
    return report


def in_time(method, limit, seconds):
    """The latitude of as many iterations as fit."""
    words = ["--method", method, "--max-intensity", limit, "--patience", "0"]
    few, many = (optimise(*words, "--iterations", count)["seconds"] for count in ("5", "25"))
    count = max(1, round(5 + 20 * (seconds - few) / (many - few)))
    return optimise(*words, "--iterations", str(count))["latitude"]


def latitude(ratio):
    """Of a ratio of the void's largest dose to the part's least."""
    return 2 * (1 - ratio) / (1 + ratio)


def main():
    os.chdir(tempfile.mkdtemp())
    failed = False
    print("| part | within the limit | any | auto | share | s | iterations | limit / even | without limit | " +
          " | ".join(OTHERS) + " |\n" + "|---" * (9 + len(OTHERS)) + "|")
    for name in NAMES or PARTS:
        vam.write_volume("part.vdb", slice_of(PARTS[name]), 0.1, shape=(1, SIDE, SIDE))
        made = optimise()
        limit = "%.9g" % made["max_intensity"]
        free = optimise("--max-intensity", "0", "--certify", "proof.vdb")
        within = optimise("--method", "minimax", "--max-intensity", limit, "--iterations", "600", "--patience", "0")
        best = [latitude(within["least_void_over_part"]), latitude(free["certificate"]["least_void_over_part"])]
        others = [in_time(method, limit, made["seconds"]) for method in OTHERS]
        share = made["latitude"] / best[0]
        print("| %s | %.3f | %.3f | %.3f | %.2f | %.2f | %d | %.2f | %.3f (%.2f) | " % (
            name, *best, made["latitude"], share, made["seconds"], made["iterations"],
            made["max_intensity"] / made["even_intensity"], free["latitude"], free["latitude"] / best[1]) +
            " | ".join("%.3f" % value for value in others) + " |")
        sys.stdout.flush()
        failed = failed or share < 0.6 or max(others) > made["latitude"] + 0.02
    return failed


if __name__ == "__main__":
    sys.exit(main())
