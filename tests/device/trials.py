# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the safety trials [devices guarantee 1]: ways to end a program, simulator logs, table of results."""

import contextlib
import json
import os
import signal
import subprocess
import time

LIMIT_S = 0.1
LOADED_LIMIT_S = 0.25  # beside LOOPS programs that compute without end
LOOPS = 6
STALL_S = 0.5  # until the guardian takes a tool without progress for hung
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV, signal.SIGABRT, signal.SIGKILL]
NEVER = float("inf")

# Of a tool built with AddressSanitizer: it dies of a signal as any other.
os.environ["ASAN_OPTIONS"] += ":handle_segv=0:detect_leaks=0"


def wait(condition, limit_s):
    """The time when the condition came true, or None."""
    deadline = time.monotonic() + limit_s
    while time.monotonic() < deadline:
        if condition():
            return time.monotonic()
        time.sleep(0.0005)
    return None


@contextlib.contextmanager
def load(loops):
    """So many programs that compute without end, beside what is tried."""
    busy = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(loops)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


class Log:
    """Reads a simulator's log as it grows."""

    def __init__(self, path):
        self.file = open(path)
        self.rest = ""

    def events(self):
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        return [json.loads(line) for line in lines]

    def wait(self, wanted, limit_s):
        """The first new event that is wanted, or None."""
        deadline = time.monotonic() + limit_s
        while time.monotonic() < deadline:
            for event in self.events():
                if wanted(event):
                    return event
            time.sleep(0.001)
        return None


def end_by(cause, process):
    """Starts the end and returns when that was."""
    if cause == "closed stdout":
        process.stdout.close()
    elif cause == "hang":
        process.send_signal(signal.SIGSTOP)
    else:
        process.send_signal(cause)
    return time.monotonic()


def ended_by(cause, process):
    """True when the program is gone, by the signal it was sent."""
    try:
        status = process.wait(3)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        return False
    return cause not in SIGNALS or status == -cause


def report(cause, times, what="", limit=LIMIT_S):
    """Prints a line of the table, which begins with what; returns how many trials took too long."""
    name = cause.name if isinstance(cause, signal.Signals) else cause
    limit += STALL_S if cause == "hang" else 0
    late = sum(1 for t in times if not t <= limit)
    times = sorted(times)
    print(f"# {what}{name}: {len(times)} trials, median {1e3 * times[len(times) // 2]:.1f} ms, worst {1e3 * times[-1]:.1f} ms, "
          f"{late} past {1e3 * limit:.0f} ms", flush=True)
    return late
