# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# trials: 100
# A print that is killed, or ended by a signal, in each state of its life [vam-print(1), States], and of which a tool is
# killed or stopped in it: nothing of it runs on, the light is off, and the rest can be resumed or is refused in one line.
# "long": every cause in every state, a fifth of VAM_TRIALS (100) each; else a kill of the print in each, the others in one.
. "$VAM_SOURCE/tests/tools/testlib.sh"
trials=$(((${VAM_TRIALS:-5} + 4) / 5))
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration=180&max_speed=360&min_angle=-1e7&max_angle=1e7"\nspeed_deg_s = 180\n' >>printer.toml
print() { vam-print frames.exr --display null: --uncalibrated --max-missed 0.9 --max-missed-lit 0.9 "$@"; }
reached() {  # reached STATE: that print, by its logs
  case $1 in
    arming) [ -e $run/printer.toml ] ;;
    armed) [ -s $run/events.jsonl ] ;;
    homed) grep -qs '"event":"started"' $run/events.jsonl ;;
    turning) [ -s $run/angles.jsonl ] ;;
    lit) grep -qs '"frame":[0-9]' $run/flips.jsonl ;;
    dark) grep -qs '"event":"end"' $run/flips.jsonl ;;
    still) grep -qs '"tool":"stage"' $run/events.jsonl ;;
  esac || over
}
over() { ! readlink /proc/$printing/exe >/dev/null; }
found() { [ $tool = vam-print ] && victim=$printing || victim=$(pgrep -P $printing -x $tool) || over || [ $turns -eq 1 ]; }
gone() { ! pgrep -f "$run/printer[.]toml" >/dev/null; }
ended_well() {  # what is left can be resumed, or is refused, in one line
  [ -d $run ] || return 0
  print --light sim: --run none --resume $run --plan >plan.txt 2>errors; status=$?
  [ $status -eq 0 ] || { [ "$(wc -l <errors)" = 1 ] && grep -Eq "^vam-print: ($run|frames)" errors; }
}
one() {  # one STATE SIGNAL VICTIM: prints what is wrong
  run=$1-$2-$3-$trial
  (exec env --default-signal=INT vam-print frames.exr --display null: --uncalibrated --max-missed 0.9 --max-missed-lit 0.9 \
    --light "sim:?log=$PWD/$run.leds" --run-up 0.3 --turns $turns --run $run) 2>said & printing=$!
  await reached $1
  tool=vam-$3; await found
  kill -$2 $victim 2>/dev/null
  wait $printing 2>/dev/null
  await gone || echo "$run: runs on: $(pgrep -af "$run/printer[.]toml" | head -n 1)"
  case $3 in project) ;; *) grep -o '"bits":[0-9]*' $run.leds 2>/dev/null | tail -n 1 | grep -q '[1-9]' && echo "$run: the light is on" ;; esac
  ended_well || echo "$run: $status: $(cat errors)"
}
turns=40  # longer than anybody waits
set -- TERM:print INT:print KILL:stage KILL:project STOP:stage STOP:project TERM:print
for state in arming armed homed turning lit dark still; do
  [ $state != dark ] || turns=1
  causes="KILL:print $1"; shift
  [ $trials -eq 1 ] || causes='KILL:print TERM:print INT:print KILL:stage KILL:project STOP:stage STOP:project'
  for cause in $causes; do
    case $state:$cause in arm*:stage | arm*:project) continue ;; esac
    for trial in $(seq $trials); do one $state ${cause%:*} ${cause#*:}; done >wrong 2>&1
    [ ! -s wrong ]; report $? "$state, $cause"
    sed 's/^/# /' wrong
  done
done
done_testing
