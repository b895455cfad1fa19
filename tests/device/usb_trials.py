# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends tools that hold USB devices in every way a program can end, again and again, and lets the simulated devices'
own logs say when the order to be safe reached them. usage: usb_trials.py TRIALS, in a folder with part.exr and
printer.toml. Prints a table; exit status 1 when one trial took too long."""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time

from trials import NEVER, SIGNALS, Log, end_by, ended_by, report

DEVICES = {"light": ["dlpc350:", "dlpc900:"], "tic": ["tic:?steps_per_deg=100"]}  # that take turns
COMMANDS = {
    "light": ["vam-project", "part.exr", "-o", "null:", "--speed", "1", "--max-missed", "1", "--light"],
    "tic": ["vam-stage", "spin", "--speed", "60", "--turns", "9", "--device"],
}
STARTED = {"light": lambda event: event.get("bits", 0) > 0, "tic": lambda event: event["event"] == "moving"}
SAFE = {"light": lambda event: event.get("bits") == 0, "tic": lambda event: event["event"] == "halt"}


ON_A_SIMULATED_BUS = ["umockdev-wrapper", os.path.join(os.environ["VAM_BUILD"], "usb_host")]
TELL_PID = ["sh", "-c", 'echo $$; exec "$@" >/dev/null', "sh"]


class Tool:
    """A tool on a USB bus of its own, which outlives it for the guardian's sake and ends with the tool's status."""

    def __init__(self, kind, number, folder):
        self.kind = kind
        os.mkdir(folder)
        path = os.path.join(folder, "log")
        open(path, "w").close()
        self.log = Log(path)
        device = DEVICES[kind][number % len(DEVICES[kind])]
        hardware = device.split("?")[0] + ("?referenced=yes" if kind == "tic" else "")
        self.host = subprocess.Popen(ON_A_SIMULATED_BUS + [hardware, path] + TELL_PID + COMMANDS[kind] + [device],
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                     env=dict(os.environ, VAM_LOCK_DIR=folder))
        self.pid = int(self.host.stdout.readline())

    def send_signal(self, number):
        with contextlib.suppress(ProcessLookupError):  # ended by itself, which its status tells
            os.kill(self.pid, number)

    def wait(self, limit_s):
        status = self.host.wait(limit_s)
        self.host.stdout.close()
        return status if status < 128 else 128 - status


def took(cause, tool, start):
    """From the end of the tool to the order in the device's log."""
    safe = tool.log.wait(SAFE[tool.kind], 3)
    return safe["t_monotonic_s"] - start if ended_by(cause, tool) and safe else NEVER


def trials(cause, count):
    """The times of each kind. Five tools of each begin together, since most of a trial is waiting, and are ended one
    after the other: one that begins would hold up the others' ends."""
    times = {kind: [] for kind in COMMANDS}
    for first in range(0, count, 5):
        with tempfile.TemporaryDirectory(dir=".") as folder:
            tools = [Tool(kind, number, os.path.abspath(f"{folder}/{kind}{number}"))
                     for number in range(first, min(first + 5, count)) for kind in COMMANDS]
            started = [tool.log.wait(STARTED[tool.kind], 10) for tool in tools]
            starts = []
            for tool in tools:
                tool.log.events()
                starts.append(end_by(cause, tool))
                time.sleep(0.02)  # each guardian by itself, as on a machine with one printer
            for tool, begun, start in zip(tools, started, starts):
                seconds = took(cause, tool, start)
                times[tool.kind].append(seconds if begun else NEVER)
    return times


def main():
    failed = 0
    for cause in SIGNALS + ["hang"]:
        for kind, times in trials(cause, int(sys.argv[1])).items():
            failed += report(cause, times, f"{kind}, ")
    sys.exit(failed > 0)


main()
