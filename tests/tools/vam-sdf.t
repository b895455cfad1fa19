# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-sdf: meshes and volumes against each other, verdicts, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

few='--samples 20000'  # a tenth, which plane faces do not need
box 4 6 1 >box.off
# The same box, turned by 90 degrees about z (x -> y, y -> -x), moved by 10, 20, 30 and grown by 1 %.
awk 'NR < 3 { print; next } NF == 3 { print -1.01 * $2 + 10, 1.01 * $1 + 20, 1.01 * $3 + 30; next } { print }' box.off >moved.off

quiet 'a box against itself' vam-sdf box.off box.off --align none --report same.json
holds 'a box does not deviate from itself' "$(json same.json print_to_design.rms_mm) < 1e-9"
quiet 'a moved and enlarged box' vam-sdf moved.off box.off $few --fit-scale --report moved.json -o moved.ply --histogram moved.csv
holds 'the alignment recovers the move' "$(json moved.json hausdorff_mm) < 1e-3"
holds 'the fitted scale is that of the box' "$(json moved.json alignment.scale) * 1.01 > 0.9999 && $(json moved.json alignment.scale) * 1.01 < 1.0001"
quiet 'the histogram as an image' vam-sdf moved.off box.off $few --histogram moved.png
quiet 'an alignment without scale' vam-sdf moved.off box.off $few --report rigid.json
# Grown by 1 % about the centre: the faces stand out by 0.02, 0.03 and 0.005.
holds 'without scale the enlargement is a deviation' "$(json rigid.json hausdorff_mm) > 0.02 && $(json rigid.json hausdorff_mm) < 0.045"
holds 'the deviation is outwards' "$(json rigid.json print_to_design.mean_mm) > 0.004"
head -c 400 moved.ply | grep -aq scalar_distance; report $? 'the PLY has the scalar CloudCompare reads'
is 'the histogram is of the whole area' "$(awk -F, 'NR > 1 { s += $3 } END { printf "%.0f", s }' moved.csv)" 100

# Half a bar could be anywhere along it.
box 20 4 3 >bar.off
awk 'NR < 3 { print; next } NF == 3 { print $1 * 0.5 + 1, $2, $3; next } { print }' bar.off >half.off
fails 65 'fits in two places' vam-sdf half.off bar.off
quiet 'which is said to be right by its place' vam-sdf half.off bar.off $few --align icp

# A print that stands out by 0.2 mm on all sides corrects its design.
box 8 6 4 >design.off
awk 'NR < 3 { print; next } NF == 3 { print $1 + ($1 > 0 ? 0.2 : -0.2), $2 + ($2 > 0 ? 0.2 : -0.2), $3 + ($3 > 0 ? 0.2 : -0.2); next } { print }' design.off >grown.off
quiet 'the deviation as a volume' vam-sdf grown.off design.off $few --align none --volume first.vdb
quiet 'is taken off the design' vam-slice design.off --compensate first.vdb --damping 1 --voxel 0.1 --stretch-z 1 -o next.vdb --report next.json
is 'by this round' "$(json next.json compensation.applied)" 1
quiet 'and its surface' vam-sdf next.vdb grown.off $few --isovalue 0.5 --align icp --report inset.json
# 0.2 mm inside the design, 0.4 mm inside the print; rounded edges are a little nearer.
holds 'is as far inside' "$(json inset.json print_to_design.mean_mm) < -0.37 && $(json inset.json print_to_design.mean_mm) > -0.41"
quiet 'a print that is worse' vam-sdf design.off design.off $few --align none --volume none.vdb
ok 'what came after the best print is left' vam-slice design.off --compensate none.vdb --compensate first.vdb --voxel 0.2 -o settled.vdb
grep -q 'has settled' .log/err; report $? 'and said'
fails 65 'another design' vam-slice grown.off --compensate first.vdb --voxel 0.2 -o x.vdb
fails 65 'RMS deviation|no grid' vam-slice design.off --compensate next.vdb --voxel 0.2 -o x.vdb
awk 'NR == 2 { print $1, $2 - 1, $3; next } { line[NR] = $0 } END { for (n = 3; n < NR; ++n) print line[n] }' design.off |
  { echo OFF; cat; } >open.off
awk 'NR == 2 { $2 *= 2 } { print } NR > 2 && NF == 4 { again = again $0 "\n" } END { printf "%s", again }' design.off >twice.off
doubled='vam-sdf: warning: twice.off: holds 12 duplicate triangles; a body may be there twice, and counts twice in areas and percentiles'
is 'a body that is there twice is named' "$(vam-sdf grown.off twice.off $few --align none --volume twice.vdb 2>&1)" \
  "$doubled"
for pair in 'twice.off design.off' 'grown.off twice.off'; do
  is "and so it is without --volume: $pair" "$(vam-sdf $pair $few --align none 2>&1 >out)" "$doubled"
done
fails 65 'open.off: has 3 boundary edges' vam-sdf design.off open.off $few --align none --volume x.vdb

