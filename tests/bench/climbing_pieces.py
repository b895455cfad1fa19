#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far does light of a piece of a part lie from that of the whole part, where rays climb?

    python3 tests/bench/climbing_pieces.py [BUILD [VOXEL_MM [METHOD...]]]

Each part is optimised as a whole, and its upper half with so many slices of the lower one (halo); iterations and
maximum intensity are the same. Prints a line a run: the largest difference of light in the upper half, and its RMS,
relative to the peak of the whole, as they are and with the light of the half at the scale that fits the whole best.
Exit status 1 if more halo makes one of them small (RMS 1e-4): vam-optimize --slices might then take rays that climb.
"""
import array
import json
import os
import subprocess
import sys
import tempfile

BUILD = os.path.abspath((sys.argv[1:] or ["build/release"])[0])
VOXEL = float((sys.argv[2:] or ["0.2"])[0])
METHODS = sys.argv[3:] or ["osmo", "pm", "apg"]
HALOS = [0, 8, 16, 32]
PARTS = {"gyroid": ["gyroid:diameter=7,height=16"], "boat": ["boat", "--fit", "13", "--up", "x"]}
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
os.environ["PATH"] = BUILD + "/bin:" + os.environ["PATH"]
import vam  # noqa: E402


def optimised(part, name, *words):
    """Its light as rows by height, and the report."""
    subprocess.run(["vam-optimize", part, "--angles", "60", "--patience", "0", "--quiet", "-o", name, "--report",
                    "report.json", *words], check=True)
    values, facts = vam.read(name)
    values, size = array.array("f", values), facts["shape"][1] * facts["shape"][2]
    low, step = facts["origin"][0], facts["spacing"][0]
    with open("report.json", encoding="utf-8") as file:
        report = json.load(file)
    return {round((low + k * step) / step * 2): values[k * size:(k + 1) * size]
            for k in range(facts["shape"][0])}, report


def difference(whole, piece, peak, rows, scale):
    most = total = count = 0
    for row in rows:
        for a, b in zip(whole[row], piece[row]):
            if a or b:
                d = abs(a - scale * b)
                most, total = max(most, d), total + d * d
        count += len(whole[row])
    return most / peak, (total / count) ** 0.5 / peak


def main():
    os.chdir(tempfile.mkdtemp())
    small = False
    print("| part | method | halo | largest | RMS | largest at one scale | RMS |\n|---|---|---|---|---|---|---|")
    for name, shape in PARTS.items():
        subprocess.run(["vam-slice", "--shape", *shape, "--voxel", str(VOXEL), "--quiet", "-o", "part.vdb"], check=True)
        values, facts = vam.read("part.vdb", "target")
        values = array.array("f", values)
        nz, ny, nx = facts["shape"]
        z, y, x = facts["origin"]
        half, plane = nz // 2, nx * ny
        for halo in HALOS:
            first = max(0, half - halo)
            vam.write_volume("%d.vdb" % halo, values[first * plane:], VOXEL, (x, y, z + first * VOXEL),
                             shape=(nz - first, ny, nx))
        for method in METHODS:
            words = ["--method", method, "--iterations", "8"]
            whole, report = optimised("part.vdb", "whole.exr", *words)
            words += ["--max-intensity", "%.9g" % report["max_intensity"]] if report.get("max_intensity") else []
            if report.get("max_intensity"):
                whole, report = optimised("part.vdb", "whole.exr", *words)
            peak = max(max(row) for row in whole.values())
            for halo in HALOS:
                piece, _ = optimised("%d.vdb" % halo, "piece.exr", *words)
                rows = [row for row in whole if row in piece and row >= round((z + half * VOXEL) / VOXEL * 2)]
                ab = sum(a * b for row in rows for a, b in zip(whole[row], piece[row]) if b)
                bb = sum(b * b for row in rows for b in piece[row] if b)
                plain, scaled = difference(whole, piece, peak, rows, 1), difference(whole, piece, peak, rows, ab / bb)
                print("| %s | %s | %d | %.2g | %.2g | %.2g | %.2g |" % (name, method, halo, *plain, *scaled), flush=True)
                small = small or min(plain[1], scaled[1]) <= 1e-4
    return 1 if small else 0


sys.exit(main())
