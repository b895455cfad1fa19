#!/bin/sh
# A print that ends before its time, from any side: dark and still, the right status, and a summary of it.
# In memory: a disk that is busy with others would hold up the screen.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
VAM_LOCK_DIR=$PWD/locks; mkdir locks; export VAM_LOCK_DIR
ASAN_OPTIONS=verify_asan_link_order=0; export ASAN_OPTIONS
screen="python3 $VAM_SOURCE/tests/device/screen.py screen/Xvfb_screen0"
shim=$(vam-sim-stage --shim)
tiny_print frames.exr
printf '[stage]\ndevice = "gcs:%s/stage"\nspeed_deg_s = 180\n' "$PWD" >>printer.toml

screen_up 64 48

simulate() {  # simulate OPTIONS...: a stage behind ./stage, its truth in ./truth
  rm -f truth path
  vam-sim-stage --link stage --log truth --die-with-parent --acceleration 9000 --max-speed 360 "$@" >path &
  simulator=$!
  await test -s path
}
finish() { kill $simulator; wait $simulator 2>/dev/null; }
stood() { ! grep -E '"(moving|angle|standing)"' truth | tail -n 1 | grep -Eq 'moving|angle_deg.*speed'; }
lit() { grep -q '"frame":[0-9]' "$1/flips.jsonl" 2>/dev/null; }
begin() {  # begin RUN: a print of 20 turns that is under way
  rm -f leds
  (exec env --default-signal=INT LD_PRELOAD="$shim" vam-print frames.exr --screen sdl:0 --light "sim:?log=$PWD/leds" \
    --uncalibrated --missed 0.9 --run-up 0.05 --turns 20 --run "$1" 2>errors) &
  printing=$!
  await lit "$1"
}
end_by() {  # end_by SIGNAL: of the print
  ended_s=$(perl -MTime::HiRes=clock_gettime,CLOCK_MONOTONIC -e 'printf "%.4f", clock_gettime(CLOCK_MONOTONIC)')
  kill -"$1" $printing
}
in_time() {  # in_time NAME: by the logs of light engine and table, which itself takes 20 ms to brake
  dark=$(tail -n 1 leds | json /dev/stdin t_monotonic_s)
  still=$(grep '"standing"' truth | tail -n 1 | json /dev/stdin t_monotonic_s)
  holds "$1: dark and still within 100 ms" "$dark - $ended_s < 0.1 && $still - $ended_s > 0 && $still - $ended_s < 0.1"
}
child() { pgrep -P $printing -x "$1"; }
aborted() {  # aborted NAME STATUS OUTCOME REGEX: of the run of that name
  wait $printing 2>/dev/null; status=$?
  is "$1: status" $status "$2"
  [ -z "$3" ] || is "$1: the summary" "$(json "$1/summary.json" outcome)" "$3"
  [ -z "$4" ] || { grep -Eq -- "$4" errors; report $? "$1: says '$4'"; }
  [ "$1" = unplugged ] || { await stood; ok "$1: the table stands" stood; }  # a pulled cable leaves it to its last order
  is "$1: black" "$($screen now)" black
  # The simulated light engine is a part of vam-project and dies with it; usb-safety.t kills it beside a real one.
  [ "$1" = projector-killed ] || is "$1: the light is off" "$(tail -n 1 leds | grep -o '"bits":[0-9]*')" '"bits":0'
}

simulate
begin interrupt; end_by INT
aborted interrupt 130 aborted ''; in_time interrupt
begin term; end_by TERM
aborted term 143 aborted ''; in_time term
begin hangup; end_by HUP
aborted hangup 129 aborted ''; in_time hangup
begin killed; tools=$(pgrep -P $printing); end_by KILL
aborted killed 137 '' ''; in_time killed
gone() { for pid in $tools; do ! kill -0 "$pid" 2>/dev/null || return 1; done; }
await gone; ok 'killed: its tools end, too' gone
begin projector-killed; kill -KILL "$(child vam-project)"
aborted projector-killed 137 'project failed' ''
begin stage-killed; kill -KILL "$(child vam-stage)"
aborted stage-killed 137 'stage failed' ''
begin busy
env LD_PRELOAD="$shim" vam-print frames.exr --screen sdl:0 --uncalibrated --run second 2>second-errors
is 'a second print is turned away' "$? $(grep -c 'in use by process' second-errors)" '75 1'
kill -TERM $printing
aborted busy 143 aborted ''
finish

# Each kind of wrong answer of the stage, a second into the light of the print.
spoilt() {  # spoilt NAME STATUS REGEX FAULT
  simulate --fault "$4"
  begin "$1"
  ok "$1: was under way" lit "$1"
  aborted "$1" "$2" 'stage failed' "$3"
  finish
}
spoilt garbage 76 'was answered' garbage@POS?:250
spoilt truncated 75 'no end of the answer' truncated@POS?:250
spoilt late 75 'no answer' late@POS?:250
spoilt wrong-sender 76 'controller 7 instead of 1' wrong-sender@POS?:250
spoilt blocked 76 'was due|is blocked' block@POS?:250
spoilt unplugged 69 'unplugged' unplug@POS?:250
simulate --fault error@VEL
(exec env LD_PRELOAD="$shim" vam-print frames.exr --screen sdl:0 --light "sim:?log=$PWD/leds" --uncalibrated --run refused 2>errors) &
printing=$!
aborted refused 76 'stage failed' 'refused with error 17'
finish
screen_down
done_testing
