# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# What vam-calibrate all repeats and what it refuses, with stand-ins for its tools: each call takes the next line of
# NAME.answers, "STATUS MESSAGE", and succeeds when none is left; all calls are written to calls.
. "$VAM_SOURCE/tests/tools/testlib.sh"
mkdir stubs
cat >stubs/answer <<'SH'
echo "${0##*/} $*" >>calls
name=${0##*/}.answers
if [ -s $name ]; then
  read -r status message <$name
  sed -i 1d $name
  [ "$status" = 0 ] || { echo "${0##*/}: $message" >&2; exit "$status"; }
fi
SH
cat >stubs/vam-capture <<'SH'
. stubs/answer
case " $* " in *' --follow - '*) read -r line || { echo 'vam-capture: stdin: is empty' >&2; exit 65; } ;; esac
case $1 in identify) echo '{"model": "stand-in"}' ;; *) shift $(($# - 1)); : >"$1" ;; esac
SH
cat >stubs/vam-stage <<'SH'
. stubs/answer
case $1 in identify) printf '{\n  "max_speed_deg_s": 90\n}\n' ;; spin) echo '{"t_monotonic_s":1,"angle_deg":0,"sigma_deg":0}' ;; esac
SH
cat >stubs/vam-calibrate <<'SH'
. stubs/answer
SH
cat >stubs/vam-project <<'SH'
case " $* " in
  *' --plan '*) . stubs/answer; exit ;;
esac
echo "${0##*/} $*" >>calls
while [ "$1" != --log ]; do shift; done
echo '{"event":"flip","frame":0}' >>"$2"
exec perl -e 'sleep 60'
SH
for stub in stubs/*; do sed -i '1i #!/bin/sh' $stub; chmod +x $stub; done
cp "$VAM_BUILD/bin/vam-calibrate" stubs/calibrate  # which finds the tools beside it
printf '%s\n' '[camera]' 'fps = 50' 'exposure_us = 100' '[stage]' 'speed_deg_s = 60' >printer.toml

calibrate() {  # calibrate SCANS: $status, events, errors
  rm -f events calls
  stubs/calibrate all --display null: --light sim: --scans "$1" --log events >errors 2>&1; status=$?
  rm -f ./*.answers
}
repeated() { grep -o '"event":"repeated","scan":"[a-z]*","status":[0-9]*,"attempt":[0-9]' events | cut -d: -f3- | tr '\n' ' '; }
answers() { name=$1; shift; printf '%s\n' "$@" >"$name.answers"; }

calibrate latency
is 'nothing is repeated without a reason' "$status$(repeated)" 0
stubs/calibrate all --display null: --light sim: --scans latency --log - 2>errors
is '--log -: events on standard error, and no file of that name' \
  "$(grep -c '"event":"[a-z]*","scan":"latency"' errors) $(ls ./- 2>&1 | grep -c 'No such')" "$(grep -c '"scan":"latency"' events) 1"
rm -f ./*.answers
# Its first answer is that of identify.
answers vam-capture 0 '75 2 of 150 frames were lost'
calibrate latency
is 'lost frames: once more' "$status $(repeated)" '0 "latency","status":75,"attempt":1 '
is 'and nothing is said' "$(cat errors)" ''
answers vam-capture 0 '75 lost' '75 lost' '75 lost the third time'
calibrate latency
is 'three times lost: the last reason' "$status $(cat errors)" '75 vam-capture: lost the third time'
is 'after two repetitions' "$(repeated)" '"latency","status":75,"attempt":1 "latency","status":75,"attempt":2 '
answers vam-capture 0 '69 no camera'
calibrate latency
is 'an absent camera: at once' "$status $(cat errors)$(repeated)" '69 vam-capture: no camera'

answers vam-calibrate '1 latency: standard deviation is 0.8 ms, above 0.5 ms' '1 latency: standard deviation is 0.7 ms, above 0.5 ms'
calibrate latency
is 'an imprecise latency: twice more' "$status $(repeated)" '0 "latency","status":1,"attempt":1 "latency","status":1,"attempt":2 '
answers vam-calibrate '1 lag: standard deviation is 0.8 ms, above 0.5 ms'
calibrate lag
is 'an imprecise lag: both turns again' "$status $(repeated)$(grep -c 'vam-stage spin' calls)" '0 "lag","status":1,"attempt":1 4'
answers vam-calibrate '1 latency: no blinks were seen'
calibrate latency
is 'another failure of the measurement: at once' "$status $(cat errors)$(repeated)" '1 vam-calibrate: latency: no blinks were seen'
answers vam-calibrate '65 axis: standard deviation'
calibrate axis
is 'nor is bad data' "$status $(repeated)" '65 '
answers vam-stage 0 '75 in use by process 1'
calibrate lag,latency
is 'a stage in use: the turn is repeated' "$status $(repeated)" '0 "lag","status":75,"attempt":1 '

answers vam-stage '75 no answer' '75 no answer'
calibrate latency
is 'a late answer to identify is asked for again' "$status $(grep -c 'vam-stage identify' calls)" '0 3'

# The display and the light engine are tried before anything moves.
answers vam-project '69 dlpc350: no such device'
calibrate lag,latency
is 'an absent light engine ends it' "$status $(cat errors)" '69 vam-project: dlpc350: no such device'
is 'the event of a failure before any scan names none' "$(grep -c '"event":"failed","status":69[,}]' events)" 1
is 'before anything moves or shines' "$(grep -Ec 'spin|move|--repeat|--frames' calls)" 0
calibrate latency
is 'by the plan of this display and light' "$(grep -c -- '--plan -o null: --light sim:' calls)" 1
done_testing
