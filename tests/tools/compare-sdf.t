# SPDX-License-Identifier: GPL-3.0-or-later
# vam-sdf against MeshLab, CloudCompare and Open3D on one pair of meshes: those that are installed. Without any of them
# the test is skipped, aloud. First with programs that stand for them: one that breaks off is skipped alone.
. "$VAM_SOURCE/tests/tools/testlib.sh"
compare=$VAM_SOURCE/scripts/compare-sdf
fake() {  # fake NAME: a program of the lines that follow
  { echo '#!/bin/sh'; cat; } >"fakes/$1"
  chmod +x "fakes/$1"
}
mkdir fakes
touch fakes/numpy.py
printf 'import os\ndef __getattr__(name): os.abort()\n' >fakes/open3d.py
echo 'kill -ABRT $$' | fake CloudCompare
echo 'exit 0' | fake meshlabserver
echo '"$VAM_FAKES/CloudCompare"; exit $?' | fake xvfb-run
VAM_FAKES=$PWD/fakes; export VAM_FAKES
fakes() { PATH=$VAM_FAKES:$PATH PYTHONPATH=$VAM_FAKES "$@"; }
box 4 4 4 >design.off
box 4.2 4 4 >print.off

fakes "$compare" print.off design.off >said 2>errors
is 'where all break off nothing is compared' "$?" 77
for name in MeshLab CloudCompare Open3D; do
  ok "$name is named" grep -Eq "^$name +SKIPPED: .* broke off \(signal 6, Aborted\)" said
done
figure() { sed -n "s/^vam-sdf .*$1 \([-0-9.]*\) mm.*/\1/p" said; }
rms=$(figure 'vertex RMS') mean=$(figure 'vertex mean') area=$(figure 'area RMS')
sigma=$(awk "BEGIN { print sqrt($rms * $rms - $mean * $mean) }")
fake CloudCompare <<SH
case "\$*" in
  *SAMPLE_MESH*) echo 'Mean distance = 0 / std deviation = $area' ;;
  *) echo 'Mean distance = $mean / std deviation = $sigma' ;;
esac
SH
echo 'kill -SEGV $$' | fake xvfb-run
fakes "$compare" print.off design.off >said 2>errors
is 'one that agrees is enough' "$?" 0
ok 'and is said to' grep -q '^CloudCompare .*: agrees' said
ok 'beside one that broke off' grep -Eq '^MeshLab +SKIPPED: .*\(signal 11, Segmentation fault\)' said
ok 'and another' grep -Eq '^Open3D +SKIPPED' said
echo 'echo "Mean distance = 1 / std deviation = 1"' | fake CloudCompare
fakes "$compare" print.off design.off >said 2>errors
is 'one that does not agree is a failure' "$? $(grep -c 'DOES NOT AGREE' said)" '1 1'
echo 'exit 3' | fake CloudCompare
fakes "$compare" print.off design.off >said 2>errors
is 'and so is one that ends with an error' "$? $(grep -c 'CloudCompare ended with 3' errors)" '1 1'
echo 'kill -ABRT $$' | fake vam-sdf
fakes "$compare" print.off design.off >said 2>errors
is 'and vam-sdf that breaks off' "$? $(grep -c 'vam-sdf broke off (signal 6' errors)" '1 1'

"$compare"
status=$?
[ $status -ne 77 ] || [ "$failures" -ne 0 ] || { echo "1..$number"; exit 77; }
report $status 'vam-sdf agrees with those that are installed'
done_testing
