#!/bin/sh
# vam-stage alone [devices guarantee 1]: stopped within 100 ms of any end. VAM_TRIALS a cause (10; 100: label "long").
# In memory: a disk that is busy with others would hold up the screen that the trials read.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
python3 "$VAM_SOURCE/tests/device/stage_trials.py" "${VAM_TRIALS:-10}" >table; status=$?
cat table
is 'every trial stopped in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 9
done_testing
