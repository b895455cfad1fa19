# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RUN_SERIAL ON COST 150
# trials: 100
# USB devices through libusb [devices guarantee 1]: the DLPC350 and DLPC900 light engines, by turns, are dark, and the
# Tic stage receives the stop command, within 100 ms of any end of the tool. VAM_TRIALS a cause (2; 100 under the label "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
tiny_print part.exr

python3 "$VAM_SOURCE/tests/device/usb_trials.py" "${VAM_TRIALS:-2}" >table; status=$?
cat table
is 'every trial was dark, or received the stop command, in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 14
done_testing
