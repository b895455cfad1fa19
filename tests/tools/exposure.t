#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 60
# The exposure travels with the light: what vam-optimize planned is what video, images, screen and print give, and the
# printer travels with it, whatever the folder.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
cat >printer.toml <<'TOML'
[projector]
columns = 64
rows = 48
pixel_mm = 0.26
axis_column = 31.5
axis_row = 23.5
fps = 30
max_intensity_mw_cm2 = 40
[vial]
radius_mm = 7
[resin]
absorption_per_mm = 0.05
critical_dose_mj_cm3 = 100
[stage]
device = "sim:"
speed_deg_s = 90
# end of the settings
TOML
mkdir else
vam-slice --shape half-cylinder:diameter=5,height=4 --voxel 0.26 -o part.vdb
vam-optimize part.vdb --angles 60 --verbose -o light.exr --report light.json 2>said
attr() { python3 "$VAM_SOURCE/tests/tools/exr.py" attr "$1" "$2" | tr -d ' '; }
turns=$(json light.json turns)
holds 'a print of several turns' "$turns > 1"
is 'which the stack states' "$(attr light.exr vam:shown_turns)" "$turns"
ok 'the verdict ends with the command' grep -q '; to show it: vam-project light.exr -o print.mkv$' said
vam-optimize part.vdb --angles 60 --iterations 2 --verbose --printer "$PWD/printer.toml" --set stage.speed_deg_s=45 -o 'a b.exr' 2>said
ok 'which names the printer, and works' sh -c "$(sed -n 's/.*; to show it: \(vam-project .* --printer .* --set .*\)/\1/p' said | grep . || echo false)"
vam-optimize part.vdb --angles 60 2>said >piped.exr
is 'a pipe states the same' "$(attr piped.exr vam:shown_turns) $(attr piped.exr vam:full_scale)" "$turns $(attr light.exr vam:full_scale)"
quiet 'the dose of the print' vam-dose light.exr --like part.vdb -o planned.vdb --report planned.json
holds 'of these turns' "$(json planned.json turns) == $turns"
vam-score planned.vdb --target part.vdb --report planned.score.json >here.txt
holds 'cures the part at the critical dose' "$(json planned.score.json critical_dose) == 100 && $(json planned.score.json cured_part) == 1"
ok 'in the time of the verdict' grep -q "duration $(awk "BEGIN { print 4 * $turns }") s" here.txt

# cures NAME FILE: the dose of what was shown is the planned one, to 2 %, by its file alone.
cures() {
  (cd else && vam-score "../$2" --target ../part.vdb --report "../$2.json" >"../$2.txt")
  holds "$1: the planned dose" "($(json "$2.json" mean_part) / $(json planned.score.json mean_part) - 1) ^ 2 < 0.02 ^ 2"
  holds "$1: cures the part" "$(json "$2.json" critical_dose) == 100 && $(json "$2.json" cured_part) > 0.99 && $(json "$2.json" cured_void) < 0.01"
}
shown() { (cd else && vam-convert "../$2" --geometry vial -o shown.exr && vam-dose shown.exr --like ../part.vdb -o "../$1.vdb") 2>/dev/null; cures "$1" "$1.vdb"; }
quiet 'a video' vam-project light.exr -o print.mkv
shown video print.mkv
quiet 'images' vam-project light.exr -o frames/
shown images frames; cp frames/facts.txt facts
for damage in 'head -c 150' 'sed s/vam:shown_turns./shown=/' 'sed s/vam:printer/vam:piece/' 'head -n -2' 'head -c 0'; do
  $damage facts >frames/facts.txt; fails 65 'facts.txt: .*; write them again' vam-convert frames --geometry vial -o cut.exr
done
# What is not all of the light, or was moved by another program.
if command -v ffmpeg >/dev/null; then
  ffmpeg -v error -i print.mkv -t 4 -c copy one.mkv </dev/null
  fails 65 "one.mkv: has 120 of the $((120 * turns)) frames of its light .*give --view-step 3" vam-convert one.mkv --geometry vial -o cut.exr
  vam-convert one.mkv --view-step 3 --geometry vial -o cut.exr 2>/dev/null
  is 'those that are there count on request' "$(attr cut.exr vam:shown_turns)" 1
  ffmpeg -v error -i print.mkv -c:v libx264 -qp 0 moved.mp4 </dev/null
  ffmpeg -v error -r 8 -i print.mkv -c:v ffv1 slow.mkv </dev/null
  fails 65 'slow.mkv: plays 8 frames per second, but was made for 30 ' vam-convert slow.mkv --geometry vial -o cut.exr
  for name in moved own; do
    [ $name = moved ] || vam-project light.exr -o own.mp4 2>/dev/null
    vam-convert $name.mp4 --geometry vial -o moved.exr 2>/dev/null
    is "$name.mp4 states its exposure" "$(attr moved.exr vam:shown_turns)" "$turns"
  done
