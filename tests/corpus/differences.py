# SPDX-License-Identifier: GPL-3.0-or-later
"""What differs between two records of figures.py, within the tolerances of a line: of values, figures and levels."""
import json
import math


def near(old, new, relative, absolute):
    return abs(old - new) <= max(relative * max(abs(old), abs(new)), absolute)


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def alike(old, new, scale):
    if is_number(old) and is_number(new):
        return near(old, new, 1e-4 * scale, 2e-6 * scale)
    if isinstance(old, list) and isinstance(new, list):
        return len(old) == len(new) and all(alike(a, b, scale) for a, b in zip(old, new))
    if isinstance(old, dict) and isinstance(new, dict):
        return all(key in new and alike(value, new[key], scale) for key, value in old.items())
    return old == new


def last_place(word):
    mantissa, _, power = word.lower().partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))


def differences(old, new, tolerance):
    """(what, old, new) wherever they differ, and the number of facts that were not there."""
    values, scale, levels = tolerance[0], tolerance[1] / 1e-4, tolerance[2]
    before, after = old.get("is", {}), new.get("is", {})
    for key, value in before.items():
        if key not in after:
            yield key, value, "nothing"
        elif not alike(value, after[key], scale):
            yield key, value, after[key]
    for kind in ("values", "text", "picture", "levels"):
        a, b = old.get(kind, []), new.get(kind, [])
        if len(a) != len(b):
            yield kind, "%d of them" % len(a), len(b)
            continue
        largest = max(map(abs, a[:2])) if kind == "values" and a else 0
        blocks, of_means = (len(a) - 3) // 2, max(1e-6, values / math.sqrt(old.get("block", 1)))
        for at, (x, y) in enumerate(zip(a, b)):
            if kind == "values":
                within = largest * (of_means if 2 <= at < 3 + blocks else values)
                place = ("least", "greatest", "mean")[at] if at < 3 else "%s of block %d of %d" % (
                    "mean" if at < 3 + blocks else "signed sum", (at - 3) % blocks + 1, blocks)
                same = abs(x - y) <= within
            elif kind == "levels":
                place, same = "%s of frame %d" % (("signed sum", "sum")[at % 2 == 0], at // 2), abs(x - y) <= levels
            elif kind == "text":
                place = "number %d" % (at + 1)
                same = near(float(x), float(y), 1e-4 * scale, 1.01 * max(last_place(x), last_place(y)))
            else:
                place, same = "block %d of the picture" % (at + 1), abs(x - y) <= (2 if values <= 1e-5 else 8)
            if not same:
                yield place, x, y


def compare(name, old, new, tolerance):
    """The differences of one line in words, at most eight of a file."""
    had, has = {what: record for _, what, record in old}, {what: record for _, what, record in new}
    for what in [*had, *(w for w in has if w not in had)]:
        label = "%s: %s" % (name, what + ": " if what else "")
        if what not in has:
            yield label + "is no longer there"
        elif what not in had:
            yield label + "was not there"
        else:
            found = list(differences(had[what], has[what], tolerance))
            for place, before, after in found[:8]:
                yield "%s%s: %s -> %s" % (label, place, json.dumps(before), json.dumps(after))
            if len(found) > 8:
                yield "%sand %d more" % (label, len(found) - 8)
