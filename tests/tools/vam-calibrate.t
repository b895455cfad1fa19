# SPDX-License-Identifier: GPL-3.0-or-later
# The calibration scans on images with known truth: records, current link, refusal.
. "$VAM_SOURCE/tests/tools/testlib.sh"
scans="python3 $VAM_SOURCE/tests/tools/scans.py"
value() { json "$1" "values.$2.value"; }  # value RECORD NAME
sigma() { json "$1" "values.$2.sigma"; }
near() { holds "$1" "($2) - ($3) <= $4 && ($3) - ($2) <= $4"; }  # near NAME GOT WANT WITHIN
kept() { ls cal | grep -c "^cal-lab-1-$1-.*json"; }  # records of a scan

geometry='columns=512 pitch=4 width=2 radius=12.4'
$scans sweep sweep axis=249.3 $geometry
$scans ramp ramp
$scans ramp darkness full=0
$scans flat flat
$scans beam beam
$scans turn turn axis=61.25 wobble=2 phase=40
$scans sweep moved axis=251.3 $geometry

is 'either form of beam is in its help' "$(vam-calibrate beam --help | grep -c 'beam \[OPTIONS\] --side FRAMES$\|beam \[OPTIONS\] --first MM --spacing MM --pixel MM FRAMES$')" 2
fails 65 'ramp/00000.png: has 12 x 8 pixels, the frames have 160 x 32' vam-calibrate beam beam --side --dark ramp/00000.png
fails 65 'at least 32 are required' vam-calibrate beam ramp --side
fails 65 'the camera is at 45 degrees to the beam' vam-calibrate beam beam --side --set camera.azimuth_deg=45
for azimuth in 0 -45 100 180; do
  fails 65 "the camera is at $azimuth degrees to the beam" vam-calibrate edges sweep --pitch 4 --width 2 --set camera.azimuth_deg=$azimuth
done
fails 65 '8 rows; at least 16' vam-calibrate beam ramp --pixel 0.0035 --first 0 --spacing 1.27

# Over-exposed frames are refused by every scan: their curve would be smooth and wrong.
$scans ramp bright full=80000
fails 65 'response: bright/00060.png: 100 % of the pixels are over-exposed .limit 0.01 %.; capture with a shorter' \
  vam-calibrate response bright
for scan in edges flat axis; do
  fails 65 "$scan: bright/.* over-exposed" vam-calibrate $scan bright $([ $scan = axis ] && echo --view-step 10)
done

# Without a folder the record is printed.
echo '{"camera": {"camera": {"serial": "7"}, "fps": 10, "gain": 3, "gamma": 1, "black_level": 2}, "stage": {"serial": "8"}}' >known.json
vam-calibrate beam beam --pixel 0.0035 --first -6.35 --spacing 1.27 --devices known.json >levels.json
is 'a record has the identities and the levels of the camera' "$(json levels.json devices)" \
  "{'camera': {'serial': '7', 'gain': 3, 'gamma': 1, 'black_level': 2}, 'stage': {'serial': '8'}}"
is 'beam: status 0' "$(vam-calibrate beam beam --pixel 0.0035 --first -6.35 --spacing 1.27 >beam.json; echo $?)" 0
near 'beam: the divergence' "$(value beam.json divergence)" 0.6417 "2 * $(sigma beam.json divergence) + 0.002"
near 'beam: a round aperture, whose chords have sqrt 3 of its half angle' "$(value beam.json half_angle)" 0.3705 "2 * $(sigma beam.json half_angle) + 0.0012"
is 'beam: eleven planes' "$(python3 -c 'import json; print(len(json.load(open("beam.json"))["planes"]))')" 11
# Black that is the camera's own dark: the contrast is a limit, in words.
vam-calibrate response ramp >contrast.json
vam-calibrate response ramp --dark darkness/00000.png >limit.json
near 'response: the contrast of a black that is seen' "$(value contrast.json contrast)" 101 3
is 'response: of one that is not, a lower limit' "$(json limit.json values.contrast.method) $(sigma limit.json contrast)" \
  'lower limit: black is not distinguished from no light 0.0'
