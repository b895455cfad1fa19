# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# Poses: vials that wobble, parts that sink, helices; from table and record to light, dose and frames, and every wrong
# input.
. "$VAM_SOURCE/tests/tools/testlib.sh"
poses="python3 $VAM_SOURCE/tests/tools/poses.py"

$poses wobble 60 0.3 >wobble.csv
$poses sink 60 1 >sink.csv
print_of() {  # print_of STACK NAME OPTION...: dose and score of a stack
  stack=$1; name=$2; shift 2
  vam-dose "$stack" "$@" --like part.vdb -o "$name.vdb" && vam-score "$name.vdb" --target part.vdb --report "$name.json"
}

ok "a part" vam-slice --shape gyroid:diameter=8,height=5 --voxel 0.25 -o part.vdb
quiet "light for nothing displaced" vam-optimize --angles 60 part.vdb -o plain.exr
quiet "light for a vial that wobbles" vam-optimize --angles 60 --poses wobble.csv part.vdb -o wobble.exr
quiet "light for a part that sinks" vam-optimize --angles 60 --poses sink.csv part.vdb -o sink.exr
ok "print" print_of plain.exr plain
ok "print in the wobbling vial: the stack knows the poses" print_of wobble.exr wobble
ok "print while sinking" print_of sink.exr sink
ok "print of light that does not know of the wobble" print_of plain.exr unknown --poses wobble.csv
ok "print of light that does not know of the sinking" print_of plain.exr unsunk --poses sink.csv

# 0.3 mm of wobble, known: IoU at least 0.999; 1 mm of sinking, known: at most 0.3 voxels of the print's surface.
holds "a known wobble does no harm" "$(json wobble.json iou) >= 0.999 && $(json wobble.json ver) == 0"
holds "an unknown one does" "$(json unknown.json iou) < 0.99"
holds "nor does known sinking" "$(json sink.json iou) >= 0.999 && $(json sink.json ver) == 0"
holds "unknown sinking does" "$(json unsunk.json iou) < 0.9"
ok "surface of the print while sinking, against the print without" vam-sdf sink.vdb plain.vdb --isovalue 0.8 \
  --design-isovalue 0.8 --align none --report surface.json
holds "within 0.3 voxels RMS" "$(json surface.json print_to_design.rms_mm) <= 0.3 * 0.25"

# What the stack holds, and its frames
is "one line a frame and the header" "$($exr attr sink.exr vam:poses | grep -c ,)" 61
is "the report counts the poses" "$(vam-dose sink.exr --like part.vdb --report dose.json -o again.vdb && json dose.json poses)" 60
cmp_dose() { vam-dose "$1" --poses "$2" --size 5 -o a.vdb && vam-dose "$1" --size 5 -o b.vdb && vam-view a.vdb --export a.nrrd && vam-view b.vdb --export b.nrrd && tail -c 8000 a.nrrd >a.raw && tail -c 8000 b.nrrd >b.raw; }
ok "the same table again" cmp_dose sink.exr sink.csv
same "gives the same dose" a.raw b.raw
sixty="--set projector.fps=10 --set stage.speed_deg_s=60"
quiet "frames of light with poses" vam-project sink.exr $sixty -o frames/ --report frames.json
is "one turn, whatever stage.turns is" "$(vam-project sink.exr $sixty --set stage.turns=3 -o three/ --report three.json; json three.json frames)" 60
fails 64 'shown once' vam-project sink.exr $sixty --turns 2 -o two/
quiet "a wobble repeats" vam-project wobble.exr $sixty --turns 2 -o two/
fails 64 'a live print repeats one turn, which its poses do not allow' vam-project sink.exr --plan --turns 2 -o null:
fails 64 'a live print repeats one turn, which its poses do not allow' vam-project sink.exr --turns 2 -o null:
fails 64 'do not return' vam-dose sink.exr --like part.vdb --exposure-plan --set resin.absorption_per_mm=0.01 \
  --set resin.critical_dose_mj_cm3=100 -o plan.vdb

