"""Ends vam-stage spin in every way a program can end, again and again, and lets the simulator's own log say when the
table stood. usage: stage_trials.py TRIALS. Prints a table; exit status 1 when one trial took too long.

The table turns at 60 deg/s and brakes at 3000 deg/s2, so 20 ms of the limit are the table's own."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time

LIMIT_S = 0.1
STALL_S = 0.5  # until the guardian takes a tool without progress for hung

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV, signal.SIGABRT, signal.SIGKILL]


class Log:
    """Reads the simulator's log as it grows."""

    def __init__(self, path):
        self.file = open(path)
        self.rest = ""

    def events(self):
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        return [json.loads(line) for line in lines]

    def wait(self, wanted, limit_s):
        deadline = time.monotonic() + limit_s
        while time.monotonic() < deadline:
            for event in self.events():
                if wanted(event):
                    return event
            time.sleep(0.001)
        return None


def at_speed(event):
    return event["event"] == "angle" and event["speed_deg_s"] > 59


def standing(event):
    return event["event"] == "standing"


def simulator(folder, *options):
    log = os.path.join(folder, "truth")
    open(log, "w").close()
    process = subprocess.Popen(["vam-sim-stage", "--acceleration", "2000", "--log", log, "--die-with-parent", *options],
                               stdout=subprocess.PIPE, text=True)
    return process, process.stdout.readline().strip(), Log(log)


def tool(path, environment):
    return subprocess.Popen(["vam-stage", "spin", "--device", f"gcs:{path}?baud=115200", "--speed", "60", "--turns", "90"],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment)


def running_tool(path, environment, log):
    """A tool whose table turns at full speed; the guardian of the one before may hold the device a moment longer."""
    for _ in range(100):
        process = tool(path, environment)
        while process.poll() is None:
            if log.wait(at_speed, 0.05):
                return process
        if process.returncode != 75:
            break
        time.sleep(0.01)
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


def trials_on_one_stage(cause, count, folder, environment):
    stage, path, log = simulator(folder)
    times = []
    for _ in range(count):
        process = running_tool(path, environment, log)
        if process is None:
            times.append(float("inf"))
            continue
        start = end_by(cause, process)
        stood = log.wait(standing, 3)
        times.append(stood["t_monotonic_s"] - start if stood else float("inf"))
        process.wait(3)
        if cause in SIGNALS and process.returncode != -cause:
            print(f"# {cause!r} ended with status {process.returncode}")
            times[-1] = float("inf")
    stage.kill()
    stage.wait()
    return times


def trials_of_device_errors(count, folder, environment):
    times = []
    for trial in range(count):
        stage, path, log = simulator(folder, "--fault", f"garbage@POS?:{30 + trial}")
        process = tool(path, environment)
        fault = log.wait(lambda event: event["event"] == "fault", 10)
        stood = log.wait(standing, 3)
        times.append(stood["t_monotonic_s"] - fault["t_monotonic_s"] if fault and stood else float("inf"))
        process.stdout.close()
        process.wait(3)
        stage.kill()
        stage.wait()
    return times


def main():
    count = int(sys.argv[1])
    shim = subprocess.run(["vam-sim-stage", "--shim"], check=True, capture_output=True, text=True).stdout.strip()
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, LD_PRELOAD=shim, VAM_LOCK_DIR=folder, ASAN_OPTIONS="verify_asan_link_order=0")
        results = {}
        for cause in SIGNALS + ["closed stdout", "hang"]:
            name = cause.name if isinstance(cause, signal.Signals) else cause
            results[name] = trials_on_one_stage(cause, count, folder, environment)
        results["device error"] = trials_of_device_errors(count, folder, environment)
    for name, times in results.items():
        limit = LIMIT_S + (STALL_S if name == "hang" else 0)
        late = sum(1 for t in times if not t <= limit)
        failed += late
        times.sort()
        print(f"# {name}: {len(times)} trials, median {1e3 * times[len(times) // 2]:.1f} ms, "
              f"worst {1e3 * times[-1]:.1f} ms, {late} past {1e3 * limit:.0f} ms")
    sys.exit(failed > 0)


main()
