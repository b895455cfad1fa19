#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Is limited light at least as good as unlimited light that was clipped? Every method, five parts, five limits.

    python3 tests/bench/limits.py [BUILD [NAME...]]

Voxels of 0.26 mm, 90 angles, 60 iterations at most; limits are 1/2 to 1/8 of the unlimited light's peak. Prints a line
a run: the process windows of the unlimited light, of the limited one and of the clipped one. Exit status 1 if a limited
window is below the clipped one by more than 0.003 of the largest dose, or a run fails.
"""
import json
import os
import subprocess
import sys
import tempfile

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
NAMES = sys.argv[2:]
PARTS = {
    "gyroid": ["--shape", "gyroid"],
    "octet": ["--shape", "octet"],
    "boat": ["--shape", "boat"],
    "hollow cylinder": ["--shape", "hollow-cylinder"],
    "disc grid": ["--shape", "disc-grid"],
}
METHODS = ["cal", "osmo", "pm", "bclp", "apg", "minimax"]
ALLOWED = 0.003


def run(tool, *words):
    return subprocess.run([os.path.join(BUILD, "bin", tool), *words, "--quiet"], stderr=subprocess.PIPE, text=True)


def optimise(method, limit, *words):
    """The report; nothing where the limit cannot give the threshold's dose, which is refused."""
    ended = run("vam-optimize", "part.vdb", "--angles", "90", "--method", method, "--max-intensity", "%g" % limit, "--report",
                "report.json", *words)
    if "more than" in ended.stderr and ended.returncode == 64:
        return None
    if ended.returncode != 0:
        sys.exit(ended.stderr)
    with open("report.json", encoding="utf-8") as file:
        return json.load(file)


def main():
    os.chdir(tempfile.mkdtemp())
    worse = 0
    print("| part | method | limit / peak | PW unlimited | limited | clipped |\n|---|---|---|---|---|---|")
    for name, shape in PARTS.items():
        if NAMES and name not in NAMES:
            continue
        sliced = run("vam-slice", *shape, "--voxel", "0.26", "-o", "part.vdb")
        if sliced.returncode != 0:
            sys.exit(sliced.stderr)
        for method in METHODS:
            free = optimise(method, 0, "--iterations", "60", "-o", "free.exr")
            for part in (2, 3, 4, 6, 8):
                limit = free["peak_intensity"] / part
                clipped = optimise(method, limit, "--init", "free.exr", "--iterations", "0", "-o", "clipped.exr")
                if clipped is None:
                    break
                limited = optimise(method, limit, "--iterations", "60", "-o", "limited.exr")
                bad = limited["pw"] < clipped["pw"] - ALLOWED
                worse += bad
                print("| %s | %s | 1/%d | %.3f | %.3f | %.3f%s |" % (name, method, part, free["pw"], limited["pw"],
                                                                   clipped["pw"], " worse" if bad else ""), flush=True)
    return 1 if worse else 0


sys.exit(main())
