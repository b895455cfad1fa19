#!/bin/sh
# Promise 1 for page flips: black within 100 ms of any end, by the log of a simulated graphics card. VAM_TRIALS a cause
# (10; 100 under the label "long").
# In memory: a disk that is busy with others would hold up the log.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
printf '[projector]\ncolumns = 64\nrows = 48\npixel_mm = 0.26\naxis_column = 31.5\naxis_row = 40\n' >printer.toml
python3 "$VAM_SOURCE/tests/tools/exr.py" make part.exr space=projector width=64 height=36 count=3
ASAN_OPTIONS=verify_asan_link_order=0; export ASAN_OPTIONS
python3 "$VAM_SOURCE/tests/device/drm_trials.py" ends "${VAM_TRIALS:-10}" "$VAM_BUILD/lib/vam-test/drm_card.so" >table
status=$?
cat table
is 'every trial was black in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 9
done_testing
