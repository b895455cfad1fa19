#!/bin/sh
# Tools start with the libraries that they always need: those of videos, desktops and figures are loaded by who opens one.
. "$VAM_SOURCE/tests/tools/testlib.sh"

for source in "$VAM_SOURCE"/tools/vam-*.cpp; do
  tool=$(basename "$source" .cpp)
  command -v "$tool" >/dev/null || continue  # built without devices
  ldd "$(command -v "$tool")" | awk '{ print $1 }' >loaded
  is "$tool: no libraries of videos, desktops and fonts" "$(grep -E 'libav(format|codec|util)|libSDL|libpango|libcairo' loaded)" ''
  is "$tool: at most 60 libraries" "$([ "$(wc -l <loaded)" -le 60 ] || cat loaded)" ''
done
done_testing
