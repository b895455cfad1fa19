#!/bin/sh
# What vam-print decides before anything moves or shines, and what it says of a print that went otherwise than asked: on a
# simulated stage and camera, without a screen.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration_deg_s2=9000&travel_deg=1e7"\nspeed_deg_s = 90\n' >>printer.toml
dry() { vam-print frames.exr --display null: --light sim: --missed 0.9 --run-up 0.05 "$@"; }
print() { dry --uncalibrated "$@"; }

# A sinogram for another printer.
fails 65 'frames.exr: was computed for another printer: vial.radius_mm 12.7, now 6; ' print --set vial.radius_mm=6 --run other
ok 'which can be accepted' print --set vial.radius_mm=6 --accept-printer --run accepted
is 'and is reported' "$(grep -c 'vial.radius_mm 12.7, now 6; accepted' .log/err) $(json accepted/summary.json project.printer_differences)" "1 ['vial.radius_mm 12.7, now 6']"
is 'how far it came' "$(json accepted/summary.json reached.turns | cut -c1-3) $(json accepted/summary.json reached.lit_flips)" "$(json accepted/summary.json reached.turns | grep -E '^(0.9|1.0)' | cut -c1-3) $(json accepted/summary.json project.lit_flips)"

# The plan: what it would be, all that is not in order, and nothing left behind.
plan() { print --plan "$@"; }
sed 's/sim:?/sim:?log=moved\&/' printer.toml >watched.toml
is 'a plan' "$(plan --turns 3 --printer watched.toml 2>&1 | sed 's/ .*//' | tr '\n' ' ')" 'sinogram records frames exposure light dose display engine stage motion '
is 'in which nothing moves' "$(grep -c '"event":"moving"' moved)" 0
plan --turns 3 --light 'sim:?log=leds' >plan.txt
is 'and nothing shines' "$(grep -c '"bits":[1-9]' leds)" 0
is 'of three turns at 90 deg/s' "$(grep '^exposure' plan.txt)" 'exposure   3 turns at 90 deg/s: 12 s of light'
is 'with the travel that they need' "$(grep -Ec '^motion     3 turns at 90 deg/s: from -[0-9.]+ to 1[0-9.]+ deg, within -1e\+07 to 1e\+07; [0-9.]+ s' plan.txt)" 1
is 'no dose, as nothing states its threshold' "$(grep -c 'dose  *not known: the sinogram states no threshold' plan.txt)" 1
resin='--set resin.absorption_per_mm=0.1 --set resin.critical_dose_mj_cm3=50 --set projector.max_intensity_mw_cm2=100 --set projector.columns=256 --set projector.axis_column=127.5'
vam-slice --shape half-cylinder:diameter=3,height=2 --voxel 0.26 $resin |
  vam-optimize --iterations 12 $resin --report optimized.json -o part.exr
vam-project part.exr --plan -o null: $resin --set projector.rows=96 --turns 20 >dose.txt
# Both bring the threshold that the light was made for to the critical dose, in a lamp bright enough for one turn.
wanted=$(awk "BEGIN { print $(json optimized.json turns) * $(json optimized.json multiplier) }")
got=$(sed -n 's/.*that takes \([0-9.]*\) turns/\1/p' dose.txt)
holds 'turns to the critical dose are those of vam-optimize' "($got - $wanted) ^ 2 < (1e-2 * $wanted) ^ 2"
plan --display drm:X --set vial.radius_mm=6 --set stage.device=grbl:/nowhere --views 90 --set 'camera.device=v4l2:/nowhere' >plan.txt 2>errors
is 'a plan goes on after what is not in order' "$? $(grep -c 'not in order' plan.txt) $(grep -c . errors)" '65 4 4'
ok 'each reported in one line' sh -c 'grep -q "vial.radius_mm 12.7, now 6" errors && grep -q "drm:X: no such" errors && grep -q "/nowhere: not a serial" errors && grep -q "/nowhere: cannot open" errors'
plan --set 'stage.device=sim:?travel_deg=360' >plan.txt 2>errors
is 'travel beyond the limits' "$? $(grep -c 'require travel from .* but the controller allows -360 to 360' errors)" '65 1'
is 'no plan leaves anything' "$(ls -d print-* 2>/dev/null)" ''

# A folder of records that was copied with its links followed.
vam-capture --device 'sim:?pace=virtual&speed=90&lit=0.01&part=cylinder:x=2,diameter=1.5,height=6' --binning 4 --speed 90 --every 10 \
  -o turn.exr
