# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RUN_SERIAL ON COST 150
# trials: 100
# Page flips [devices guarantee 1]: black within 100 ms of any end, by the log of a simulated graphics card. VAM_TRIALS a
# cause (2; 100 under the label "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
tiny_print part.exr
python3 "$VAM_SOURCE/tests/device/drm_trials.py" ends "${VAM_TRIALS:-2}" "$VAM_BUILD/lib/vam-test/drm_card.so" >table
status=$?
cat table
is 'every trial was black in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 9
done_testing
