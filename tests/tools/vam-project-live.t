# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# vam-project on a screen: pixels exact, frames by the stage angle, black in every case.
. "$VAM_SOURCE/tests/tools/testlib.sh"
screen="python3 $VAM_SOURCE/tests/device/screen.py screen/Xvfb_screen0"

tiny_print part.exr

fails 64 '1.5 is not a whole number' vam-project part.exr -o null: --turns 1.5
fails 64 '2 inputs are standard input' vam-project - -o null: --follow -
fails 69 'no such connected screen' vam-project part.exr -o drm:HDMI-A-1
fails 69 'cannot reach a desktop' env -u DISPLAY -u WAYLAND_DISPLAY vam-project part.exr -o sdl:0
fails 64 '47 % is above the limit of 40 %' vam-project part.exr -o null: --light 'sim:?current_percent=47' --log why
fails 64 'above the limit of 50' vam-project part.exr -o null: --light 'sim:?current_percent=60&max_current_percent=80' --set projector.max_led_current_percent=50
ok 'no current is requested' vam-project --pattern grey -o null: --hold 0.05 --light 'sim:?current_percent=0&log=none' --log engine
is 'and none is set' "$(grep '"bits":4' none | grep -o '"current_percent":[^]]*]')" '"current_percent":[0.0,0.0,0.0]'
is 'as logged' "$(grep '"event":"light"' engine | grep -o '"led_current_percent":[^]]*]')" '"led_current_percent":[0.0,0.0,0.0]'
fails 73 'cannot be written' vam-project part.exr -o null: --log missing/log

# Test patterns, to files and to a dry run.
fails 64 'from: 720 degrees is beyond the 2 turns' vam-project part.exr -o null: --turns 2 --from 720
fails 64 'from: 720 degrees is beyond the 2 turns' vam-project part.exr -o null: --plan --turns 2 --from 720
vam-project part.exr -o null: --plan --turns 2 --from 180 >plan
ok "the plan of a print's rest has its turns" grep -q '^exposure   1.5 turns from 180 deg on at ' plan
vam-project --pattern star --plan -o null: --light 'sim:?log=planned' >plan
is 'the plan of a pattern: its devices, without light' "$? $(cut -d' ' -f1 plan | tr '\n' ' ') $(cat planned 2>/dev/null)" '0 display relay engine  '
fails 64 'is not one of dlpc350:, dlpc900:, sim:|sim0' vam-project --pattern star --plan -o null: --light sim0:
for pattern in star axis grid grey ramp sweep row blink; do ok "pattern $pattern" vam-project --pattern $pattern -o $pattern/; done
is 'a ramp has 17 levels' "$(ls ramp | grep -c png)" 17
ok 'a dry run reports the pattern it shows' vam-project --pattern row --width 3 --hold 0.05 -o null: --log rows
is 'in its log' "$(grep '"event":"pattern"' rows | grep -c '"name":"row"')" 1
is 'a sweep has 64 / 4 places' "$(ls sweep | grep -c png)" 16
is 'blinks have 127 steps' "$(ls blink | grep -c png)" 127
ok 'patterns can be shown' vam-project --pattern ramp --steps 3 --hold 0.1 -o null: --log ramps --light sim:
is 'one after the other' "$(grep -o '"frame":-*[0-9]*' ramps | uniq | tr '\n' ' ')" '"frame":0 "frame":1 "frame":2 "frame":-1 '
ok 'blinks can be shown' vam-project --pattern blink --hold 0.02 -o null: --log blinks
is 'by their sequence: seven steps of light, six black, one of light' \
  "$(grep -o '"frame":-*[0-9]*' blinks | uniq | sed -n '1p;2p;3p;$p' | tr '\n' ' ')" '"frame":1 "frame":0 "frame":1 "frame":-1 '

# Three simultaneous dry runs by stage angles: a good one, one whose stage ends too early, and one that is too fast.
follow() {  # follow LEDS FLIPS OPTIONS...: the lines of a stage, without a screen
  leds=$1; flips=$2; shift 2
  vam-project part.exr -o null: --follow - --light "sim:?log=$leds" --log $flips --max-missed 0.9 "$@"
}
(vam-stage spin --device 'sim:?acceleration=1000' --speed 85 --run-up 0.5 | sed -u 550q | follow leds2 flips2) 2>errors2 &
early=$!
(vam-stage spin --device 'sim:?acceleration=1000&speed_error=0.03' --speed 85 --run-up 0.1 | follow leds3 flips3) 2>errors3 &
fast=$!
vam-stage spin --device 'sim:?acceleration=1000' --speed 85 --run-up 0.5 | follow leds flips --report report.json
is 'a followed print has status 0' $? 0
is 'the light came on once and went off once' "$(grep -o '"bits":[0-9]*' leds | tail -n 3 | tr '\n' ' ')" '"bits":0 "bits":4 "bits":0 '
holds 'about four seconds of light at 60 Hz' "$(json report.json lit_flips) > 200 && $(json report.json lit_flips) < 260"
is 'black before and after' "$(grep -c '"frame":-1' flips | awk '{ print ($1 > 50) }') $(grep '"event":"flip"' flips | tail -n 1 | grep -c '"frame":-1')" '1 1'
python3 - >angles <<'PY'
import json
worst = 0
for line in map(json.loads, open("flips")):
    if line["event"] == "flip" and line["frame"] >= 0:
        off = (line["angle_deg"] - 10 * line["frame"] + 180) % 360 - 180
        worst = max(worst, abs(off))
        assert line["angle_deg"] >= 0
