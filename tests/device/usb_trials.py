"""Ends a tool that holds a USB device in every way a program can end, again and again, and lets the simulated device's
own log say when the order to be safe reached it. usage: usb_trials.py dlpc350|tic TRIALS, in a folder with part.exr and
printer.toml. Prints a table; exit status 1 when one trial took too long."""

import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from trials import NEVER, SIGNALS, Log, end_by, ended_by, report  # noqa: E402

COMMANDS = {
    "dlpc350": ["vam-project", "part.exr", "-o", "null:", "--light", "dlpc350:", "--speed", "1", "--missed", "1"],
    "tic": ["vam-stage", "spin", "--device", "tic:?steps_per_deg=100", "--speed", "60", "--turns", "9"],
}
STARTED = {"dlpc350": lambda event: event.get("bits", 0) > 0, "tic": lambda event: event["event"] == "moving"}
SAFE = {"dlpc350": lambda event: event.get("bits") == 0, "tic": lambda event: event["event"] == "halt"}


ON_A_SIMULATED_BUS = ["umockdev-wrapper", os.path.join(os.environ["VAM_BUILD"], "usb_host")]
TELL_PID = ["sh", "-c", 'echo $$; exec "$@" >/dev/null', "sh"]


class Tool:
    """A tool on a USB bus of its own, which outlives it for the guardian's sake and then ends with the tool's status."""

    def __init__(self, device, folder):
        os.mkdir(folder)
        path = os.path.join(folder, "log")
        open(path, "w").close()
        self.log = Log(path)
        self.host = subprocess.Popen(ON_A_SIMULATED_BUS + [device, path] + TELL_PID + COMMANDS[device],
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                     env=dict(os.environ, VAM_LOCK_DIR=folder))
        self.pid = int(self.host.stdout.readline())

    def send_signal(self, number):
        os.kill(self.pid, number)

    def wait(self, limit_s):
        status = self.host.wait(limit_s)
        self.host.stdout.close()
        return status if status < 128 else 128 - status


def took(device, cause, tool, start):
    """From the end of the tool to the order in the device's log."""
    safe = tool.log.wait(SAFE[device], 3)
    return safe["t_monotonic_s"] - start if ended_by(cause, tool) and safe else NEVER


def trials(device, cause, count):
    """Five tools at a time, ended one after the other: most of a trial is waiting."""
    times = []
    while len(times) < count:
        with tempfile.TemporaryDirectory(dir=".") as folder:
            tools = [Tool(device, os.path.abspath(f"{folder}/{n}")) for n in range(min(5, count - len(times)))]
            started = [tool.log.wait(STARTED[device], 10) for tool in tools]
            starts = []
            for tool in tools:
                tool.log.events()
                starts.append(end_by(cause, tool))
                time.sleep(0.02)  # each guardian by itself, as on a machine with one printer
            for tool, begun, start in zip(tools, started, starts):
                seconds = took(device, cause, tool, start)
                times.append(seconds if begun else NEVER)
    return times


def main():
    device, count = sys.argv[1], int(sys.argv[2])
    print(f"# {device}")
    failed = sum([report(cause, trials(device, cause, count)) for cause in SIGNALS + ["hang"]])
    sys.exit(failed > 0)


main()
