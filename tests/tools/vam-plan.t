# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-plan end to end: parts that fit and that do not, the estimate, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

# A box of 10 x 10 x 4 mm: its corners are 7.07 mm from the axis, within the 8.3 mm of the default printer.
box 10 10 4 >box.off
ok 'a plan that is to print' sh -c 'vam-plan box.off --require "prints>=1, slices<70" --report plan.json >plan'
is 'it fits' "$(json plan.json fits)" true
is 'at the size that it has' "$(json plan.json size_mm.0) $(json plan.json size_mm.2)" '10.0 4.0'
holds 'slices of a pixel' "$(json plan.json slices) >= 4 / 0.065 - 1 && $(json plan.json slices) < 1.1 * 4 / 0.065 + 2"
holds 'the thinnest wall is its height' "($(json plan.json thinnest_wall_voxels) - $(json plan.json slices)) ^ 2 <= 4"
holds 'in mm of the part, not of the stretched target' "($(json plan.json thinnest_wall_mm) - 4) ^ 2 < 0.0627 ^ 2"
ok 'as the table says' grep -qE '^thinnest wall  *6[34][.0-9]* voxels \((3.9[4-9]|4|4.0[0-6])[0-9]* mm\)' plan
ok 'and so are slices' grep -q '^slices .* of 0.0626 mm$' plan
ok 'in words' sh -c 'grep -q "^fits  *yes: a cylinder of 16.6 mm diameter" plan && grep -q "^verdict  *will print: forgives +-[0-9.]* % of dose, process window +" plan && grep -q "^  index +-0.005  *process window" plan'
ok 'frames are held by the angles of the print, not of the estimate' grep -q '^verdict .*; by each frame over 1 deg of the stage' plan
ok 'one that turns asks for angles that hardly blur' grep -qE '^angles  *--angles (120|180|240|360|720): process window [-+][0-9.]* with 120, .* with 720, as the stage turns' plan
holds 'of which more are no worse' "$(json plan.json pw_by_angles.120) < $(json plan.json pw_by_angles.360) && $(json plan.json pw_by_angles.360) < $(json plan.json pw_by_angles.720) + 0.002"
holds 'which costs little' "($(json plan.json pw) - $(json plan.json pw_by_angles.720)) ^ 2 < 0.002 ^ 2"
ok 'without the resin no duration' grep -q '^duration  *not known; set resin.critical_dose_mj_cm3' plan

# The scale that is said is the one that vam-slice takes, and hardly larger ones are refused.
box 40 40 9 >large.off
ok 'a part that is too large' sh -c 'vam-plan large.off --no-preview --report large.json >large'
is 'does not fit' "$(json large.json fits)" false
fails 1 'fits = 0, .*; prints is not known, ' vam-plan large.off --no-preview --require 'fits>=1,prints>=1'
scale=$(json large.json scale)
ok 'vam-slice takes the scale' vam-slice large.off --scale "$scale" --voxel 0.065 -o large.vdb
fails 65 'large.off' vam-slice large.off --scale "$(awk "BEGIN { print 1.02 * $scale }")" --voxel 0.065 -o none.vdb
ok 'the table says it' grep -q -- "^scale needed  *--scale $scale;" large
holds 'a bath of the resin lets more in' "$(json large.json index_bath.scale_that_fits) > 1.4 * $scale"
# Without refraction all of the resin is lit, but for the outermost ray: 12.7 mm.
holds 'nearly all of the vial' "$(json large.json index_bath.writable_radius_mm) > 12.5"

# The bath's scale is rounded down, too: 0.4067 is 0.406.
bath='--set bath.index=1.53 --set bath.window_mm=19.05'
box 44 44 9 >wider.off
scale=$(vam-plan wider.off --no-preview | sed -n 's/^index bath .*--scale //p')
is 'which the plan says' "$scale" 0.406
ok 'vam-slice takes it' vam-slice wider.off --scale "$scale" --voxel 0.065 $bath -o wider.vdb
fails 65 'wider.off' \
  vam-slice wider.off --scale "$(awk "BEGIN { print 1.02 * $scale }")" --voxel 0.065 $bath -o none.vdb
