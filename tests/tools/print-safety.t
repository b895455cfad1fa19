# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RUN_SERIAL ON COST 150
# trials: 100
# A print of which the script or a tool is killed: dark, the relay open, and still within 100 ms, beside six busy loops within 250 ms
# [devices guarantee 1]. A fifth of VAM_TRIALS a cause (5; 100: "long"), as a print takes seconds to begin.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
tiny_print frames.exr
printf 'relay = "relay:%s/relay"\n' "$PWD" >>printer.toml
printf '[stage]\ndevice = "gcs:%s/stage"\nspeed_deg_s = 180\n' "$PWD" >>printer.toml
screen_up 64 48
python3 "$VAM_SOURCE/tests/device/print_trials.py" $((${VAM_TRIALS:-5} / 5)) >table; status=$?
screen_down
cat table
is 'every trial was dark and still in time' $status 0
is 'every tool was killed, on a machine without and with load' "$(grep -c trials table)" 18
done_testing
