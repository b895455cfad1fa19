# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills vam-print, or one of its tools, in the middle of a print, again and again: by the memory of a virtual screen and
the logs of a simulated relay and stage, how long until the image is off, the relay open and the stage at a standstill.
First on a machine that has nothing else to do, then beside busy loops. usage: print_trials.py TRIALS [several], in a
folder with frames.exr and printer.toml. Prints a table; exit status 1 when one trial took too long.

several: kills more than one at once, a tool with its guardian or vam-print with each of them, of a print with a light
engine, whose LEDs must go off too, and which no longer has anybody to tell it: by its own log."""

import glob
import os
import signal
import subprocess
import sys
import time

from screen import Screen
from trials import LIMIT_S, LOADED_LIMIT_S, LOOPS, NEVER, Log, load, report, wait

PRINT = ["vam-print", "frames.exr", "--display", "sdl:0", "--uncalibrated", "--max-missed", "0.9", "--max-missed-lit", "0.9",
         "--run-up", "0.05", "--turns", "40"]
CALIBRATION = ["vam-calibrate", "all", "--display", "sdl:0", "--scans", "flat", "--set", "camera.device=sim:", "--set", "camera.fps=10"]
ENGINE = ["umockdev-wrapper", os.path.join(os.environ["VAM_BUILD"], "usb_host"), "dlpc350:?outlives=3000", "engine",
          "sh", "-c", 'LD_PRELOAD="$SHIM:$LD_PRELOAD"; echo $$ >pid; exec "$@"', "sh"]
SINGLE = [["vam-print"], ["vam-stage"], ["vam-project"]]
SEVERAL = [["guardian of vam-project", "vam-project"], ["guardian of vam-stage", "vam-stage"],
           ["vam-project", "vam-stage"], ["vam-steward", "vam-print"],
           ["vam-project", "vam-print"], ["vam-stage", "vam-print"],
           ["vam-print", "guardian of vam-project"], ["vam-print", "guardian of vam-stage"],
           ["guardian of vam-project", "vam-project", "vam-print"], ["guardian of vam-stage", "vam-stage", "vam-print"]]
SEVERAL_LIMIT_S = 2  # where vam-print, or what it left to watch, has to notice


def children(pid):
    return {open(f"/proc/{child}/comm").read().strip(): int(child)
            for path in glob.glob(f"/proc/{pid}/task/*/children") for child in open(path).read().split()}


def find(pid, name):
    """The process that is killed: vam-print itself, its child of that name, or that one's guardian."""
    if name == "vam-print":
        return pid
    tool = children(pid).get(name.split()[-1])
    return children(tool).get("vam-guardian") if tool and name.startswith("guardian") else tool


def lit(screen):
    start = screen.offset
    return any(screen.memory[start:start + screen.line * screen.height:4])


def left():
    """The processes of a print that was killed: they may still hold a device."""
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            words = open(path, "rb").read().split(b"\0")
        except OSError:
            continue
        if words[0] in (b"vam-project", b"vam-stage", b"vam-devices") and any(b"killed-" in word for word in words):
            yield path


class Bench:
    """Screen, stage, relay and, for several, a light engine, each with its own witness."""

    def __init__(self, several):
        self.several = several
        self.calibrates = False
        shim = subprocess.run(["vam-sim", "stage", "--shim"], check=True, capture_output=True, text=True).stdout.strip()
        self.simulators = [self.simulate("stage", "truth", "--acceleration", "9000", "--max-speed", "360"),
                           self.simulate("relay", "opened", "--protocol", "relay")]
        self.environment = dict(os.environ, LD_PRELOAD=shim)
        subprocess.run(["vam-stage", "home"], check=True, env=self.environment)
        self.screen = Screen("screen/Xvfb_screen0")
        self.logs = {"relay open": (Log("opened"), lambda event: event["event"] == "open"),
                     "still": (Log("truth"), lambda event: event["event"] == "standing")}
        if several:
            self.environment = dict(os.environ, SHIM=shim)

    def simulate(self, link, log, *options):
        process = subprocess.Popen(["vam-sim", "stage", "--link", link, "--log", log, "--die-with-parent", *options],
                                   stdout=subprocess.PIPE, text=True)
        process.stdout.readline()
        return process

    def start(self, run):
        """The process, and the number of the script that is tried, which may be its child."""
        command = CALIBRATION if self.calibrates else [*PRINT, "--run", run]
        if not self.several:
            process = subprocess.Popen(command, stderr=subprocess.DEVNULL, env=self.environment)
            return process, process.pid
        for name in ("engine", "pid"):
            open(name, "w").close()
        self.logs["LEDs off"] = (Log("engine"), lambda event: event.get("bits") == 0)
        process = subprocess.Popen([*ENGINE, *command, "--light", "dlpc350:"], stderr=open("said", "a"),
                                   env=self.environment)
        wait(lambda: os.path.getsize("pid") > 0, 5)
        return process, int(open("pid").read() or 0)

    def trial(self, names, run):
        """Seconds until each state; None for a print that ended before it was killed."""
        process, pid = self.start(run)
        wait(lambda: process.poll() is not None or lit(self.screen), 20)
        time.sleep(0.3)
        victims = [find(pid, name) for name in names]
        if None in victims or process.poll() is not None or not lit(self.screen):
            process.terminate()
            process.wait(10)
            return None
        for log, _ in self.logs.values():
            log.events()
        start = time.monotonic()
        for victim in victims:
            os.kill(victim, signal.SIGKILL)
        dark = wait(lambda: not lit(self.screen), 3)
        times = {"dark": dark - start if dark else NEVER}
        for state, (log, reached) in self.logs.items():
            event = log.wait(reached, 3)
            times[state] = event["t_monotonic_s"] - start if event else NEVER
        process.wait(10)
        wait(lambda: not any(left()), 3)
        return times

    def trials(self, kills, count, what, limit_s):
        failed = 0
        for names in kills:
            who = " and ".join(names)
            done = []
            for attempt in range(3 * count):
                if len(done) < count:
                    times = self.trial(names, f"killed-{what}{who}-{attempt}".replace(" ", "-"))
                    done += [times] if times else []
            for state in ["dark", *self.logs]:
                times = [times[state] for times in done] + [NEVER] * (count - len(done))
                failed += report(f"{who} killed: {state}", times, what, limit_s)
        return failed


def main():
    count = int(sys.argv[1])
    bench = Bench(sys.argv[2:] == ["several"])
    if bench.several:
        failed = bench.trials(SEVERAL, count, "", SEVERAL_LIMIT_S)
        bench.calibrates = True
        del bench.logs["still"]  # nothing moves
        failed += bench.trials(SEVERAL[:1], count, "calibration ", SEVERAL_LIMIT_S)
    else:
        failed = bench.trials(SINGLE, count, "", LIMIT_S)
        with load(LOOPS):
            failed += bench.trials(SINGLE, count, "busy ", LOADED_LIMIT_S)
    for simulator in bench.simulators:
        simulator.kill()
        simulator.wait()
    sys.exit(failed > 0)


main()
