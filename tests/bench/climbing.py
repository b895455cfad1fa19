#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do parts print in rays that climb? Light by vam-optimize, judged by vam-dose and by the deposition oracle.

    python3 tests/bench/climbing.py [BUILD [RAYS [NAME...]]]

Voxels of 0.13 mm, 360 angles, the built-in printer unless said; the void is judged to the writable radius, and above
and below the part. RAYS x RAYS rays a pixel of the oracle (default 4: doses
differ by some 1e-3 RMS). Exit status 1 unless every part prints without an error to both judges.
"""
import json
import os
import subprocess
import sys
import tempfile

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
RAYS = (sys.argv[2:] or ["4"])[0]
NAMES = sys.argv[3:]
SHORT = ["--set", "projector.throw_ratio=1"]
EDGE = ["--set", "projector.axis_row=767"]
PARTS = {
    "gyroid, 10 mm": (["--shape", "gyroid"], []),
    "gyroid, 24 mm": (["--shape", "gyroid:height=24"], []),
    "boat": (["--shape", "boat"], []),
    "boat on its stern, 20 mm": (["--shape", "boat", "--rotate", "0,-90,0", "--fit", "20"], []),
    "octet, 46 mm": (["--shape", "octet:layers=9"], []),
    "gyroid, 10 mm, throw ratio 1": (["--shape", "gyroid"], SHORT),
    "gyroid, 24 mm, throw ratio 1": (["--shape", "gyroid:height=24"], SHORT),
    "gyroid, 10 mm, lens at the lower edge": (["--shape", "gyroid"], EDGE),
}


def run(tool, *words):
    return subprocess.run([os.path.join(BUILD, tool), *words], check=True, stdout=subprocess.PIPE, text=True).stdout


def judge(dose):
    run("bin/vam-score", dose, "--target", "part.vdb", "--report", "score.json")
    with open("score.json", encoding="utf-8") as file:
        return json.load(file)


def main():
    os.chdir(tempfile.mkdtemp())
    print("| part | VER | PW | IoU | oracle: VER | PW | IoU | RMS of the doses' difference |\n|---|---|---|---|---|---|---|---|")
    printed = True
    for name, (shape, printer) in PARTS.items():
        if NAMES and not any(one in name for one in NAMES):
            continue
        run("bin/vam-slice", *shape, "--voxel", "0.13", *printer, "-o", "part.vdb")
        run("bin/vam-optimize", "part.vdb", "--angles", "360", *printer, "-o", "light.exr")
        run("bin/vam-dose", "light.exr", "--like", "part.vdb", *printer, "-o", "dose.vdb")
        difference = json.loads(run("deposit_dose", "light.exr", "dose.vdb", "deposited.vdb", RAYS))
        ours, oracle = judge("dose.vdb"), judge("deposited.vdb")
        figures = ["%.2g | %.3f | %.4g" % (s["ver"], s["pw"], s["iou"]) for s in (ours, oracle)]
        print("| %s | %s | %s | %.2g |" % (name, *figures, difference["rms"]), flush=True)
        printed = printed and ours["ver"] == 0 and oracle["ver"] == 0
    return 0 if printed else 1


sys.exit(main())