# A part whose file is in micrometres: three digits of a small number.
box 10000 10000 4000 >micro.off
ok 'a file in micrometres' sh -c 'vam-plan micro.off --no-preview --report micro.json >micro'
holds 'as large as fits' "$(json micro.json scale) > 0.99 * $(json micro.json scale_that_fits) && $(json micro.json scale) <= $(json micro.json scale_that_fits)"
deep=$(printf 'deep%.0s' $(seq 50)); mkdir -p "$deep/$deep/$deep"; cp box.off "$deep/$deep/$deep"
ok 'a long name is not cut' sh -c "vam-plan $deep/$deep/$deep/box.off --no-preview | grep -q 'box.off: 10 x 10 x 4 mm\$'"

# A pyramid is no thin wall, but pointed.
cat >pyramid.off <<END
OFF
5 6 0
-3 -3 0
3 -3 0
3 3 0
-3 3 0
0 0 5
3 0 2 1
3 0 3 2
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
END
ok 'a pyramid' sh -c 'vam-plan pyramid.off --no-preview --report pyramid.json >pyramid'
holds 'is as thick as the ball within' "($(json pyramid.json thinnest_wall_voxels) * 0.065 - 3.4) ^ 2 < 0.02"
is 'and has sharp edges' "$(json pyramid.json sharp_edges) $(grep -c '^sharp edges ' pyramid)" 'true 1'
is 'unlike a box' "$(json plan.json sharp_edges) $(grep -c '^sharp edges ' plan)" 'false 0'

sed -e '2s/.*/5 5 0/' -e '$d' pyramid.off >holed.off
ok 'holes in a mesh are a warning' sh -c 'vam-plan holed.off --no-preview 2>&1 >holed | grep -q "holed.off: 3 boundary edges remain; the inside"'
is 'closed meshes are none' "$(vam-plan box.off --no-preview 2>&1 >/dev/null)" ''

# Of large parts walls are measured on larger voxels, and the estimate is coarser.
box 16 0.05 45 >sheet.off
ok 'a sheet in a tall part' sh -c 'vam-plan sheet.off --no-preview >sheet'
ok 'is thinner than what is told apart' grep -q '^thinnest wall  *below 2 voxels (0.13 mm)' sheet
fine='--set projector.columns=3840 --set projector.rows=2880 --set projector.pixel_mm=0.0173 --set projector.axis_column=1919.5 --set projector.axis_row=1439.5'
box 11 11 5 >wide.off
ok 'a projector of 11 million pixels' sh -c "vam-plan wide.off $fine >fine"
ok 'coarser voxels' grep -q '^estimate  *voxels of 0.138 mm' fine

ok 'with a resin' sh -c 'vam-plan --shape cylinder:diameter=6,height=2 --set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05 --report resin.json >resin'
holds 'there is a duration' "$(json resin.json duration_s) > 0 && $(json resin.json turns) >= 1"
# The same part at full resolution: turns differ by the coarseness of the estimate, not by a factor.
vam-slice --shape cylinder:diameter=6,height=2 --voxel 0.13 -o part.vdb
vam-optimize part.vdb --angles 90 --iterations 20 --set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05 \
  --report full.json -o full.exr 2>.log/full
holds 'as long as that of vam-optimize' "$(json resin.json duration_s) < 2 * $(json full.json duration_s) && $(json resin.json duration_s) > 0.5 * $(json full.json duration_s)"
is 'and with the same verdict' "$(awk "BEGIN { print ($(json resin.json pw) >= 0) }")" "$(awk "BEGIN { print ($(json full.json pw) >= 0) }")"

# A part that is in metres, and one whose walls no voxel of 4 pixels is inside of.
box 0.02 0.012 0.016 >metres.off
ok 'a file in metres' sh -c 'vam-plan metres.off >metres 2>metres.log'
ok 'is doubted' grep -q 'metres.off: the part is only 0.02 mm large; is its unit m?' metres.log
ok 'and has no voxel to judge' grep -q '^verdict  *unknown at 0.065 mm; --voxel [0-9.e-]* tells: no voxel is wholly inside the part' metres
ok 'its unit is believed' sh -c 'vam-plan metres.off --unit mm --no-preview >said 2>said.log && ! test -s said.log'
few='--set vial.radius_mm=4'  # as wide as these parts need
ok 'a tiny part in mm' sh -c "vam-plan metres.off --scale 12 $few --report thin.json >thin 2>thin.log && ! test -s thin.log"
holds 'is judged on finer voxels' "$(json thin.json estimate_voxel_mm) <= 2 * 0.065"