vam-calibrate axis turn.exr --heights 3 --set calibration.folder=cal --set stage.device= >/dev/null
cp -rL cal copied
ok 'a copied folder of records' vam-calibrate check --need axis --set calibration.folder=copied
is 'names its files' "$(vam-calibrate check --set calibration.folder=copied | json /dev/stdin axis.record)" copied/current-axis.json
ok 'a plan by records' dry --plan --need axis --set calibration.folder=copied
is 'tells their age' "$(grep -Ec '^record     axis: [a-z]+, 0.0 h old, valid until 2' .log/out)" 1
rm -f cal/current-axis.json
fails 65 'has no record of axis' dry --need axis --set calibration.folder=cal --run none

# A place with letters that mean something to shells, sed and TOML, and files relative to the printer file.
odd='a&b #c "d" \e
f'
mkdir "$odd"
printf 'grey,intensity\n0,0\n255,1\n' >"$odd/r.csv"
sed 's/^rows/response = "r.csv"\nrows/' printer.toml >"$odd/printer.toml"
(cd "$odd" && vam-print ../frames.exr --display null: --light sim: --uncalibrated --missed 0.9 --run-up 0.05 --run 'r & #1') 2>errors
is 'a path with & # quotes and a newline' "$? $(cat errors)" '0 '
ok 'whose settings can be read from elsewhere' vam-project frames.exr -o again.exr --printer "$odd/r & #1/printer.toml"

# A condition that is never met.
vam-slice --shape half-cylinder:diameter=3,height=2 --voxel 0.26 -o part.vdb
print --turns 2 --views 10 --until 'iou>=0.99' --target part.vdb --isovalue 0.001 --run unmet --set stage.speed_deg_s=45 \
  --set stage.device="sim:?acceleration_deg_s2=9000&log=$PWD/truth" \
  --set camera.axis_column=63.5 --set camera.tilt_deg=0 --set camera.pixel_mm=0.26 --set camera.device="sim:?angles=$PWD/truth&lit_s=0.01&columns=128&rows=96" >out 2>errors
is 'a condition that is not met is status 1' "$? $(grep -c . errors)" '1 1'
sed 's/^/# /' errors
is 'with the last figures' "$(grep -Ec "^vam-print: --until 'iou>=0.99' was not met in 2 turns; at last turns [0-9.]+, missing_percent [-0-9.e+]+, overcure_percent [-0-9.e+]+, iou [-0-9.e+]+$" errors)" 1
is 'and an outcome of its own' "$(json unmet/summary.json outcome)" 'printed in full, --until not met'
holds 'the summary has them, too' "$(json unmet/summary.json reached.figures.iou) < 0.99"

# A tool that is stopped does not hold up the end.
(exec vam-print frames.exr --display null: --light sim: --missed 0.9 --run-up 0.05 --uncalibrated --turns 50 --run stopped) 2>errors &
printing=$!
await grep -qs '"frame":[0-9]' stopped/flips.jsonl
stuck=$(pgrep -P $printing -x tee); kill -STOP "$stuck"
start=$(date +%s)
kill -TERM $printing; wait $printing
is 'a print with a stopped tool ends all the same' $? 143
holds 'within 2 s and what a busy machine needs' "$(date +%s) - $start < 6"
is 'the tool, too' "$(kill -0 "$stuck" 2>/dev/null && echo there)" ''
is 'the summary tells how it ended' "$(json stopped/summary.json exit_statuses.lines)" 137
holds 'and how far it came' "$(json stopped/summary.json reached.lit_flips) > 0 && $(json stopped/summary.json reached.turns) < 50"