# Faces and walls: the print that stands out by 0.2 mm on all sides.
faces='--region top=plane:-9,-9,3.5,9,9,4.5 --region body=wall:-3,-2,-1,3,2,5 --region front=-9,-9,-9,9,-2.5,9'
quiet 'regions' vam-sdf grown.off design.off $few --align none $faces --tolerance 0.25 --report regions.json \
  --require 'top.flatness<=0.001,top.offset>=0.199,body.thickness>=4.39,front.within>=90'
holds 'the top stands out by as much' "$(json regions.json regions.top.offset_mm) > 0.1999 && $(json regions.json regions.top.offset_mm) < 0.2001"
holds 'and is turned by nothing' "$(json regions.json regions.top.tilt_deg) < 0.01"
holds 'the wall is 4.4 mm thick' "$(json regions.json regions.body.thickness_mm) > 4.399 && $(json regions.json regions.body.thickness_mm) < 4.401"
holds 'of 4' "$(json regions.json regions.body.design_thickness_mm) > 3.999 && $(json regions.json regions.body.design_thickness_mm) < 4.001"
fails 1 'top.offset = .* top.offset<=0.1' vam-sdf grown.off design.off $few --align none $faces --require 'top.offset<=0.1'

# Faces as a CAD program exports them, meshed otherwise than the design, and a tolerance of their own.
printf 'OFF\n4 2 0\n-4 -3 4\n4 -3 4\n4 3 4\n-4 3 4\n3 0 1 2\n3 0 2 3\n' >seat.off
own='--region seat=plane:seat.off --region front=-9,-9,-9,9,-2.5,9'
quiet 'a region on faces' vam-sdf grown.off design.off $few --align none $own --tolerance 0.25 --tolerance seat=0.1 \
  --report own.json --require 'seat.offset>=0.199,seat.within<=0,front.within>=90,within>=90'
is 'is that of the box' "$(json own.json regions.seat.offset_mm)" "$(json regions.json regions.top.offset_mm)"
is 'and has its tolerance' "$(json own.json regions.seat.tolerance_mm) $(json own.json regions.front.tolerance_mm)" '0.1 0.25'
quiet 'a tolerance for one region alone' vam-sdf grown.off design.off $few --align none $own --tolerance seat=0.21 --require 'seat.within>=90'
fails 64 'front.within: give the tolerance' vam-sdf grown.off design.off $own --tolerance seat=0.1 --require 'front.within>=90'
fails 64 "'sest' is not a name" vam-sdf grown.off design.off $own --tolerance sest=0.1
fails 64 'must be more than 0' vam-sdf grown.off design.off $own --tolerance seat=-1
fails 64 'must be more than 0' vam-sdf grown.off design.off $own --tolerance wide
fails 64 'given already' vam-sdf grown.off design.off $own --tolerance 1 --tolerance 2
fails 64 "'5.1mm' is not a number" vam-sdf grown.off design.off --region top=plane:-5,-5,4.9,5,5,5.1mm
fails 66 'none.off' vam-sdf grown.off design.off --region seat=plane:none.off
sed 's/^3 \([0-9]\) \([0-9]\) \([0-9]\)$/3 \1 \3 \2/' seat.off >turned.off
fails 65 'face the same way' vam-sdf grown.off design.off --align none --region seat=plane:turned.off
is 'a print without noise is certain' "$(awk "BEGIN { print $(json regions.json expanded_uncertainty.regions.top.offset_mm) < 1e-4 }")" 1
# A scale that may be off by 1 %: the top at 4.2 mm by 0.042 mm, twice that with k = 2, drawn 20 times (+-16 %).
quiet 'an uncertain scale' vam-sdf grown.off design.off $few --align none $faces --scale-uncertainty 1 --report scale.json
holds 'is stated' "$(json scale.json expanded_uncertainty.regions.top.offset_mm) > 0.05 && $(json scale.json expanded_uncertainty.regions.top.offset_mm) < 0.13"
quiet 'a condition holds by the figure' vam-sdf grown.off design.off $few --align none $faces --scale-uncertainty 1 --require 'top.offset<=0.21'
fails 1 'with its uncertainty of' vam-sdf grown.off design.off $few --align none $faces --scale-uncertainty 1 --guard-band --require 'top.offset<=0.21'
# Three faces of the print, moved by 0.3 mm, are laid onto those of the design; the opposite ones stand out by 0.4.
datum='--region a=plane:-9,-9,-0.5,9,9,0.5 --region b=plane:-4.5,-9,-9,-3.5,9,9 --region c=plane:-9,-3.5,-9,9,-2.5,9'
awk 'NR < 3 { print; next } NF == 3 { print $1 + 0.3, $2 - 0.1, $3 + 0.2; next } { print }' grown.off >off.off
quiet 'datum faces' vam-sdf off.off design.off $few --align icp $datum --datum a --datum b --datum c --region top=plane:-9,-9,3.5,9,9,4.5 --report datum.json
holds 'lie on those of the design' "($(json datum.json regions.a.offset_mm)) ^ 2 < 1e-12 && ($(json datum.json regions.c.offset_mm)) ^ 2 < 1e-12"
holds 'and the others stand out' "$(json datum.json regions.top.offset_mm) > 0.399 && $(json datum.json regions.top.offset_mm) < 0.401"
fails 64 'not a plane that --region names' vam-sdf off.off design.off $datum --datum a --datum b --datum d
fails 64 'is given already' vam-sdf off.off design.off $datum --region a=0,0,0,1,1,1
fails 64 'top.bend' vam-sdf grown.off design.off $faces --require 'top.bend<1'

