# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock COST 200
# What vam-print checks before any motion or light, and reports after an incomplete print: on a simulated stage and camera,
# without a screen.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration=9000&max_speed=360&min_angle=-1e7&max_angle=1e7"\nspeed_deg_s = 90\n' >>printer.toml
dry() {  # dry OPTIONS...: with these where no others are given
  for usual in '--display null:' '--light sim:' '--max-missed 0.9' '--run-up 0.05'; do
    case " $* " in *" ${usual%% *} "*) ;; *) set -- "$@" $usual ;; esac
  done
  vam-print frames.exr "$@"
}
print() { dry --uncalibrated "$@"; }
quick='--set stage.speed_deg_s=360 --run-up 0.2'  # a turn in a second, where its light is not compared

# Limits of the system.
for files in 5 7 10 63; do
  prlimit --nofile=$files vam-print frames.exr --display null: 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&- >few 2>&1
  is "with $files open files" "$? $(cat few)" "71 vam-print: needs 64 open files, and the limit is $files; raise it (ulimit -n)"
done
fails 71 '^vam-print: needs 64 processes, and the limit is 1; raise it \(ulimit -u\)$' prlimit --nproc=1 vam-print frames.exr --display null:

# A path with special characters of shells, sed and TOML, and files relative to the printer file.
odd='a&b #c "d" \e
f'
mkdir "$odd"
printf 'grey,intensity\n0,0\n255,1\n' >"$odd/r.csv"
sed 's/^rows/response = "r.csv"\nrows/' printer.toml >"$odd/printer.toml"
: >odd.err
(cd "$odd" && vam-print ../frames.exr --display null: --light sim: --uncalibrated --max-missed 0.9 $quick --run 'r & #1') 2>odd.err & far_away=$!

# A sinogram for another printer.
fails 65 'frames.exr: computed for another printer: vial.radius_mm 12.7, now 6; ' print --set vial.radius_mm=6 --run other
ok 'which can be accepted' print $quick --set vial.radius_mm=6 --accept-printer --run accepted
is 'and is reported' "$(grep -c 'vial.radius_mm 12.7, now 6; accepted' .log/err) $(json accepted/summary.json project.printer_differences)" "1 ['vial.radius_mm 12.7, now 6']"
is 'progress at the end' "$(json accepted/summary.json reached.turns | cut -c1-3) $(json accepted/summary.json reached.lit_flips)" "$(json accepted/summary.json reached.turns | grep -E '^(0.9|1.0)' | cut -c1-3) $(json accepted/summary.json project.lit_flips)"

fails 64 'vam-print: stage.device: no device is set; .*--set stage.device=DEVICE' print --set stage.device= --run none

# Every device is asked before anything moves; the folder of a print that cannot begin is not left.
refused_by() { status=$1 regex=$2; shift 2; fails "$status" "$regex" print --run refused "$@"; is 'no folder is left' "$(ls -d refused 2>/dev/null)" ''; }
refused_by 69 'nowhere: not a serial port' --set stage.device=gcs:/nowhere
refused_by 69 'nowhere: cannot open' --view-step 90 --set camera.device=v4l2:/nowhere
refused_by 69 'no such device; check power and cable' --light dlpc350:
refused_by 76 'above the limit of 10 %' --set projector.max_led_current_percent=10
refused_by 65 'exceeds the stage.s maximum' --set stage.speed_deg_s=1000

# The plan: the figures, every problem, and no file left.
plan() { print --plan "$@"; }
sed 's/sim:?/sim:?log=moved\&/' printer.toml >watched.toml
is 'a plan' "$(plan --turns 3 --printer watched.toml 2>&1 | sed 's/ .*//' | tr '\n' ' ')" 'sinogram records frames exposure intensity dose display relay engine stage motion disk '
is 'in which nothing moves' "$(grep -c '"event":"moving"' moved)" 0
plan --turns 3 --light 'sim:?log=leds' >plan.txt
is 'and no light is on' "$(grep -c '"bits":[1-9]' leds)" 0
fails 65 'projector.axis_column: -500 is not in the image of 64 columns; set it' plan --set projector.axis_column=-500 --accept-printer
is 'of three turns at 90 deg/s' "$(grep '^exposure' plan.txt)" 'exposure   3 turns at 90 deg/s: 12 s of light'
is 'with the travel that they need' "$(grep -Ec '^motion     3 turns at 90 deg/s: from -[0-9.]+ to 1[0-9.]+ deg, within -1e\+07 to 1e\+07; [0-9.]+ s' plan.txt)" 1
is 'no dose of a sinogram without a plan' "$(grep -c '^dose  *relative without resin.absorption_per_mm and resin.critical_dose_mj_cm3, ' plan.txt)" 1
resin='--set resin.absorption_per_mm=0.1 --set resin.critical_dose_mj_cm3=50 --set projector.max_intensity_mw_cm2=100 --set projector.columns=256 --set projector.axis_column=127.5'
vam-slice --shape half-cylinder:diameter=3,height=2 --voxel 0.26 $resin |
  vam-optimize --iterations 12 $resin --report optimized.json -o part.exr
