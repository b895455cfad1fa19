# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-ost: views to volume, threshold, live turns and the stop event; every wrong input. The views are a projector's
# frames read as a camera's (rays run both ways); tests/lib/metrology judges accuracy with traced rays.
. "$VAM_SOURCE/tests/tools/testlib.sh"

rig='--pixel 0.2 --set camera.distance_mm=119.808 --set camera.azimuth_deg=0'
vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1 -o design.vdb
vam-sinogram design.vdb --angles 60 >sino.exr
cat >coarse.toml <<'TOML'
[projector]
columns = 333
rows = 40
pixel_mm = 0.2
axis_column = 166
axis_row = 19.5
throw_ratio = 1.8
fps = 1.6666667
TOML
vam-resample sino.exr --printer coarse.toml -o seen.exr
vam-project seen.exr --printer coarse.toml -o views
is 'as many views as angles' "$(ls views | grep -c png)" 60

quiet 'a folder of views' vam-ost views --view-step 6 $rig -o scatter.vdb --report ost.json --projections sums.png
holds 'the axis is where it was put' "$(json ost.json axis_column_px) > 165.9 && $(json ost.json axis_column_px) < 166.1"
holds 'and upright' "$(json ost.json axis_tilt_deg) > -0.05 && $(json ost.json axis_tilt_deg) < 0.05"
quiet 'threshold of a standard' vam-calibrate resin scatter.vdb --diameter 6 -o resin.json
holds 'the circle is seen at its size' "$(json resin.json apparent_diameter_mm) > 5.7 && $(json resin.json apparent_diameter_mm) < 6.3"
quiet 'with the record' vam-ost views --view-step 6 $rig --resin resin.json --mesh print.ply -o again.vdb
quiet 'the print is the design' vam-sdf print.ply design.vdb --align icp --require 'rms<=0.15'

quiet 'live' vam-ost views --view-step 6 $rig --live --resin resin.json --target design.vdb \
  -o live --log log.jsonl --projections now.png --page now.html
is 'one volume a turn' "$(ls live)" scatter-0000.vdb
is 'one line per volume' "$(grep -c missing_percent log.jsonl)" 1
quiet 'and its uncertainty' vam-ost views --view-step 6 $rig --live --uncertainties -o both
is 'in the folder, the volume last' "$(ls -tr both | tr '\n' ' ')" 'uncertainty-0000.vdb scatter-0000.vdb '
is 'both state their turns' "$(grep -alc vam:turns both/*.vdb | wc -l)" 2
grep -q 'now.png' now.html; report $? 'the page shows the image'
event=$(vam-ost views --view-step 6 $rig --live --resin resin.json --target design.vdb --until 'iou>=0.5')
echo "$event" | grep -q '"event":"stop"'; report $? 'a stop event when the condition holds'

# What follows sees a standard through glass and resin by traced rays, with noise: 3 % of the brightest in each pixel.
glass='--set vial.radius_mm=12.7 --set vial.wall_mm=1 --set vial.index_glass=1.52 --set camera.distance_mm=200
  --set camera.index_resin=1.5 --set camera.azimuth_deg=90'
