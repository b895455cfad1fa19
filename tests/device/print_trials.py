# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills vam-print, or one of its tools, in the middle of a print, again and again: by the memory of a virtual screen and
the logs of a simulated relay and stage, how long until the light is off, the relay open and the stage at a standstill. First on a machine that has nothing
else to do, then beside busy loops. usage: print_trials.py TRIALS, in a folder with frames.exr and printer.toml. Prints a
table; exit status 1 when one trial took too long."""

import glob
import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from screen import Screen  # noqa: E402
from trials import LIMIT_S, LOADED_LIMIT_S, LOOPS, NEVER, Log, load, report, wait  # noqa: E402

COMMAND = ["vam-print", "frames.exr", "--screen", "sdl:0", "--uncalibrated", "--max-missed", "0.9", "--max-missed-lit", "0.9",
           "--run-up", "0.05", "--turns", "40", "--run"]


def tool_of(pid, name):
    """The process that is killed: vam-print itself, or its child of that name."""
    if name == "vam-print":
        return pid
    for path in glob.glob(f"/proc/{pid}/task/*/children"):
        for child in open(path).read().split():
            if open(f"/proc/{child}/comm").read().strip() == name:
                return int(child)
    return None


def lit(screen):
    start = screen.offset
    return any(screen.memory[start:start + screen.line * screen.height:4])


def trial(name, run, screen, log, relay, environment):
    """Seconds until dark, until the relay is open, and until still; None for a print that ended before it was killed."""
    process = subprocess.Popen([*COMMAND, run], stderr=subprocess.DEVNULL, env=environment)
    wait(lambda: process.poll() is not None or lit(screen), 20)
    time.sleep(0.3)
    victim = tool_of(process.pid, name)
    if victim is None or process.poll() is not None or not lit(screen):
        process.terminate()
        process.wait(10)
        return None
    log.events()
    relay.events()
    start = time.monotonic()
    os.kill(victim, signal.SIGKILL)
    dark = wait(lambda: not lit(screen), 3)
    opened = relay.wait(lambda event: event["event"] == "open", 3)
    stood = log.wait(lambda event: event["event"] == "standing", 3)
    process.wait(10)
    wait(lambda: not any(other(path) for path in glob.glob("/proc/[0-9]*/cmdline")), 3)
    return (dark - start if dark else NEVER, opened["t_monotonic_s"] - start if opened else NEVER,
            stood["t_monotonic_s"] - start if stood else NEVER)


def other(path):
    """Is it a tool of a print that was killed? It may still hold a device."""
    try:
        words = open(path, "rb").read().split(b"\0")
    except OSError:
        return False
    return words[0] in (b"vam-project", b"vam-stage") and any(word.startswith(b"killed-") for word in words)


def trials(count, screen, log, relay, environment, what, limit_s):
    failed = 0
    for name in ["vam-print", "vam-stage", "vam-project"]:
        done = []
        for attempt in range(3 * count):
            if len(done) < count:
                done.append(trial(name, f"killed-{what}{name}-{attempt}", screen, log, relay, environment))
                done = [times for times in done if times]
        done += [(NEVER, NEVER, NEVER)] * (count - len(done))
        for n, state in enumerate(["dark", "relay open", "still"]):
            failed += report(f"{name} killed: {state}", [times[n] for times in done], what, limit_s)
    return failed


def main():
    count = int(sys.argv[1])
    shim = subprocess.run(["vam-sim-stage", "--shim"], check=True, capture_output=True, text=True).stdout.strip()
    stage = subprocess.Popen(["vam-sim-stage", "--link", "stage", "--log", "truth", "--die-with-parent", "--acceleration",
                              "9000", "--max-speed", "360"], stdout=subprocess.PIPE, text=True)
    stage.stdout.readline()
    relay = subprocess.Popen(["vam-sim-stage", "--protocol", "relay", "--link", "relay", "--log", "opened", "--die-with-parent"],
                             stdout=subprocess.PIPE, text=True)
    relay.stdout.readline()
    environment = dict(os.environ, LD_PRELOAD=shim)
    subprocess.run(["vam-stage", "home"], check=True, env=environment)
    screen, log = Screen("screen/Xvfb_screen0"), Log("truth")
    logs = [log, Log("opened"), environment]
    failed = trials(count, screen, *logs, "", LIMIT_S)
    with load(LOOPS):
        failed += trials(count, screen, *logs, "busy ", LOADED_LIMIT_S)
    for simulator in (stage, relay):
        simulator.kill()
        simulator.wait()
    sys.exit(failed > 0)


main()
