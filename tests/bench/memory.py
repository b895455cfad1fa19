#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do the tools keep to the memory that their manuals say? A gyroid of three voxel sizes, and a rod of 50,000 slices.

    python3 tests/bench/memory.py [BUILD [VOXEL_MM...]]

The default voxels give volumes of 10, 40 and 130 million. Exit status 1 if a process takes more peak RSS than its
formula, or at 130 million more than 4 GiB (vam-optimize) and 0.5 GiB (the others), or grows with the slices of the rod,
which are small, by more than its manual says.
"""
import math
import os
import subprocess
import sys
import tempfile

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
VOXELS = [float(v) for v in sys.argv[2:]] or [0.0705, 0.0445, 0.03]
COLUMNS, PIXEL_MM, ANGLES, RESIN_MM, REACH_MM, HEIGHT_MM = 1024, 0.065, 360, 12.7, 8.3, 12.4  # the built-in printer
MIB = 1 << 20


def run(tool, *words):
    """Peak RSS in MiB, of the process or of its child."""
    child = subprocess.Popen([BUILD + "/bin/" + tool, *words], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit("%s: status %d" % (tool, child.returncode))
    return usage.ru_maxrss / 1024


def formulas(voxel):
    """Million voxels of the dose, and the MiB of the manuals' formulas."""
    side = 2 * REACH_MM / voxel
    rows = HEIGHT_MM / voxel
    slice_bytes = 4 * side * side
    topology = 0.3 * side * side * rows
    reach_rows = 16 * math.ceil(64 / 16 + 2 + 0.5 / voxel / 16)  # rays climb by 0.25 mm at the ends of 12.4 mm
    light = 4 * reach_rows * ANGLES * 2 * RESIN_MM / PIXEL_MM
    images = 48 * 4 * COLUMNS * ANGLES
    corner = min(RESIN_MM, math.sqrt(2) * REACH_MM)
    table = 90 * 1440 * (REACH_MM + 8 * (corner - REACH_MM)) / voxel
    dose = 90 * slice_bytes + light + images + table + topology + 0.1 * 1024 * MIB
    score = 32 * slice_bytes + topology + 0.15 * 1024 * MIB
    slices = 16 * math.ceil((rows + 2 * (1 + 0.5 / voxel)) / 16)  # with those that the light climbs to
    arrays = 3 * slices * (slice_bytes + 4 * ANGLES * 2 * RESIN_MM / PIXEL_MM)
    return side * side * rows / 1e6, (arrays + 0.2 * 1024 * MIB) / MIB, dose / MIB, score / MIB


# kB a slice that the manuals say; of volumes those of a rod of 16 x 16 voxels, which are a block of 8 slices wide.
PER_SLICE = {"vam-slice": 1.5, "vam-sinogram": 2, "vam-optimize": 2, "vam-resample": 1.5, "vam-convert": 0.5,
             "vam-check": 0.5, "vam-view": 1.5}


def rod(slices):
    """Peak RSS in MiB of each tool, where rays are level."""
    pixel = 0.018
    settings = ["telecentric=true", "rows=60000", "columns=64", "axis_row=30000", "pixel_mm=%g" % pixel]
    run("vam-slice", "--print-printer", *(w for s in settings for w in ("--set", "projector." + s)), "--set",
        "vial.radius_mm=2", "--set", "vial.wall_mm=0.5", "-o", "rod.toml")
    printer = ["--printer", "rod.toml"]
    return {
        "vam-slice": run("vam-slice", *printer, "--shape", "cylinder:diameter=0.25,height=%g" % (slices * pixel),
                         "--voxel", str(pixel), "-o", "rod.vdb"),
        "vam-optimize": run("vam-optimize", *printer, "rod.vdb", "--angles", "12", "--method", "dose-norm", "-o",
                            "light.exr"),
        "vam-sinogram": run("vam-sinogram", "rod.vdb", "--angles", "12", "-o", "rod.exr"),
        "vam-resample": run("vam-resample", *printer, "rod.exr", "-o", "frames.exr"),
        "vam-convert": run("vam-convert", "join", "light.exr", "-o", "copy.exr"),
        "vam-check": run("vam-check", "light.exr"),
        "vam-view": run("vam-view", "rod.vdb", "-o", "rod.png"),
    }


def rods():
    """Whether memory grows with the slices as the manuals say."""
    kept = True
    few, many = rod(5000), rod(50000)
    for tool, most in PER_SLICE.items():
        growth = (many[tool] - few[tool]) * MIB / 1000 / 45000
        print("a rod of 5,000 and 50,000 slices: %s %.0f and %.0f MiB, %.2f kB a slice of %g" %
              (tool, few[tool], many[tool], growth, most), flush=True)
        kept = kept and growth <= most
    return kept


def main():
    os.chdir(tempfile.mkdtemp())
    kept = rods()
    for voxel in VOXELS:
        voxels, most_light, most_dose, most_score = formulas(voxel)
        run("vam-slice", "--shape", "gyroid:height=%g" % HEIGHT_MM, "--extent", "writable", "--voxel", str(voxel), "-o",
            "part.vdb")
        light = run("vam-optimize", "part.vdb", "--method", "dose-norm", "-o", "light.exr")
        dose = run("vam-dose", "light.exr", "--like", "part.vdb", "-o", "dose.vdb")
        score = run("vam-score", "dose.vdb", "--target", "part.vdb")
        print("%.0f million voxels: vam-optimize %.0f MiB of %.0f, vam-dose %.0f of %.0f, vam-score %.0f of %.0f" %
              (voxels, light, most_light, dose, most_dose, score, most_score), flush=True)
        kept = kept and light <= most_light and dose <= most_dose and score <= most_score
        kept = kept and (voxels > 131 or light <= 4096 and dose <= 512 and score <= 512)
    return 0 if kept else 1


sys.exit(main())