vam-project part.exr --plan -o null: $resin --set projector.rows=96 >dose.txt
wanted=$(json optimized.json turns)
got=$(sed -n 's/.*is reached after \([0-9.]*\) turns/\1/p' dose.txt)
holds 'turns to the critical dose are those of vam-optimize' "($got - $wanted) ^ 2 < (1e-2 * $wanted) ^ 2"
far() {  # far TURNS: the status, and what is said of the dose
  vam-project part.exr -o null: $resin --set projector.rows=96 --speed 720 --max-missed 1 --max-missed-lit 1 --turns "$1" --accept-dose >far 2>&1
  echo "$? $(grep -o 'turns* gives* .* planned dose, .*' far)"
}
# At a speed of 720 for 90 deg/s.
is 'too few turns are said' "$(far 1 | sed 's/ .*which/ which/')" "0 which $(awk "BEGIN { printf \"%.4g\", 8 * $got }") turns reach"
is 'enough are not' "$(far $((8 * got)))" '0 '
plan --display drm:X --set vial.radius_mm=6 --set stage.device=grbl:/nowhere --view-step 90 --set 'camera.device=v4l2:/nowhere' >plan.txt 2>errors
is 'a plan continues after a problem' "$? $(grep -c 'failed$' plan.txt) $(grep -c . errors)" '65 4 4'
ok 'each reported in one line' sh -c 'grep -q "vial.radius_mm 12.7, now 6" errors && grep -q "drm:X: no such" errors && grep -q "/nowhere: not a serial" errors && grep -q "/nowhere: cannot open" errors'
plan --set 'stage.device=sim:?min_angle=-360&max_angle=360' >plan.txt 2>errors
is 'travel beyond the limits' "$? $(grep -c 'require travel from .* but the controller allows -360 to 360' errors)" '65 1'
is 'free space' "$(plan --run runs/new 2>&1 | grep -c 'runs: no such folder; create it for --run\|^disk  *failed')" 2
is 'no plan leaves anything' "$(ls -d print-* 2>/dev/null)" ''
plan --commands $quick --turns 1 --run 'by hand' | sed -n '/^mkdir/,$p' >by.hand
ok 'its command lines run by hand' sh -e by.hand
holds 'and show the light' "$(grep -c '"frame":[0-9]' 'by hand/flips.jsonl') >= 40 && $(grep -c '"event":"end"' 'by hand/stage.jsonl') == 1"

# A folder of records that was copied with its links followed.
vam-capture --device 'sim:?pace=virtual&speed=90&lit=0.01&part=cylinder:x=2,diameter=1.5,height=6' --binning 4 --speed 90 --view-step 9 \
  -o turn.exr
vam-calibrate axis turn.exr --heights 3 --set calibration.folder=cal --set stage.device= >/dev/null
cp -rL cal copied
ok 'a copied folder of records' vam-calibrate check --need axis --set calibration.folder=copied
is 'names its files' "$(vam-calibrate check --set calibration.folder=copied | json /dev/stdin axis.record)" copied/current-axis.json
ok 'a plan by records' dry --plan --need axis --set calibration.folder=copied
is 'states their age' "$(grep -Ec '^record     axis: [a-z]+, 0.0 h old, valid until 2' .log/out)" 1
rm -f cal/current-axis.json
fails 65 'has no record of axis' dry --need axis --set calibration.folder=cal --run none

wait $far_away
is 'a path with & # quotes and a newline' "$? $(cat odd.err)" '0 '
ok 'whose settings can be read from elsewhere' vam-project frames.exr -o again.exr --printer "$odd/r & #1/printer.toml"

# A condition that is never met; beside it, what is refused.
vam-slice --shape half-cylinder:diameter=3,height=2 --voxel 0.26 -o part.vdb
print --turns 2 --view-step 10 --until 'iou>=0.99' --target part.vdb --isovalue 0.001 --run unmet --set stage.speed_deg_s=45 \
  --set stage.device="sim:?acceleration=9000&log=$PWD/truth" \
  --set camera.axis_column=63.5 --set camera.tilt_deg=0 --set camera.pixel_mm=0.26 --set camera.device="sim:?follow=$PWD/truth&lit=0.01&columns=128&rows=96" >unmet.out 2>unmet.err & unmet=$!
