# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# vam-project by page flips: the real libdrm on a simulated graphics card, whose log is the judge.
. "$VAM_SOURCE/tests/tools/testlib.sh"
mkdir -p card/dri
touch card/dri/card0
FAKE_DRM=$PWD/card; export FAKE_DRM
card=$VAM_BUILD/lib/vam-test/drm_card.so
tiny_print part.exr
printf '[stage]\nspeed_deg_s = 360\n' >>printer.toml
judge="python3 $VAM_SOURCE/tests/device/drm_trials.py"
shown() { grep '"shade"' card/log | tail -n 1 | grep -o '"shade":"[a-z]*"'; }
print() { rm -f card/log flips leds; LD_PRELOAD=$card vam-project part.exr -o drm:HDMI-A-1 "$@"; }

vam-project part.exr -o frames/ --fps 1 --speed 10
print --max-missed 1 --log flips 2>errors
is 'a print by page flips has status 0' "$? $(cat errors)" '0 '
$judge images frames flips >judged
is 'every flip showed the frame in its log line, at that blank' "$(cut -d' ' -f1 judged)" exact
holds 'of 36 frames and black nearly all' "$(cut -d' ' -f2 judged) > 30"
is 'black at the end' "$(shown)" '"shade":"black"'
is 'the gamma table is linear' "$(grep -o '"straight":.' card/log)" '"straight":1'

# New projections from the next turn on, to the byte, without a dark image.
mkdir new
$exr make other.part space=projector width=64 height=36 count=3 value=0.25
cp other.part other.exr
vam-project part.exr -o frames1/ --fps 1 --speed 10 --full-scale 1
vam-project other.exr -o frames2/ --fps 1 --speed 10 --full-scale 1
rm -f flips; print --max-missed 1 --log flips --turns 6 --full-scale 1 --frames-from new &
tool=$!
await grep -qs '"frame":[0-9]' flips
mv other.part new/other.exr
wait $tool
is 'a print whose projections are renewed has status 0' $? 0
sed '/"event":"frames"/,$d' flips >flips1
sed '1,/"event":"frames"/d' flips >flips2
$judge images frames1 flips1 >judged1
$judge images frames2 flips2 >judged2
is 'every flip showed the frame of its sinogram' "$(cut -d' ' -f1 judged1 judged2 | tr '\n' ' ')" 'exact exact '
is 'the new ones begin with frame 0' "$(head -n 1 flips2 | grep -o '"frame":-*[0-9]*')" '"frame":0'

is 'RGB is sent in full range, its bits are left alone' "$(grep -o '"full_range.*' card/log)" '"full_range":1,"bpc":12}'
is 'in the mode that the screen prefers' "$(grep -o '"columns":[0-9]*' card/log | sort -u)" '"columns":64'
FAKE_DRM_FAULT=no-properties; export FAKE_DRM_FAULT
ok 'a card that does not know ranges is used as it is' print --max-missed 1
fails 64 'omit bpc' env LD_PRELOAD="$card" vam-project part.exr -o 'drm:HDMI-A-1?bpc=8'
FAKE_DRM_FAULT=limited
fails 76 'does not send full-range RGB' env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-1
FAKE_DRM_FAULT=limited-only
fails 76 'does not send full-range RGB' env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-1
FAKE_DRM_FAULT=taken
fails 75 'every display controller .CRTC. of the GPU drives another screen' env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-1
FAKE_DRM_FAULT=interlaced
fails 64 'no mode 64x48@50; the screen has: 64x48@60' env LD_PRELOAD="$card" vam-project part.exr -o 'drm:HDMI-A-1?mode=64x48@50'
ok 'an interlaced mode is not taken, though preferred' print --max-missed 1
is 'but the whole one' "$(grep -o '"interlaced":.' card/log | sort -u)" '"interlaced":0'
unset FAKE_DRM_FAULT
grey() { rm -f card/log; LD_PRELOAD=$card vam-project --pattern grey -o "drm:HDMI-A-1?$1" --hold 0.05; }
ok 'bits per colour are set' grey bpc=8
is 'and read back' "$(grep -o '"bpc":[0-9]*' card/log | tail -n 1)" '"bpc":8'
fails 76 'rejects 16 bits' grey bpc=16
printf '[projector]\ncolumns = 32\nrows = 24\nlens_distance_mm = 100\n' >small.toml
ok 'another mode' env VAM_PRINTER=small.toml LD_PRELOAD="$card" vam-project --pattern grey -o 'drm:HDMI-A-1?mode=32x24@60' --hold 0.05
is 'is set' "$(grep -o '"columns":[0-9]*' card/log | tail -n 1)" '"columns":32'
fails 64 'no mode 1920x1080; the screen has: 32x24@60, 64x48@60' grey mode=1920x1080
fails 64 'no mode 64x48@50' grey mode=64x48@50

