# SPDX-License-Identifier: GPL-3.0-or-later
# Every include keeps to lib/layers.txt; and the check that verifies it finds those that do not.
. "$VAM_SOURCE/tests/tools/testlib.sh"

check() { "$VAM_SOURCE/scripts/check-layers" "$@"; }
ok "every include keeps to lib/layers.txt" check

mkdir tree
for part in lib tools tests; do cp -r "$VAM_SOURCE/$part" tree; done
found() {  # found NAME REGEX: it is a fault, and the only one
  check tree >faults && report 1 "found: $1" && return
  is "found: $1" "$(wc -l <faults):$(grep -Ec "$2" faults)" 1:1
}
number_of_file=0
finds() {  # finds FILE INCLUDE REGEX: a file with this line has this fault and no other; judged by all_found
  number_of_file=$((number_of_file + 1))
  file=${1%.cpp}_$number_of_file.cpp
  printf '%s\n' "$2" >"tree/$file"
  echo "$file" >"file_$number_of_file"
  printf '%s\n' "$3" >"wanted_$number_of_file"
}
all_found() {
  check tree >faults && report 1 'the check finds faults'
  for n in $(seq $number_of_file); do
    file=$(cat "file_$n")
    grep -F "$file:" faults >here
    is "found: $file: $(cat "tree/$file")" "$(wc -l <here):$(grep -Ec -f "wanted_$n" here)" 1:1
    rm "tree/$file"
  done
  is 'and nothing else' "$(wc -l <faults)" $number_of_file
}
finds tools/vam-score/new.cpp '#include "../vam-slice/part.hpp"' 'vam-score must not include tools/vam-slice/part.hpp'
finds tools/vam-score/new.cpp '#include <vam-slice/part.hpp>' 'vam-score must not include tools/vam-slice/part.hpp'
touch tree/tools/loose.hpp
finds tools/vam-score/new.cpp '#include "loose.hpp"' 'vam-score must not include tools/loose.hpp'
finds tools/vam-score/new.cpp '#include "io/mesh/private/formats.hpp"' 'is private to io/mesh'
finds tools/vam-score/new.cpp '#include "oracle/meshes.hpp"' 'oracle/meshes.hpp> has no room'
finds tools/vam-score/new.cpp '#include "../../tests/oracle/meshes.hpp"' 'must not include tests/oracle/meshes.hpp'
finds tools/vam-score/new.cpp '#include "opencv2/core.hpp"' 'belongs to .*metrology/ost'
finds lib/plot/new.cpp '#include "session/printer.hpp"' 'plot must not include session'
finds tests/oracle/new.cpp '#include <light/rays/vial_setup.hpp>' 'the oracle must share nothing'
finds tests/lib/tomo/new.cpp '#include "io/mesh/private/formats.hpp"' 'is private to io/mesh'
finds tests/lib/tomo/new.cpp '#include <OpenEXR/ImfHeader.h>' 'belongs to io/exr'
finds lib/optics/new.cpp '#include <io/exr/stack.hpp>' 'optics must not include io/exr'
finds lib/optics/new.cpp '# include "io/exr/stack.hpp"' 'optics must not include io/exr'
finds lib/optics/new.cpp '  #  include"io/exr/stack.hpp"' 'optics must not include io/exr'
finds lib/optics/new.cpp '#include "printer.hpp"' '<printer.hpp> has no room'
finds lib/optics/new.cpp '#include HEADER' 'has no room'
for header in boost/array.hpp libswscale/swscale.h drm.h SDL2/SDL.h; do
  finds lib/device/projector/new.cpp "#include <$header>" "<$header> (has no room|belongs to)"
done
all_found

layer() {  # layer LINE REGEX: with this line at the top of the table
  { echo "$1"; cat "$VAM_SOURCE/lib/layers.txt"; } >tree/lib/layers.txt
  found "$1" "$2"
}
layer 'weather:' 'there is no folder weather'
layer 'tomo:' 'tomo has two lines'
sed 's/^optics: base/optics: tomo base/' "$VAM_SOURCE/lib/layers.txt" >tree/lib/layers.txt
found 'a cycle' 'optics names tomo, which has no line above it'
done_testing