await test -s unmet/angles.jsonl
# The options of live metrology are checked before any motion, by the plan, too.
till() { print --isovalue 1 --target part.vdb --until "$@"; }
live() { till "$@" --turns 2 --view-step 10; }
fails 64 "unknown figure 'foo'" live 'foo>=1' --run none
fails 66 'nowhere.vdb: cannot open' print --turns 2 --view-step 10 --isovalue 1 --target nowhere.vdb --until 'iou>=1' --run none
fails 64 'vam-ost: --target: requires --isovalue, --resin or --projections; ' print --turns 2 --view-step 10 --target part.vdb --until 'iou>=1' --run none
fails 64 '.--view-step: is 15; --until requires views at most 12 degrees apart' till 'iou>=1' --turns 2 --view-step 15 --run none
fails 64 '.--until: requires at least 2 turns' till 'iou>=1' --turns 1 --view-step 10 --run none
is 'by its plan, too' "$(till 'iou>=1' --turns 1 --view-step 10 --plan 2>&1 >/dev/null | grep -c 'until: requires at least 2 turns')" 1
fails 64 ".--view-step: 'ten' is not a number" print --view-step ten --run none
is 'by its plan' "$(live 'foo>=1' --plan 2>&1 >/dev/null | grep -c "unknown figure 'foo'")" 1
is 'which does not mention valid options' "$(live 'iou>=1' --plan 2>&1 | grep -c '^metrology\|empty')" 0
# A tool that fails later, when the light is on, is the cause, and not those that are ended because of it.
mkdir fake
printf '#!/bin/sh\n[ -p /dev/stdin ] || { echo "vam-ost: stdin: is empty" >&2; exit 65; }\nuntil grep -qs "\"frame\":[0-9]" died/flips.jsonl; do sleep 0.02; done\necho "vam-ost: died" >&2; exit 71\n' >fake/vam-ost
chmod +x fake/vam-ost
cp "$(command -v vam-print)" fake  # which looks for tools beside itself first
PATH=$PWD/fake:$PATH live 'iou>=1' --set camera.device=sim: --run died 2>errors
is 'the cause is the tool that failed first' "$? $(cat errors) $(json died/summary.json outcome)" '71 vam-ost: died ost failed'

# Prints that are begun together, as that takes its time, and end in several ways.
for name in stopped project lines; do
  (exec vam-print frames.exr --display null: --light sim: --max-missed 0.9 --run-up 0.05 --uncalibrated --turns 50 --run $name) 2>$name.err &
  eval "pid_$name=\$!"
done
# One that was started in the background by a script ignores an interrupt, its tools do not.
perl -e 'setpgrp(0, 0); $SIG{INT} = "IGNORE"; exec @ARGV' vam-print frames.exr --display null: --light sim: --max-missed 0.9 \
  --run-up 0.05 --uncalibrated --turns 50 --run interrupted 2>interrupted.err &
interrupted=$!
for name in stopped project lines interrupted; do await grep -qs '"frame":[0-9]' $name/flips.jsonl; done

# A stopped tool does not delay the end.
printing=$pid_stopped
fails 75 'stopped: is still being printed' print --resume stopped --run none
stuck=$(pgrep -P $printing -x tee); kill -STOP "$stuck"
start=$(date +%s)
kill -TERM $printing; wait $printing
is 'a print with a stopped tool ends nevertheless' $? 143
holds 'within 2 s, and a margin for a busy machine' "$(date +%s) - $start < 6"
is 'the tool, too' "$(kill -0 "$stuck" 2>/dev/null && echo there)" ''
is 'the summary states the outcome' "$(json stopped/summary.json exit_statuses.lines)" 137
holds 'and the progress' "$(json stopped/summary.json reached.lit_flips) > 0 && $(json stopped/summary.json reached.turns) < 50"

# Nor is it waited for: the others would wait with the light on.
for name in project lines; do
  eval "printing=\$pid_$name"
  program=vam-$name; [ $name = project ] || program=tee
  kill -STOP "$(pgrep -P $printing -x $program)"
  start=$(date +%s)
  wait $printing
  is "a print whose $name is stopped fails" "$? $(json $name/summary.json outcome)" "137 $name failed"
  ok 'the error names it' grep -qx "vam-print: $name was stopped by a signal and is ended" $name.err
  holds 'soon' "$(date +%s) - $start < 6"
done

# An interrupt of all its tools, which no terminal sends.
printing=$interrupted
kill -INT $(pgrep -P $printing -x 'vam-project|vam-stage|tee'); wait $printing
is 'an interrupt of all processes is not a failure of one' "$? $(json interrupted/summary.json outcome)" '130 aborted'
is 'and is reported in one line' "$(cat interrupted.err)" "$(grep -E '^vam-print: aborted: (stage|project|lines) was ended by a signal$' interrupted.err)"

