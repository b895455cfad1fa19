# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends vam-stage spin in every way a program can end, again and again, and lets the simulator's own log say when the
stage stood. usage: stage_trials.py TRIALS PROTOCOL (gcs, grbl, zaber). Prints a table; exit status 1 when one trial took too long.

The stage turns at 60 deg/s and brakes at 3000 deg/s2, so 20 ms of the limit are the stage's own."""

import concurrent.futures
import os
import subprocess
import sys
import tempfile
import time

from trials import NEVER, SIGNALS, Log, end_by, ended_by, report

SCHEME = sys.argv[2]
OPTIONS = {"gcs": "?baud=115200"}.get(SCHEME, "")
ANGLE_QUERY = {"gcs": "POS?", "grbl": "?", "zaber": "get pos"}[SCHEME]
HOME = ["--home"] if SCHEME == "grbl" else []  # the others keep their reference
TRAVEL = ["--min-angle", "-900000", "--max-angle", "900000"]  # of a Zaber stage, whose position counts on from trial to trial
LANES = 3  # trials at the same time, each with a stage of its own: mostly they wait


def at_speed(event):
    return event["event"] == "angle" and event["speed_deg_s"] > 59


def standing(event):
    return event["event"] == "standing"


def simulator(folder, *options):
    log = os.path.join(folder, "truth")
    open(log, "w").close()
    process = subprocess.Popen(["vam-sim", "stage", "--protocol", SCHEME, "--acceleration", "2000", *TRAVEL, "--log", log,
                                "--die-with-parent", *options],
                               stdout=subprocess.PIPE, text=True)
    return process, process.stdout.readline().strip(), Log(log)


def tool(path, environment):
    return subprocess.Popen(["vam-stage", "spin", "--device", f"{SCHEME}:{path}{OPTIONS}", "--speed", "60", "--turns", "90",
                             *HOME],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment)


def running_tool(path, environment, log):
    """A tool whose stage turns at full speed; the guardian of the one before may hold the device a moment longer."""
    for _ in range(100):
        process = tool(path, environment)
        while process.poll() is None:
            if log.wait(at_speed, 0.05):
                return process
        if process.returncode != 75:
            break
        time.sleep(0.01)
    return None


def home(path, environment):
    """A stage that was just switched on turns only after this."""
    command = ["vam-stage", "home", "--device", f"{SCHEME}:{path}{OPTIONS}"]
    for _ in range(5):  # the simulator may still start, on a busy machine
        if subprocess.run(command, stderr=subprocess.DEVNULL, env=environment).returncode != 75:
            return


def trials_on_one_stage(cause, count, folder, environment):
    stage, path, log = simulator(folder)
    home(path, environment)
    times = []
    for _ in range(count):
        process = running_tool(path, environment, log)
        if process is None:
            times.append(NEVER)
            continue
        start = end_by(cause, process)
        stood = log.wait(standing, 3)
        times.append(stood["t_monotonic_s"] - start if ended_by(cause, process) and stood else NEVER)
    stage.kill()
    stage.wait()
    return times


def trials_of_device_errors(count, folder, environment):
    times = []
    for trial in range(count):
        stage, path, log = simulator(folder, "--fault", f"garbage@{ANGLE_QUERY}:{60 + trial}")
        home(path, environment)
        process = tool(path, environment)
        fault = log.wait(lambda event: event["event"] == "fault", 10)
        stood = log.wait(standing, 3)
        times.append(stood["t_monotonic_s"] - fault["t_monotonic_s"] if fault and stood else NEVER)
        process.stdout.close()
        process.wait(3)
        stage.kill()
        stage.wait()
    return times


def trials(cause, count, shim):
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, LD_PRELOAD=shim, VAM_LOCK_DIR=folder)
        if cause == "device error":
            return trials_of_device_errors(count, folder, environment)
        return trials_on_one_stage(cause, count, folder, environment)


def main():
    count = int(sys.argv[1])
    shim = subprocess.run(["vam-sim", "stage", "--shim"], check=True, capture_output=True, text=True).stdout.strip()
    causes = SIGNALS + ["closed stdout", "hang", "device error"]
    with concurrent.futures.ThreadPoolExecutor(LANES) as pool:
        results = pool.map(lambda cause: trials(cause, count, shim), causes)
        failed = sum([report(cause, times) for cause, times in zip(causes, results)])
    sys.exit(failed > 0)


main()
