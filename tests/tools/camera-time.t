# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RESOURCE_LOCK camera COST 250
# Cameras as their makers document them: as delivered, seen by a client that shares nothing with ours; and the times of
# their frames, by vam-capture, whether they stamp the start, the middle or the end of a long exposure.
. "$VAM_SOURCE/tests/tools/testlib.sh"

camera_up --maker flir
python3 "$VAM_SOURCE/tests/device/gvcp.py" 127.0.0.1 >plain
quiet 'an exposure in parts of a microsecond, which it rounds' \
  vam-capture --device aravis:127.0.0.1 --fps 20 --exposure 25.6 --frames 1 --timeout 20 -o short/
is 'is recorded as it is' "$(sed -n 's/.*"exposure_us":\([0-9.]*\).*/\1/p' short/manifest.jsonl | head -n 1)" 25.0
camera_down
is 'its maker, and that it is simulated' "$(json plain maker), $(json plain model)" 'Point Grey Research, Grasshopper3 (simulated)'
is 'gain is automatic at power-on' "$(json plain gain_auto)" true
is 'a latched time stays until the next, and the clock runs' "$(json plain latched_until_next) $(json plain clock)" 'true true'
holds 'it runs from power-on' "$(json plain since_power_on_s) < 1000"

late() {  # late LAG SIMULATOR-OPTIONS... [-- CAPTURE-OPTIONS]: $stamp, and by how much the times are late beyond the lag
  lag=$1; shift
  options=
  while [ $# -gt 0 ] && [ "$1" != -- ]; do options="$options $1"; shift; done
  [ $# -eq 0 ] || shift
  rm -rf views log
  camera_up $options --lag "$lag" --speed 30 --columns 64 --rows 48 --log log
  # A busy machine may lose some, and take its time.
  vam-capture --device aravis:127.0.0.1 --fps 50 --exposure 15000 --frames 30 --timeout 20 "$@" -o views/ 2>errors
  camera_down
  stamp=$(head -n 1 views/manifest.jsonl | sed 's/.*"stamp":"\([a-z]*\)".*/\1/')
  python3 - "$lag" >late <<'PY'
import json, sys
true = {e["number"]: e["t_monotonic_s"] for e in map(json.loads, open("log")) if e["event"] == "frame"}
seen = [e for e in map(json.loads, open("views/manifest.jsonl")) if e.get("complete")]
assert len(seen) >= 10
late = sorted(1e3 * (e["t_monotonic_s"] - true[e["number"]]) - float(sys.argv[1]) for e in seen)
print(late[0], late[-1])
PY
  read -r least most <late || sed 's/^/# /' errors
}
on_time() {  # on_time NAME: a thirtieth of the exposure, as readings of the camera's clock take 0.2 ms
  holds "$1: the middle of every exposure within 0.5 ms ($least to $most)" "$least > -0.5 && $most < 0.5"
}

late 0 --maker basler
is 'by the maker' $stamp start
on_time 'stamped at the start'
late 40 --maker flir
is 'by another maker' $stamp end
on_time 'stamped at the end, 40 ms late'
late 60 --stamp middle -- --set camera.stamp=middle
is 'by the printer file' $stamp middle
on_time 'stamped in the middle, 60 ms late'
# A clock that cannot be read: the end of the exposure and the way are known, here 4 ms and what the machine adds; a
# start that is taken for an end would be 15 ms early.
late 0 --maker basler --no-latch
is 'without a latch' $stamp arrival
holds "without a latch: late by the way ($least to $most)" "$least > 3 && $least < 10"
done_testing
