# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the scan of a flat field, taken live, against the simulated camera's settings.
usage: scan_judge.py FIELD VIGNETTING SIGMA   "good" or "bad", the part of pixels within 2 sigma, the worst error"""

import sys

import exr


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


flat(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]))