holds 'response: no higher than a camera resolves' "$(value limit.json contrast) > 100 && $(value limit.json contrast) <= 4096"

cat >printer.toml <<'TOML'
[projector]
columns = 512
[calibration]
folder = "cal"
instrument = "lab 1"
vial = "A7"
valid_hours = 12
TOML
vam-calibrate edges sweep --pitch 4 --width 2 2>errors
is 'edges of one stage angle, with a warning' "$? $(grep -c 'swept at one stage angle: .* recorded as the rotation axis' errors)" '0 1'
near 'edges: the middle' "$(value cal/current-edges.json axis_column)" 249.3 0.1
near 'edges: the radius' "$(value cal/current-edges.json radius)" 12.4 0.0062
mkdir far; $exr make stated.exr space=projector width=512 height=8 count=2 'printer=projector.columns=512 projector.rows=8'
fails 65 'projector.axis_column 255.5, now 249' env -u VAM_PRINTER sh -c 'cd far && vam-project ../stated.exr -o x/ --set calibration.folder=../cal --set calibration.instrument="lab 1" --set calibration.vial=A7'
is 'edges: the fields of a value' "$(json cal/current-edges.json values.axis_column.unit) $(json cal/current-edges.json values.radius.unit)" 'px mm'
is 'edges: the frames are named by their hash' "$(json cal/current-edges.json sha256.sweep)" "$(cd sweep && sha256sum * | sha256sum | cut -d' ' -f1)"
quiet 'response' vam-calibrate response ramp
is 'response: the exposure is recorded' "$(json cal/current-response.json settings.exposure_us)" 20000.0
near 'response: half grey' "$(awk -F, '$1 == 128 { print $2 }' cal/cal-lab-1-response-*.csv)" 0.229 0.003
quiet 'flat' vam-calibrate flat flat
near 'flat: unevenness' "$(json cal/current-flat.json flat.unevenness)" 0.09 0.02
quiet 'axis' vam-calibrate axis turn --view-step 10
near 'axis: the column' "$(value cal/current-axis.json axis_column)" 61.25 0.02
near 'axis: the wobble' "$(value cal/current-axis.json wobble)" 2 0.02
near 'axis: its phase' "$(value cal/current-axis.json wobble_phase)" 40 1
vam-capture --device 'sim:?pace=virtual&speed=90&lit=0.01&part=cylinder:x=2,diameter=1.5,height=6' --binning 4 \
  --speed 90 --view-step 9 --exposure 7000 -o simulated/ && vam-calibrate axis simulated --heights 3 --set calibration.folder= >simulated.json
is 'a record of simulated frames is marked, with their own exposure, one of others is not' \
  "$(json simulated.json simulated) $(json simulated.json settings.exposure_us) $(grep -c simulated cal/current-axis.json)" 'true 7000.0 0'
is 'records are read-only' "$(find cal -name 'cal-*.json' -perm 0444 | wc -l)" 4

# The tools use the records.
vam-project --print-printer -o in-force.toml
is 'axis_column is that of the record' "$(sed -n 's/^axis_column = \([0-9.]*\).*/\1/p' in-force.toml | head -n 1)" "$(value cal/current-edges.json axis_column)"
ok 'the response, too' grep -q '^response = "cal/cal-lab-1-response-.*csv"' in-force.toml
ok 'and the flat field' grep -q '^flat = "cal/cal-lab-1-flat-.*exr"' in-force.toml
ok 'which can be read' exrheader cal/cal-lab-1-flat-*.exr
cp -rL cal copied
ok 'a folder copied with its links followed' vam-calibrate check --set calibration.folder=copied
ok 'check' vam-calibrate check --need 'edges, response'
vam-calibrate check >state
is 'the records in force' "$(json state edges.usable) $(json state edges.sha256)" "true $(sha256sum <cal/current-edges.json | cut -d' ' -f1)"

