# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic of dose volumes on one grid, for the tests.

usage: volumes.py fall IN.vdb FACTOR FALL OUT.vdb    (times FACTOR, 1 + FALL at the bottom to 1 - FALL at the top)
       volumes.py sum A.vdb B.vdb FACTOR OUT.vdb     (A + FACTOR B)"""
import array
import os
import sys

sys.path.insert(0, os.path.join(os.environ["VAM_SOURCE"], "scripts"))
import vam  # noqa: E402


def write(path, values, facts):
    x_y_z = tuple(reversed(facts["origin"]))
    vam.write_volume(path, array.array("f", values), facts["spacing"][0], x_y_z, "dose", "mJ/cm3", facts["shape"])


def flat(path):
    values, facts = vam.read(path, "dose")
    return array.array("f", values.tobytes()), facts


def main(what, first, second, third, out):
    values, facts = flat(first)
    if what == "fall":
        factor, fall, slices = float(second), float(third), facts["shape"][0]
        size = len(values) // slices
        write(out, (v * factor * (1 - fall * (2 * (i // size) / (slices - 1) - 1)) for i, v in enumerate(values)), facts)
    else:
        write(out, (a + float(third) * b for a, b in zip(values, flat(second)[0])), facts)


main(*sys.argv[1:])
