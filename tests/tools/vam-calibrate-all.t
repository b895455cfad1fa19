# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS long RESOURCE_LOCK camera COST 110
# Calibration on misaligned simulators: stage, screen and a GigE Vision camera beside a glowing vial,
# all taken live; the records are held against what the simulators were set to.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
mkdir keep
judge="python3 $VAM_SOURCE/tests/tools/scan_judge.py"
camera_bench "sim:?acceleration=1000&max_speed=180&log=$PWD/truth" 85
value() { json "cal/current-$1.json" "values.$2.value"; }
sigma() { json "cal/current-$1.json" "values.$2.sigma"; }
within() { near "$1 is within its stated sigma" "$2" "$3" "4 * $4"; }  # within NAME GOT WANT SIGMA: one of 16 000 is not
near() { holds "$1 ($2)" "($2) - ($3) <= $4 && ($3) - ($2) <= $4"; }  # near NAME GOT WANT WITHIN

fails 73 '/nowhere/log: cannot be written' vam-calibrate all --display null: --log /nowhere/log
fails 64 '.--scans: empty' vam-calibrate all --display null: --scans ' '

# A bench out of adjustment, its camera's stamps 40 ms late, its projector's light 30 ms. The projector's log tells the
# camera's simulator which pattern is on.
screen_up 208 96
bench() {  # bench OPTIONS...
  camera_up --follow truth --flips keep/flips --columns 200 --rows 60 --noise 0.002 --glow "${glow:-5}" --projector-gamma 1.8 \
    --lag 40 --latency 30 --maker basler --axis-offset 2.5 --tilt 0.4 --centre 3.2 --set calibration.folder= "$@"
}
calibrate() { vam-calibrate all --display sdl:0 --light sim: --set stage.speed_deg_s=120 --keep keep --log events --home --pitch 4 \
    --sweep-exposure 19000 --scans "$@"; }