# A value that no tool takes over makes a record unusable for all.
edited() {  # edited KEY VALUE: a copy of the records, without seals, in ./edited
  rm -rf edited; cp -rL cal edited; chmod -R u+w edited
  python3 -c 'import json, sys
path = "edited/current-edges.json"
record = json.load(open(path)); del record["seal"]
record["values"][sys.argv[1]]["value"] = json.loads(sys.argv[2])
json.dump(record, open(path, "w"))' "$@"
}
for wrong in '1e9:projector.axis_column' 'null:incomplete record of edges' '"512":incomplete record of edges'; do
  edited axis_column "${wrong%%:*}"
  fails 65 "edited/current-edges.json: ${wrong#*:}" vam-calibrate check --set calibration.folder=edited
done

# Expired, foreign and missing records.
fails 64 'expected one of edges' vam-calibrate check --need edge
fails 65 "belongs to instrument 'lab 1', but calibration.instrument is 'lab 2'" vam-project --print-printer --set calibration.instrument='lab 2'
fails 65 "belongs to vial 'A7', but calibration.vial is 'B1'" vam-project --print-printer --set calibration.vial=B1
ok 'without records a tool continues' vam-project --print-printer --set calibration.folder= -o plain.toml
vam-calibrate axis turn --view-step 10 --set calibration.valid_hours=1e-7
fails 65 'current-axis.json: is .* h old and was valid for' vam-project --print-printer
quiet 'an expired record does not prevent a new one' vam-calibrate axis turn --view-step 10
ok 'which is in force' vam-project --print-printer -o healed.toml

# A vial that moved is reported and not put in force, except with --accept.
before=$(readlink cal/current-edges.json)
vam-calibrate edges moved --pitch 4 --width 2 2>errors
is 'a vial that moved by 2 px is status 1' $? 1
ok 'which reports the distance' grep -q 'moved by 2\.* px\|moved by [12]\.[0-9]* px' errors
is 'the record in force stays' "$(readlink cal/current-edges.json)" "$before"
is 'the new one is kept, too' "$(kept edges)" 2
vam-calibrate edges moved --pitch 4 --width 2 --accept 2>errors
is 'accepted' "$? $(grep -c 'warning.*moved' errors)" '0 1'
near 'it is in force' "$(value cal/current-edges.json axis_column)" 251.3 0.1

# A record that is gone, whose link dangles, is an error, but for the scan that makes it anew.
rm -f "cal/$(readlink cal/current-axis.json)" "cal/$(readlink cal/current-edges.json)"
fails 66 'current-axis.json: links to a record that is gone; restore it, or run vam-calibrate axis' vam-calibrate edges moved --pitch 4 --width 2
quiet 'the axis is measured anew' vam-calibrate axis turn --view-step 10
vam-calibrate edges moved --pitch 4 --width 2 2>errors
is 'and the edges, with a warning' "$? $(grep -c 'warning.*not compared with the previous record: .*current-edges.json: links to a record that is gone' errors)" '0 1'
ok 'both are in force' vam-project --print-printer -o healed.toml

# What the printer cannot have is kept, but not put in force.
vam-calibrate beam beam --pixel 0.07 --first -6.35 --spacing 1.27 2>errors
is 'light too wide for a printer is status 1' "$? $(grep -c 'beam: projector.half_angle_deg: .*; not put in force' errors)" '1 1'
is 'its record is kept' "$(kept beam) $(json cal/cal-lab-1-beam-*.json status)" '1 fail'
ok 'and the tools continue' vam-project --print-printer -o healed.toml
echo malformed >cal/current-beam.json
fails 65 'is not a vam-calibration/1 record' vam-project --print-printer
fails 73 'cannot make the folder' vam-calibrate axis turn --view-step 10 --set calibration.folder=printer.toml/cal
fails 66 'nowhere: no such folder of calibration records' vam-calibrate check --set calibration.folder=nowhere
done_testing