# A fin of 3 pixels on a block is 7 % of it: coarse voxels lose it, and it is judged on finer ones. On a block for
# which those would be too many, the plan says what was not judged, and where.
block() { boxes "$1 $2 $3" "$4 3 $5 0 0 $3"; }  # block X Y Z THICK HIGH: a fin of 3 mm across the top
block 3 3 1.5 0.2 1.5 >fin.off
ok 'a block with a fin' sh -c "vam-plan fin.off $few --report fin.json >fin"
holds 'is judged on voxels that show it' "$(json fin.json estimate_voxel_mm) <= 0.2 / 1.5"
block 11 11 3 0.1 3 >wide-fin.off
ok 'on a large block' sh -c 'vam-plan wide-fin.off --report wide.json >wide'
ok 'the answer is open' grep -qE '^verdict  *unknown at 0.[12][0-9]* mm, as what is cut or joined on these voxels may be whole on smaller ones; --voxel 0.0?[0-9]* tells: forgives [+]-[0-9.]* % of dose, process window [+]' wide
ok 'with the reason' grep -qE '^  too coarse  *at 0.26 mm: 0.2[0-9]* % of the part is in walls too thin .* between z = -?0?[.0-9]+ and 3[.0-9]* mm' wide
is 'in the report, too' "$(json wide.json prints) $(json fin.json prints)" 'None 1'
holds 'with its share' "($(json wide.json unresolved_part) / (0.9 / 363.9) - 1) ^ 2 < 0.3 ^ 2"
holds 'on the voxels of the estimate' "$(json wide.json estimate_voxel_mm) > 0.12"
block 4 4 2 0.1 1 >thin.off
ok 'on voxels of 0.25 mm' \
  sh -c 'vam-plan thin.off --no-preview --set projector.pixel_mm=0.25 --report thin.json >thin 2>.log/thin'
ok 'the fin is the thinnest wall' grep -qx 'thinnest wall  *below 1 voxel (0.25 mm): enlarge the part, or use smaller pixels' thin
is 'the report gives no other' "$(grep -c thinnest_wall thin.json)" 0
block 4 4 1.5 0.01 3 >sheet.off
ok 'walls that the printer loses are a warning' \
  sh -c 'vam-plan sheet.off --no-preview 2>&1 >.log/sheet | grep -q "sheet.off: 0.37 % of the part is in walls too thin"'
is 'others are not' "$(vam-plan fin.off --no-preview 2>&1 >.log/fin)" ''

# A strut of 0.2 mm between two plates, of less than a hundredth of the middle of all.
boxes '8 8 2' '0.2 0.2 2.2 1 -2 1.9' '8 8 2 0 0 4' >strut.off
ok 'two plates and a strut' sh -c 'vam-plan strut.off --no-preview --report strut.json >strut 2>.log/strut'
holds 'the walls are the plates' "$(json strut.json thinnest_wall_mm) > 1"
holds 'the strut is the thinnest place' "($(json strut.json thinnest_place_mm) - 0.2) ^ 2 < 0.07 ^ 2"
ok 'the table says where' grep -Eq '^  thinnest place   [234][0-9.]* voxels \(0.[12][0-9]* mm\) at x, y, z = (0.9|1|1.0)[0-9]*, -(1.9|2|2.0)[0-9]*, -?[0-9.]+ mm' strut
is 'and of a plain block nothing' "$(box 8 8 4 >plain.off; vam-plan plain.off --no-preview | grep -c 'thinnest place')" 0