bench --part 'cylinder:x=2,diameter=8,height=20' --lit 0 --beam 0.5 --focus 1.5 --divergence 1.5
quiet 'six scans in one run' calibrate 'edges axis beam latency lag response'
# A signal ends what moves and what is lit at once: a stage that turns for a minute, or a capture beside a lit projector.
aborted() {  # aborted SCAN CONDITION SIGNAL STATUS: it goes to this process alone, once the condition holds
  (exec env --default-signal=INT vam-calibrate all --display sdl:0 --light sim: --keep keep --log aborted --scans "$1" --set resin.name=test$$ 2>aborted.err) & scans=$!
  await "$2"
  kill -TSTP $scans
  sent=$(date +%s%N); kill -"$3" $scans; wait $scans
  is "$3 in $1: status" $? "$4"
  [ "$3" != KILL ] || sleep 1  # they end by themselves
  holds "$3 in $1: within 2 s" "$(date +%s%N) - $sent < 2000000000"
  is "$3 in $1: no tool is left" "$(pgrep -f "vam-(capture|project|stage) .* resin.name=test$$ .*calibration.folder=" | wc -l)" 0
}
turning() { [ -s keep/angles.jsonl ]; }
rm -f keep/angles.jsonl
aborted lag turning TERM 143
capturing() { pgrep -f 'vam-capture .* keep/latency.exr' >looked && grep -q '"frame":1' keep/flips; }
for signal in TERM:143 INT:130 HUP:129 KILL:137; do
  aborted latency capturing ${signal%:*} ${signal#*:}
  is "$signal in latency: the last image is the dark one" "$(grep '"event":"flip"' keep/flips | tail -n 1 | grep -c '"frame":-1')" 1
done
camera_down
is 'every event in both times' "$(grep -Evc '^\{"utc":"[^"]*Z","t_monotonic_s":[0-9.]+,"event"' events)" 0
is 'in the order of dependence' "$(grep -o '"event":"end","scan":"[a-z]*"' events | cut -d'"' -f8 | tr '\n' ' ')" 'lag latency response axis beam edges '
# 0.5 ms is 0.01 degrees at the speed of a print; each delay has its own record.
near 'lag: that of the camera' "$(value lag camera_lag)" 40 0.5
near 'latency: that of the projector alone' "$(value latency latency)" 30 0.5
is 'lag: relative to the moment that stamps name' "$(json cal/current-lag.json devices.camera.stamp)" start
holds 'lag: in force in the printer file' "$(vam-project --print-printer | sed -n 's/^lag_ms = \([0-9.]*\).*/\1/p' | tail -n 1) == $(value lag camera_lag)"
near 'response: the gamma of the projector' "$(awk -F, '$1 == 128 { print $2 }' cal/cal-simulated-response-*.csv)" 0.289 0.01
near 'axis: the column' "$(value axis axis_column)" 102 0.05
near 'axis: the tilt' "$(value axis tilt)" 0.4 0.1
within 'axis: the tilt' "$(value axis tilt)" 0.4 "$(sigma axis tilt)"
holds 'axis: standard deviation' "$(sigma axis tilt) < 0.06"
# A lit row is 0.1 mm high, as wide as a Gaussian of 0.068 mm: hypot(0.5, 0.068). 2 %: it is no Gaussian, and the planes
# are 1.6 mm thick. The rest is the noise that the record tells.
near 'beam: the waist' "$(value beam waist)" 0.5046 0.01
near 'beam: the position of the waist' "$(value beam focus)" 1.5 "0.05 + 3 * $(sigma beam focus)"
near 'beam: the divergence' "$(value beam divergence)" 1.5 "0.03 + 3 * $(sigma beam divergence)"
# Air has a flat wall's light: 1.5 * 1.53 / sqrt 3, and the focus so far before the wall, over 1.53.
near 'beam: its half angle in air' "$(value beam half_angle)" 1.325 "0.027 + 3 * $(sigma beam half_angle)"
near 'beam: in force' "$(vam-dose --print-printer | sed -n 's/^focus_mm = \([-0-9.]*\).*/\1/p')" "$(value beam focus_in_air)" 1e-6
holds 'beam: standard deviation' "$(sigma beam divergence) < 0.1 && $(sigma beam focus) < 0.2"
# The figures of the proof: 0.1 px, 0.05 %.
near 'edges: the middle' "$(value edges axis_column)" 106.7 0.1
near 'edges: the radius' "$(value edges radius)" 9 0.0045
within 'edges: the middle' "$(value edges axis_column)" 106.7 "$(sigma edges axis_column)"
within 'edges: the radius' "$(value edges radius)" 9 "$(sigma edges radius)"

# A vial with wobble: its centre is up to 3 px beside the axis.
bench --wobble 0.3 --wobble-phase 50 --beam 0.5 --part 'cylinder:x=2,diameter=8,height=20' --lit 0  # nothing may grow in a sweep
quiet 'edges of a vial that wobbles' calibrate edges
near 'edges: the axis, not the middle of the vial' "$(value edges axis_column)" 106.7 0.1
near 'edges: the wobble' "$(value edges wobble)" 3 0.1
near 'edges: in millimetres' "$(value edges wobble_mm)" 0.3 0.01
near 'edges: its phase' "$(value edges wobble_phase)" 50 2
within 'edges: its phase' "$(value edges wobble_phase)" 50 "$(sigma edges wobble_phase)"
is 'edges: from four stage angles' "$(json cal/current-edges.json settings.stage_angles_deg)" '[0.0, 90.0, 180.0, 270.0]'
camera_down

# Eight times the intensity, which saturates the camera in 2.5 ms: the scan shortens its exposure.
glow=40; bench; glow=5
quiet 'a scan that is over-exposed at first' calibrate response
near 'response: the gamma all the same' "$(awk -F, '$1 == 128 { print $2 }' "$(ls -t cal/cal-simulated-response-*.csv | head -n 1)")" 0.289 0.01
is 'response: by a shorter exposure' "$(json cal/current-response.json settings.exposure_us) $(grep -c '"event":"over-exposed.*"scan":"response"' events)" '400.0 2'
camera_down

bench --card --vignetting 0.3
quiet 'the flat field, of a card' calibrate flat
# Nine of ten pixels within two sigma: 40 frames of noise, and the 8-bit grey levels of all of them.
$judge cal/cal-simulated-flat-*.exr 0.3 "$(json cal/current-flat.json flat.pixel_sigma)" >judged
is 'flat: the shape of the light' "$(cut -d' ' -f1 judged)" good
sed 's/^/# flat: /' judged
ok 'all are in force' vam-calibrate check --need latency --need response --need axis --need beam --need edges --need flat

# A print uses the records and freezes them; its sinogram was computed with them.
vam-slice --print-printer -o now.toml
column=$(awk '/^\[/ { here = $0 == "[projector]" } here && $1 == "axis_column" { print $3 }' now.toml)
near 'the axis in force is that of the bench' "$column" 106.7 0.1
$exr make part.exr space=projector width=208 height=36 count=3 pixel=0.1 row=0.1 \
  "printer=projector.columns=208 projector.pixel_mm=0.1 projector.axis_column=$column projector.telecentric=true vial.radius_mm=9 bath.index=1.53 bath.window_mm=12 $(awk '$1 == "half_angle_deg" || $1 == "focus_mm" { print "projector." $1 "=" $3 }' now.toml | tr '\n' ' ')"
quiet 'a dry run with the records' vam-print part.exr --display null: --need 'latency response axis' --run-up 0.1 --max-missed 0.9 \
  --view-step 90 --run run
camera_down
is 'whose summary names them' "$(json run/summary.json calibration.response.sha256)" "$(sha256sum <cal/current-response.json | cut -d' ' -f1)"
is 'and the camera' "$(json run/devices.json camera.camera.serial)" VAM1
is 'both are marked as simulated, and so are the records' \
  "$(json run/devices.json camera.camera.simulated) $(json run/devices.json stage.simulated) $(json cal/current-edges.json simulated)" 'true true true'
is 'and the stage' "$(json run/devices.json stage.serial)" "$(json cal/current-axis.json devices.stage.serial)"

# Records of other devices are refused.
bench --serial another
vam-print part.exr --display null: --need 'latency response axis' --view-step 90 --run foreign 2>foreign.err
is 'a foreign camera is refused' "$? $(grep -c 'was measured with the camera VAM1, but the one in use is another; run vam-calibrate' foreign.err)" '65 1'
is 'before any motion, and no folder is left' "$(ls -d foreign 2>/dev/null)" ''
vam-print part.exr --display null: --need 'latency response axis' --view-step 90 --plan >plan.txt 2>foreign.err
is 'the plan says so, too' "$? $(grep -c 'but the one in use is another' foreign.err) $(grep -c '^devices  *failed' plan.txt)" '65 1 1'
camera_down
echo '{"stage": {"serial": "another"}}' >other.json
fails 65 'was measured with the stage .*, but the one in use is another; run vam-calibrate' vam-calibrate check --devices other.json
fails 65 "belongs to instrument 'simulated', but calibration.instrument is 'other'" vam-calibrate check --set calibration.instrument=other
screen_down
done_testing
