# SPDX-License-Identifier: GPL-3.0-or-later
# Tools start with the libraries that they always need: those of videos, desktops and figures are loaded by who opens one.
. "$VAM_SOURCE/tests/tools/testlib.sh"

for source in "$VAM_SOURCE"/tools/vam-*.cpp; do
  tool=$(basename "$source" .cpp)
  command -v "$tool" >/dev/null || continue  # built without devices
  ldd "$(command -v "$tool")" | awk '{ print $1 }' >loaded
  is "$tool: no libraries of videos, desktops and fonts" "$(grep -E 'libav(format|codec|util)|libSDL|libpango|libcairo' loaded)" ''
  is "$tool: at most 60 libraries" "$([ "$(wc -l <loaded)" -le 60 ] || cat loaded)" ''
  # Most symbols that are looked up at the start are OpenVDB's: behind four others it took 8 ms more.
  if grep -q libopenvdb loaded; then
    is "$tool: OpenVDB is looked up first" "$(grep '^lib' loaded | head -n 1 | cut -d. -f1)" libopenvdb
  fi
done
for tool in vam-resample vam-stage; do
  command -v "$tool" >/dev/null || continue
  is "$tool: no libraries of volumes and drawing" "$(ldd "$(command -v "$tool")" | grep -E 'openvdb|opencv|cairo')" ''
done
# Who ends with a figure asks for its libraries first.
mkdir broken
: >broken/libpangocairo-1.0.so.0
fails 69 'install the package libpangocairo' \
  env LD_LIBRARY_PATH="$PWD/broken" vam-optimize --tradeoff front.png absent.vdb -o absent.exr
fails 69 'install the package libpangocairo' \
  env LD_LIBRARY_PATH="$PWD/broken" vam-ost absent --projections sums.png -o scatter.vdb
done_testing