# A print that was killed is resumed, and the two give what a whole one gives; vam-dose tells what each gave.
print --turns 2 --run whole
(exec vam-print frames.exr --display null: --light sim: --missed 0.9 --run-up 0.05 --uncalibrated --turns 2 --run killed) 2>errors &
printing=$!
lit() { [ "$(cat killed/flips.jsonl 2>/dev/null | grep -c '"frame":[0-9]')" -gt 300 ]; }  # a turn has 240
await lit; kill -KILL $printing; wait $printing 2>/dev/null
for tool in vam-project vam-stage; do await sh -c "! pgrep -x $tool -f killed/printer.toml >/dev/null"; done
ok 'a killed print is resumed' print --resume killed --run rest
is 'for its last turn' "$(grep -o '"turns":[0-9]*,"from_deg":[0-9]*' rest/events.jsonl | cut -d, -f1) $(json rest/summary.json outcome)" '"turns":1 done'
# One that was calibrated needs no records to be resumed: its settings hold them. Its devices must be the same.
cp -r killed known; vam-stage identify --printer killed/printer.toml >known/stage.json; echo '{"edges": 1}' >known/calibration.json
ok 'a calibrated print is resumed with its own settings' dry --resume known --run rest2
is 'its records go along' "$(cat rest2/calibration.json)" '{"edges": 1}'
is 'by its plan' "$(dry --resume known --plan | grep ^records)" 'records    as in known/printer.toml'
sed -i 's/"serial": "/&9/' known/stage.json
fails 65 'known: its stage was another one' dry --resume known --run rest3
cp -r killed cut; printf '{"event":"flip","t_monotonic_s":9,"frame":1,"angle_deg":7' >>cut/flips.jsonl
is 'a line that its death cut does not count' "$(print --resume cut --plan 2>&1 | grep ^exposure)" "$(print --resume killed --plan 2>&1 | grep ^exposure)"
dose() { vam-dose frames.exr --printer whole/printer.toml --report "$1.json" -o "$1.vdb" $2; }
ok 'the dose of a run' dose whole.dose '--shown whole'
ok 'that of a killed one' dose killed.dose '--shown killed'
ok 'and of both parts' dose both.dose '--shown killed --shown rest/flips.jsonl'
holds 'a whole print gave its turns' "($(json whole.dose.json shown_turns) - 2) ^ 2 < 0.02 ^ 2"
holds 'a killed one less' "$(json killed.dose.json shown_turns) > 1.2 && $(json killed.dose.json shown_turns) < 1.9"
# One image of 480 at each end of either part; a blank of a busy machine is an image more or less.
holds 'both parts together the whole' "($(json both.dose.json shown_turns) - $(json whole.dose.json shown_turns)) ^ 2 < 0.02 ^ 2"
holds 'and its dose, everywhere' "($(json both.dose.json dose_shown_max_relative) / $(json whole.dose.json dose_shown_max_relative) - 1) ^ 2 < 0.03 ^ 2"
fails 65 'rest: is complete, all 1 turns of it; there is nothing to resume' print --resume rest --run none
fails 66 'nowhere: is not the folder of a print that began' print --resume nowhere --run none
fails 64 '.--turns: conflicts with --resume' print --resume killed --turns 3 --run none
python3 "$VAM_SOURCE/tests/tools/exr.py" make other.exr space=projector width=64 height=36 count=2
fails 65 'other.exr: is not the sinogram of whole, whose SHA-256 begins' vam-dose other.exr --printer whole/printer.toml --shown whole -o none.vdb
fails 65 'other.exr: is not the sinogram of killed' vam-print other.exr --display null: --resume killed --run none
fails 65 'none: no light was shown|no light was shown' sh -c ': >empty; vam-dose frames.exr --shown empty -o x.vdb; status=$?; rm -f empty; exit $status'
fails 66 'nowhere' vam-dose frames.exr --shown nowhere -o x.vdb
fails 64 'omit --exposure-plan' vam-dose frames.exr --shown whole --exposure-plan --like part.vdb --set resin.absorption_per_mm=0.1 --set resin.critical_dose_mj_cm3=5 -o x.vdb

# A disk that fills in the print.
mkdir small
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=400k none small 2>/dev/null; then
  trap 'umount small 2>/dev/null; rm -rf "$scratch"' EXIT
  print --turns 50 --run small/run --light "sim:?log=$PWD/full-leds" >out 2>errors
  is 'a full disk ends a print' "$? $(grep -c 'No space left on device' errors)" '74 1'
  ok 'in the name of a tool' grep -Eq '^(vam-[a-z]+|tee): ' errors
  is 'the light is off' "$(grep -o '"bits":[0-9]*' full-leds | tail -n 1)" '"bits":0'
  is 'and there is a summary' "$(json small/run/summary.json status) $(json small/run/summary.json outcome | grep -c failed)" '74 1'
  holds 'that tells how far it came' "$(json small/run/summary.json reached.lit_flips) > 0"
  umount small
else
  echo '# no small disk can be mounted: none is filled'
fi
done_testing
