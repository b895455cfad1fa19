#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Does the preview say what the whole run finds? Twenty parts, some of which cannot print.

    python3 tests/bench/preview.py [BUILD]

Walls from comfortable to thinner than a voxel, low contrast in absorbing resin, short lenses, light that is blurred, a
metal insert. A whole run prints where its process window is above 0. The preview agrees where it says yes or no rightly,
and where it says unsure of a window within 0.05 of 0 or of walls that its voxels do not show. It must never say yes of
what does not print. Exit status 1 below 18 of 20, or for one such yes.
"""
import json
import os
import subprocess
import sys
import tempfile

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
SHORT = ["--set", "projector.throw_ratio=0.8"]
ABSORBING = ["--set", "resin.absorption_per_mm=0.15"]
BLURRED = ["--set", "resin.psf_mm=0.35"]
PARTS = [  # name, shape, voxel in mm, settings, options of vam-slice
    ("gyroid", "gyroid:diameter=14,height=10,cell=5,sheet=0.9", 0.13, [], []),
    ("gyroid, thin sheet", "gyroid:diameter=14,height=10,cell=5,sheet=0.3", 0.13, [], []),
    ("gyroid, fine cells", "gyroid:diameter=10,height=6,cell=1.5,sheet=0.3", 0.13, [], []),
    ("gyroid, blurred", "gyroid:diameter=10,height=8,cell=2.5,sheet=0.5", 0.13, BLURRED, []),
    ("gyroid, absorbing", "gyroid:diameter=14,height=8,cell=4,sheet=0.8", 0.13, ABSORBING, []),
    ("gyroid, short lens", "gyroid:diameter=12,height=12,cell=4,sheet=0.8", 0.13, SHORT, []),
    ("octet", "octet", 0.13, [], []),
    ("octet, blurred", "octet", 0.13, BLURRED, []),
    ("octet, short lens", "octet", 0.13, SHORT, []),
    ("boat", "boat", 0.13, [], []),
    ("boat, absorbing", "boat", 0.13, ABSORBING, []),
    ("boat, blurred", "boat", 0.13, ["--set", "resin.psf_mm=0.8"], []),
    ("hollow cylinder", "hollow-cylinder:outer=12,inner=6,height=10", 0.13, [], []),
    ("thin tube", "hollow-cylinder:outer=12,inner=11.6,height=10", 0.13, [], []),
    ("thick tube, narrow bore", "hollow-cylinder:outer=13,inner=0.6,height=8", 0.13, [], []),
    ("tube, absorbing", "hollow-cylinder:outer=14,inner=8,height=8", 0.13, ABSORBING, []),
    ("disc grid", "disc-grid", 0.13, [], []),
    ("disc grid, blurred", "disc-grid", 0.13, ["--set", "resin.psf_mm=0.5"], []),
    ("half cylinder", "half-cylinder:diameter=12,height=8", 0.13, [], []),
    ("gyroid round a rod", "gyroid:diameter=14,height=8,cell=4,sheet=0.8", 0.13, [],
     ["--insert-shape", "cylinder:diameter=3,height=20", "--cut-insert", "0.2"]),
]
NEAR = 0.05  # a window as near to 0 as this is not sure


def run(tool, *words):
    ended = subprocess.run([os.path.join(BUILD, "bin", tool), *words, "--quiet"], capture_output=True, text=True)
    return ended.returncode, ended.stderr.strip()


def report_of(*words):
    status, problem = run("vam-optimize", "part.vdb", "--report", "report.json", *words)
    if status != 0:
        return None, problem
    with open("report.json", encoding="utf-8") as file:
        return json.load(file), ""


def main():
    os.chdir(tempfile.mkdtemp())
    agree = optimistic = 0
    print("| part | preview | PW there | PW of the whole run | agrees |\n|---|---|---|---|---|")
    for name, shape, voxel, settings, slicing in PARTS:
        status, problem = run("vam-slice", "--shape", shape, "--voxel", str(voxel), *settings, *slicing, "-o", "part.vdb")
        if status != 0:
            sys.exit(f"{name}: {problem}")
        seen, problem = report_of("--preview", *settings)
        whole, refused = report_of(*settings, "-o", "frames.exr")
        says = seen["prints"] if seen else "no"
        window = whole["pw"] if whole else -1.0
        thin = seen is not None and seen["unresolved_part"] + seen["unresolved_gaps"] > 0.02
        right = {"yes": window > 0, "no": window <= 0, "unsure": abs(window) <= NEAR or thin}[says]
        agree += right
        optimistic += says == "yes" and window <= 0
        print(f"| {name} | {says} | {seen['pw'] if seen and 'pw' in seen else float('nan'):.3f} | "
              f"{window:.3f}{' ' + refused if refused else ''} | {'yes' if right else 'NO'} |", flush=True)
    print(f"\n{agree} of {len(PARTS)} agree; {optimistic} were optimistic")
    return 0 if agree >= 18 and optimistic == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
