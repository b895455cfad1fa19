# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RUN_SERIAL ON COST 150
# trials: 100
# vam-stage alone, by every serial protocol [devices guarantee 1]: stopped within 100 ms of any end. VAM_TRIALS a cause (2; 100: label "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
for protocol in gcs grbl zaber; do
  python3 "$VAM_SOURCE/tests/device/stage_trials.py" "${VAM_TRIALS:-2}" $protocol >table; status=$?
  sed "s/^/$protocol: /" table
  is "$protocol: every trial stopped in time" $status 0
  is "$protocol: every cause was tried" "$(grep -c trials table)" 9
done
done_testing
