# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends a tool that shows light behind a dead-man relay, again and again, and lets the simulated relay's log say when it
opened. usage: relay_trials.py TRIALS. Prints a table; exit status 1 when one trial took longer than the relay states.

Alone: tool and guardian are killed at once, as by the death of the machine, so that only the relay is left."""

import glob
import os
import signal
import subprocess
import sys
import tempfile
import time

from trials import LIMIT_S, LOADED_LIMIT_S, LOOPS, NEVER, Log, end_by, load, report

STATED_S = 0.3  # of the relay, after the last heartbeat
TICK_S = 0.02   # of the simulator and of this machine
COMMAND = ["vam-project", "--pattern", "grey", "-o", "null:", "--light", "sim:", "--hold", "60", "--set"]


def children(pid):
    return [int(word) for path in glob.glob(f"/proc/{pid}/task/*/children") for word in open(path).read().split()]


def end(cause, process):
    if cause != "alone":
        return end_by(cause, process)
    start = time.monotonic()
    for pid in [*children(process.pid), process.pid]:
        os.kill(pid, signal.SIGKILL)
    return start


def trial(cause, log, command, environment):
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment)
    closed = log.wait(lambda event: event["event"] == "closed", 10)
    log.wait(lambda event: event.get("text") == "H", 3)
    start = end(cause, process)
    opened = log.wait(lambda event: event["event"] == "open", 3)
    process.wait(3)
    process.stdout.close()
    if not closed or not opened:
        return NEVER, ""
    return opened["t_monotonic_s"] - start, opened["reason"]


def table(count, log, command, environment, what, limit_s):
    failed = 0
    for cause in [signal.SIGKILL, signal.SIGTERM, "hang", "alone"]:
        by_itself = cause in ("hang", "alone")
        done = [trial(cause, log, command, environment) for _ in range(count)]
        name = "stopped" if cause == "hang" else cause  # the relay does not wait for a guardian
        failed += report(name, [seconds for seconds, _ in done], what, STATED_S + TICK_S if by_itself else limit_s)
        failed += {why for _, why in done} != {"heartbeat" if by_itself else "order"}
    return failed


def main():
    shim = subprocess.run(["vam-sim", "stage", "--shim"], check=True, capture_output=True, text=True).stdout.strip()
    with tempfile.TemporaryDirectory() as folder:
        truth = os.path.join(folder, "truth")
        open(truth, "w").close()
        relay = subprocess.Popen(["vam-sim", "stage", "--protocol", "relay", "--log", truth, "--die-with-parent"],
                                 stdout=subprocess.PIPE, text=True)
        command = [*COMMAND, f"projector.relay=relay:{relay.stdout.readline().strip()}"]
        environment = dict(os.environ, LD_PRELOAD=shim, VAM_LOCK_DIR=folder)
        log = Log(truth)
        failed = table(int(sys.argv[1]), log, command, environment, "", LIMIT_S)
        with load(LOOPS):
            failed += table(int(sys.argv[1]), log, command, environment, "busy ", LOADED_LIMIT_S)
        relay.kill()
        relay.wait()
    sys.exit(failed > 0)


main()