# A killed print is resumed, and both parts deliver the dose of a whole one, by vam-dose.
print --turns 2 --run whole & whole=$!
(exec vam-print frames.exr --display null: --light sim: --max-missed 0.9 --run-up 0.05 --uncalibrated --turns 2 --run killed) 2>errors &
printing=$!
lit() { [ "$(cat killed/flips.jsonl 2>/dev/null | grep -c '"frame":[0-9]')" -gt 300 ]; }  # a turn has 240
await lit; kill -KILL $printing; wait $printing 2>/dev/null
wait $whole
wait $unmet
is 'a condition that is not met is status 1' "$? $(grep -c . unmet.err)" '1 1'
sed 's/^/# /' unmet.err
is 'with the last figures' "$(grep -Ec "^vam-print: --until 'iou>=0.99' was not met in 2 turns; last figures: turns [0-9.]+, missing_percent [-0-9.e+]+, overcure_percent [-0-9.e+]+, iou [-0-9.e+]+$" unmet.err)" 1
is 'and an outcome of its own' "$(json unmet/summary.json outcome)" 'complete, --until not met'
holds 'the summary has them, too' "$(json unmet/summary.json reached.figures.iou) < 0.99"
for tool in '[v]am-project' '[v]am-stage'; do await sh -c "! pgrep -f '$tool.*killed/printer.toml' >/dev/null"; done
cp -r killed known; cp -r killed cut; cp -r killed again
is 'a killed print leaves its pipes' "$(ls -A killed | grep '^[.]' | tr '\n' ' ')" '.capture .project .reserve .stage .views '
# One that was calibrated needs no records to be resumed: its settings hold them. Its devices must be the same.
vam-stage identify --printer killed/printer.toml >known/stage.json; echo '{"edges": 1}' >known/calibration.json
dry --resume known --run rest2 & rest2=$!
ok 'a killed print is resumed' print --resume killed --run rest
is 'which removes them' "$(ls -A killed | grep -c '^[.]')" 0
fails 65 'killed: already resumed, by .*/rest; resume that one instead' print --resume killed --run none
# That it was resumed is in its events, too: a mark that is lost or spoilt is not taken for none.
for tool in vam-check vam-status 'print --run none --resume'; do
  rm -rf spoilt; cp -r killed spoilt; rm spoilt/resumed.json
  fails 65 'spoilt/resumed.json: is gone, but events.jsonl states that /.*/rest resumed this print; restore it$' $tool spoilt
  for mark in '' '[]' '{"resumed_by":"/x"}' malformed; do
    printf %s "$mark" >spoilt/resumed.json
    fails 65 'spoilt/resumed.json: does not say when and by which print' $tool spoilt
  done
  rm spoilt/resumed.json; mkdir spoilt/resumed.json; fails 65 'spoilt/resumed.json: is not a regular file' $tool spoilt
