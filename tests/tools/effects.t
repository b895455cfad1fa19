# SPDX-License-Identifier: GPL-3.0-or-later
# No option is without effect: on each kind of input it changes what its tool writes, or is refused.
. "$VAM_SOURCE/tests/tools/testlib.sh"
VAM_PRINTER=$scratch/printer.toml; export VAM_PRINTER
python3 "$VAM_SOURCE/tests/tools/effects.py" "$VAM_SOURCE/tests/tools/effects.txt" "$scratch"
