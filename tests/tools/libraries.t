#!/bin/sh
# Tools start with the libraries that they always need: those of videos and desktops are loaded by who opens one.
. "$VAM_SOURCE/tests/tools/testlib.sh"

for source in "$VAM_SOURCE"/tools/vam-*.cpp; do
  tool=$(basename "$source" .cpp)
  command -v "$tool" >/dev/null || continue  # built without devices
  ldd "$(command -v "$tool")" | awk '{ print $1 }' >loaded
  is "$tool: no libraries of videos and desktops" "$(grep -E 'libav(format|codec|util)|libSDL' loaded)" ''
  is "$tool: at most 60 libraries" "$([ "$(wc -l <loaded)" -le 60 ] || cat loaded)" ''
done
done_testing
