#!/bin/sh
# USB devices through the real libusb: the Tic stage and the DLPC350 light engine, and their safe state after kill -9.
# VAM_TRIALS kills each (10; 100 under the label "long").
# In memory: a disk that is busy with others would hold up the screen that the trials read.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
VAM_LOCK_DIR=$PWD/locks; mkdir locks; export VAM_LOCK_DIR
printf '[projector]\ncolumns = 64\nrows = 48\npixel_mm = 0.26\naxis_column = 31.5\naxis_row = 40\n' >printer.toml
python3 "$VAM_SOURCE/tests/tools/exr.py" make part.exr space=projector width=64 height=36 count=3
on() { umockdev-wrapper "$VAM_BUILD/usb_host" "$@"; }  # on DEVICE LOG PROGRAM...

on tic log vam-stage identify --device 'tic:?steps_per_deg=100' >about
is 'a Tic is found' "$(json about model) $(json about serial)" 'Tic T825 00312345'
ok 'and turns' on tic moved vam-stage move --device 'tic:00312345?steps_per_deg=100' --home --to 20 --speed 90
holds 'to where it was sent' "$(tail -n 1 moved | json /dev/stdin angle_deg) == 20"
fails 69 'no such device' on tic log vam-stage identify --device 'tic:999?steps_per_deg=100'
fails 69 'no such device' on tic log vam-project part.exr -o null: --light dlpc350:

ok 'a light engine shines for a print' on dlpc350 leds vam-project part.exr -o null: --light dlpc350: --speed 360 --missed 1
is 'off, on, off' "$(grep -o '"bits":[0-9]*' leds | tr '\n' ' ')" '"bits":0 "bits":4 "bits":0 '

cat >killed.sh <<'EOF'
# killed.sh LOG PATTERN PROGRAM...: kills it with SIGKILL once the pattern is in the log; prints when, on CLOCK_MONOTONIC
log=$1; pattern=$2; shift 2
"$@" >/dev/null 2>&1 &
tool=$!
tries=0; until grep -q "$pattern" "$log" 2>/dev/null || [ $tries -ge 500 ]; do tries=$((tries + 1)); sleep 0.01; done
sleep 0.05
LD_PRELOAD= python3 -c 'import os, signal, sys, time
start = time.monotonic(); os.kill(int(sys.argv[1]), signal.SIGKILL); print(start)' $tool
wait $tool
EOF

late=0; worst=0
for trial in $(seq "${VAM_TRIALS:-10}"); do
  rm -f leds moved
  start=$(on dlpc350 leds sh killed.sh leds '"bits":4' vam-project part.exr -o null: --light dlpc350: --speed 1 --missed 1 2>/dev/null)
  dark=$(tail -n 1 leds | python3 -c 'import json,sys; e=json.loads(sys.stdin.read()); print(e["t_monotonic_s"] if e["bits"]==0 else 1e9)')
  start2=$(on tic moved sh killed.sh moved moving vam-stage spin --device 'tic:?steps_per_deg=100' --speed 60 2>/dev/null)
  still=$(grep '"halt"' moved | tail -n 1 | python3 -c 'import json,sys; print(json.loads(sys.stdin.read() or "{\"t_monotonic_s\":1e9}")["t_monotonic_s"])')
  took=$(awk "BEGIN { a = $dark - $start; b = $still - $start2; print (a > b ? a : b) }")
  worst=$(awk "BEGIN { print ($took > $worst ? $took : $worst) }")
  awk "BEGIN { exit !($took <= 0.1) }" || late=$((late + 1))
done
echo "# worst of ${VAM_TRIALS:-10} kills each: $worst s"
is 'dark, and the order to stand given, within 100 ms of every kill' $late 0
done_testing