print(worst <= 5 + 1e-9)
PY
is 'every frame is the one nearest to the angle' "$(cat angles)" True

# New projections between turns: the frames change at a turn's begin, without a dark image; what does not fit is refused.
mkdir new
$exr make one.exr space=projector width=64 height=36 count=3 value=1 printer=none
cp one.exr new/earlier.exr
vam-project one.exr -o null: --speed 180 --turns 4 --max-missed 0.9 --log renewed --frames-from new &
tool=$!
await grep -qs '"frame":[0-9]' renewed
$exr make small.exr space=projector width=64 height=12 count=3
mv small.exr new/a.exr
$exr make other.part space=projector width=64 height=36 count=3 value=0.25
await grep -q frames-refused renewed  # of several the last counts
mv other.part new/b.exr
wait $tool
is 'a print whose projections were renewed' $? 0
is 'one was refused' "$(grep '"event":"frames-refused"' renewed | grep -c 'new/a.exr: has 64 columns x 12 angles .*, but the print shows 64 columns x 36 angles .*; compute it')" 1
is 'one was shown' "$(grep -c '"event":"frames",' renewed)" 1
is 'with its hash' "$(grep '"event":"frames",' renewed | grep -c "$(sha256sum <new/b.exr | cut -d' ' -f1)")" 1
python3 - >between <<'PY'
import json
flips, at = [], None
for line in map(json.loads, open("renewed")):
    if line["event"] == "frames": at, turn = len(flips), line["turn"]
    if line["event"] == "flip": flips.append(line)
lit = [i for i, flip in enumerate(flips) if flip["frame"] >= 0]
print(all(flips[i]["frame"] >= 0 for i in range(lit[0], lit[-1])), flips[at]["frame"], abs(flips[at]["angle_deg"] - 360 * turn) <= 10)
PY
is 'nothing dark between, the first frame at the begin of a turn' "$(cat between)" 'True 0 True'
sed '/"event":"frames",/,$d' renewed >first  # as if it had been killed there
vam-dose one.exr --shown first --size 2 --set stage.speed_deg_s=180 -o dose.vdb --report one.json
vam-dose one.exr new/b.exr --shown renewed --size 2 --set stage.speed_deg_s=180 -o dose.vdb --report both.json
holds 'each was shown for whole turns, all of them together' \
  "($(json both.json shown_turns) - 4) ^ 2 < 0.1 ^ 2 && $(json both.json shown_turns) - $(json one.json shown_turns) > 0.9"
holds 'and the dose is that of their intensities, at the full scale of the first' \
  "($(json one.json dose_shown_mean_relative) / $(json one.json shown_turns) - 4 * ($(json both.json dose_shown_mean_relative) - $(json one.json dose_shown_mean_relative)) / ($(json both.json shown_turns) - $(json one.json shown_turns))) ^ 2 < 1e-4 * $(json one.json dose_shown_mean_relative) ^ 2"
fails 64 'shown: renewed showed [0-9]* images of .new/b.exr. .*, which is not given' vam-dose one.exr --shown renewed --size 2 --set stage.speed_deg_s=180 -o x.vdb
begun=$(grep -m 1 '"frame":[0-9]' renewed | sed 's/.*"t_monotonic_s":\([0-9.]*\).*/\1/')
vam-dose one.exr --shown renewed --before "$(awk "BEGIN { printf \"%.6f\", $begun + 1 }")" --size 2 --set stage.speed_deg_s=180 -o dose.vdb --report early.json
holds 'in the first second half a turn was shown' "($(json early.json shown_turns) - 0.5) ^ 2 < 0.02 ^ 2"
fails 65 'no light was shown in this run before that time; check --before' vam-dose one.exr --shown renewed --before 0 --size 2 --set stage.speed_deg_s=180 -o x.vdb
cp one.exr same.exr
fails 64 'same.exr: is given twice, but its light was delivered once' vam-dose one.exr same.exr --shown renewed --size 2 --set stage.speed_deg_s=180 -o x.vdb
fails 64 'one.exr: is given twice' vam-dose one.exr one.exr --shown renewed --size 2 --set stage.speed_deg_s=180 -o x.vdb
fails 64 'SINOGRAM: several add up only as a print showed them; give its --shown' vam-dose one.exr new/b.exr --size 2 -o x.vdb
fails 64 'full-scale: renewed showed one.exr at a full scale of 1, not 2; omit it' vam-dose one.exr new/b.exr --shown renewed --full-scale 2 --size 2 --set stage.speed_deg_s=180 -o x.vdb
# What completes a dose states its scale, its turns and the turn that it is for: taken there, or not at all.
mkdir for
vam-project one.exr -o null: --speed 180 --turns 6 --max-missed 0.9 --log stated --frames-from for &
tool=$!
await grep -qs '"frame":[0-9]' stated
for turn in 2 3; do
  $exr make stated.part space=projector width=64 height=36 count=3 value=0.25 full_scale=0.5 shown_turns=2
  mv stated.part for/turn-$turn.exr
  await grep -qs "turn-$turn.exr" stated