resin="--set resin.absorption_per_mm=0.01 --set resin.critical_dose_mj_cm3=100"
vam-optimize --method fbp --angles 60 --poses sink.csv $resin part.vdb -o once.exr --report once.json
is "frames that are shown once have no turns to plan" "$(grep -c '"turns"' once.json)" 0
vam-optimize --method fbp --angles 60 --poses wobble.csv $resin part.vdb -o again.exr --report again.json
is "those that repeat do" "$(grep -c '"turns"' again.json)" 1
slow="--set resin.diffusion_mm2_s=0.0001 --set stage.turns=9"
vam-dose sink.exr $slow --size 5 -o one.vdb --report one.json
vam-dose plain.exr $slow --size 5 -o nine.vdb --report nine.json
holds "they diffuse for their own turn" "($(json nine.json blur_sigma_mm) / $(json one.json blur_sigma_mm)) ^ 2 > 3 "
fails 64 'standard input' vam-optimize --poses - - -o none.exr

# A helix: three turns for a part that is three images high
image="--set projector.columns=240 --set projector.rows=40 --set projector.pixel_mm=0.1 --set projector.axis_column=119.5 --set projector.axis_row=19.5 --set projector.lens_distance_mm=120"
fails 65 'any-height' vam-slice --shape cylinder:diameter=6,height=11.4 --voxel 0.25 $image -o tall.vdb
ok "a tall part" vam-slice --shape cylinder:diameter=6,height=11.4 --voxel 0.25 $image --any-height -o tall.vdb
quiet "light for a helix" vam-optimize --angles 60 --helix 5.2 $image tall.vdb -o helix.exr
is "three turns" "$($exr attr helix.exr vam:poses | grep -c ,)" 181
ok "its dose" vam-dose helix.exr $image --like tall.vdb -o helix.vdb
ok "prints without an error" vam-score helix.vdb --target tall.vdb $image --require 'ver=0,iou>=0.9999'
vam-view helix.vdb --export helix.nrrd
holds "without a seam" "$($poses seam helix.nrrd 2.5 0.25) <= 0.01"
quiet "its frames" vam-project helix.exr $image $sixty -o helix/ --report helix.json
is "as many as there are poses" "$(json helix.json frames)" 180
ok "downwards, too" vam-optimize --angles 60 --helix -5.2 --iterations 1 $image tall.vdb -o down.exr
fails 64 'at least half a turn' vam-optimize --helix 9 $image tall.vdb -o none.exr
ok "the doses without --like reach as high as the helix lifts" vam-dose helix.exr $image -o high.vdb

# Records of wobble: the projector's columns see it, or a camera at an azimuth
times='"utc":"2026-01-01T00:00:00.000Z","valid_until":"2126-01-01T00:00:00.000Z"'
record() { printf '{"schema":"vam-calibration/1",'"$times"',"scan":"%s","status":"pass","values":{"wobble_mm":{"value":0.3},"wobble_phase":{"value":%s}}}' "$1" "$2" >"$3"; }
record edges 28.6478898 edges.json
record axis -61.3521102 axis.json
for scan in edges axis; do
  quiet "wobble from a record of $scan" vam-optimize --method fbp --angles 60 --wobble-record $scan.json part.vdb -o $scan.exr
done
is "the poses are those of the table, to 1e-6 mm" "$($exr attr edges.exr vam:poses | cut -c1-9)" "$($exr attr axis.exr vam:poses | cut -c1-9)"
vam-optimize --method fbp --angles 60 --poses wobble.csv part.vdb -o table.exr
for scan in edges axis; do
  is "the same light from the record of $scan and the table" "$(vam-dose $scan.exr --size 5 -o r.vdb --report r.json; json r.json dose_per_turn_max_relative | cut -c1-6)" \
    "$(vam-dose table.exr --size 5 -o r.vdb --report r.json; json r.json dose_per_turn_max_relative | cut -c1-6)"