else
  echo "ok $((number += 1)) - videos that ffmpeg wrote # SKIP no ffmpeg here"
fi
sed 's/critical_dose_mj_cm3=100/critical_dose_mj_cm3=90/' facts >frames/facts.txt
fails 65 'frames/facts.txt: the facts or the [0-9]* frames beside it are not those that were written' vam-convert frames --geometry vial -o cut.exr
cp facts frames/facts.txt; sed 's/^00007.png,[^,]*,[^,]*/00007.png,9,9/' frames/frames.csv >index; cp frames/frames.csv whole; cp index frames/frames.csv
fails 65 'frames/facts.txt: the facts or the [0-9]* frames beside it are not those' vam-convert frames --geometry vial -o cut.exr
cp whole frames/frames.csv; cp -r frames fewer; rm fewer/frames.csv; (cd fewer && rm $(ls [0-9]*.png | tail -n +121))
fails 65 'fewer/facts.txt: the facts or the 120 frames beside it are not those' vam-check fewer
head -n -1 facts >fewer/facts.txt
fails 65 "fewer: has 120 of the $((120 * turns)) frames of its light" vam-convert fewer --geometry vial -o cut.exr
mkdir card card/dri; touch card/dri/card0
FAKE_DRM=$PWD/card LD_PRELOAD=$VAM_BUILD/lib/vam-test/drm_card.so vam-project light.exr -o drm:HDMI-A-1 --max-missed 1 --max-missed-lit 1 --log flips 2>errors
is 'a screen' "$? $(cat errors)" '0 '
vam-dose light.exr --like part.vdb --shown flips -o screen.vdb
cures screen screen.vdb
ok 'vam-print' vam-print light.exr --display null: --uncalibrated --max-missed 1 --max-missed-lit 1 --run run
vam-dose light.exr --like part.vdb --shown run -o print.vdb
cures vam-print print.vdb

is 'a planned dose says how it is shown, one that was shown does not' "$(grep -c '; to show it: vam-project SINOGRAM -o print.mkv$' here.txt) $(cat print.vdb.txt screen.vdb.txt | grep -c 'to show it')" '1 0'

critical() { vam-calibrate critical-dose part.vdb --isovalue 0.5 --dose "$@" -o critical.json; json critical.json critical_dose_mj_cm3; }
fails 65 'planned.vdb: is of no print that was made .*--turns' vam-calibrate critical-dose part.vdb --isovalue 0.5 --dose planned.vdb
fails 64 '--turns: does not apply to doses by --shown' vam-calibrate critical-dose part.vdb --isovalue 0.5 --dose print.vdb --turns 1
holds 'what a print was given is known, of a plan what part of it' "($(critical print.vdb) / $(critical planned.vdb --turns 1) - $turns) ^ 2 < (0.02 * $turns) ^ 2"

# From another folder the same verdict; what differs there is named.
(cd else && vam-score ../planned.vdb --target ../part.vdb) >there.txt
same 'the verdict is that of any folder' here.txt there.txt
sed 's/= 7$/= 9/; s/= 100$/= 130/' printer.toml >else/printer.toml
(cd else && vam-score ../planned.vdb --target ../part.vdb) >there.txt 2>errors
same 'with another printer in it, too' here.txt there.txt
ok 'which is named' grep -q 'planned.vdb: made for another printer than printer.toml: .*vial.radius_mm 7, now 9; .*critical_dose_mj_cm3 100, now 130; its own counts' errors
(cd else && vam-dose ../light.exr --like ../part.vdb --report other.json -o other.vdb) 2>/dev/null
holds 'the dose is that of its printer' "$(json else/other.json critical_dose_mj_cm3) == 100"
fails 65 'vial.radius_mm 7, now 9' vam-project light.exr --printer else/printer.toml -o x.mkv
rm else/printer.toml
(cd else && vam-project ../light.exr -o named.mkv && vam-project -o piped.mkv <../light.exr)
is 'a pipe has its printer, too' "$(vam-check else/piped.mkv | sed 's/.*, //')" "$(vam-check else/named.mkv | sed 's/.*, //')"
vam-sinogram part.vdb -o parallel.exr
(cd else && vam-dose ../parallel.exr --like ../part.vdb --report parallel.json -o parallel.vdb)
holds 'as parallel light has that of its part' "$(json else/parallel.json critical_dose_mj_cm3) == 100"
(cd else && vam-project ../light.exr --print-printer -o own.toml)
is 'its printer, but no device of its' "$(grep -c '^radius_mm = 7' else/own.toml) $(grep -c '^device = "sim:"' else/own.toml)" '1 0'
fails 65 'half_angle_deg 0, now 1.*stage.motion [a-z]*, now interpolated' vam-project light.exr --set projector.half_angle_deg=1 --set stage.motion=interpolated -o x.mkv
vam-project light.exr --verbose -o x.mkv 2>said
ok 'frames over other stage angles than were judged are told' grep -qx 'vam-project: shows each frame of light.exr over 7.94 deg of the stage, which was judged with [06] deg; stage.motion=interpolated judges by what is shown' said

