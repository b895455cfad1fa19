# SPDX-License-Identifier: GPL-3.0-or-later
# vam-calibrate registration: a camera that is turned, too low and of another scale than the printer file has it; its
# views are the oracle's.
. "$VAM_SOURCE/tests/tools/testlib.sh"
"$VAM_BUILD/render_views" box:x=5,y=3.4,z=4 views.exr columns=160 rows=64 pixel=0.12 angles=90 noise=0.02
vam-slice --shape box:x=5,y=3.4,z=4 --voxel 0.1 --stretch-z 1 -o design.vdb
cat >printer.toml <<TOML
[vial]
radius_mm = 12.7
wall_mm = 1
index_glass = 1.52
[camera]
distance_mm = 200
index_resin = 1.5
azimuth_deg = 90
axis_row = 31.5
pixel_mm = 0.12
[calibration]
folder = "cal"
TOML
export VAM_PRINTER=$PWD/printer.toml
mkdir cal
reconstruct() { vam-ost views.exr --axis-column 79.5 --tilt 0 --keep-run-out -o $1.vdb 2>ost.err || sed 's/^/# /' ost.err; }
wrong() { sed -e "s/^azimuth_deg.*/azimuth_deg = $1/" -e "s/^axis_row.*/axis_row = $2/" -i printer.toml; }
wrong 93 29.5
reconstruct off
isovalue=0.5  # of the density
quiet 'a registration' vam-calibrate registration off.vdb --design design.vdb --isovalue "$isovalue"
value() { json cal/current-registration.json values.$1.value; }
sigma() { json cal/current-registration.json values.$1.sigma; }
# The views' angles are whole turns of the oracle; noise and voxels leave a tenth of a degree and of a pixel.
holds 'the angle' "($(value azimuth) - 90) ^ 2 < 0.1 ^ 2 && $(sigma azimuth) < 0.2"
holds 'the height' "($(value axis_row) - 31.5) ^ 2 < 0.15 ^ 2 && $(sigma axis_row) < 0.2"
holds 'the scale is 1 within its standard deviation' "($(value scale) - 1) ^ 2 < (2 * $(sigma scale)) ^ 2 && $(sigma scale) < 0.015"
is 'so that the pixel stays' "$(grep -c '"pixel"' cal/current-registration.json)" 0
reconstruct registered
sleep 1  # records are named by the second
vam-sdf registered.vdb design.vdb --isovalue "$isovalue" --align none --report after.json >/dev/null
vam-sdf off.vdb design.vdb --isovalue "$isovalue" --align none --report before.json >/dev/null
holds 'the record is in force: the next volume stands where its print does' \
  "$(json after.json print_to_design.rms_mm) < 0.4 * $(json before.json print_to_design.rms_mm)"
vam-calibrate registration registered.vdb --design design.vdb --isovalue "$isovalue"
sleep 1
holds 'and stays there' "($(value azimuth) - 90) ^ 2 < 0.1 ^ 2"
vam-slice --shape box:x=5.5,y=3.74,z=4.4 --voxel 0.1 --stretch-z 1 -o large.vdb
vam-calibrate registration registered.vdb --design large.vdb --isovalue "$isovalue"
holds 'a scale of 1.1 is another pixel' "($(value pixel) / 0.12 - 1.1) ^ 2 < 0.02 ^ 2"
ok 'it is among the records' sh -c 'vam-calibrate check | grep -q registration'
vam-slice --shape cylinder:diameter=5,height=4 --voxel 0.1 --stretch-z 1 -o round.vdb
vam-calibrate registration round.vdb --isovalue 0.5 --design round.vdb >out 2>err; status=$?
is 'a round part is refused' "$status $(grep -c 'is round about its axis' err)" '1 1'
vam-calibrate registration off.vdb --design design.vdb --isovalue "$isovalue"
holds 'the volume states the camera that it was made with: again, and the result is the same' \
  "($(value azimuth) - 90) ^ 2 < 0.1 ^ 2 && ($(value axis_row) - 31.5) ^ 2 < 0.15 ^ 2"
vam-sdf off.vdb design.vdb --isovalue "$isovalue" --align none -o off.ply >/dev/null
sed -e /axis_row/d -e /calibration/d -e /folder/d printer.toml >bare.toml
fails 64 'set camera.axis_row' vam-calibrate registration --printer bare.toml off.ply --design design.vdb
fails 64 'isovalue' vam-calibrate registration off.vdb --design design.vdb
fails 64 'design' vam-calibrate registration off.vdb --isovalue 1
fails 66 'absent' vam-calibrate registration off.vdb --design absent.vdb --isovalue "$isovalue"
done_testing