# An hourglass, two cones that share a neck: none of its faces is near a parallel one, and on coarse voxels it holds.
hourglass() {  # hourglass RADIUS: of the neck, between ends of 1.5 mm
  awk -v neck="$1" 'BEGIN {
    n = 32; print "OFF\n" 3 * n + 2 " " 6 * n " 0"
    for (ring = -1; ring <= 1; ring++) for (i = 0; i < n; i++) {
      a = 2 * 3.14159265 * i / n; r = ring ? 1.5 : neck; print 2.5 * ring, r * cos(a), r * sin(a) }
    print "-2.5 0 0\n2.5 0 0"
    for (i = 0; i < n; i++) { j = (i + 1) % n
      for (b = 0; b <= n; b += n) print "3 " b + i " " b + j " " b + n + i "\n3 " b + j " " b + n + j " " b + n + i
      print "3 " 3 * n " " j " " i "\n3 " 3 * n + 1 " " 2 * n + i " " 2 * n + j } }'
}
coarse='--set projector.columns=96 --set projector.rows=96 --set projector.pixel_mm=0.2 --set projector.axis_column=47.5 --set projector.axis_row=47.5'
hourglass 0.16 >neck.off
ok 'an hourglass' sh -c "vam-plan neck.off $coarse --report neck.json >neck"
ok 'may not print at its neck' grep -q '^  thinnest place  *1.*voxels (0.3.* mm) at x, y, z = -*0.1, -*0.1, -*0.*; it may not print' neck
hourglass 0.13 >thin.off; ok 'a thinner one' sh -c "vam-plan thin.off $coarse --report neck.json >neck"
ok 'is cut' grep -q '^verdict  *[a-z].*: forgives +-.* of dose, process window +.*; the print is in' neck
holds 'with the numbers' "$(json neck.json solids) == 1 && $(json neck.json print_pieces_most) > 1"
hourglass 0.4 >waist.off; ok 'a wider one' sh -c "vam-plan waist.off $coarse --report waist.json >waist"
is 'prints' "$(grep -c '^verdict  *will print: ' waist) $(grep -c 'the print is in' waist)" '1 0'
is 'in one piece' "$(json waist.json solids) $(json waist.json print_pieces_least) $(json waist.json print_pieces_most)" '1 1 1'

# The estimate and the final verdict are of one judge.
gyroid='--shape gyroid:diameter=8,height=4,cell=4,sheet=0.3'
printer='--set projector.columns=160 --set projector.rows=120 --set projector.pixel_mm=0.13'
printer="$printer --set stage.motion=stepped"
vam-plan $gyroid $printer --report stepped.json >stepped
is 'a stage that stands asks for no more angles' "$(grep -c '^angles ' stepped)" 0
vam-slice $gyroid $printer -o gyroid.vdb
vam-optimize gyroid.vdb $printer --angles 180 -o gyroid.exr 2>.log/gyroid
vam-dose gyroid.exr --like gyroid.vdb $printer | vam-score --target gyroid.vdb $printer >scored
is 'a gyroid near the edge prints, as vam-score says' \
  "$(grep -c '^verdict  *will print: forgives +-[0-9.]* % of dose, process window +' stepped) $(grep -c 'will print: forgives +-[0-9.]* % of dose, process window +' scored)" '1 1'
vam-plan --shape hollow-cylinder:outer=6,inner=5.9,height=3 --voxel 0.05 --report foil.json >foil 2>.log/foil
is 'walls too thin to be seen are no silent yes' "$(json foil.json prints)" None
holds 'their share is reported' "$(json foil.json unresolved_part) > 0.9"
ok 'and smaller voxels are named' grep -q '^verdict  *unknown at 0.05 mm; --voxel 0.0[12][0-9]* tells' foil
vam-plan --shape ladder --voxel 0.3 --report rungs.json >rungs 2>.log/rungs
is 'nor are walls too thin for the voxels of the print' "$(json rungs.json prints) $(grep -c '^verdict .*; .* too thin for the voxels' rungs)" 'None 1'
vam-plan --shape gyroid:diameter=5,height=3,cell=3,sheet=0.6 --voxel 0.2 --set resin.psf_mm=1 --report blurred.json >blurred
is 'what the beam blurs away does not print' "$(json blurred.json prints)" 0
ok 'and where' grep -q '^  wrong voxels  *z = ' blurred
# An oblique wall of two voxels, which a little less dose pierces.
awk 'BEGIN { print "OFF\n8 12 0"; c = cos(0.6); s = sin(0.6)
  for (i = 0; i < 8; i++) { x = i % 2 ? 3 : -3; y = int(i / 2) % 2 ? 0.21 : -0.21; z = i > 3 ? 2 : -2; print c * x - s * y, s * x + c * y, z + 0.3 * x }
  print "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 5" }' >wall.off
vam-plan wall.off --set projector.pixel_mm=0.2 --report wall.json >wall
is 'an oblique wall of two voxels is no silent yes' "$(json wall.json prints) $(grep -c '^verdict  *unknown at 0.2 mm, as 2 % of the dose decide; ' wall)" 'None 1'
vam-plan --shape box:x=2,y=2,z=8 --report tall.json >tall
holds 'a thin part is judged on coarse voxels, where the resin around it is large' "$(json tall.json estimate_voxel_mm) >= 0.2"

