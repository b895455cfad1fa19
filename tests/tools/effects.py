# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges tests/tools/effects.txt: no option is without effect.

    effects.py TABLE FOLDER [-k PATTERN]

Every tool, and command of one, has a section, and every option of its --help=all a row. On every kind of input it
changes what the tool writes (values, figures, facts; histories, seals, times and hashes aside) or is refused with status
64 in its own name; on one kind at least it changes something. So it is with the context of its row, which succeeds on
one kind at least, and without: but for settings of the printer. Prints a line of TAP for each option.
"""
import argparse
import functools
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "corpus"))
import exr  # noqa: E402
import figures  # noqa: E402


def read_table(path):
    """{tool: (kinds, rows)}; kinds: {name: words}, rows: [(option, words, context, reason)]. What has a reason is not run."""
    tools, prepared, aside, kinds, rows = {}, [], [], None, None
    for line in open(path):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        if line.startswith("$"):
            prepared.append(line[1:].strip())
        elif line.startswith("[") and " as " in line:
            aside += re.findall(r"\[(.*?)\]", line)
        elif line.startswith("["):
            kinds, rows = tools.setdefault(line.strip("[]"), ({}, []))
        elif line.startswith("kind "):
            name, command = line[5:].split(":", 1)
            kinds[name.strip()] = shlex.split(command)
        else:
            rows.extend(row for cell in line.split(" | ") for row in rows_of(cell))
    return prepared, tools, aside


def rows_of(cell):
    if " as " in cell:
        options, reason = cell.split(" as ", 1)
        return [(option, [], [], reason) for option in options.split()]
    words, _, context = cell.partition(";")
    words = shlex.split(words)
    return [(words[0], words, shlex.split(context), "")]


@functools.cache
def help_of(tool):
    return subprocess.run(shlex.split(tool) + ["--help=all"], stdout=subprocess.PIPE, check=True).stdout.decode()


def options_of(tool):
    own = help_of(tool).split("\nCommon options:")[0]
    return [match.group(1) for match in re.finditer(r"^  (?:-\w, )?(--[\w-]+)", own, re.M)]


def forms_of(tool):
    """It, where it has options of its own, and its commands."""
    commands = re.search(r"^Commands:\n((?:  .*\n)+)", help_of(tool), re.M)
    named = re.findall(r"^  (\w[\w-]*)", commands.group(1), re.M) if commands else []
    return ([tool] if options_of(tool) else []) + ["%s %s" % (tool, name) for name in named]


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
    """What is stored beside the facts: the same bytes for the same values."""
    kind = kind_of(path)
    if kind == ".exr":
        data, _, begin = exr.opened(path)
        return data[begin:]
    return [stored for _, _, stored in figures.stored_of(path)] if kind == ".vdb" else None


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
        permits = "!" in context
        bare = context and option not in ("--set", "--printer") and not permits
        context = [word for word in context if word != "!"]
        only = only or [kind for kind in self.kinds if not kind.startswith("+")]
        for kind in only:
            for beside in (context, []) if bare else (context,):
                changed += self.judge_one(kind, option, words, beside, faults, beside is context)
        if not permits and not any(self.base(kind, context).status in (0, 1) for kind in only):
            faults.append("%s: succeeds on no kind" % " ".join(context))
        return changed, faults

    def judge_one(self, kind, option, words, context, faults, complete):
        """[kind] if it changes something; without its context it may also lack data."""
        base = self.base(kind, context)
        run = self.run(self.kinds[kind] + context + words)
        where = "%s: %s" % (kind, " ".join(context + words))
        changes = run.status in (0, 1) and run.differs(base)
        if run.status == 64:
            if option not in run.said and base.status == 0:
                faults.append("%s: refused, but not in its name: %s" % (where, run.said))
        elif run.status not in (0, 1):
            faults += ["%s: status %d, %s" % (where, run.status, run.said)] if complete or run.status != 65 else []
        elif not changes:
            faults.append(where + ": changes nothing, and is not refused")
        shutil.rmtree(run.folder)
        return [kind] if changes else []


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("table")
    parser.add_argument("folder")
    parser.add_argument("-k", default="")
    args = parser.parse_args()
    prepared, tools, aside = read_table(args.table)
    for command in prepared:
        subprocess.run(command, shell=True, check=True, cwd=args.folder, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
    names = {os.path.basename(path)[:-4] for path in glob.glob(os.environ["VAM_SOURCE"] + "/tools/vam-*.cpp")} - set(aside)
    forms = {form for name in names for form in forms_of(name)} - set(aside)
    results = [(form, "", ["has no section in the table"]) for form in sorted(forms - set(tools))]
    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(lambda form: judge_tool(form, *tools[form], args), tools):
            results += found
    for number, (name, option, faults) in enumerate(results, 1):
        print("%s %d - %s %s" % ("not ok" if faults else "ok", number, name, option))
        for fault in faults:
            print("#   " + fault)
    print("1..%d" % len(results))
    sys.exit(1 if any(faults for _, _, faults in results) else 0)


def judge_tool(name, kinds, rows, args):
    """[(name, option, faults)]"""
    tool = Tool(name, kinds, args.folder)
    results = {option: ([], []) for option in options_of(name)}
    asides = {option for option, _, _, reason in rows if reason}
    for option, words, context, reason in rows:
        known = results.setdefault(option, ([], ["is in the table, but not an option"]))
        if reason or not re.search(args.k, name + " " + option):
            continue
        for kept, found in zip(known, tool.judge(option, words, context)):
            kept.extend(found)
    for option, (changed, faults) in results.items():
        if option not in [row[0] for row in rows]:
            faults.append("has no row in the table")
        elif option not in asides and not changed and not faults:
            faults.append("is refused everywhere")
    return [(name, option, faults) for option, (_, faults) in results.items() if re.search(args.k, name + " " + option)]


main()
