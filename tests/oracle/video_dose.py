# SPDX-License-Identifier: GPL-3.0-or-later
"""The dose that a video leaves while the stage turns, summed over its frames by the definition alone: a frame stays lit
until the next one, and every ray adds its pixel's light to what it crosses [physics §2].

    video_dose.py FRAMES TIMES SPEED MIDDLE NX VOXEL PIXEL PARTS >DOSE
        FRAMES  bytes, a row of columns each; TIMES: seconds at which each begins, and the end
        SPEED   deg/s of the stage; MIDDLE: seconds after the start at which it is at 0 deg
        NX VOXEL  square of voxels around the axis, mm; PIXEL: pitch of columns, mm
        PARTS   of a frame's time, each at the angle in its middle
        DOSE    NX x NX doubles, x fastest: turns at full light times the width of a ray in a voxel
"""
import math
import sys

import numpy as np


def mean_over_voxels(light, pixel, x, y, c, s, voxel):
    """Light on the lines through square voxels at (x, y): its second integral differenced over the two shadows."""
    width = pixel * len(light)
    edges = np.linspace(-width / 2, width / 2, len(light) + 1)
    first = np.concatenate([[0], np.cumsum(light) * pixel])  # integral up to each edge
    second = np.concatenate([[0], np.cumsum((first[1:] + first[:-1]) / 2) * pixel])

    def integral(t):
        t = np.clip(t, edges[0], None)
        i = np.minimum(((t - edges[0]) / pixel).astype(int), len(light) - 1)
        d = t - edges[i]
        return second[i] + first[i] * d + light[i] * np.minimum(d, pixel) ** 2 / 2 + light[i] * pixel * np.maximum(d - pixel, 0)

    a, b = max(abs(c), abs(s)) * voxel, max(min(abs(c), abs(s)), 1e-3) * voxel
    t = x * c + y * s
    return (integral(t + (a + b) / 2) - integral(t + (a - b) / 2) - integral(t - (a - b) / 2)
            + integral(t - (a + b) / 2)) / (a * b)


def main(frames, times, speed, middle, nx, voxel, pixel, parts):
    times = np.loadtxt(times)
    frames = np.fromfile(frames, np.uint8).reshape(len(times) - 1, -1) / 255
    speed, middle, nx, voxel, pixel, parts = float(speed), float(middle), int(nx), float(voxel), float(pixel), int(parts)
    at = (np.arange(nx) - (nx - 1) / 2) * voxel
    x, y = np.meshgrid(at, at)
    dose = np.zeros((nx, nx))
    for light, begin, end in zip(frames, times[:-1], times[1:]):
        for part in range(parts):
            angle = math.radians(speed * (begin + (end - begin) * (part + 0.5) / parts - middle))
            turn = abs(speed) * (end - begin) / parts / 360
            dose += turn * mean_over_voxels(light, pixel, x, y, math.cos(angle), math.sin(angle), voxel)
    sys.stdout.buffer.write(dose.tobytes())


main(*sys.argv[1:])
