#!/bin/sh
# Calibration on simulators that are out of adjustment: stage, screen and a GigE Vision camera beside a glowing vial.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
VAM_LOCK_DIR=$PWD/locks; mkdir locks screen keep; export VAM_LOCK_DIR
address=127.0.0.1
cat >printer.toml <<TOML
[projector]
columns = 256
rows = 64
pixel_mm = 0.1
axis_column = 127.5
axis_row = 31.5
telecentric = true
[vial]
radius_mm = 9
[bath]
index = 1.53
window_mm = 12
[stage]
device = "sim:?acceleration_deg_s2=1000&log=$PWD/truth"
speed_deg_s = 85
[camera]
device = "aravis:$address"
pixel_mm = 0.15
exposure_us = 15000
fps = 40
[calibration]
folder = "cal"
instrument = "simulated"
valid_hours = 1
TOML
value() { json "cal/current-$1.json" "values.$2.value"; }
near() { holds "$1 ($2)" "($2) - ($3) <= $4 && ($3) - ($2) <= $4"; }  # near NAME GOT WANT WITHIN

fails 64 'no --screen' vam-calibrate
fails 64 'none of latency' vam-calibrate --screen null: --scans edge

exec 4>screen.number
Xvfb -displayfd 4 -screen 0 256x64x24 -fbdir "$PWD/screen" -nolisten tcp -noreset -nocursor >/dev/null 2>&1 &
server=$!
tries=0; while [ ! -s screen.number ] && [ $tries -lt 250 ]; do tries=$((tries + 1)); sleep 0.02; done
DISPLAY=:$(cat screen.number); export DISPLAY
export SDL_VIDEODRIVER=x11 SDL_RENDER_DRIVER=software

# Each scan has its pattern, which the camera's simulator must be told, too; the light makes next to no print.
calibrate() {  # calibrate SCAN PATTERN...: on a bench out of adjustment
  scan=$1; shift
  for try in 1 2 3 4 5 6 7 8; do  # an address serves one camera at a time; another test may have it
    rm -f camera
    vam-sim-camera --address $address --angles truth --columns 200 --rows 60 --noise 0.003 --axis-column 2.5 --tilt 0.4 --centre 3.2 \
      --gamma 1.8 --die-with-parent --set calibration.folder= "$@" >camera 2>camera.err &
    camera=$!
    tries=0; until [ -s camera ] || ! kill -0 $camera 2>/dev/null || [ $tries -ge 250 ]; do tries=$((tries + 1)); sleep 0.02; done
    [ -s camera ] && break
    sleep 5
  done
  quiet "$scan" vam-calibrate --screen sdl:0 --light sim: --scans "$scan" --keep keep --log events --pitch 2 --sweep-exposure 20000
  kill -KILL $camera 2>/dev/null; wait $camera 2>/dev/null
}
glow() { scan=$1; shift; calibrate "$scan" --shown "keep/$scan.flips" --lit 1e9 "$@"; }
glow latency --pattern ramp --steps 2
near 'latency: what the simulator has is none' "$(value latency latency)" 0 6
glow response --pattern ramp --steps 17
near 'response: the gamma of the projector' "$(awk -F, '$1 == 128 { print $2 }' cal/cal-simulated-response-*.csv)" 0.289 0.01
calibrate axis --part 'cylinder:x=2,diameter=1.5,height=6' --lit 0.001
near 'axis: the column' "$(value axis axis_column)" 102 0.3
near 'axis: the tilt' "$(value axis tilt)" 0.4 0.1
glow edges --pattern sweep --pitch 2 --width 4
# The simulated light ends up to one of the simulator's steps (0.11 mm) inside the vial, on either side.
near 'edges: the middle' "$(value edges axis_column)" 130.7 0.4
near 'edges: the radius' "$(value edges radius)" 9 0.12
is 'four scans, begun and ended' "$(grep -c '"event":"begin"' events) $(grep -c '"event":"end"' events)" '4 4'
ok 'all are in force' vam-capture check --need latency --need response --need axis --need edges

# A print takes them up, and freezes them.
python3 "$VAM_SOURCE/tests/tools/exr.py" make part.exr space=projector width=256 height=36 count=3 pixel=0.1 row=0.1
quiet 'a dry run by the records' vam-print part.exr --screen null: --need 'latency response axis' --run-up 0.1 --missed 0.9 --run run
is 'whose summary names them' "$(json run/summary.json calibration.response.sha256)" "$(sha256sum <cal/current-response.json | cut -d' ' -f1)"
is 'and the stage' "$(json run/devices.json stage.serial)" "$(json cal/current-axis.json devices.stage.serial)"
echo '{"stage": {"serial": "another"}}' >other.json
fails 65 'was made with the stage .*, this is another; run vam-calibrate' vam-capture check --devices other.json
fails 65 "is of instrument 'simulated', this is 'other'" vam-capture check --set calibration.instrument=other
kill $server; wait $server 2>/dev/null
done_testing