# So do its files.
mkdir bench
printf 'grey,intensity\n0,0\n128,10\n255,40\n' >bench/lamp.csv
printf 'grey,intensity\n0,0\n255,40\n' >else/lamp.csv
(cd bench && vam-project ../light.exr --set projector.response=lamp.csv -o curved.mkv && vam-convert curved.mkv --geometry vial -o home.exr)
(cd else && vam-convert ../bench/curved.mkv --geometry vial -o away.exr)
for place in bench/home else/away; do vam-dose $place.exr --like part.vdb -o curved.vdb --report $place.json; done
is 'a response of that name elsewhere is another' "$(json else/away.json full_scale) $(json else/away.json part_dose_per_turn_mean_mj_cm3)" \
  "$(json bench/home.json full_scale) $(json bench/home.json part_dose_per_turn_mean_mj_cm3)"

# Another exposure than the planned one.
for given in '--turns 1' '--set stage.turns=1'; do
  fails 65 'light.exr: 1 turn gives 0[.][0-9]* of the planned dose, which .* turns reach; .*--accept-dose' vam-project light.exr $given -o x.mkv
done
sed 's/^device/turns = 9\n&/' printer.toml >nine.toml
vam-project light.exr --printer nine.toml -o x.mkv 2>said; vam-print light.exr --printer nine.toml --display null: --uncalibrated --plan 2>>said | grep '^exposure' >plan.txt
is 'turns of a file are no plan, which is said' "$(grep -c "warning: light.exr: is planned for $turns turns, and stage.turns 9 is not used; --set" said) $(cut -d' ' -f4 plan.txt)" "2 $turns"
fails 65 'of the planned dose' vam-print light.exr --display null: --uncalibrated --turns 1 --run short
fails 65 'of the planned dose' vam-project light.exr --speed 45 -o x.mkv
ok 'is accepted on request' vam-project light.exr --turns 1 --accept-dose -o short.mkv --report short.json
vam-print light.exr --display null: --uncalibrated --max-missed 1 --max-missed-lit 1 --turns 1 --accept-dose --run short 2>said
ok 'which a print says' grep -q 'warning: light.exr: 1 turn gives .* of the planned dose' said
holds 'and told in the report' "($(json short.json share_of_planned_dose) * $turns - 1) ^ 2 < 1e-6"
fails 65 '0.[0-9]* of the planned dose' vam-project light.exr --turns 1 --multiplier "$turns" -o x.mkv
vam-project light.exr -o null: --speed 900 --from 540 --max-missed 1 --max-missed-lit 1 --report rest.json
holds 'the rest of a print is told as such' "($(json rest.json share_of_planned_dose) - 0.1 * (1 - 1.5 / $turns)) ^ 2 < 1e-8"
vam-project light.exr --multiplier 0.95 -o x.mkv 2>said
ok 'a little less is said' grep -q 'warning: light.exr: .* 0.95 of the planned dose' said

