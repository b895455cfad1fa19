# SPDX-License-Identifier: GPL-3.0-or-later
# The check that every source begins with its licence finds those that do not, and mends them.
. "$VAM_SOURCE/tests/tools/testlib.sh"

check() { "$VAM_SOURCE/scripts/check-headers" "$@"; }
mkdir -p tree/lib tree/scripts tree/man tree/tests/tools
licence='SPDX-License-'Identifier': GPL-3.0-or-later'  # in parts, or REUSE would read it here
printf '%s\n' "// $licence" '#include "a.hpp"' >tree/lib/good.cpp
printf '%s\n' '#include "a.hpp"' >tree/lib/bare.cpp
printf '%s\n' '// Of another.' "// $licence" >tree/lib/late.hpp
printf '%s\n' '#!/bin/sh' 'set -eu' >tree/scripts/bare
printf '%s\n' '.Dd today' >tree/man/bare.7
printf '%s\n' '.\" Printed by a tool; do not edit.' >tree/man/printed.1
printf '%s\n' '# A test.' >tree/tests/tools/bare.t
printf '%s\n' 'all:' >tree/Makefile.example
chmod +x tree/scripts/bare
check tree >faults && report 1 'faults are a status'
is 'it names those that lack it, and their line' "$(cut -d: -f1-2 faults | sort | tr '\n' ' ')" \
  'Makefile.example:1 lib/bare.cpp:1 lib/late.hpp:1 man/bare.7:1 scripts/bare:2 tests/tools/bare.t:1 '

ok 'it mends them' check -i tree
ok 'so that none is left' check tree
is 'the licence comes first' "$(head -n 1 tree/lib/bare.cpp)" "// $licence"
is 'or second, after the interpreter' "$(tr '\n' '|' <tree/scripts/bare)" "#!/bin/sh|# $licence|set -eu|"
is 'in comments of the kind of file' "$(head -n 1 tree/man/bare.7)" ".\\\" $licence"
ok 'programs stay programs' test -x tree/scripts/bare
is 'what a tool prints is left alone' "$(wc -l <tree/man/printed.1)" 1
mkdir empty
check empty >faults && report 1 'nothing to check is a status'
is 'and said' "$(cat faults)" 'check-headers: no sources found'

done_testing
