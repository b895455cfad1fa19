"""Ends vam-project in every way a program can end while a picture is on, again and again, and reads from the memory of
a virtual screen when it was black. usage: project_trials.py TRIALS, in a folder with part.exr and printer.toml. Prints a
table; exit status 1 when one trial took too long."""

import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from screen import Screen  # noqa: E402

LIMIT_S = 0.1
STALL_S = 0.5
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV, signal.SIGABRT, signal.SIGKILL]


def black(screen):
    """True when no grey byte is above 0; the fourth byte of a pixel is not shown."""
    picture = screen.memory[screen.offset:screen.offset + screen.line * screen.height]
    return not any(picture[0::4]) and not any(picture[1::4]) and not any(picture[2::4])


def wait(condition, limit_s):
    """The time when the condition came true, or None."""
    deadline = time.monotonic() + limit_s
    while time.monotonic() < deadline:
        if condition():
            return time.monotonic()
        time.sleep(0.0005)
    return None


def angles(start):
    """Lines of a table that turns at 30 deg/s, up to now."""
    now = time.monotonic()
    lines = []
    while start[0] < now:
        start[0] += 0.01
        lines.append('{"t_monotonic_s":%.6f,"angle_deg":%.5f,"sigma":0.001}\n' % (start[0], 30 * (start[0] - start[1])))
    return "".join(lines).encode()


def trial(cause, screen, environment):
    tool = subprocess.Popen(["vam-project", "part.exr", "-o", "sdl:0", "--follow", "-", "--turns", "9", "--missed", "1"],
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment)
    begin = time.monotonic()
    start = [begin - 1, begin - 1]
    lit_until = None
    while lit_until is None or time.monotonic() < lit_until:  # a steady table, until a picture was on for 50 ms
        tool.stdin.write(angles(start))
        tool.stdin.flush()
        if lit_until is None and not black(screen):
            lit_until = time.monotonic() + 0.05
        if tool.poll() is not None or time.monotonic() > begin + 5:
            return float("inf")
        time.sleep(0.005)
    done = time.monotonic()
    if cause == "end of the angles":
        tool.stdin.close()
    elif cause == "nonsense for an angle":
        tool.stdin.write(b"garbage\n")
        tool.stdin.flush()
    elif cause == "hang":
        tool.send_signal(signal.SIGSTOP)
    else:
        tool.send_signal(cause)
    dark = wait(lambda: black(screen), 3)
    try:
        tool.wait(3)
    except subprocess.TimeoutExpired:
        tool.kill()
        return float("inf")
    if cause in SIGNALS and tool.returncode != -cause:
        return float("inf")
    return dark - done if dark else float("inf")


def main():
    count = int(sys.argv[1])
    reader, writer = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "64x48x24", "-fbdir", "screen",
                               "-nolisten", "tcp", "-noreset", "-nocursor"], pass_fds=[writer],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    display = os.read(reader, 10).decode().strip()
    screen = Screen("screen/Xvfb_screen0")
    environment = dict(os.environ, DISPLAY=":" + display, SDL_VIDEODRIVER="x11", SDL_RENDER_DRIVER="software",
                       VAM_LOCK_DIR=os.path.abspath("locks"))
    failed = 0
    try:
        for cause in SIGNALS + ["hang", "end of the angles", "nonsense for an angle"]:
            name = cause.name if isinstance(cause, signal.Signals) else cause
            times = sorted(trial(cause, screen, environment) for _ in range(count))
            limit = LIMIT_S + (STALL_S if cause == "hang" else 0)
            late = sum(1 for t in times if not t <= limit)
            failed += late
            print(f"# {name}: {count} trials, median {1e3 * times[count // 2]:.1f} ms, worst {1e3 * times[-1]:.1f} ms, "
                  f"{late} past {1e3 * limit:.0f} ms", flush=True)
    finally:
        server.kill()
        server.wait()
    sys.exit(failed > 0)


main()