fails 65 'box.off: is 1e[+]05 x 1e[+]05 x 4e[+]04 mm, [0-9e+.]* times too large for this printer; check --unit' \
  vam-plan box.off --scale 10000
fails 65 '^vam-plan: shape cylinder:diameter=1000,height=2: is 1e[+]06 x 1e[+]06 x 2000 mm' \
  vam-plan --shape cylinder:diameter=1000,height=2 --scale 1000
fails 65 'box.off: no part fits the cylinder that can be written, of .* mm radius and 48.* mm height, with pixels' \
  vam-plan box.off --set projector.columns=1 --set projector.axis_column=0 --set projector.lens_distance_mm=120

# A slot of 0.6 mm that diffusion shuts: where most of it is, in mm of the part.
python3 - >slot.off <<'END'
points, faces = [], []
for low, high in [((-4, -4, 0), (2.4, 4, 6)), ((3, -4, 0), (4, 4, 6)), ((2.4, -4, 0), (3, 4, 2))]:
    first = len(points)
    points += [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces += [[first + i for i in face] for face in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))]
print("OFF\n%d %d 0" % (len(points), len(faces)))
for point in points: print(*point)
for face in faces: print(4, *face)
END
vam-plan slot.off --voxel 0.2 --set resin.psf_mm=0.7 --set projector.telecentric=true --report slot.json >.log/slot
holds 'the place of a shut slot is in the slot' "$(python3 -c '
import json
x, y, z = json.load(open("slot.json"))["shut_at_mm"]
print(int(2.3 < x < 3.1 and -4 < y < 4 and 1.8 < z < 6.1))')"

# Faces of closed solids a fiftieth of a voxel apart touch; a seventh of one is a gap, which is lost.
for gap in 0.0012 0.01; do
  boxes "2 3 3 -1 0 0" "2 3 3 $(awk "BEGIN { print 1 + $gap }") 0 0" >touch.off
  vam-plan touch.off --no-preview --report touch.json 2>touch.log >touch
  is "a gap of $gap mm" "$(grep -c 'gaps of' touch.log)" "$(awk "BEGIN { print ($gap > 0.003) }")"
done

# An array of parts, each of its own voxels.
box 2 3 1 >one.off
box 1 1 1 >small.off
vam-plan one.off --copies 2x2 --gap 0.5 --voxel 0.25 --report array.json >array
is 'four parts' "$(json array.json size_mm | tr -d ' ') $(json array.json solids)" '[4.5,6.5,1.0] 4'
vam-plan one.off --beside small.off --beside small.off --no-preview --report several.json >several
holds 'three in the rows of the smallest radius' "$(json several.json size_mm.0) <= 8 && $(json several.json size_mm.1) <= 7"
fails 65 'one.off: is .* times too large' vam-plan one.off --copies 100x100 --gap 1000
vam-plan one.off --copies 4x4 --no-preview --report many.json >many
is 'what does not fit is told' "$(json many.json fits) $(grep -c '^scale needed' many)" 'false 1'
fails 64 "copies: '2' is not NXxNY" vam-plan one.off --copies 2
fails 64 "copies: '0' is no number of copies" vam-plan one.off --copies 0x2
fails 64 'copies: 1x1 has no place for 2 meshes' vam-plan one.off --copies 1x1 --beside small.off
fails 64 'gap' vam-plan one.off --gap 1
fails 66 'none.off: cannot open' vam-plan one.off --beside none.off
is 'every answer that is left open has its reason' "$(grep -h '^verdict  *unknown' * 2>/dev/null | grep -vc ', as \|no voxel is wholly inside')" 0
fails 66 'opencl: .*did you mean opencal' vam-plan one.off --printer opencl
fails 64 'cuvette: is square' vam-plan one.off --printer opencal,cuvette
ok 'presets are listed' sh -c 'vam-plan --printers | grep -q "^  vial-16: .*16.6 mm"'
is 'a printer and a vial' "$(vam-plan one.off --no-preview --printer opencal,vial-16,dudma 2>said | grep -c '0.0801\|^fits  *yes')" 1
ok 'what is not published is named' grep -q 'opencal,vial-16,dudma: projector.throw_ratio, projector.max_intensity_mw_cm2 are not published' said
done_testing
