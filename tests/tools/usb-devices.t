# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# USB devices through the real libusb, on simulated buses: the Tic stage, and the DLPC350 and DLPC900 light engines,
# with each possible fault in turn. All run in parallel, as most of the time is waiting.
. "$VAM_SOURCE/tests/tools/testlib.sh"
ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0  # what is preloaded for the simulated bus keeps 16 bytes
touch second
tiny_print part.exr
on() { umockdev-wrapper "$VAM_BUILD/usb_host" "$@"; }  # on DEVICE LOG PROGRAM...
begin() {  # begin NAME DEVICE PROGRAM...: on a bus and with a lock of its own
  name=$1; device=$2; shift 2; mkdir "$name"
  (VAM_LOCK_DIR=$PWD/$name; on "$device" "$name/truth" "$@" >"$name/out" 2>"$name/err"; echo $? >"$name/status") &
}
ended() {  # ended NAME STATUS REGEX: with that status, and such a line on stderr, or none
  is "$1: status" "$(cat "$1/status")" "$2"
  if [ -n "$3" ]; then ok "$1: reports '$3'" grep -Eq -- "$3" "$1/err"; else is "$1: silent" "$(cat "$1/err")" ''; fi
}
bits() { grep -o '"bits":[0-9]*' "$1/truth" | tr '\n' ' '; }
asleep() { tail -n 1 "$1/truth" | grep -c '"event":"asleep"'; }
grey='vam-project --pattern grey -o null: --hold'

begin found tic: vam-stage identify --device 'tic:?steps_per_deg=100'
begin moved tic: vam-stage move --device 'tic:00312345?steps_per_deg=100' --home --angle 20 --speed 90
begin foreign tic: vam-stage identify --device 'tic:999?steps_per_deg=100'
begin missing dlpc350: $grey 0.05 --light dlpc900:
for engine in dlpc350 dlpc900; do
  begin $engine "$engine:?slow_reads=3" \
    vam-project part.exr -o null: --light "$engine:?current_percent=33.4" --speed 360 --max-missed 1
done
begin asked-too-much dlpc900: $grey 0.05 --light dlpc900:?current_percent=60 --set projector.max_led_current_percent=50
begin found-too-bright dlpc350:?current_percent=47 $grey 0.05 --light dlpc350:
begin stuck-grey dlpc900:?stuck_grey=yes $grey 0.05 --light dlpc900:
prepared=30  # reports
for fault in error unplug; do begin $fault "dlpc900:?fault=$fault&fault_after=9" $grey 0.05 --light dlpc900:; done
for fault in silent late garbage truncated wrong-sender; do  # on the command to switch on
  begin $fault "dlpc900:?fault=$fault&fault_after=$prepared" $grey 0.05 --light dlpc900:
done

# One user at a time, named to the second; a killed one leaves the engine dark and in standby.
mkdir killed; : >killed/truth
on dlpc900: killed/truth $grey 60 --light dlpc900: 2>killed/err & first=$!
await grep -q '"bits":4' killed/truth
holder=$(cat "$VAM_LOCK_DIR"/*)
fails 75 "in use by process $holder;" on dlpc900: second $grey 0.05 --light dlpc900:
kill -9 "$holder"; wait $first 2>/dev/null
is 'dark after its user was killed' "$(bits killed)" '"bits":0 "bits":4 "bits":0 '
is 'and in standby' "$(asleep killed)" 1

wait
ended found 0 ''
is 'a Tic is found' "$(json found/out model) $(json found/out serial)" 'Tic T825 00312345'
ended moved 0 ''
holds 'to the requested angle' "$(tail -n 1 moved/truth | json /dev/stdin angle_deg) == 20"
ended foreign 69 'no such device'
ended missing 69 'no such device'
for engine in dlpc350 dlpc900; do
  ended $engine 0 ''
  is "$engine: off, on, off" "$(bits $engine)" '"bits":0 "bits":4 "bits":0 '
  is "$engine: with linear grey and the requested current" \
    "$(grep '"bits":4' $engine/truth | grep '"linear":true' | grep -c '"current_percent":\[33.3,33.3,33.3\]')" 1
  is "$engine: and in standby at the end" "$(asleep $engine)" 1
done
ended asked-too-much 64 'current of 60 % is above the limit of 50 %'
ended found-too-bright 76 'LED current is 47.1 %, above the limit of 40 %'
ended stuck-grey 76 'video pattern mode was set to 02 but reads back as 00'
ended error 76 'was refused'
ended unplug 69 'NO_DEVICE'
for name in asked-too-much found-too-bright stuck-grey error unplug; do
  is "$name: no light" "$(grep -c '"bits":[1-9]' $name/truth)" 0
done
ended silent 75 'sent no report .LIBUSB_ERROR_TIMEOUT'
ended late 75 'sent no report .LIBUSB_ERROR_TIMEOUT'
for name in garbage truncated wrong-sender; do ended $name 76 'answered with another command'; done
for name in silent late garbage truncated wrong-sender; do
  is "$name: dark again" "$(bits $name)" '"bits":0 "bits":4 "bits":0 '
  is "$name: and in standby" "$(asleep $name)" 1
done
done_testing
