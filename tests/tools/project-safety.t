# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RUN_SERIAL ON COST 150
# trials: 100
# vam-project alone [devices guarantee 1]: a black screen within 100 ms of any end. VAM_TRIALS a cause (2; 100: "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
tiny_print part.exr
python3 "$VAM_SOURCE/tests/device/project_trials.py" "${VAM_TRIALS:-2}" >table; status=$?
cat table
is 'every trial was black in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 9
done_testing
