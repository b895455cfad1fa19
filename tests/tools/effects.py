# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges tests/tools/effects.txt: no option is without effect.

    effects.py TABLE FOLDER [-k PATTERN]

Every option of a tool's --help=all has a row, and on every kind of input of that tool it changes what the tool writes
(values, figures, facts; histories, seals, times and hashes aside) or is refused with status 64 in its own name. On one
kind at least it changes something. Prints a line of TAP for each option.
"""
import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "corpus"))
import figures  # noqa: E402


def read_table(path):
    """{tool: (kinds, rows)}; kinds: {name: words}, rows: [(option, words, context, reason)]. A row of a reason is not run."""
    tools, prepared, kinds, rows = {}, [], None, None
    for line in open(path):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        if line.startswith("$"):
            prepared.append(line[1:].strip())
        elif line.startswith("["):
            kinds, rows = tools.setdefault(line.strip("[]"), ({}, []))
        elif line.startswith("kind "):
            name, command = line[5:].split(":", 1)
            kinds[name.strip()] = shlex.split(command)
        elif " as " in line:
            option, reason = line.split(" as ", 1)
            rows.extend((one, [], [], reason) for one in option.split())
        else:
            option, _, context = line.partition(";")
            words = shlex.split(option)
            rows.append((words[0], words, shlex.split(context), ""))
    return prepared, tools


def options_of(tool):
    text = subprocess.run(shlex.split(tool) + ["--help=all"], stdout=subprocess.PIPE, check=True).stdout.decode()
    own = text.split("\nCommon options:")[0]
    return [match.group(1) for match in re.finditer(r"^  (?:-\w, )?(--[\w-]+)", own, re.M)]


def files_in(folder):
    return sorted(os.path.relpath(os.path.join(root, name), folder)
                  for root, _, names in os.walk(folder) for name in names)


def content(data):
    """What a picture shows, without its comments."""
    if not data.startswith(b"\x89PNG"):
        return data
    found, at = [], 8
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        if kind in (b"IHDR", b"PLTE", b"IDAT", b"pHYs"):
            found.append(data[at + 8:at + 8 + size])
        at += 12 + size
    return found


def kind_of(path):
    """Its ending, of what is no text in its place, as --print-printer writes."""
    with open(path, "rb") as file:
        return ".txt" if file.read(2) == b"# " else os.path.splitext(path)[1]


def facts_of(path):
    """What is cheap to read."""
    kind = kind_of(path)
    if kind == ".exr":
        return figures.attributes_of(path)
    if kind == ".vdb":
        return list(figures.grids_of(path))
    with open(path, "rb") as file:
        data = file.read()
    if kind in (".json", ".jsonl", ".html"):
        return figures.of_file(path)
    return content(data)


def values_of(path):
    kind = kind_of(path)
    if kind not in (".exr", ".vdb"):
        return None
    grids = [["--grid", name] for name, _ in figures.grids_of(path)] if kind == ".vdb" else [[]]
    return [subprocess.run(["vam-view", path, "--quiet", "--export", "/dev/stdout", *grid], stdout=subprocess.PIPE,
                           check=True).stdout.split(b"\n\n", 1)[1] for grid in grids]


class Run:
    """A command in a folder of its own beside the inputs."""

    def __init__(self, words, folder):
        self.folder = folder
        os.mkdir(folder)
        done = subprocess.run(words + ["--quiet"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.status, self.said = done.returncode, done.stderr.decode("utf-8", "replace").strip()
        self.out = content(done.stdout)
        self.files = files_in(folder)
        self.known = {}

    def read(self, how, name):
        if (how, name) not in self.known:
            self.known[how, name] = how(os.path.join(self.folder, name))
        return self.known[how, name]

    def differs(self, other):
        if (self.status, self.files, self.out) != (other.status, other.files, other.out):
            return True
        return any(self.read(how, name) != other.read(how, name)
                   for how in (facts_of, values_of) for name in self.files)


class Tool:
    def __init__(self, name, kinds, folder):
        self.name, self.kinds, self.folder, self.bases, self.count = name, kinds, folder, {}, 0

    def run(self, words):
        self.count += 1
        return Run(words, os.path.join(self.folder, "%s.%d" % (self.name.replace(" ", "."), self.count)))

    def base(self, kind, context):
        key = kind, tuple(context)
        if key not in self.bases:
            self.bases[key] = self.run(self.kinds[kind] + context)
        return self.bases[key]

    def judge(self, option, words, context):
        """(kinds that it changes, faults)"""
        changed, faults = [], []
        only = [word[1:] for word in context if word.startswith("@")]
        context = [word for word in context if not word.startswith("@")]
        for kind in only or self.kinds:
            base = self.base(kind, context)
            run = self.run(self.kinds[kind] + context + words)
            where = "%s: %s" % (kind, " ".join(context + words))
            if run.status == 64:
                if option not in run.said and base.status == 0:
                    faults.append("%s: refused, but not in its name: %s" % (where, run.said))
            elif run.status not in (0, 1):
                faults.append("%s: status %d, %s" % (where, run.status, run.said))
            elif run.differs(base):
                changed.append(kind)
            else:
                faults.append(where + ": changes nothing, and is not refused")
            shutil.rmtree(run.folder)
        return changed, faults


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("table")
    parser.add_argument("folder")
    parser.add_argument("-k", default="")
    args = parser.parse_args()
    prepared, tools = read_table(args.table)
    for command in prepared:
        subprocess.run(command, shell=True, check=True, cwd=args.folder, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
    number = failures = 0
    for name, (kinds, rows) in tools.items():
        tool = Tool(name, kinds, args.folder)
        declared = options_of(name)
        results = {option: ([], []) for option in declared}
        asides = {option for option, _, _, reason in rows if reason}
        for option, words, context, reason in rows:
            if reason or not re.search(args.k, name + " " + option):
                continue
            changed, faults = tool.judge(option, words, context)
            known = results.setdefault(option, ([], ["is in the table, but not an option"]))
            known[0].extend(changed)
            known[1].extend(faults)
        for option, (changed, faults) in results.items():
            if not re.search(args.k, name + " " + option):
                continue
            if option not in asides and option not in [row[0] for row in rows]:
                faults.append("has no row in the table")
            elif option not in asides and not changed and not faults:
                faults.append("is refused everywhere")
            number += 1
            failures += 1 if faults else 0
            print("%s %d - %s %s" % ("not ok" if faults else "ok", number, name, option))
            for fault in faults:
                print("#   " + fault)
    print("1..%d" % number)
    sys.exit(1 if failures else 0)


main()