# Frames are kept as grey, a byte a pixel, whatever the card needs: 720 of 1920 x 1080 pixels in less than 2 GB.
cat >hd.toml <<'TOML'
[projector]
columns = 1920
rows = 1080
pixel_mm = 0.02
axis_column = 959.5
axis_row = 539.5
TOML
peak_mb() {  # peak_mb FRAMES
  rm -f card/log card/memory
  LD_PRELOAD=$VAM_BUILD/lib/vam-test/drm_card_hd.so VAM_PRINTER=hd.toml python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3)' \
    vam-project --pattern ramp --steps $1 --hold 0.001 -o drm:HDMI-A-1
}
if ! sanitized; then
  few=$(peak_mb 4); many=$(peak_mb 36)
  echo "# 4 frames: $few MB, 36 frames: $many MB"
  holds 'a frame takes a byte a pixel' "($many - $few) / 32 < 1.1 * 1920 * 1080 / 1e6"
  holds 'so that 720 take less than 2 GB' "$few + 716 * ($many - $few) / 32 < 2000"
fi

FAKE_DRM_FAULT=skip:10 print --max-missed 1 --log flips
is 'blanks are missed' $? 0
$judge images frames flips >judged
holds 'and all counted' "$(cut -d' ' -f3 judged) >= 5"

fails 69 'connectors: eDP-1, HDMI-A-1, HDMI-A-2 \(nothing connected\)' env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-2
fails 64 'unknown option' env LD_PRELOAD="$card" vam-project part.exr -o 'drm:HDMI-A-1?hz=60'
fails 65 'do not match the screen' env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-1 --set projector.rows=44

# Each answer of the GPU wrong in turn. Without the GPU the screen cannot be blackened: the light engine switches off.
dark_after() {  # seconds from the last image until the last black, by the card's log
  python3 -c 'import json
shown = [line for line in map(json.loads, open("card/log")) if "shade" in line]
lit = [line["t_monotonic_s"] for line in shown if line["shade"] == "lit"]
print(shown[-1]["t_monotonic_s"] - lit[-1] if lit else 0)'
}
spoilt() {  # spoilt STATUS REGEX LAST-SHADE FAULT
  FAKE_DRM_FAULT=$4 print --speed 720 --max-missed "${5-1}" --light "sim:?log=$PWD/leds" >out 2>errors; status=$?
  is "$4: status, in one line with the reason" "$status $(wc -l <errors) $(grep -Ec -- "$2" errors)" "$1 1 1"
  if [ -n "$3" ]; then
    is "$4: $3" "$(shown)" "\"shade\":\"$3\""
    holds "$4: within the time-out" "$(dark_after) < 0.5"
  fi
  [ "$4" = gamma ] ||  # found before the light is woken
    is "$4: the light is off" "$(grep -o '"bits":[0-9]*' leds | tail -n 1)" '"bits":0'
}
wrong() { fails "$1" "$2" env LD_PRELOAD="$card" FAKE_DRM_FAULT="$3" vam-project part.exr -o drm:HDMI-A-1 --light sim:; }
wrong 75 'the GPU is in use' not-master
wrong 69 'the connector rejects its own mode' no-mode
wrong 71 'no GPU memory for an image of 64 x 48 pixels' no-memory:3
spoilt 76 'gamma table' black gamma
spoilt 75 'rejected a page flip' black busy:20
spoilt 75 'rejected a page flip' '' lost:20
spoilt 69 'rejected a page flip' '' gone:20
spoilt 69 'the screen was disconnected or switched off; check its cable' black unplugged:20
spoilt 75 'no flip within 0.25 s' black silent:20
spoilt 75 'no flip within 0.25 s' black late:20
spoilt 75 'missed 1 vertical blanks' black skip:20 0.001

# A second user is refused; a killed one leaves black and a free card.
rm -f card/log
LD_PRELOAD=$card vam-project part.exr -o drm:HDMI-A-1 --speed 10 --max-missed 1 2>killed & first=$!
tries=0; until grep -q lit card/log 2>/dev/null || [ $tries -ge 250 ]; do tries=$((tries + 1)); sleep 0.02; done
fails 75 "in use by process $first;" env LD_PRELOAD="$card" vam-project part.exr -o drm:HDMI-A-1
kill -9 $first; wait $first 2>/dev/null
is 'a killed print is killed' $? 137
tries=0; until grep -q guardian killed || [ $tries -ge 100 ]; do tries=$((tries + 1)); sleep 0.02; done
is 'its guardian reports its action' "$(grep -c "process $first ended unexpectedly; screen safe" killed) $(shown)" '1 "shade":"black"'
print --max-missed 1 --speed 720
is 'the screen is free again' $? 0
done_testing