done
$exr make stated.part space=projector width=64 height=36 count=3 value=0.25 full_scale=0.5 shown_turns=9
cp stated.part for/.hidden.exr
mkfifo for/pipe.exr
mv stated.part for/turn-1.exr
await grep -qs 'turn 1 came too late' stated
$exr make stated.part space=projector width=64 height=36 count=3 value=0.25 full_scale=0.5 shown_turns=9
mv stated.part for/turn-9.exr
wait $tool
is 'a print whose projections say for how long' $? 0
is 'they are for turns two and three' "$(grep -o '"event":"frames",.*' stated | sed 's/.*"turn":\([0-9]*\),.*"full_scale":\([0-9.]*\).*"turns":\([0-9]*\).*/\2 \1 \3/' | tr '\n' ' ')" '0.5 2 2 0.5 3 2 '
is 'others come too late' "$(grep '"event":"frames-refused"' stated | grep -c 'the frames of turn 1 came too late')" 1
is 'those of a turn that does not come are not shown' "$(grep '"event":"frames-refused"' stated | grep -c 'for/turn-9.exr were not shown: the print ended')" 1
is 'a pipe is no sinogram, and what is hidden none yet' "$(grep -c 'for/pipe.exr: is no regular file' stated) $(grep -c hidden stated)" '1 0'
holds 'and after two turns more it is dark' "$(grep '"frame":[0-9]' stated | tail -n 1 | sed 's/.*"angle_deg":\([0-9.]*\).*/\1/') > 1780 && $(grep '"frame":[0-9]' stated | tail -n 1 | sed 's/.*"angle_deg":\([0-9.]*\).*/\1/') < 1800"
$exr make nothing.exr space=projector width=64 height=36 count=3 value=0.25 full_scale=-1
fails 65 "state vam:full_scale '-1', which is not above 0" vam-project nothing.exr --fps 30 -o x.mkv
vam-project for/turn-2.exr --fps 30 -o stated.mkv --report scale.json
holds 'a video has that scale, too' "$(json scale.json full_scale) == 0.5"

vam-project part.exr -o null: --speed 360 --turns 1 --max-missed 0.9 --log /dev/full --frames-from new 2>full
is 'a log that cannot be written ends the print in good order' "$? $(grep -c '/dev/full: write failed' full)" '74 1'
fails 66 'nowhere: cannot read the folder' vam-project part.exr -o null: --turns 1 --speed 180 --frames-from nowhere
misuse --frames-from files vam-project part.exr -o x.mkv --frames-from new

wait $early
is 'a stage that ends is an error' $? 75
ok 'which is reported' grep -q 'ended after line 550' errors2
is 'and the light is off' "$(grep -o '"bits":[0-9]*' leds2 | tail -n 1)" '"bits":0'
wait $fast
is 'a stage 3 % too fast is an error' "$? $(grep -c '3 % error, limit 1 %' errors3)" '75 1'
is 'the light never came on, and all was black' "$(grep -c '"bits":[1-9]' leds3) $(grep -c '"frame":[0-9]' flips3)" '0 0'

# A real window, on a virtual screen whose image is a file.
screen_up 64 48

fails 65 'do not match the screen' vam-project part.exr -o sdl:0 --set projector.rows=40 --set projector.axis_row=30
fails 69 'no such screen' vam-project part.exr -o sdl:7
vam-project part.exr -o frames/ --fps 1 --speed 10
vam-project part.exr -o sdl:0 --speed 90 --log shown --max-missed 0.5 2>errors &
tool=$!
$screen watch 6 0.5 >seen &
watcher=$!
await test -s shown
vam-project part.exr -o sdl:0 2>second
is 'a second user is refused' "$? $(grep -c "in use by process $tool;" second)" '75 1'
wait $tool
is 'an unfollowed print has status 0' $? 0
wait $watcher
$screen compare frames seen >compared
is 'every image on the screen equals one of the frames' "$(cut -d' ' -f1 compared)" exact
holds 'and nearly all of the 19 different frames were shown' "$(cut -d' ' -f2 compared) >= 18"
is 'black at the end' "$($screen now)" black
is 'silent' "$(cat errors)" ''

screen_down
done_testing
