# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock COST 200
# trials: 100
# The dead-man relay on the lamp [devices §7]: closed during a print only, and no light without it.
. "$VAM_SOURCE/tests/tools/testlib.sh"
shim=$(vam-sim stage --shim)
hold=0.4
grey() { vam-project --pattern grey -o null: --hold $hold --light "sim:?log=$PWD/light" "$@"; }

quiet 'a pattern behind a simulated relay' grey --set 'projector.relay=sim:?log=relay' --log events
is 'closed for the pattern, then opened' "$(grep -oE '"event":"(closed|open)"' relay | tr -d '\n')" '"event":"closed""event":"open"'
ok 'heartbeats are received' test "$(grep -c '"text":"H"' relay)" -ge 5
ok 'log and relay are marked as simulated' grep -q '"event":"relay".*simulated' events

# With a relay in the printer file there is no light without its reply.
printf '[projector]\nrelay = "relay:%s/line"\n' "$PWD" >printer.toml
rm light; hold=5
fails 69 'line' grey
fails 64 'unknown scheme|use one of' grey --set projector.relay=usb:1
fails 64 'unknown option' grey --set 'projector.relay=sim:?colour=1'
: >light
for fault in 'silent@A' 'error@A'; do fails 75 'does not close; the light stays off without it' grey --set "projector.relay=sim:?fault=$fault"; done
stage_up --protocol gcs; fails 75 'no reply from the relay within 3 s' env LD_PRELOAD=$shim vam-project --pattern grey -o null: --set "projector.relay=relay:$PWD/stage"; stage_down
is 'no light in any of these' "$(grep -c '"bits":4' light 2>/dev/null)" 0
fails 76 'relay' grey --set 'projector.relay=sim:?fault=garbage@H:3'
ok 'dark after a malformed reply' sh -c 'tail -n 2 light | grep -Eq "\"bits\":0|asleep"'

python3 "$VAM_SOURCE/tests/device/relay_trials.py" "${VAM_TRIALS:-2}" >table; status=$?
cat table
is 'it opened in time, on command or by itself' $status 0
done_testing
