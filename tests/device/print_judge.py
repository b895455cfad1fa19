# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the frames shown were from the angle of the stage, by the simulator's own log.
usage: print_judge.py TRUTH FLIPS [LATENCY_MS]; frames are those of 3600 a turn at 60 Hz and 25 deg/s, their light
comes so long after the flip (0). Prints JSON."""

import bisect
import json
import sys

FRAMES, HZ, SPEED = 3600, 60, 25


def p99(errors):
    return sorted(errors)[int(0.99 * len(errors))]


def ahead(a, b):
    return (a - b + 180) % 360 - 180


def main():
    truth = []
    for line in map(json.loads, open(sys.argv[1])):
        if line["event"] == "zeroed":
            truth = []  # what comes after counts from the new zero
        if line["event"] == "angle":
            truth.append((line["t_monotonic_s"], line["angle_deg"]))
    times = [t for t, _ in truth]

    def angle(t):
        i = bisect.bisect_right(times, t)
        (t0, a0), (t1, a1) = truth[i - 1], truth[i]
        return a0 + (a1 - a0) * (t - t0) / (t1 - t0)

    zero = next(t0 - a0 * (t1 - t0) / (a1 - a0) for (t0, a0), (t1, a1) in zip(truth, truth[1:]) if a1 >= 0)
    latency_s = 1e-3 * float(sys.argv[3]) if len(sys.argv) > 3 else 0
    followed, elapsed, late = [], [], 0
    for line in map(json.loads, open(sys.argv[2])):
        if line["event"] != "flip" or line["frame"] < 0:
            continue
        if line.get("missed") or line.get("late_ms"):
            late += 1  # a missed or late blank is counted by itself
            continue
        middle = line["t_monotonic_s"] + latency_s + 0.5 / HZ
        followed.append(ahead(360 * line["frame"] / FRAMES, angle(middle)))
        elapsed.append(abs(ahead(SPEED * (middle - zero), angle(middle))))
    off = [abs(error) for error in followed]
    print(json.dumps({"flips": len(off), "late": late, "bias_deg": round(sum(followed) / len(off), 4),
                      "p99_deg": round(p99(off), 4), "worst_deg": round(max(off), 4),
                      "elapsed_p99_deg": round(p99(elapsed), 3)}))


main()
