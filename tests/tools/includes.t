# SPDX-License-Identifier: GPL-3.0-or-later
# Every file includes what it uses; and the check that verifies it finds those that do not.
. "$VAM_SOURCE/tests/tools/testlib.sh"

check() { "$VAM_SOURCE/scripts/check-includes" "$@"; }
ok "every file includes what it uses" check

mkdir tree
for part in lib tools tests; do cp -r "$VAM_SOURCE/$part" tree; done
missing() {  # missing FILE INCLUDE WHAT: found, where FILE has no longer this line; judged below
  ok "$1 has $2" grep -qxF "#include $2" "tree/$1"
  grep -vxF "#include $2" "tree/$1" >without
  cp without "tree/$1"
  echo "includes: $1: $3" >>wanted
}
missing lib/base/text/json_text.cpp '<vector>' 'std::vector needs <vector>'
missing lib/optics/slice_place.cpp '"base/error.hpp"' 'Error needs lib/base/error.hpp'
missing tools/vam-ost/live.cpp '"base/text/text.hpp"' 'format_number needs lib/base/text/text.hpp'
missing lib/io/settings/printer_text.cpp '<toml++/toml.h>' 'toml needs <toml++/...>'
missing tests/lib/device/lock_test.cpp '<fstream>' 'std::ofstream needs <fstream>'
sed -i '2a#include <cstddef>' tree/lib/io/array/array.cpp
echo 'includes: lib/io/array/array.cpp: cstddef is in its header' >>wanted
check tree 2>faults && report 1 'the check finds faults'
grep -vxF -f faults wanted >unseen
is "what is missing and not found" "$(cat unseen)" ""
done_testing
