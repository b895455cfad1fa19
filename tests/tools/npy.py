# SPDX-License-Identifier: GPL-3.0-or-later
"""NumPy files made and taken apart without NumPy.

    npy.py make FILE TYPE SHAPE [ORDER]   the numbers 0, 1, 2, ... mod 101 of that type ('<f4', '>u2'), shape 2,3,4, by
                                          their place in C order, stored in order C or F
    npy.py of FILE SHAPE EXPRESSION       '<f4', of 3 axes, by an expression of the places k, j and i along them
    npy.py show FILE                      shape, then the values in C order, on one line
    npy.py eval EXPRESSION FILE...        of v[0], v[1], ..., the values of each file in C order
    npy.py head FILE DICTIONARY           a header with that text and no values
    npy.py cuts FILE STEP                 FILE.0, FILE.STEP, ...: its beginnings
"""
import itertools
import math
import struct
import sys

CODES = {"u1": "B", "i1": "b", "b1": "B", "u2": "H", "i2": "h", "u4": "I", "i4": "i", "u8": "Q", "i8": "q", "f2": "e",
         "f4": "f", "f8": "d"}


def head(text):
    text += " " * (63 - (10 + len(text)) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(text)) + text.encode()


def make(path, kind, shape, order="C"):
    sizes = tuple(int(n) for n in shape.split(","))
    values = [n % (2 if kind[1:] == "b1" else 101) for n in range(math.prod(sizes))]
    if order == "F":
        strides = [math.prod(sizes[i + 1:]) for i in range(len(sizes))]
        places = itertools.product(*(range(n) for n in reversed(sizes)))
        values = [values[sum(i * s for i, s in zip(reversed(place), strides))] for place in places]
    text = "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }" % (kind, order == "F", sizes)
    with open(path, "wb") as out:
        out.write(head(text) + struct.pack("%s%d%s" % (">" if kind[0] == ">" else "<", len(values), CODES[kind[1:]]),
                                           *values))


def of(path, shape, expression):
    sizes = tuple(int(n) for n in shape.split(","))
    value = compile(expression, path, "eval")
    values = [eval(value, vars(math), {"k": k, "j": j, "i": i}) for k, j, i in itertools.product(*map(range, sizes))]
    with open(path, "wb") as out:
        out.write(head("{'descr': '<f4', 'fortran_order': False, 'shape': %s, }" % (sizes,)))
        out.write(struct.pack("<%df" % len(values), *values))


def load(path):
    data = open(path, "rb").read()
    size = struct.unpack("<H", data[8:10])[0]
    about = eval(data[10:10 + size])  # written by the tool under test
    return about, struct.unpack("<%df" % math.prod(about["shape"]), data[10 + size:])


def show(path):
    about, values = load(path)
    print(*about["shape"], about["descr"], *("%g" % value for value in values))


def evaluate(expression, *paths):
    values = eval(expression, vars(math) | {"v": [load(path)[1] for path in paths]})
    print(*values if isinstance(values, tuple) else [values])


def cuts(path, step):
    data = open(path, "rb").read()
    for size in range(0, len(data), int(step)):
        open("%s.%d" % (path, size), "wb").write(data[:size])


if sys.argv[1] == "head":
    open(sys.argv[2], "wb").write(head(sys.argv[3]))
else:
    {"make": make, "of": of, "show": show, "eval": evaluate, "cuts": cuts}[sys.argv[1]](*sys.argv[2:])
