#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Is a print that corrects itself better than one that is stopped at its best moment? Simulated prints without a clock.

    python3 tests/bench/closed_loop.py [--seeds N] [--jobs N] [--nominal] [--drift] [--unjudged] [--faults]
                                       [--keep FOLDER] [--table CSV] [BUILD]

The plan knows nothing of what is wrong with each printer: a lamp 20 % weaker (with --drift, one that becomes so),
a resin that inhibits 15 % more at one end of the vial, absorbs 30 % more, and stands with its axis 0.2 mm to one side.
Ends, sides, noise and specks are drawn by the seed. --nominal: nothing is wrong. As a lab would, the resin's working
curve is measured first, and its critical dose at the surface by a print that is judged (--unjudged: not).

Printed for each seed is the RMS deviation of the print's surface from the design (vam-sdf) when the open loop is
stopped at its best sixth of a turn, that of the closed loop, and their ratio. --faults: the camera or its volumes fail
from some turn on, and the open loop ends as planned. --table writes both against turns, the median over the seeds.
"""
import argparse
import json
import math
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHAPE = "gyroid:cell=6,sheet=1.2,diameter=7,height=5"
CAMERA = ["columns=66", "rows=46", "views=60", "voxel=0.2"]
CRITICAL = 60.0  # mJ/cm3, of the true resin
TRUE_RESIN = "resin.critical_dose_mj_cm3=%g" % CRITICAL
LAST_TURN = 30
SEEN = ["--axis-column", "32.5", "--tilt", "0", "--keep-run-out"]


def run(*command, folder, good=(0,)):
    """In a folder whose printer.toml is that of the plan."""
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True)
    if done.returncode not in good:
        sys.exit("%s\n%s" % (" ".join(map(str, command)), done.stderr))
    return done.returncode


def load(path):
    with open(path) as file:
        return json.load(file)


class Print:
    """One simulated print in a folder of its own, with the plan's sinogram and printer file."""

    def __init__(self, plan, folder, truth):
        self.folder = folder
        os.makedirs(folder + "/ost")
        shutil.copy(plan.folder + "/whole.exr", folder + "/sinogram.exr")
        run("vam-project", "sinogram.exr", "--printer", plan.folder + "/printer.toml", "--freeze", "printer.toml",
            folder=folder)
        self.player = subprocess.Popen(["play_turns", "flips.jsonl", *CAMERA, *truth], cwd=folder, text=True,
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.plan = plan

    def tell(self, *words):
        print(*words, file=self.player.stdin, flush=True)
        if self.player.stdout.readline() != "done\n":
            sys.exit("play_turns: no reply to " + " ".join(map(str, words)))

    def deviation(self):
        """RMS and mean of the surface, in mm, were the light switched off now; infinite while nothing is solid."""
        self.tell("settled", "settled.vdb")
        if run("vam-sdf", "settled.vdb", self.plan.folder + "/part.vdb", "--align", "none", "--samples", "20000",
               "--isovalue", "1", "--report", "sdf.json", folder=self.folder, good=(0, 1, 65)) == 65:
            return math.inf, 0.0
        found = load(self.folder + "/sdf.json")["print_to_design"]
        return found["rms_mm"], found["mean_mm"]

    def end(self):
        self.player.stdin.close()
        self.player.wait()


class Plan:
    def __init__(self, folder, critical, curve=None):
        """Projections for a resin of that critical dose; its working curve is measured if it is not given."""
        self.folder = folder
        self.critical = critical
        os.makedirs(folder, exist_ok=True)
        with open(SOURCE + "/tests/tools/curing_printer.toml") as file:
            settings = file.read().replace("critical_dose_mj_cm3 = 60", "critical_dose_mj_cm3 = %g" % critical)
        with open(folder + "/printer.toml", "w") as file:
            file.write(settings)
        run("vam-slice", "--shape", SHAPE, "--voxel", "0.2", "-o", "part.vdb", folder=folder)
        run("vam-optimize", "--angles", "60", "part.vdb", "-o", "whole.exr", folder=folder)
        run("vam-dose", "whole.exr", "--like", "part.vdb", "--exposure-plan", "-o", "plan.vdb", "--report", "plan.json",
            folder=folder)
        plan = load(folder + "/plan.json")
        self.turns = plan["turns"]
        self.curve = curve or self.working_curve(int(plan["turns_to_critical_all"]))

    def working_curve(self, lit):
        """Of a print as planned, that is stopped when about half of it scatters."""
        folder = self.folder
        player = subprocess.Popen(["play_turns", "curve.jsonl", *CAMERA, TRUE_RESIN], cwd=folder, text=True,
                                  stdin=subprocess.PIPE, stdout=subprocess.DEVNULL)
        player.communicate("play whole.exr 0 %d +\nplay - %d %d all.exr\n" % (360 * lit, 360 * lit, 360 * lit + 1080))
        run("vam-dose", "whole.exr", "--like", "part.vdb", "-o", "turn.vdb", folder=folder)
        run("vam-ost", "all.exr", "--live", *SEEN, "-o", "live", folder=folder)
        run("vam-calibrate", "working-curve", "live", "--dose", "turn.vdb", "--lit-turns", lit, "-o", "curve.json",
            folder=folder)
        return folder + "/curve.json"

    def next_critical(self):
        """Of a print with nothing wrong that was judged: with which the next one is as large as the design."""
        folder = self.folder + "/judged"
        closed_loop(self, folder, ["seed=99", TRUE_RESIN])
        light = sorted(name for name in os.listdir(folder + "/renewed") if name.startswith("turn-") and
                       name.endswith(".exr"))
        run("vam-dose", "sinogram.exr", *("renewed/" + name for name in light), "--shown", "flips.jsonl", "--like",
            self.folder + "/part.vdb", "-o", "dose.vdb", folder=folder)
        run("vam-calibrate", "critical-dose", "settled.vdb", "--isovalue", "1", "--dose", "dose.vdb", "--design",
            self.folder + "/part.vdb", "-o", "critical.json", folder=folder)
        return load(folder + "/critical.json")["next_critical_dose_mj_cm3"]


def truth_of(seed, options):
    draw = random.Random(seed)
    truth = ["seed=%d" % seed, "specks=%d" % draw.randrange(6), TRUE_RESIN]
    side, end = draw.choice((-1, 1)), draw.choice((-1, 1))
    if options.nominal:
        return truth
    truth += ["gradient=%g" % (0.15 * end), "centre=%d" % side, "resin.absorption_per_mm=0.078"]
    return truth + (["drift=-0.033"] if options.drift else ["projector.max_intensity_mw_cm2=0.72"])


def open_loop(plan, folder, truth):
    """Deviations by sixths of turns, up to where they have grown again."""
    one = Print(plan, folder, truth)
    found = {}
    for sixth in range(6 * LAST_TURN):
        one.tell("play", "sinogram.exr", 60 * sixth, 60 * sixth + 60, "-")
        turns = (sixth + 1) / 6
        if turns < 0.7 * plan.turns:
            continue
        found[turns] = one.deviation()
        if found[turns][0] > 2 * min(found.values())[0] and turns > plan.turns:
            break
    one.end()
    return found


FAULTS = ("lost", "late", "stale", "damaged", "turned")  # of the camera's volumes, from some turn on


def broken(path, fault, first):
    """The volume as that fault leaves it; False: there is none."""
    if fault == "stale" and first:
        shutil.copy(first, path)
    elif fault == "damaged":
        with open(path, "r+b") as file:
            file.seek(os.path.getsize(path) // 2)
            file.write(b"not a volume")
    return fault != "lost"


def closed_loop(plan, folder, truth, fault="", fault_turn=0):
    """Deviations by turns; vam-correct renew takes the volume of each. Without new light the print ends as planned."""
    one = Print(plan, folder, truth)
    light, end, found, axis, first = "sinogram.exr", LAST_TURN, {}, "1", ""
    if fault:
        end = math.ceil(plan.turns)
    for turn in range(LAST_TURN):
        if turn >= end:
            break
        if os.path.exists("%s/renewed/turn-%d.exr" % (folder, turn)):
            light = "renewed/turn-%d.exr" % turn
            with open(folder + "/renewed.jsonl") as log:
                end = [entry["end"] for entry in map(json.loads, log) if entry.get("from_turn") == turn][-1]
        for sixth in range(6):
            start = 360 * turn + 60 * sixth
            one.tell("play", light, start, start + 60, "+" if sixth < 5 else "views.exr")
            if turn + (sixth + 1) / 6 >= 0.7 * plan.turns:
                found[turn + (sixth + 1) / 6] = one.deviation()
        if turn + 1 < 0.6 * plan.turns:
            continue
        failing = fault if turn >= fault_turn else ""
        wrong = ["--set", "camera.azimuth_deg=120"] if failing == "turned" else []
        run("vam-ost", "views.exr", "--live", *SEEN, *wrong, "-o", "of_turn", folder=folder, good=(0, 1, 65))
        if not os.path.exists(folder + "/of_turn/scatter-0000.vdb"):
            continue
        if failing and not broken(folder + "/of_turn/scatter-0000.vdb", failing, first):
            continue
        number = len([name for name in os.listdir(folder + "/ost") if name.startswith("scatter")])
        os.rename(folder + "/of_turn/scatter-0000.vdb", folder + "/ost/scatter-%04d.vdb" % number)
        first = first or folder + "/ost/scatter-0000.vdb"
        with open(folder + "/ost.jsonl", "a") as log:
            print(json.dumps({"turns": turn + 1, "time_s": 18 * turn + 18}), file=log)
        run("vam-correct", "renew", ".", "--target", plan.folder + "/part.vdb", "--curve", plan.curve, "--axis-sigma",
            axis, "--once", number, *(["--lead", "1.5"] if failing == "late" else []),
            folder=folder, good=(0, 1))
    one.end()
    return found


def trial(plan, seed, options):
    folder = "%s/seed-%d" % (plan.folder, seed)
    truth = truth_of(seed, options)
    opened = open_loop(plan, folder + "-open", truth)
    closed = closed_loop(plan, folder + "-closed", truth)
    best_turn = min(opened, key=lambda turn: opened[turn][0])
    best, last = opened[best_turn], closed[max(closed)]
    print("seed %2d  open %.4f mm at turn %5.2f (mean %+.4f)  closed %.4f mm at turn %d (mean %+.4f)  ratio %.3f" %
          (seed, best[0], best_turn, best[1], last[0], max(closed), last[1], last[0] / best[0]), flush=True)
    return opened, closed, last[0] / best[0]


def fault_trial(plan, seed, options):
    """Against the same print in open loop, which ends as planned: without a camera nothing can stop it earlier."""
    draw = random.Random(1000 + seed)
    fault = FAULTS[seed % len(FAULTS)]
    turn = draw.randrange(int(0.6 * plan.turns), math.ceil(plan.turns))
    folder = "%s/fault-%d" % (plan.folder, seed)
    truth = truth_of(seed, options)
    one = Print(plan, folder + "-open", truth)
    one.tell("play", "sinogram.exr", 0, 360 * math.ceil(plan.turns), "-")
    opened = one.deviation()
    one.end()
    closed = closed_loop(plan, folder + "-closed", truth, fault, turn)
    last = closed[max(closed)]
    ratio = 1.0 if last == opened else last[0] / opened[0]  # also where nothing is solid in either
    print("seed %2d  %-7s from turn %2d  open %.4f mm  closed %.4f mm at turn %d  ratio %.3f" %
          (seed, fault, turn, opened[0], last[0], max(closed), ratio), flush=True)
    return {}, {}, ratio


def write_table(path, trials):
    """Turns and the median deviations, once there is a surface; of a closed print that has ended, its last."""
    turns = sorted({turn for opened, _, _ in trials for turn in opened})
    with open(path, "w") as file:
        print("turn,open_loop_mm,closed_loop_mm", file=file)
        for turn in turns:
            opened = [one[turn][0] for one, _, _ in trials if turn in one]
            closed = [one[min(turn, max(one))][0] for _, one, _ in trials if min(turn, max(one)) in one]
            row = [statistics.median(values or [math.inf]) for values in (opened, closed)]
            if max(row) < math.inf:
                print("%.3f,%.5f,%.5f" % (turn, *row), file=file)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", nargs="?", default="build/release")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--unjudged", action="store_true")
    parser.add_argument("--nominal", action="store_true")
    parser.add_argument("--drift", action="store_true")
    parser.add_argument("--faults", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--table")
    options = parser.parse_args()
    build = os.path.abspath(options.build)
    os.environ.pop("VAM_PRINTER", None)
    os.environ["PATH"] = ":".join([build + "/bin", build, SOURCE + "/scripts", os.environ["PATH"]])
    folder = os.path.abspath(options.keep or tempfile.mkdtemp())
    os.makedirs(folder, exist_ok=True)
    plan = Plan(folder, CRITICAL)
    if not options.unjudged:
        plan = Plan(folder + "/again", plan.next_critical(), plan.curve)
        print("critical dose by a judged print: %.2f mJ/cm3" % plan.critical, flush=True)
    with ThreadPoolExecutor(options.jobs) as pool:
        one = fault_trial if options.faults else trial
        trials = list(pool.map(lambda seed: one(plan, seed, options), range(1, options.seeds + 1)))
    ratios = [ratio for _, _, ratio in trials]
    print("ratio: median %.3f, mean %.3f, largest %.3f" %
          (statistics.median(ratios), statistics.mean(ratios), max(ratios)))
    if options.table and not options.faults:
        write_table(options.table, trials)
    if not options.keep:
        shutil.rmtree(folder)


main()