done
ok 'both parts are verified' vam-check killed rest
mkdir archive; cp -r killed archive; rm archive/killed/resumed.json; sed -i '$d' archive/killed/events.jsonl
fails 65 'archive/killed/resumed.json: is gone, but rest/events.jsonl states that it resumes this print; restore it$' vam-check archive/killed rest
rm -r archive/killed; cp -r stopped archive/killed
ok 'another print by this name was not resumed' vam-check archive/killed rest
# One that is given up before light has given nothing.
cp -r again early; printf '{"utc' >>early/events.jsonl
(exec vam-print frames.exr --display null: --light sim: --max-missed 0.9 --run-up 9 --uncalibrated --resume early --run dark) 2>errors &
printing=$!
await grep -qs '"event":"resumed"' early/events.jsonl; await grep -qs '"event":"flip"' dark/flips.jsonl
kill -TERM $printing; wait $printing
is 'is taken back' "$? $(grep -o '"event":"re[a-z]*"' early/events.jsonl | tr '\n' ' ')$(ls early/resumed.json 2>/dev/null)" '143 "event":"resumed" "event":"released" '
ok 'and the print can be resumed' print --resume early --plan
ok 'both are verified' vam-check early dark
is 'for its last turn' "$(grep -o '"turns":[0-9]*,"from_deg":[0-9]*' rest/events.jsonl | cut -d, -f1) $(json rest/summary.json outcome)" '"turns":1 done'
ok 'a calibrated print is resumed with its own settings' wait $rest2
is 'its records are copied' "$(cat rest2/calibration.json)" '{"edges": 1}'
rm known/resumed.json; sed -i '$d' known/events.jsonl
is 'by its plan' "$(dry --resume known --plan | grep ^records)" 'records    as in known/printer.toml'
sed -i 's/"serial": "/&9/' known/stage.json
for way in --plan '--run rest3'; do fails 65 'known: printed with another stage .stage.json differs.' dry --resume known $way; done
is 'a refused print leaves no mark' "$(ls known/resumed.json 2>/dev/null)" ''
printf '{"event":"flip","t_monotonic_s":9,"frame":1,"angle_deg":7' >>cut/flips.jsonl
is 'a truncated last line of the log is ignored' "$(print --resume cut --plan 2>&1 | grep ^exposure)" "$(print --resume again --plan 2>&1 | grep ^exposure)"
# Flips that were lost or changed would be light that is given twice.
refuses() {  # refuses REGEX COMMAND: a killed print whose log of flips (standard input) becomes what COMMAND makes of it
  rm -rf spoilt; cp -r again spoilt; eval "$2" <again/flips.jsonl >spoilt/flips.jsonl
  fails 65 "^vam-print: spoilt/flips.jsonl$1" print --resume spoilt --run none
  fails 65 "^vam-dose: spoilt/flips.jsonl$1" vam-dose frames.exr --shown spoilt -o none.vdb
  fails 65 "^vam-check: spoilt/flips.jsonl$1" vam-check spoilt
  fails 65 "^vam-check: spoilt/flips.jsonl$1" vam-check spoilt/flips.jsonl
}
cut_short='has [0-9]+ bytes of whole lines, but events.jsonl states [0-9]+ at [-0-9T:.]+Z; it was cut; restore it$'
changed='[0-9]+: does not follow from the line before it; the log was changed; restore it$'
line=$(grep -n '"frame":[0-9]' again/flips.jsonl | sed -n '100s/:.*//p')  # of the 100th lit image
refuses ": $cut_short" :
refuses ": $cut_short" "head -n $line"
for change in "$((line - 20)),${line}d" "$((line - 20))h;${line}G" "${line}s/\"utc\":\"2/\"utc\":\"3/" 1d; do refuses ":$changed" "sed '$change'"; done
refuses ": $cut_short" "sed 's/,\"chain\":\"[0-9a-f]*\"//'"
# Without chains nobody would know: such a print is not resumed.
rm -rf spoilt; cp -r again spoilt; unchain spoilt/*.jsonl; sed -i '/"event":"sealed"/d' spoilt/events.jsonl
fails 65 '^vam-print: spoilt/flips.jsonl: has no chain, by which lost lines would be found' print --resume spoilt --run none
ok 'its dose can be computed' vam-dose frames.exr --shown spoilt -o lost.vdb
sed -i "${line}h;${line}d;$((line + 1))G" spoilt/flips.jsonl
fails 65 '^vam-dose: spoilt/flips.jsonl:[0-9]*: time [0-9.]* s is before that of the flip before it' vam-dose frames.exr --shown spoilt -o none.vdb
# As of an untouched one is said what of it is verified, so of what was lost or changed that it was.
ok 'a killed print is verified up to where its events state its flips' vam-check again
of='flips.jsonl is sealed up to byte [0-9]+ of [0-9]+'
is 'which says up to where' "$(grep -Ec "^again: run folder of a print that goes on or was killed: $of, sealed\$" .log/out)" 1
is 'and what was delivered, in ten lines at most' "$(grep -Ec '^  delivered  turn [01][.][0-9]* of 2, from 0.00 on: [0-9]* images' .log/out) $(($(wc -l <.log/out) <= 10))" '1 1'
is 'by its log alone, too' "$(vam-check again/flips.jsonl | grep -Ec "^again/flips.jsonl: flips of a print: $of, sealed\$")" 1
rm -rf spoilt; cp -r again spoilt; is 'of a copy, too, that it is over' "$(vam-status spoilt 2>/dev/null | grep -c '^end not logged ')" 1
is 'and by its progress' "$(vam-status again 2>&1 >/dev/null | grep -Ec "is gone; only its logs are verified: $of\$")" 1
spoilt() {  # spoilt REGEX COMMAND: a killed print after COMMAND in its folder
  rm -rf spoilt; cp -r again spoilt; (cd spoilt && eval "$2")
  fails 65 "^vam-print: spoilt/$1" print --resume spoilt --run none
  fails 65 "^vam-dose: spoilt/$1" vam-dose frames.exr --shown spoilt -o none.vdb
  fails 65 "^vam-status: spoilt/$1" vam-status spoilt
  fails 65 "^vam-check: spoilt/$1" vam-check spoilt
}
for log in angles flips; do spoilt "$log.jsonl: is gone, but events.jsonl states [0-9]+ bytes of it; restore it\$" "rm $log.jsonl"; done
fails 65 '^vam-check: spoilt/flips.jsonl: is gone, but' vam-check spoilt/flips.jsonl
spoilt 'printer.toml: changed after it was written .*; restore it$' 'sed -i 2d printer.toml'
spoilt 'printer.toml: has no seal, with which a print writes it; it was cut or changed; restore it$' 'sed -i "/^# sealed/d" printer.toml'
fails 65 '^vam-dose: .*/spoilt/printer.toml: has no seal' vam-dose frames.exr --shown spoilt/flips.jsonl -o none.vdb
for log in events angles stage; do spoilt "$log.jsonl:1: does not follow from the line before it" "sed -i '1s/^{/{ /' $log.jsonl"; done
spoilt "events.jsonl:$changed" 'sed -i "/started/d" events.jsonl'
spoilt "events.jsonl:1: does not" 'sed -i "1s/\"turns\":2/\"turns\":13/" events.jsonl'
spoilt "angles.jsonl: $cut_short" ': >angles.jsonl'
spoilt "angles.jsonl: $cut_short" 'sed -i "2,\$d" angles.jsonl'
seals=$(grep -c '"event":"sealed"' again/events.jsonl)
spoilt "angles.jsonl: $cut_short" ': >angles.jsonl; sed -i "\$d" events.jsonl
  head -c "$(sed -n "\$s/.*\"flips.jsonl\":{\"bytes\":\([0-9]*\).*/\1/p" events.jsonl)" ../again/flips.jsonl >flips.jsonl'
