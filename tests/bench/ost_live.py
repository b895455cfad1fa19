#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Does vam-ost --live keep up with a camera? Sends turns of 180 views of 480 x 300 pixels at 30 frames a second.

    python3 tests/bench/ost_live.py [BUILD [TURNS [FPS]]]

The pipe stands for the camera: a frame that cannot be written when it is due is late. Printed are the worst lateness,
and for each volume how long after the last frame of its turn it was logged.
"""
import os
import subprocess
import sys
import tempfile
import threading
import time

BUILD, TURNS, FPS = (sys.argv[1:] + ["build/release", "4", "30"][len(sys.argv) - 1:])[:3]
BUILD, TURNS, FPS = os.path.abspath(BUILD), int(TURNS), float(FPS)
VIEWS = 180
RIG = ["vial.radius_mm=12.7", "vial.wall_mm=1", "vial.index_glass=1.52", "camera.distance_mm=200",
       "camera.index_resin=1.5", "camera.azimuth_deg=90"]


def main():
    os.chdir(tempfile.mkdtemp())
    subprocess.run([BUILD + "/render_views", "gyroid:diameter=8,height=8", "views.exr", "columns=480", "rows=300",
                    "pixel=0.05", "angles=%d" % VIEWS, "noise=0.05", "step=0.2"], check=True)
    subprocess.run([BUILD + "/bin/vam-slice", "--shape", "gyroid:diameter=8,height=8", "--voxel", "0.1", "--stretch-z",
                    "1", "-o", "design.vdb"], check=True)
    stream = open("views.exr", "rb").read()
    frame = 480 * 300 * 4 + 300 * 12  # pixels, and 12 bytes before each row
    head = len(stream) - VIEWS * frame
    tool = [BUILD + "/bin/vam-ost", "--live", "--isovalue", "0.5", "--target", "design.vdb", "--log", "-", "-o", "turns",
            "--projections", "turns.png", "--page", "turns.html"]
    for setting in RIG:
        tool += ["--set", setting]
    child = subprocess.Popen(tool, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    logged = []
    reader = threading.Thread(target=lambda: logged.extend((time.monotonic(), line) for line in child.stderr))
    reader.start()
    start = time.monotonic()
    worst = 0.0
    ends = []
    for turn in range(TURNS):
        at = 0
        for view in range(VIEWS):
            due = start + (turn * VIEWS + view) / FPS
            time.sleep(max(0.0, due - time.monotonic()))
            size = head + frame if view == 0 else frame
            child.stdin.write(stream[at:at + size])
            child.stdin.flush()
            at += size
            worst = max(worst, time.monotonic() - due)
        ends.append(time.monotonic())
    sent = time.monotonic() - start
    child.stdin.close()
    child.wait()
    reader.join()
    print("%d frames in %.2f s: %.1f frames a second; the worst frame was %.0f ms late" %
          (TURNS * VIEWS, sent, TURNS * VIEWS / sent, 1000 * worst))
    for end, (when, line) in zip(ends, logged):
        print("volume %.2f s after the last frame of its turn: %s" % (when - end, line.decode().strip()))


main()
