# SPDX-License-Identifier: GPL-3.0-or-later
# A print of 20 turns on simulated stage, screen and light engine, to be ended before its time. A test sources this after
# testlib.sh; screen_up 64 48 comes before launch.
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
screen="python3 $VAM_SOURCE/tests/device/screen.py screen/Xvfb_screen0"
shim=$(vam-sim stage --shim)
tiny_print frames.exr
printf '[stage]\ndevice = "gcs:%s/stage"\nspeed_deg_s = 180\n' "$PWD" >>printer.toml

launch() {  # launch RUN OPTIONS...: that print, on a stage with these options
  run=$1; shift
  stage_up --acceleration 9000 --max-speed 360 --start-angle 1 "$@"
  rm -rf leds "$run"
  (exec env --default-signal=INT LD_PRELOAD="$shim" vam-print frames.exr --display sdl:0 --light "sim:?log=$PWD/leds" \
    --uncalibrated --home --max-missed 0.9 --run-up 0.05 --turns 20 --run "$run" 2>errors) &
  printing=$!
}
lit() { grep -q '"frame":[0-9]' "$run/flips.jsonl" 2>/dev/null; }
over() { ! readlink /proc/$printing/exe >/dev/null; }
lit_or_over() { lit || over; }
begin() {  # begin RUN OPTIONS...: the same, under way. Its end is judged: a start that a busy machine spoils is repeated
  for attempt in 1 2 3; do
    launch "$@"
    await lit_or_over
    if lit; then return; fi
    wait $printing
    sed 's/^/# did not get going: /' errors
    stage_down
  done
}
aborted() {  # aborted STATUS OUTCOME REGEX: that print
  wait $printing 2>/dev/null; status=$?
  is "$run: status" $status "$1"
  [ $status -eq "$1" ] || sed 's/^/# /' errors
  [ -z "$2" ] || is "$run: the summary" "$(json "$run/summary.json" outcome)" "$2"
  [ -z "$3" ] || { grep -Eq -- "$3" errors; report $? "$run: reports '$3'"; }
  [ $run = unplugged ] || { await stood; ok "$run: the stage stands" stood; }  # a pulled cable leaves it to its last order
  is "$run: black" "$($screen now)" black
  # The simulated light engine is a part of vam-project and dies with it; usb-safety.t kills it beside a real one.
  [ $run = projector-killed ] || is "$run: the light is off" "$(grep -o '"bits":[0-9]*' leds | tail -n 1)" '"bits":0'
  stage_down
}