# Prints that grow by 0.05 mm from one to the next.
for n in 1 2 3 4; do
  awk -v n=$n '{ by = 0.05 * n } NR < 3 { print; next } NF == 3 { print $1 + ($1 > 0 ? by : -by), $2, $3; next } { print }' design.off >print$n.off
  vam-sdf print$n.off design.off $few --align none --region side=plane:3.5,-9,-9,4.5,9,9 --report run$n.json
done
mkdir run5 && cp run4.json run5 && ok 'a trend' vam-sdf trend run1.json run2.json run3.json run4.json --report trend.json --figure regions.side.offset_mm --plot trend.png
is 'prints a line a figure' "$(grep -c '^regions.side.offset_mm,' .log/out)" 1
drift=$(python3 -c 'import json; print(json.load(open("trend.json"))["figures"]["regions.side.offset_mm"]["drift"])')
holds 'with the drift' "$drift > 0.0499 && $drift < 0.0501"
quiet 'of a folder' vam-sdf trend run1.json run2.json run5
fails 64 'is not in all reports' vam-sdf trend run1.json run2.json run3.json --figure nothing --plot x.png

vam-slice --shape sphere:diameter=6 --voxel 0.2 -o sphere.vdb
vam-slice --shape sphere:diameter=6.4 --voxel 0.2 -o bigger.vdb
quiet 'volume against volume' vam-sdf bigger.vdb sphere.vdb $few --isovalue 0.5 --align none --report volume.json
# A surface of voxels of 0.2 mm is known to 0.04 of them, with or without their noise; edges of a mesh say nothing.
holds 'the voxels of a volume are in its uncertainty' "$(json volume.json uncertainty_budget.resolution_mm) > 0.006 && $(json volume.json uncertainty_budget.resolution_mm) < 0.01"
is 'and no edges of a mesh' "$(json regions.json uncertainty_budget.resolution_mm)" 0.0
# The bigger sphere stands on the same plane: its centre is 0.2 higher. Mean over the sphere 0.2 + d^2/(3R) = 0.204.
holds 'the deviation of two spheres is the difference of their radii' "$(json volume.json print_to_design.mean_mm) > 0.19 && $(json volume.json print_to_design.mean_mm) < 0.22"

quiet 'a condition that holds' vam-sdf box.off box.off $few --require 'rms<=0.01,hausdorff<0.1'
quiet 'the share within a tolerance' vam-sdf bigger.vdb sphere.vdb $few --isovalue 0.5 --align full --tolerance 0.3 --require 'within>=99,trimmed<=0.25' --report within.json
holds 'is reported' "$(json within.json within_percent) >= 99"
fails 1 'within = ' vam-sdf bigger.vdb sphere.vdb $few --isovalue 0.5 --align full --tolerance 0.1 --require 'within>=50'
fails 64 'give the tolerance' vam-sdf bigger.vdb sphere.vdb --isovalue 0.5 --require 'within>=50'
fails 1 'rms = .* rms<=0.001' vam-sdf bigger.vdb sphere.vdb $few --isovalue 0.5 --align none --require 'rms<=0.001'

# An embossed badge seen from above, 2 % too small, on a disc.
vam-slice --shape resolution:height=1 --voxel 0.1 --stretch-z 1 -o badge.vdb
vam-slice --shape resolution:height=1 --voxel 0.1 --scale 0.98 --rotate 0,0,31 --stretch-z 1 -o seen.vdb
quiet 'heights against a design' vam-sdf height seen.vdb badge.vdb --pixel 0.08 -o outline.png --plot section.png \
  --report height.json --require 'iou>=0.7,rms<=0.1'
holds 'shrinkage' "$(json height.json shrinkage_percent) > 1.8 && $(json height.json shrinkage_percent) < 2.2"
holds 'turn' "$(json height.json turn_deg) > 30.8 && $(json height.json turn_deg) < 31.2"
$png size outline.png >/dev/null; report $? 'an image of the heights'
fails 1 'shrinkage = ' vam-sdf height seen.vdb badge.vdb --pixel 0.08 --require 'shrinkage<=1'
fails 64 'DESIGN' vam-sdf height seen.vdb
fails 64 'outside the image' vam-sdf height seen.vdb badge.vdb --pixel 0.08 --line 0,0,9999,10
fails 65 'flat' vam-sdf height box.off badge.vdb --pixel 0.08

printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n' >flat.off
fails 65 'no triangle with an area' vam-sdf box.off flat.off

done_testing
