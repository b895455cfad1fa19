"""Holds live scans against the simulated camera's own log and settings.
usage: scan_judge.py latency LOG STACK           how late the stack's times are, by the log's middles of exposures: median
                                                 and range of nine tenths of the frames, in ms
       scan_judge.py flat FIELD VIGNETTING SIGMA  "good" or "bad", the part of pixels within 2 sigma, the worst error"""

import json
import os
import struct
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import exr  # noqa: E402


def latency(log, stack):
    # Several captures were served, each numbered anew by its client; but frames are a period apart, and the delay less.
    times = [json.loads(line)["t_monotonic_s"] for line in open(log)]
    late = []
    for head in exr.read(stack)[0][10:]:  # the first ones have not found the shortest way yet
        taken_s = struct.unpack("<d", head["vam:time_s"])[0]
        late.append(taken_s - max(t for t in times if t <= taken_s))
    late.sort()
    print(1e3 * late[len(late) // 2], 1e3 * (late[int(0.95 * len(late))] - late[int(0.05 * len(late))]))


def flat(path, vignetting, sigma):
    rows = {row: values for _, row, values in exr.read(path)[1]}
    height, width = len(rows), len(rows[0])
    reach = 0.25 * (width * width + height * height)
    truth = {(x, y): 1 - vignetting * ((x - 0.5 * (width - 1)) ** 2 + (y - 0.5 * (height - 1)) ** 2) / reach
             for y in range(height) for x in range(width)}
    mean = sum(truth.values()) / len(truth)
    off = [abs(rows[y][x] - value / mean) for (x, y), value in truth.items()]
    inside = sum(1 for error in off if error <= 2 * sigma) / len(off)
    print("good" if inside > 0.9 and max(off) < 6 * sigma else "bad", round(inside, 4), round(max(off), 5), sigma)


if sys.argv[1] == "latency":
    latency(*sys.argv[2:])
else:
    flat(sys.argv[2], float(sys.argv[3]), float(sys.argv[4]))
