# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# A print whose stage replies wrongly, by every kind of fault in turn: it ends dark and at standstill, with the right status.
. "$VAM_SOURCE/tests/tools/testlib.sh"
. "$VAM_SOURCE/tests/tools/printlib.sh"

screen_up 64 48
# Each kind of wrong reply, one second after the light came on.
spoilt() {  # spoilt NAME STATUS REGEX FAULT
  begin "$1" --fault "$4"
  ok "$1: the print has begun" lit
  aborted "$2" 'stage failed' "$3"
}
spoilt garbage 76 'was answered' garbage@POS?:250
spoilt truncated 75 'no end of the answer' truncated@POS?:250
spoilt late 75 'no answer' late@POS?:250
spoilt wrong-sender 76 'controller 7 instead of 1' wrong-sender@POS?:250
spoilt blocked 76 'was expected|is blocked' block@POS?:250
spoilt unplugged 69 'unplugged' unplug@POS?:250
launch refused --fault error@VEL
aborted 76 'stage failed' 'refused with error 17'
begin busy
env LD_PRELOAD="$shim" vam-print frames.exr --display sdl:0 --uncalibrated --run second 2>second-errors
is 'a second print is refused' "$? $(grep -c 'in use by process' second-errors)" '75 1'
kill -TERM $printing
aborted 143 aborted ''
screen_down
done_testing
