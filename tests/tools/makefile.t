# SPDX-License-Identifier: GPL-3.0-or-later
# Makefile.example: incremental, parallel, and its check fails when a part will not print.
. "$VAM_SOURCE/tests/tools/testlib.sh"

cp "$VAM_SOURCE/Makefile.example" Makefile
box 4 4 1 >box.off
cp box.off other.off
ok 'builds all, two at once' make -j2 VOXEL=0.2
for part in box other; do
  [ -s $part.mkv ] && [ -s $part.dose.png ]; report $? "$part has a video and a figure"
done
is 'a second run does nothing' "$(make -s VOXEL=0.2 | wc -c)" 0
touch other.off
remade=$(make VOXEL=0.2 | grep -c 'vam-slice')
is 'only the changed part is made again' "$remade" 1
cp printer.toml 'my printer.toml'
is 'another printer file makes all again' "$(VAM_PRINTER='my printer.toml' make -n VOXEL=0.2 | grep -c 'vam-slice .*off')" 2
ok 'a printable part passes' make check VOXEL=0.2 LIMITS='iou>=0.5'
rm -f ./*.score.json
make check VOXEL=0.2 LIMITS='iou>=1.5' >.log/out 2>&1
[ $? -ne 0 ]; report $? 'a part that will not print fails the check'
[ ! -e box.score.json ] || [ ! -e other.score.json ]; report $? 'a failed verdict leaves no target behind'
rm -f ./*.off
box 4 4 1 >PART.OFF
ok 'a mesh whose ending is in capitals is a part' sh -c 'make -n | grep -q "vam-slice PART.OFF .* -o PART.vdb"'
rm -f PART.OFF
box 4 4 1 >box.off; cp box.off box.dose.off
make >.log/out 2>&1; status=$?
is 'a mesh that would make the output of another is refused' "$status $(grep -c 'box.dose.off: would make box.dose.vdb, an output of box.off; rename it' .log/out)" '2 1'

done_testing