holds 'a cut where the flips are stated was one' "$(grep -c '"event":"sealed"' spoilt/events.jsonl) == $seals - 1"
# A power failure at any byte of a log: the rest is printed exactly, or it is said why not.
wrong=0 resumed=0
from() { print --resume "$1" --plan --commands 2>errors | sed -n 's/^vam-project .*--turns \([0-9]*\) --from \([0-9.]*\) .*&$/\1 \2/p' | awk '{ print 720 - 360 * $1 + $2 }'; }
whole_from=$(from again)
for cut in $(python3 -c "import random, os; random.seed(7)
for log in 'events', 'flips', 'angles', 'stage':
    for n in range(8): print(log + ':%d' % random.randrange(os.path.getsize('again/%s.jsonl' % log) + 1))"); do
  log=${cut%:*}; rm -rf spoilt; cp -r again spoilt; head -c ${cut#*:} again/$log.jsonl >spoilt/$log.jsonl
  is_from=$(from spoilt)
  case ${is_from:+resumed}:$log in
    resumed:flips) holds "$cut: light is given twice for hardly more than a second" "$whole_from - $is_from < 135 && $is_from <= $whole_from"; resumed=$((resumed + 1)) ;;
    resumed:*) [ "$is_from" = "$whole_from" ] || wrong=$((wrong + 1)); resumed=$((resumed + 1)) ;;
    *) [ "$(grep -Ec "^vam-print: spoilt(/$log.jsonl)?: " errors) $(wc -l <errors)" = '1 1' ] || { wrong=$((wrong + 1)); sed "s/^/# $cut: /" errors; } ;;
  esac
done
is 'cut at any byte: exactly, or one line' "$wrong" 0
holds 'some can be resumed' "$resumed > 2"
rm -r spoilt; cp -r again spoilt; rm spoilt/printer.toml
for tool in vam-check vam-status 'print --run none --resume'; do
  fails 65 'spoilt/printer.toml: is gone, without which the print can be neither resumed nor its dose computed' $tool spoilt
done
fails 66 'spoilt/printer.toml: is gone; restore it, or give' vam-dose frames.exr --shown spoilt/flips.jsonl -o none.vdb
rm -r spoilt; cp -r again spoilt
: >spoilt/flips.jsonl
fails 65 "^vam-print: spoilt/flips.jsonl: $cut_short" print --resume spoilt --run none
is 'what is refused leaves no mark' "$(ls spoilt/resumed.json none 2>/dev/null)" ''
# The rest is printed with the same dose at the same position.
other='again: printed with other settings: vial.radius_mm 12.7, now 12.72; stage.speed_deg_s 90.0, now 40.0; '
set_other() { "$@" --set stage.speed_deg_s=40 --set vial.radius_mm=12.72; }
fails 65 "$other" set_other print --resume again --run none
is 'by its plan, too' "$(set_other print --resume again --plan 2>&1 | grep -c "$other")" 1
is 'unless accepted' "$(set_other print --resume again --plan --accept-printer 2>&1 | grep -c "$other""accepted")" 1
mkdir edited; for name in printer.toml flips.jsonl events.jsonl angles.jsonl stage.jsonl; do cp again/$name edited; done
(cd edited && find . -type f ! -name SHA256SUMS -exec sha256sum {} + >../sums && mv ../sums SHA256SUMS)
ok 'a print with its hashes' vam-dose frames.exr --printer whole/printer.toml --shown edited -o edited.vdb
for name in flips.jsonl printer.toml; do
  cp edited/$name kept; sed -i 2d edited/$name
  fails 65 "edited/$name: changed after the print" vam-dose frames.exr --printer whole/printer.toml --shown edited -o none.vdb
  fails 65 "edited/$name: changed after the print" print --resume edited --run none
  mv kept edited/$name