# The dose diffuses for as long as the print takes that is planned, and is judged by that in every tool.
diffuses='--set resin.diffusion_mm2_s=0.0004'
vam-optimize part.vdb --angles 60 $diffuses --report diffused.json -o diffused.exr 2>said
ok 'which the light does not compensate by itself' grep -q "warning: the light compensates for the diffusion of 4 s, and its print takes $(json diffused.json duration_s | sed 's/.0$//') s; optimize.diffusion_time_s=" said
vam-dose diffused.exr --like part.vdb --report blurred.json -o blurred.vdb 2>/dev/null
holds 'by the time of the plan' "($(json blurred.json blur_sigma_mm) ^ 2 / (0.0004 * $(json diffused.json duration_s)) - 1) ^ 2 < 1e-12"
vam-score blurred.vdb --target part.vdb --report blurred.json >/dev/null
holds 'with one figure' "($(json blurred.json pw) - $(json diffused.json pw)) ^ 2 < 1e-8"
vam-dose diffused.exr --like part.vdb --exposure-plan --diffusion-time 4 -o x.vdb 2>said
ok 'another time for another plan is said' grep -q 'exposure: planned for the dose that diffuses for 4 s, it takes [0-9]* s; --diffusion-time [0-9]* plans for that' said
plans() { vam-plan --shape half-cylinder:diameter=5,height=4 --voxel 0.26 $diffuses "$@" 2>/dev/null; }
plans --report slow.json >/dev/null
plans --set resin.critical_dose_mj_cm3=5 --report quick.json >/dev/null
holds 'vam-plan judges the same light by its turns, too' "$(json slow.json turns) > $(json quick.json turns) && ($(json slow.json pw) - $(json quick.json pw)) ^ 2 > 1e-6"

# Pieces know no plan of the whole; joined, they have that of their threshold.
vam-optimize part.vdb --geometry parallel --angles 60 -o flat.exr --report flat.json --verbose 2>said
is 'no projector shows parallel light' "$(grep -c 'verdict\|print' said) $(grep -c 'to show it' said)" '1 0'
vam-dose flat.exr --like part.vdb -o flat.vdb; vam-score flat.vdb --target part.vdb --report flat.score.json >/dev/null
judged() { echo "$(json $1 judged_radius_mm | cut -c1-6) $(json $1 verdict | grep -o '([0-9]* voxels)')"; }
is 'one region of parallel light is judged, and stated' "$(judged flat.score.json)" "$(judged flat.json)"
for n in 1 2; do quiet "piece $n" vam-optimize part.vdb --geometry parallel --angles 60 --slices $n/2 -o piece-$n.exr; done
is 'states no exposure' "$(attr piece-2.exr vam:shown_turns 2>&1 | tail -n 1)" "KeyError: 'vam:shown_turns'"
quiet 'joined' vam-convert join piece-1.exr piece-2.exr -o joined.exr
vam-dose joined.exr --like part.vdb --report joined.json -o joined.vdb
holds 'the turns follow from their light' "$(json joined.json turns) == $(json flat.json turns)"
vam-dose joined.exr --like part.vdb $diffuses --report joined.json -o joined.vdb 2>/dev/null
holds 'for which the dose diffuses' "($(json joined.json blur_sigma_mm) ^ 2 / (0.0004 * 4 * $(json joined.json turns)) - 1) ^ 2 < 1e-12"
fails 64 'not known before the end of a pipe; give a file, or --diffusion-time' sh -c "vam-dose --like part.vdb $diffuses -o x.vdb <joined.exr"

# Resampled, light is planned for the printer that shows it.
for speed in 90 180; do
  vam-resample flat.exr --set stage.speed_deg_s=$speed -o at.exr 2>/dev/null
  vam-dose at.exr --like part.vdb --report "at-$speed.json" -o at.vdb 2>/dev/null && vam-score at.vdb --target part.vdb --report "$speed.json" >/dev/null
done
holds 'at twice the speed for the same dose' "$(json at-180.json turns) > $(json at-90.json turns) && ($(json 180.json mean_part) / $(json 90.json mean_part) - 1) ^ 2 < 1e-8"

# Grey levels are those that are shown.
vam-optimize part.vdb --angles 60 --bits 2 -o two.exr --report two.json
holds 'below full intensity' "$(json two.json multiplier) < 0.95"
vam-dose two.exr --like part.vdb -o two.vdb; vam-score two.vdb --target part.vdb --report two.score.json >two.txt
vam-project two.exr --bits 2 --fps 15 -o two/ --report levels.json
vam-convert two --geometry vial -o levels.exr && vam-dose levels.exr --like part.vdb -o levels.vdb
vam-score levels.vdb --target part.vdb --report levels.score.json >levels.txt
holds 'none is clipped, none is another' "$(json levels.json clipped_fraction) == 0 && ($(json levels.score.json mean_part) / $(json two.score.json mean_part) - 1) ^ 2 < 1e-8"
is 'the verdict is that of the levels' "$(json two.json verdict | cut -c -10)" "$(json two.score.json verdict | cut -c -10)"

vam-optimize part.vdb --angles 60 --iterations 2 --set resin.absorption_per_mm=0 --verbose -o x.exr 2>said
ok 'without a known resin dose and time are relative' grep -q '; dose and time are relative without resin.absorption_per_mm, which vam-calibrate cure-depth measures$' said
done_testing
