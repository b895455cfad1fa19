# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends vam-project in every way a program can end while an image is on, again and again, and reads from the memory of
a virtual screen when it was black. usage: project_trials.py TRIALS, in a folder with part.exr and printer.toml. Prints a
table; exit status 1 when one trial took too long."""

import concurrent.futures
import os
import queue
import subprocess
import sys
import threading
import time

from screen import Screen
from trials import NEVER, SIGNALS, end_by, ended_by, report, wait

LANES = 9  # of trials: a cause each; every lane must have as many as the others


def black(screen):
    """True when no grey byte is above 0; the fourth byte of a pixel is not shown."""
    image = screen.memory[screen.offset:screen.offset + screen.line * screen.height]
    return not any(image[0::4]) and not any(image[1::4]) and not any(image[2::4])


def angles(table):
    """Lines of a stage that turns at 30 deg/s, up to now. table: the last line's time and the start's."""
    now = time.monotonic()
    lines = []
    while table[0] < now:
        table[0] += 0.01
        lines.append('{"t_monotonic_s":%.6f,"angle_deg":%.5f,"sigma_deg":0.001}\n' % (table[0], 30 * (table[0] - table[1])))
    return "".join(lines).encode()


class Feeder(threading.Thread):
    """Prints the angle of a stage until stopped or until the reader has gone."""

    def __init__(self, pipe):
        super().__init__(daemon=True)
        self.pipe, self.enough = pipe, threading.Event()
        self.start()

    def run(self):
        table = [time.monotonic() - 1] * 2
        while not self.enough.wait(0.02):
            try:
                self.pipe.write(angles(table))
                self.pipe.flush()
            except (BrokenPipeError, ValueError):
                return

    def stop(self):
        self.enough.set()
        self.join()


def begin(venue):
    """A tool that has had an image on for 50 ms, and what feeds it; or None for a tool."""
    tool = subprocess.Popen(["vam-project", "part.exr", "-o", "sdl:0", "--follow", "-", "--turns", "9", "--max-missed", "1"],
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            env=venue.environment)
    feeder = Feeder(tool.stdin)
    lit = wait(lambda: tool.poll() is not None or not black(venue.screen), 10)
    time.sleep(0.05)
    if not lit or tool.poll() is not None:
        feeder.stop()
        tool.kill()
        return None, feeder
    return tool, feeder


def end(cause, tool, feeder, screen):
    """Ends the tool; the seconds until the screen was black."""
    if cause in ("end of the angles", "malformed angle"):
        feeder.stop()
        start = time.monotonic()
        if cause == "malformed angle":
            tool.stdin.write(b"garbage\n")
            tool.stdin.flush()
        else:
            tool.stdin.close()
    else:
        start = end_by(cause, tool)
    dark = wait(lambda: black(screen), 3)
    return dark - start if ended_by(cause, tool) and dark else NEVER


class Venue:
    """A virtual screen of its own, and a place for locks; so that several trials can run beside each other."""

    def __init__(self, folder):
        os.makedirs(folder)
        reader, writer = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "64x48x24", "-fbdir", folder,
                                        "-nolisten", "tcp", "-noreset", "-nocursor"], pass_fds=[writer],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        display = os.read(reader, 10).decode().strip()
        self.screen = Screen(os.path.join(folder, "Xvfb_screen0"))
        self.environment = dict(os.environ, DISPLAY=":" + display, SDL_VIDEODRIVER="x11", SDL_RENDER_DRIVER="software",
                                VAM_LOCK_DIR=os.path.abspath(folder))


def trials(cause, count, free, step, turn):
    """All lanes begin their tools together, then end them one at a time: a tool that begins would hold up the others."""
    venue = free.get()
    times = []
    for _ in range(count):
        tool, feeder = begin(venue)
        step.wait(60)
        with turn:
            times.append(end(cause, tool, feeder, venue.screen) if tool else NEVER)
        feeder.stop()
        step.wait(60)
    free.put(venue)
    return times


def main():
    count = int(sys.argv[1])
    causes = SIGNALS + ["hang", "end of the angles", "malformed angle"]
    venues = [Venue(f"screen{number}") for number in range(LANES)]
    free = queue.SimpleQueue()
    for venue in venues:
        free.put(venue)
    step, turn = threading.Barrier(LANES), threading.Lock()
    try:
        with concurrent.futures.ThreadPoolExecutor(LANES) as pool:
            results = pool.map(lambda cause: trials(cause, count, free, step, turn), causes)
            failed = sum([report(cause, times) for cause, times in zip(causes, results)])
    finally:
        for venue in venues:
            venue.server.kill()
            venue.server.wait()
    sys.exit(failed > 0)


main()