done
# As vam-check, vam-status and vam-dose do, by the same check: also where there is a summary but no list.
cp -r edited summed; rm summed/SHA256SUMS; sed '/"outcome"/d; s/"reached": .*/"reached": null,/' whole/summary.json >summed/summary.json
ok 'a print without its list is resumed' print --resume summed --plan
sed -i 's/"angle_deg":1/"angle_deg":2/' summed/flips.jsonl
for tool in 'vam-check summed' 'vam-status summed' 'print --resume summed --run none'; do
  fails 65 "summed/flips.jsonl:$changed" $tool
done
echo note >edited/note.txt; mv edited 'moved & edited'
ok 'a folder that was moved, with a file more' vam-dose frames.exr --printer whole/printer.toml --shown 'moved & edited' -o edited.vdb
mv 'moved & edited' edited
cp edited/SHA256SUMS kept
for cut in 'head -c 100' 'head -c 0' 'grep -v flips'; do
  $cut kept >edited/SHA256SUMS
  fails 65 'SHA256SUMS: (has no hash of [a-z]*.[a-z]*; it was cut or changed; restore it, or delete it|is empty; it was cut|line 1: is not a hash|line 2: is not a hash)' vam-dose frames.exr --printer whole/printer.toml --shown edited -o none.vdb
  fails 65 "^vam-print: $(sed 's/^[^:]*: //;s/[()]/./g' .log/err)$" print --resume edited --run none
done
mv kept edited/SHA256SUMS; mv edited/events.jsonl kept
fails 65 'edited/events.jsonl: is gone, but SHA256SUMS lists it; restore it' vam-dose frames.exr --printer whole/printer.toml --shown edited -o none.vdb
mv kept edited/events.jsonl
fails 65 'home=here, whose zero ended with the print' print --resume again --set 'stage.device=grbl:/dev/ttyACM0?home=here' --run none
is 'another device is not a different setting' "$(print --resume again --plan --set 'stage.device=sim:' --set resin.name=new 2>&1 | grep -c 'other settings')" 0
cp -r whole unset && rm unset/printer.toml unset/SHA256SUMS
fails 66 'unset/printer.toml: is gone; restore it, or give the settings of the print by --printer' vam-dose frames.exr --shown unset -o none.vdb
ok 'the settings beside a log are those of the run' sh -c "vam-dose frames.exr --shown whole -o a.vdb --report a.json &&
  vam-dose frames.exr --shown whole/flips.jsonl -o b.vdb --report b.json"
is 'with the same turns' "$(json b.json shown_turns)" "$(json a.json shown_turns)"
fails 65 'whole: was printed with other settings: stage.speed_deg_s 90, now 60; omit --printer and --set' vam-dose frames.exr --shown whole --set stage.speed_deg_s=60 -o none.vdb
fails 65 'whole: was printed with other settings: projector.max_intensity_mw_cm2 3.8, now 10; omit' vam-dose frames.exr --shown whole --set projector.max_intensity_mw_cm2=10 -o none.vdb
ok 'the settings of a run are its own' env VAM_PRINTER=nowhere vam-dose frames.exr --shown whole -o own.vdb
# A disk that fills during the print.
mkdir small
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=200k none small 2>/dev/null; then
  trap 'umount small 2>/dev/null; rm -rf "$scratch"' EXIT
  print --turns 50 --run small/run --light "sim:?log=$PWD/full-leds" >full.out 2>full.err & full=$!
  await grep -qs '"frame":[0-9]' small/run/flips.jsonl
else
  full=
  echo '# no small disk can be mounted: none is filled'