done
mkdir -p folder && printf '{"schema":"vam-calibration/1",'"$times"',"scan":"edges","status":"pass","values":{"axis_column":{"value":511.5},"radius":{"value":12.5},"wobble_mm":{"value":0.3,"sigma":0.01}}}' >folder/current-edges.json
vam-optimize --method fbp --angles 60 --set calibration.folder=folder part.vdb -o o.exr 2>errors
is "a wobble that is known and left out is a warning" "$? $(grep -c 'warning: the vial wobbles by 0.3 mm .*compensate for it by --wobble-record' errors)" '0 1'
sed 's/2126/2026/' axis.json >old.json
vam-optimize --method fbp --angles 60 --wobble-record old.json part.vdb -o old.exr 2>errors
is "a record past its validity is used with a warning" "$? $(grep -c 'warning: old.json: is .* h old and was valid for' errors)" '0 1'
vam-optimize --method fbp --angles 60 --wobble-record axis.json --set 'calibration.vial=vial 9' part.vdb -o other.exr 2>errors
is "one of another vial, too" "$? $(grep -c "warning: axis.json: belongs to vial '', but calibration.vial is 'vial 9'" errors)" '0 1'
printf '{"schema":"vam-calibration/1",'"$times"',"scan":"edges","status":"pass","values":{}}' >still.json
fails 65 'lacks wobble_mm' vam-optimize --wobble-record still.json part.vdb -o none.exr
wrong() { printf '%s' "$2" >wrong.json; fails 65 "$1" vam-optimize --wobble-record wrong.json part.vdb -o none.exr; }
head='{"schema":"vam-calibration/1",'"$times"',"scan":"axis","status":"pass"' values='"values":{"wobble_mm":{"value":0.3},"wobble_phase":{"value":20}}'
wrong 'changed after it was written' "$head,$values,\"seal\":\"xxh3:00000000000000000000000000000000\"}"
wrong 'the record of a failed scan' "$(echo "$head" | sed s/pass/fail/),$values}"
wrong 'a wobble of -0.3 mm' "$head,\"values\":{\"wobble_mm\":{\"value\":-0.3},\"wobble_phase\":{\"value\":20}}}"
wrong 'lacks wobble_mm' "$head,\"values\":{\"wobble_mm\":{\"value\":\"x\"},\"wobble_phase\":{\"value\":20}}}"
for other in '' '[]' '{"schema":5}' "$head" "$head,\"values\":4}" '{"schema":"vam-calibration/1","scan":3,"values":{}}'; do
  wrong 'is not a vam-calibration/1 record' "$other"
done
fails 65 'is not a vam-calibration/1 record' vam-optimize --wobble-record wobble.csv part.vdb -o none.exr

# Wrong tables and combinations
head -n 60 wobble.csv >short.csv
vam-optimize --method fbp --angles 60 --poses short.csv part.vdb -o short.exr 2>short.err
is "a pose too few is said" "$(cat short.err)" "vam-optimize: warning: short.csv: has 59 poses, 1 fewer than 1 turn of 60 angles (--angles); the stage angles at the end are lit that much less"
fails 66 'missing.csv' vam-optimize --poses missing.csv part.vdb -o none.exr
fails 65 'is at 6 degrees, but frame 1 is at 1' vam-optimize --poses wobble.csv part.vdb -o none.exr
sed 's/vial/lens/' wobble.csv >lens.csv
fails 65 "lens.csv:2: a pose moves 'lens', not vial or part" vam-optimize --angles 60 --poses lens.csv part.vdb -o none.exr
sed 's/,0,vial/,nan,vial/' wobble.csv >nan.csv
fails 65 "nan.csv:2: dz_mm" vam-optimize --angles 60 --poses nan.csv part.vdb -o none.exr
sed 's/,0,vial/,99999,vial/' wobble.csv >far.csv
fails 65 'check the unit' vam-optimize --angles 60 --poses far.csv part.vdb -o none.exr
$poses wobble 60 3 >wide.csv
fails 65 'align the vial' vam-optimize --angles 60 --poses wide.csv part.vdb -o none.exr
head -n 31 wobble.csv >half.csv
fails 65 'one pose per frame' vam-dose plain.exr --poses half.csv --like part.vdb -o none.vdb
fails 64 'in-plane' vam-dose wobble.exr --in-plane --like part.vdb -o none.vdb
fails 64 'do not return' vam-optimize --angles 60 --poses sink.csv --turns 3 --set resin.absorption_per_mm=0.01 \
  --set resin.critical_dose_mj_cm3=100 part.vdb -o none.exr

# A sleeve around a shaft that wobbles with the vial
ok "a shaft" vam-slice --shape cylinder:diameter=6,height=3 --insert-shape cylinder:diameter=2,height=3 --cut-insert 0 \
  --voxel 0.5 -o shaft.vdb
ok "light around it" vam-optimize --angles 60 --poses wobble.csv shaft.vdb -o shaft.exr
vam-dose shaft.exr --like shaft.vdb -o shaft-dose.vdb && vam-score shaft-dose.vdb --target shaft.vdb --report shaft.json >table
is "prints the sleeve" "$(json shaft.json ver)" 0.0
done_testing
