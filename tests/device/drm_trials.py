# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges vam-project on a graphics card by the card's own log (drm_card.c), in a folder with part.exr and printer.toml,
and card/ for images. usage: drm_trials.py images FRAMES FLIPS   what was shown is what FLIPS (the tool's log) lists, of the PNGs
              drm_trials.py ends TRIALS CARD.so     black in time after every end of the tool; prints a table"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from screen import raw_grey
from trials import NEVER, SIGNALS, end_by, ended_by, report

COLUMNS, ROWS = 64, 48


def lines(path):
    text = open(path).read() if os.path.exists(path) else ""
    return [json.loads(line) for line in text.split("\n")[:-1]]


def fingerprint(grey):
    """As the card has it: FNV-1a of three bytes a pixel."""
    value = 0xCBF29CE484222325
    for byte in grey:
        for _ in range(3):
            value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return "%016x" % value


def images(frames, flips):
    card = lines("card/log")
    wanted = [fingerprint(raw_grey(path)) for path in sorted(pathlib.Path(frames).glob("*.png"))]
    shown = {line["sequence"]: line for line in card if line["event"] == "flip"}
    told = [line for line in lines(flips) if line["event"] == "flip"]
    black = fingerprint(bytes(COLUMNS * ROWS))
    for line in told:
        flip = shown[line["sequence"]]
        assert flip["pixels"] == (black if line["frame"] < 0 else wanted[line["frame"]])
        assert abs(flip["t_monotonic_s"] - line["t_monotonic_s"]) < 2e-6
    lit = next(i for i, line in enumerate(card) if line.get("shade") == "lit")
    buffers = [i for i, line in enumerate(card) if line["event"] == "buffer"]
    assert len(buffers) == 3 and buffers[-1] < lit  # all are there before the first is shown
    sequences = [line["sequence"] for line in told]
    missed = sum(line.get("missed", 0) for line in told[1:])
    assert missed == sequences[-1] - sequences[0] + 1 - len(sequences)
    assert {line["crtc"] for line in card if line["event"] == "mode"} == {32}  # the other screen keeps its own
    print("exact", len({line["frame"] for line in told}), missed)


class Trial:
    """A print on a card of its own, until an image is on."""

    def __init__(self, folder, card, cause):
        self.cause = cause
        os.makedirs(folder + "/dri")
        open(folder + "/dri/card0", "w").close()
        self.log = folder + "/log"
        self.tool = subprocess.Popen(["vam-project", "part.exr", "-o", "drm:HDMI-A-1", "--speed", "30", "--turns", "9",
                                      "--max-missed", "1", "--printer", "printer.toml", "--log", "/dev/stdout"],
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                     env=dict(os.environ, LD_PRELOAD=card, FAKE_DRM=folder, VAM_LOCK_DIR=folder,
                                              FAKE_DRM_FAULT="busy:30" if cause == "device error" else ""))

    def shown(self):
        return [line for line in lines(self.log) if "shade" in line]

    def lit(self):
        return any(line["shade"] == "lit" for line in self.shown())

    def end(self):
        self.ended = time.monotonic()
        if self.cause != "device error":  # which comes by itself
            self.ended = end_by(self.cause, self.tool)

    def took(self):
        """From the end to the vertical blank at which black is on."""
        if not ended_by(self.cause, self.tool):
            return NEVER
        shown = self.shown()
        while shown and shown[-1]["shade"] == "lit" and time.monotonic() < self.ended + 3:
            time.sleep(0.002)
            shown = self.shown()
        lit = [i for i, line in enumerate(shown) if line["shade"] == "lit"]
        if not lit or lit[-1] + 1 == len(shown):
            return NEVER
        begin = shown[lit[-1]]["t_monotonic_s"] if self.cause == "device error" else self.ended
        return shown[lit[-1] + 1]["t_monotonic_s"] - begin


def trials(cause, count, card):
    """Ten at a time: most of a trial is waiting for the tool to begin."""
    times = []
    for first in range(0, count, 10):
        with tempfile.TemporaryDirectory(dir=".") as folder:
            batch = [Trial(os.path.abspath(f"{folder}/{n}"), card, cause) for n in range(min(10, count - first))]
            deadline = time.monotonic() + 10
            while not all(one.lit() for one in batch) and time.monotonic() < deadline:
                time.sleep(0.01)
            for one in batch:
                one.end()
                time.sleep(0.02)
            times += [one.took() for one in batch]
    return times


def ends(count, card):
    causes = SIGNALS + ["hang", "closed stdout", "device error"]
    failed = sum([report(cause, trials(cause, count, card)) for cause in causes])
    sys.exit(failed > 0)


if sys.argv[1] == "images":
    images(*sys.argv[2:])
else:
    ends(int(sys.argv[2]), sys.argv[3])