fi
print --turns 50 --run hang 2>hang.err & hang=$!
await grep -qs '"frame":[0-9]' hang/flips.jsonl
dose() { vam-dose frames.exr --printer whole/printer.toml --report "$1.json" -o "$1.vdb" $2; }
ok 'the dose of a run' dose whole.dose '--shown whole'
ok 'that of a killed one' dose killed.dose '--shown killed'
ok 'and of both parts' dose both.dose '--shown killed --shown rest/flips.jsonl'
is 'without a word' "$(cat .log/err)" ''
ok 'that of the rest alone' dose rest.dose '--shown rest'
is 'with one' "$(cat .log/err)" 'vam-dose: warning: rest: resumes killed, whose light is not counted; give it, too: --shown killed'
holds 'a whole print delivered its turns' "($(json whole.dose.json shown_turns) - 2) ^ 2 < 0.02 ^ 2"
holds 'a killed one fewer' "$(json killed.dose.json shown_turns) > 1.2 && $(json killed.dose.json shown_turns) < 1.9"
# One image of 480 at each end of either part; a blank of a busy machine is an image more or less.
mkdir dimmer; cp rest/flips.jsonl dimmer/
sed 's/^max_intensity_mw_cm2 = 3.8/max_intensity_mw_cm2 = 1.9/; /^# sealed/d' rest/printer.toml >dimmer/printer.toml
ok 'and of a dimmer rest' dose dimmer.dose '--shown killed --shown dimmer'
holds 'which counts half' "($(json dimmer.dose.json shown_turns) - ($(json both.dose.json shown_turns) + $(json killed.dose.json shown_turns)) / 2) ^ 2 < 0.02 ^ 2"
holds 'both parts together the whole' "($(json both.dose.json shown_turns) - $(json whole.dose.json shown_turns)) ^ 2 < 0.02 ^ 2"
holds 'and its dose, everywhere' "($(json both.dose.json dose_shown_max_relative) / $(json whole.dose.json dose_shown_max_relative) - 1) ^ 2 < 0.03 ^ 2"
fails 65 'rest: complete, all 1 turns; nothing is left to print' print --resume rest --run none
fails 66 'nowhere: not a folder; give the run folder of vam-print' print --resume nowhere --run none
fails 64 '.--turns: conflicts with --resume' print --resume again --turns 3 --run none
$exr make other.exr space=projector width=64 height=36 count=2
fails 65 'other.exr: is not the sinogram of whole, whose SHA-256 begins' vam-dose other.exr --printer whole/printer.toml --shown whole -o none.vdb
fails 65 'other.exr: not the sinogram of killed' vam-print other.exr --display null: --resume killed --run none
fails 65 'none: no light was shown|no light was shown' sh -c ': >empty; vam-dose frames.exr --shown empty -o x.vdb; status=$?; rm -f empty; exit $status'
fails 64 './killed/flips.jsonl is given twice' vam-dose frames.exr --shown killed --shown ./killed/flips.jsonl -o x.vdb
fails 66 'nowhere' vam-dose frames.exr --shown nowhere -o x.vdb
fails 65 'other.exr: is not the sinogram of whole' vam-status whole --page page.html --sinogram other.exr

# A projector that hangs is ended; how long its last image stayed on is logged.
printing=$hang
kill -STOP "$(pgrep -s 0 -f 'vam-project .*--printer hang/printer.toml' | head -n 1)"
wait $printing
is 'a hanging projector ends the print' "$? $(grep -c 'project was stopped by a signal and is ended' hang.err)" '137 1'
is 'how long its image stayed on is said' "$(grep -Ec 'warning: the last image stayed on for [0-9.]+ s, while the stage turned by [0-9]+ deg' hang.err)" 1
on=$(tail -n 2 hang/flips.jsonl | grep -o '"t_monotonic_s":[0-9.]*' | cut -d: -f2 | awk 'NR == 1 { on = $1 } NR == 2 { printf "%.3f", $1 - on }')
holds 'and logged' "$on > 0.3 && $on < 3"
is 'as black' "$(tail -n 1 hang/flips.jsonl | grep -o '"frame":-1.*"by":"vam-print"' | wc -l)" 1
fails 74 'standard output: write failed' sh -c 'vam-print frames.exr --display null: --uncalibrated --plan >/dev/full'

if [ -n "$full" ]; then
  wait $full
  is 'a full disk ends a print' "$? $(grep -c 'No space left on device' full.err)" '74 1'
  # Where the end of the light could not be logged, its time is the latest at which vam-print knows it to be over.
  is 'reported with the name of the tool or of the file' \
    "$(grep -Ev '^vam-[a-z]+: .*small/run|^vam-print: warning: the last image stayed on for 0[.][0-9]+ s' full.err)" ''
  is 'the light is off' "$(grep -o '"bits":[0-9]*' full-leds | tail -n 1)" '"bits":0'
  is 'and a summary is written' "$(json small/run/summary.json status) $(json small/run/summary.json outcome | grep -c failed)" '74 1'
  holds 'which states the progress' "$(json small/run/summary.json reached.lit_flips) > 0"
  umount small
  mount -t tmpfs -o size=60k none small
  fails 74 '^vam-print: small/run: has no room for 64 kB' print --run small/run
  umount small
fi
done_testing
