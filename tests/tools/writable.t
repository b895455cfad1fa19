# SPDX-License-Identifier: GPL-3.0-or-later
# One writable radius: what vam-slice makes as large as the printer allows, vam-optimize accepts, and both refuse alike.
. "$VAM_SOURCE/tests/tools/testlib.sh"

few='--set projector.columns=161 --set projector.axis_column=80 --set projector.throw_ratio=11'
accepted() {  # accepted NAME PART...: at two voxel sizes, by the default printer and by one with few columns
  part=$1; shift
  for voxel in 0.3 0.41; do
    for printer in '' "$few"; do
      vam-slice "$@" --fit-writable --voxel $voxel $printer -o fit.vdb 2>.log/slice || cat .log/slice
      ok "$part, voxels of $voxel mm${printer:+, few columns}" \
        vam-optimize --angles 24 --method fbp $printer fit.vdb -o fit.exr
    done
  done
}
accepted "a boat" --shape boat
accepted "a gyroid" --shape gyroid
accepted "a plate" --shape box:x=20,y=20,z=2
accepted "a tilted plate" --shape box:x=20,y=20,z=2 --rotate 30,20,10
accepted "a rod" --shape cylinder:diameter=2.5,height=100
if [ -n "${VAM_BUNNY:-}" ]; then accepted "the bunny" "$VAM_BUNNY"; fi
if [ -n "${VAM_SPOT:-}" ]; then accepted "the cow" "$VAM_SPOT"; fi

# What no voxel would hold is refused, with the voxels that do, where it was written and vam-optimize refused it.
for part in 'box:x=20,y=20,z=0.2' 'cylinder:diameter=30,height=0.3' 'cylinder:diameter=1,height=100' 'box:x=40,y=1,z=1' 'box:x=20,y=20,z=0.5 --rotate 90,0,0'; do
  thin="vam-slice --shape $part --fit-writable -o thin.vdb --voxel"
  rm -f thin.vdb
  fails 65 'at the size that fits, [0-9.]+ mm, no voxel of 0.41 mm is at least half covered \(0.[0-9]+ at most\); use voxels of [0-9.]+ mm, or thicken the part' $thin 0.41
  is 'and nothing is written' "$(ls thin.vdb 2>/dev/null)" ''
  voxel=$(sed 's/.*use voxels of \([0-9.]*\) mm.*/\1/' .log/err)
  ok "$part at $voxel mm" $thin "$voxel"
  # Smaller voxels than the projector's pixels are no more than sliced.
  awk "BEGIN { exit !($voxel < 0.065) }" || ok 'which vam-optimize takes' vam-optimize --angles 24 --method fbp thin.vdb -o thin.exr
done

# One number: 80 columns of 0.065 mm with 115.115 mm to the lens are 5.1947 mm in air, 3.395 mm in the resin.
disc='--shape cylinder:diameter=8,height=2 --voxel 0.2'
vam-slice $disc -o disc.vdb
fails 65 'reaches 4 mm \(20 voxels\) from the axis, beyond the writable radius of 3.395 mm \(16.98 voxels\)' \
  vam-slice $disc $few -o out.vdb
fails 65 'light reaches only 16.98;' vam-optimize $few --geometry parallel disc.vdb -o out.exr
# The projector's own rays know from which angles light comes.
vam-optimize $few --iterations 1 --angles 24 disc.vdb -o out.exr 2>err
is 'it is reported from how many angles the rim is lit' "$?:$(cat err)" \
  '0:vam-optimize: warning: disc.vdb: reaches 4.111 mm from the axis, beyond the writable radius of 3.395 mm; its outermost voxels are lit from 62.5 % of the stage angles, and doses there are accurate to 1 % of the maximum (RMS; single voxels to some per cent)'
# A part that is narrower, but whose voxels are not.
brim='--shape cylinder:diameter=16.59,height=2 --voxel 0.4'
fails 65 'its voxels reach 8.528 mm \(21.32 voxels\) from the axis, beyond the writable radius of 8.301 mm' vam-slice $brim -o out.vdb
fails 65 'outside its columns 0 to 199' vam-slice $disc --set projector.columns=200 --set projector.axis_column=511.5 -o out.vdb
fails 65 'outside its columns 0 to 199' vam-optimize disc.vdb --set projector.columns=200 --set projector.axis_column=511.5 -o out.exr

# A square bar in a vial in air, its corners at 1.15 R/n, in resin that absorbs: printable from 60 angles.
glass='--set vial.wall_mm=0.5 --set projector.telecentric=true --set resin.absorption_per_mm=0.05'
bar='--shape box:x=13.5,y=13.5,z=2 --voxel 0.4'
fails 65 'beyond the writable radius of 8.301 mm .*; give --scale 0.839 or --fit-writable to make it fit, or --extent resin to accept' vam-slice $bar -o bar.vdb
fails 65 "beyond the resin's edge at 12.2 mm" vam-slice $bar $glass --scale 1.5 --extent resin -o bar.vdb
quiet 'a bar beyond the writable radius' vam-slice $bar $glass --extent resin -o bar.vdb
vam-optimize bar.vdb $glass --angles 60 -o bar.exr 2>err
vam-dose bar.exr $glass --like bar.vdb -o dose.vdb
ok 'it prints' vam-score dose.vdb --target bar.vdb $glass --require 'ver<=0,pw>=0.05' --lit-fraction reach.vdb --report score.json
vam-score reach.vdb --grid lit_fraction --target bar.vdb $glass --report - >reach.json
holds 'its corners are lit from five sixths of the angles' "$(json reach.json min_part) > 0.78 && $(json reach.json min_part) < 0.88"
done_testing
