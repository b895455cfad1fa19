#!/bin/sh
# USB devices through the real libusb: the Tic stage and the DLPC350 light engine, and promise 1 for both: dark, or
# told to stand, within 100 ms of any end of the tool. VAM_TRIALS a cause (10; 100 under the label "long").
# In memory: a disk that is busy with others would hold up the screen that the trials read.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
tiny_print part.exr
on() { umockdev-wrapper "$VAM_BUILD/usb_host" "$@"; }  # on DEVICE LOG PROGRAM...

on tic log vam-stage identify --device 'tic:?steps_per_deg=100' >about
is 'a Tic is found' "$(json about model) $(json about serial)" 'Tic T825 00312345'
ok 'and turns' on tic moved vam-stage move --device 'tic:00312345?steps_per_deg=100' --home --to 20 --speed 90
holds 'to where it was sent' "$(tail -n 1 moved | json /dev/stdin angle_deg) == 20"
fails 69 'no such device' on tic log vam-stage identify --device 'tic:999?steps_per_deg=100'
fails 69 'no such device' on tic log vam-project part.exr -o null: --light dlpc350:

ok 'a light engine shines for a print' on dlpc350 leds vam-project part.exr -o null: --light dlpc350: --speed 360 --missed 1
is 'off, on, off' "$(grep -o '"bits":[0-9]*' leds | tr '\n' ' ')" '"bits":0 "bits":4 "bits":0 '

trials() { python3 "$VAM_SOURCE/tests/device/usb_trials.py" "$1" "${VAM_TRIALS:-10}" >"$1.table"; }
trials dlpc350 & light=$!
trials tic; stage=$?
wait $light; light=$?
cat dlpc350.table tic.table
is 'every trial was dark in time' $light 0
is 'every trial was told to stand in time' $stage 0
is 'every cause was tried' "$(cat dlpc350.table tic.table | grep -c trials)" 14
done_testing
