# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS long RESOURCE_LOCK camera COST 110
# A print with the records of its own instrument, judged by the simulators' logs: the stage's speed ripples by 3 % each 30
# degrees and its replies are up to 20 ms late, the camera's time stamps are 40 ms late, the light comes 30 ms after its
# flip. All delays must be measured, and every frame shown at its angle [devices guarantee 3].
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
shim=$(vam-sim stage --shim)
mkdir keep
camera_bench "gcs:$PWD/stage" 25
lag=40 latency=30

screen_up 208 96
stage_up --acceleration 1000 --max-speed 360 --ripple 0.03 --jitter 20
camera_up --follow truth --flips keep/flips --columns 200 --rows 60 --noise 0.002 --glow 5 --lag $lag --latency $latency \
  --maker basler --part 'cylinder:x=2,diameter=8,height=20' --lit 0 --set calibration.folder=
LD_PRELOAD=$shim vam-calibrate all --display sdl:0 --light sim: --keep keep --home --scans lag,latency 2>errors
is 'the scans have status 0, silently' "$? $(cat errors)" '0 '
camera_down
near() {  # near SCAN NAME TRUTH: within the bar of both delays, 0.5 ms
  is=$(json "cal/current-$1.json" "values.$2.value")
  holds "$1: $is ms, within 0.5 ms of $3" "$is - $3 <= 0.5 && $3 - $is <= 0.5"
}
near lag camera_lag $lag
near latency latency $latency

$exr make part.exr space=projector width=208 height=36 count=3 pixel=0.1 row=0.1 \
  "printer=projector.columns=208 projector.pixel_mm=0.1 projector.axis_column=103.5 projector.telecentric=true vial.radius_mm=9 bath.index=1.53 bath.window_mm=12"
LD_PRELOAD=$shim vam-print part.exr --display sdl:0 --light sim: --need 'lag latency' --run-up 1 --frames-per-turn 3600 \
  --max-missed 0.2 --max-missed-lit 0.2 --run run 2>errors
is 'the print has status 0, silently' "$? $(cat errors)" '0 '
stage_down
screen_down
python3 "$VAM_SOURCE/tests/device/print_judge.py" truth run/flips.jsonl $latency >judged
sed 's/^/# /' judged
holds 'nearly every flip of a turn' "$(json judged flips) > 600"
bias=$(json judged bias_deg)
# Half of a frame's step is 0.05 degrees of the 0.1.
holds 'shown-frame angle error, 99th percentile' "$(json judged p99_deg) <= 0.1"
holds 'shown-frame angle error, mean' "$bias <= 0.02 && $bias >= -0.02"
done_testing
