# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK camera COST 110
# vam-sim camera and vam-capture's aravis: camera, over GigE Vision on loopback; its log is the reference.
. "$VAM_SOURCE/tests/tools/testlib.sh"
take="vam-capture --device aravis:127.0.0.1 --binning 6 --fps 20"

fails 64 'not an IPv4 address' vam-sim camera --address here
fails 64 'cannot serve a camera' vam-sim camera --address 192.0.2.1
fails 64 'not a frame number' vam-sim camera --drop x
fails 64 'expected a form like sphere' vam-sim camera --part cube
fails 66 'missing' vam-sim camera --projected missing
fails 73 'cannot be written' vam-sim camera --log missing/log

camera_up --drop 5 --incomplete 8,11 --speed 45 --lit 0.5 --shrink 60 --log truth
vam-capture identify --device aravis:127.0.0.1 >who
is 'the identity' "$? $(json who camera.serial) $(json who camera.transport)" '0 VAM1 GigE Vision'
fails 75 'UDP port 3956 is in use' vam-sim camera
fails 64 'no trigger Line9; the camera has Line0, Software' $take --trigger Line9 --frames 1 -o no.exr
fails 64 'no pixel format Mono12' $take --format Mono12 --frames 1 -o no.exr
$take --frames 40 -o views/ --log log 2>said & tool=$!
await test -s views/manifest.jsonl
vam-capture identify --device aravis:127.0.0.1 2>second
is 'a second user is refused' "$? $(grep -c "in use by process $tool;" second)" '75 1'
wait $tool
is 'dropped frames are missing' "$? $(grep -c '3 of 40 frames are missing (1 frames dropped and 2 incomplete)' said)" '75 1'
python3 - >judged <<'PY'
import json
sent = {e["number"]: e for e in map(json.loads, open("truth"))}
lines = [json.loads(line) for line in open("views/manifest.jsonl")][1:-1]
taken = {e["number"]: e for e in lines if "frame" in e}
good = [n for n in sent if n < 40 and sent[n]["event"] == "frame"]
print(len(good), sum(taken[n]["complete"] and taken[n]["levels"] == sent[n]["levels"] for n in good))
print(sorted(n for n in taken if not taken[n]["complete"]), [e["dropped"] for e in lines if "dropped" in e])
delays = sorted(taken[n]["t_monotonic_s"] - sent[n]["t_monotonic_s"] for n in good)
print(delays[-4] - delays[3] < 0.02)  # the first few have not found the shortest way yet
PY
is 'every other frame arrived, exactly as sent' "$(sed -n 1p judged)" '37 37'
is 'dropped and incomplete frames are marked' "$(sed -n 2p judged)" '[8, 11] [[5, 5]]'
is 'times are those of the sender plus a constant delay' "$(sed -n 3p judged)" True
$take --frames 60 -o shrunk/ 2>said
is 'images of another size are a protocol error' "$? $(grep -c ': sends images of 120 x 45 pixels instead of 120 x 90;' said) $(wc -l <said)" '76 1 1'
is 'earlier frames are kept' "$(grep -c '"complete":true' shrunk/manifest.jsonl)" "$(ls shrunk | grep -c png)"
camera_down

camera_up --unplug 12
begun=$(date +%s)
$take --frames 40 -o gone.exr 2>said; status=$?
is 'a camera whose cable is disconnected is absent' "$status $(grep -c 'the camera is disconnected' said)" '69 1'
holds 'reported within the time-out plus 5 s, and a margin for a busy machine' "$(($(date +%s) - begun)) <= 12"
is 'no incomplete stack is left' "$(ls | grep -c gone)" 0
wait $camera 2>/dev/null

camera_up --pattern sweep --pitch 200 --width 40 --flips flips --background 0 --set projector.rows=60 --set projector.axis_row=30 --log truth2
$take --format Mono16 --frames 60 -o swept/ & tool=$!
sleep 0.5
vam-project --pattern sweep --pitch 200 --width 40 --hold 0.2 -o null: --log flips --set projector.rows=60 --set projector.axis_row=30
wait $tool
is 'sixteen bits, no frame lost' "$? $(grep -c '"complete":true' swept/manifest.jsonl)" '0 60'
python3 - >seen <<'PY'
import json
sent = {e["number"]: e for e in map(json.loads, open("truth2"))}
taken = [json.loads(line) for line in open("swept/manifest.jsonl")][1:-1]
print(all(e["levels"] == sent[e["number"]]["levels"] for e in taken), len({e["levels"] for e in taken}) >= 5)
PY
is 'exactly as sent, and the line moved: five places and black' "$(cat seen)" 'True True'
ok 'software trigger: one frame per trigger' $take --trigger software --gain 4 --frames 5 -o asked/ --report asked.json
is 'all of them' "$(ls asked | grep -c png) $(json asked.json missing)" '5 0'
is 'the gain, which automatic gain would have changed' "$(json asked.json gain) $(json asked.json automatic_off)" "4.0 ['GainAuto']"
fails 64 'has no setting for black level; omit it' $take --black-level 3 --frames 1 -o no.exr
fails 64 'has no setting for gamma; omit it' $take --gamma 2 --frames 1 -o no.exr
camera_down
fails 69 'no such camera' vam-capture --device aravis:127.0.0.9 --frames 1 -o none.exr
done_testing