render=$VAM_BUILD/render_views
"$render" boat:length=8,wall=0.6 boat.exr noise=0.2 offset=7.4 tilt=0.5 angles=60 columns=320 rows=128 pixel=0.06 step=0.15
quiet 'traced views with noise' vam-ost boat.exr $glass --binning 2 -o boat.vdb --report boat.json
holds 'the axis is off by 7.4 px of the camera' "$(json boat.json axis_column_px) > 166.7 && $(json boat.json axis_column_px) < 167.1"
"$render" boat:length=8,wall=0.6 cut.exr noise=0.2 clipped=1 angles=60 columns=320 rows=128 pixel=0.06 step=0.15
vam-ost cut.exr $glass --binning 2 -o cut.vdb 2>said
ok 'a camera that cuts its noise off at 0 is a warning' grep -Eq "warning: [0-9.]+ % of the camera's readings are 0, with a background of .*; raise its black level" said
quiet 'which can be given' vam-ost boat.exr $glass --binning 2 --axis-column "$(json boat.json axis_column_px)" -o said.vdb --report said.json
is 'and is reported as it was said' "$(json said.json axis_column_px)" "$(json boat.json axis_column_px)"
holds 'and leans by 0.5 deg' "$(json boat.json axis_tilt_deg) > 0.45 && $(json boat.json axis_tilt_deg) < 0.55"
"$render" cylinder:diameter=6,height=4 standard.exr noise=0.2
quiet 'a standard cylinder' vam-ost standard.exr $glass -o standard.vdb
quiet 'I_p by its known diameter' vam-calibrate resin standard.vdb --diameter 6 -o glass.json
quiet 'its uncertainty' vam-ost standard.exr $glass -o known.vdb --uncertainty sigma.vdb --resin glass.json --mesh known.ply
head -c 600 known.ply | grep -aq 'property float scalar_uncertainty'; report $? 'is in the mesh'
vam-slice --shape cylinder:diameter=6,height=4 --voxel 0.1 --stretch-z 1 -o standard-design.vdb
quiet 'and is used by vam-sdf' vam-sdf known.vdb standard-design.vdb --resin glass.json --uncertainty sigma.vdb --report known.json
is 'which says so' "$(json known.json uncertainty_budget.source)" volume
holds 'a tenth of a pixel or so' "$(json known.json uncertainty_budget.surface_mm) > 0.001 && $(json known.json uncertainty_budget.surface_mm) < 0.1"
quiet 'or of the mesh' vam-sdf known.ply standard-design.vdb --report mesh.json
is 'which says so, too' "$(json mesh.json uncertainty_budget.source)" mesh
holds 'and knows as much' "$(json mesh.json uncertainty_budget.surface_mm) / $(json known.json uncertainty_budget.surface_mm) > 0.99 && $(json mesh.json uncertainty_budget.surface_mm) / $(json known.json uncertainty_budget.surface_mm) < 1.01"
holds 'the standard is as high as it was drawn' "$(json glass.json height_mm) > 3.8 && $(json glass.json height_mm) < 4.2"
# The profilometer's image of the standard: 6 mm, off the middle.
$png make profile.png 200 200 '200 if ((x - 103) ** 2 + (y - 96) ** 2) ** 0.5 * 0.05 < 3 else 20'
quiet 'I_p by a profilometer' vam-calibrate resin standard.vdb --profile profile.png --profile-pixel 0.05 -o profile.json
holds 'measures the standard' "$(json profile.json diameter_mm) > 5.95 && $(json profile.json diameter_mm) < 6.05"
holds 'and its isovalue is on the edge' "$(json profile.json isovalue) > 0.3 && $(json profile.json isovalue) < 0.7"
"$render" cylinder:diameter=4,height=4 other.exr noise=0.2
quiet 'the record is read' vam-ost other.exr $glass --resin glass.json --mesh other.ply -o other.vdb
diameter=$(python3 - <<'PY'
import struct
data = open("other.ply", "rb").read()
head, body = data.split(b"end_header\n", 1)
count = int(head.split(b"element vertex ")[1].split()[0])
points = list(struct.iter_unpack("<3f", body[:12 * count]))
radii = sorted((x * x + y * y) ** 0.5 for x, y, z in points if abs(z) < 1.5)
print(2 * radii[len(radii) // 2])
PY
)
holds "another cylinder's diameter is right within 0.1 mm ($diameter)" "$diameter > 3.9 && $diameter < 4.1"
vam-slice --shape cylinder:diameter=4,height=4 --voxel 0.1 --stretch-z 1 -o four.vdb
quiet 'vam-sdf takes the same record' vam-sdf other.vdb four.vdb --resin glass.json --align icp --require 'rms<=0.08'
vam-ost other.exr $glass | vam-sdf - four.vdb --resin glass.json --align icp --require 'rms<=0.08'
report $? 'also through a pipe'
quiet 'binned by four, by MLEM' vam-ost other.exr $glass --binning 4 --mlem-iterations 10 -o coarse.vdb --report coarse.json
is 'makes voxels of four pixels' "$(json coarse.json voxel_mm)" 0.48

# Where resin and bath match and the vial is 80 pixels in radius, rounding decides whether a column is on its rim.
"$render" cylinder:diameter=6,height=2 round.exr noise=0.05 columns=201 rows=24 pixel=0.155 angles=60 step=0.3
matched='--pixel 0.155 --set resin.index=1.53 --set bath.index=1.53 --set bath.window_mm=30 --set camera.distance_mm=150
  --set camera.azimuth_deg=90 --keep-run-out'
ok 'a radius of whole pixels in a matched bath' timeout 60 vam-ost round.exr $matched --set vial.radius_mm=12.4 -o round.vdb
ok 'and one that is not' vam-ost round.exr $matched --set vial.radius_mm=12.43 -o uneven.vdb
ok 'give the same print' vam-sdf round.vdb uneven.vdb --isovalue 0.5 --align none --require 'rms<=0.005'

# A print that grows: nothing at first, then three turns; live through a pipe until it is done.
"$render" cylinder:diameter=4,height=4 grows.exr noise=0.05 turns=4 growth=0.5 angles=60
cat grows.exr | vam-ost --live $glass --resin glass.json --target four.vdb --until 'missing<=5%' \
  -o turns --log turns.jsonl --projections 'turns"><b>.png' --page turns.html >event.json 2>.log/err
report $? 'a print that grows'
is 'nothing on standard error' "$(cat .log/err)" ''
is 'it stops once' "$(grep -c '"event":"stop"' event.json)" 1
python3 - <<'PY'
import json
missing = [json.loads(line)["missing_percent"] for line in open("turns.jsonl")]
assert len(missing) >= 3 and missing == sorted(missing, reverse=True) and missing[-1] <= 5 < missing[-2], missing
PY
report $? 'the missing part decreases from turn to turn'
is 'a volume for every line' "$(ls turns | wc -l)" "$(wc -l <turns.jsonl)"
grep -q 'missing_percent' turns.html; report $? 'the page has the figures'
grep -q 'src="turns%22%3E%3Cb%3E.png?' turns.html; report $? 'and the image by a name that cannot end the attribute'
"$render" cylinder:diameter=4,height=4 faint.exr noise=0.05 turns=2 growth=0 angles=60
vam-ost faint.exr --live $glass --isovalue 0.5 --filter ram-lak -o faint --log - >.log/out 2>.log/err
is 'the log - is standard error, its data unmixed' "$(cat .log/out)" ''
grep -q '"waiting"' .log/err; report $? 'the log is there'
quiet 'live waits while nothing is visible' vam-ost faint.exr --live $glass --isovalue 0.5 -o faint --log faint.jsonl
is 'with the reason' "$(grep -c '"waiting":"views: no rotation axis' faint.jsonl)" 1
"$render" cylinder:diameter=4,height=4 gap.exr noise=0.05 turns=3 angles=60 lost=8
vam-ost gap.exr --live $glass --isovalue 0.5 -o gap --log gap.jsonl 2>errors
report $? 'a gap costs a live print no more than its turn'
is 'with a warning' "$(grep -c 'warning: no volume after .* turns: views: the turn is incomplete' errors)" 1
is 'which is reported' "$(grep -c '"waiting":"views: the turn is incomplete, no frame for 54 deg' gap.jsonl) $(ls gap | wc -l)" '1 2'
: >live.jsonl
fails 65 'no volume' vam-ost views --view-step 2 $rig --live --log live.jsonl
fails 65 'turns were recorded; last: views: the turn is incomplete' vam-ost views --view-step 20 $rig --live --log live.jsonl

fails 64 "'p.off' must end in .3mf or .ply or .stl or .obj" vam-ost views --view-step 6 --isovalue 1 --mesh p.off -o x.vdb
fails 65 'views: views: the turn is incomplete' vam-ost views --view-step 2 $rig -o x.vdb
for wrong in dark saturated sizes; do mkdir $wrong; cp views/* $wrong; done
first=$(ls views | head -n 1); last=$(ls views | grep png | tail -n 1)
$png make "dark/$first" 333 40 0
$png make "saturated/$first" 333 40 '255 * (x < 166)'
$png make "sizes/$last" 300 40 '100 * (x < 150)'
fails 65 'has 300 x 40 pixels, but those before have 333 x 40' vam-ost sizes --view-step 6 $rig -o x.vdb
# A view that cannot be measured, or is missing, costs no more than itself; many of them are an error.
cp -r views missing; rm "missing/$(ls views | grep png | sed -n 21p)"
left_out() {  # left_out FOLDER REGEX: reconstructs, and warns in one line
  vam-ost "$1" --view-step 6 $rig --resin resin.json --target design.vdb -o "$1.vdb" --report "$1.json" 2>errors
  is "$1: status, warnings" "$? $(grep -c . errors) $(grep -Ec "$2" errors)" '0 1 1'
  holds "$1: as from all views" "$(json "$1.json" print.iou) > $whole - 0.01"
}
quiet 'all views' vam-ost views --view-step 6 $rig --resin resin.json --target design.vdb -o x.vdb --report whole.json
whole=$(json whole.json print.iou)
# A target that was sliced for rays that climb, beside an insert, is the same part.
vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1.1333333 \
  --insert-shape cylinder:diameter=1,height=1 --insert-at 0,0,2 -o overprint.vdb
quiet 'stretched, beside an insert' vam-ost views --view-step 6 $rig --resin resin.json --target overprint.vdb -o x.vdb --report over.json
for figure in missing_percent overcure_percent; do
  holds "$figure is that of the part" "($(json over.json print.$figure) - $(json whole.json print.$figure))^2 < 1"
done
left_out saturated 'saturated, 49.8 % of the pixels are at 1;.*the view is left out'
left_out dark 'dark, every pixel is 0.*the view is left out'
left_out missing '1 number is missing between the first and the last'
mkdir later; n=2; for view in views/*.png; do cp "$view" "later/$(printf %04d $n).png"; n=$((n + 1)); done
left_out later 'numbers begin at 2, which is taken for angle 0; if earlier images are missing'

vam-ost views --view-step 6 $rig --isovalue "$(json resin.json isovalue)" --min-body 1e6 --mesh none.ply -o x.vdb 2>errors
is 'a print without a body' "$? $(grep -c 'no body is kept: the largest has .* mm3; check --min-body' errors) $(ls none.ply 2>/dev/null)" '65 1 '
fails 65 'standard: appears .* mm in diameter, 6.5 mm are stated; check --diameter' vam-calibrate resin standard.vdb --diameter 6.5 -o wrong.json
done_testing
