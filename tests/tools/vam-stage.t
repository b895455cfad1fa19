# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
. "$VAM_SOURCE/tests/tools/testlib.sh"
shim=$(vam-sim stage --shim)

stage() { command=$1; shift; LD_PRELOAD=$shim vam-stage "$command" --device "gcs:$PWD/stage" "$@"; }
turning() { tail -n 1 truth | grep -q '"speed_deg_s":1\.0'; }

# Wrong options open nothing.
fails 64 'not a number' vam-stage spin --device 'sim:?jitter=much'
fails 69 'not a serial port' vam-stage identify --device gcs:/dev/null
fails 73 'cannot be written' vam-stage identify --log missing/log

# The stage is that of the printer file; a simulated one is used only if it is named.
mkdir lab; printf '[stage]\ndevice = "grbl:/dev/nope"\nturns = 3\n' >lab/printer.toml
printf '[stage]\ndevice = "usb:1"\n' >lab/odd.toml
fails 64 'stage: no device is set; give --device, or stage.device in the printer file, .*; sim: is a simulated one' vam-stage home --log why
(cd lab && vam-stage home) 2>said
is 'the stage of ./printer.toml' "$? $(grep -c "^vam-stage: /dev/nope: not a serial port" said)" '69 1'
fails 69 '/dev/nope' env VAM_PRINTER=lab/printer.toml vam-stage home
fails 69 '/dev/nope' vam-stage home --printer lab/printer.toml
fails 65 "odd.toml:2: stage.device: 'usb:1': unknown device scheme" vam-stage home --printer lab/odd.toml
fails 65 'use one of gcs:, tic:, grbl:, zaber:, sim:' vam-slice --shape gyroid --printer lab/odd.toml --fit-writable -o no.vdb
fails 64 "camera.device: 'webcam': unknown device scheme" vam-stage home --set camera.device=webcam
for scheme in $(vam-stage home --help=all | tr ' ,' '\n\n' | sed -n 's/^\([a-z0-9]*\):[A-Z][A-Z]*$/\1/p' | sort -u) sim; do
  ok "the printer file accepts $scheme:" vam-stage home --print-printer --set "stage.device=$scheme:x"
done
ok 'options may precede the command' vam-stage --device sim: identify
ok '--device overrides the printer file' vam-stage identify --device sim: --printer lab/printer.toml --log events
is 'a simulated stage is marked in the log' "$(grep -c '"device":"sim:".*"simulated":true' events)" 1
rm events

# The simulator inside the tool.
vam-stage identify --set stage.device=sim: >about
is 'the model is marked as simulated' "$(json about model) $(json about simulated)" 'C-863.11 true'
ok 'ports' vam-stage ports
quiet 'move' vam-stage move --device 'sim:?acceleration=1000&start_angle=3' --home --angle 20 --speed 80
fails 65 '20 deg is beyond its limits of travel, -36000 to 10 deg; give another --angle' vam-stage move --device 'sim:?acceleration=1000&start_angle=3&max_angle=10' --home --angle 20
vam-stage follow --device sim: --duration 0.2 --rate 50 >samples
is 'follow prints its samples' "$(wc -l <samples)" 10
holds 'and reports the stage angle' "$(sed -n 3p samples | json /dev/stdin angle_deg) == 17"

# The same controller behind a serial line.
stage_up --acceleration 5000 --max-speed 720
stage identify >about
is 'identify over the line' "$(json about serial)" 0116012345
quiet 'home over the line' stage home
stage spin --speed 360 --run-up 0.25 --turns 1 --log events >samples 2>errors
is 'spin has status 0' $? 0
is 'the ramp is marked, and no more' "$(grep -c '"ramp":true' samples) $(awk -F '[:,]' '/"ramp"/ && $4 > -90' samples | grep -c .)" \
  "$(sed -n '/"ramp"/=' samples | tail -n 1) 0"
is 'and prints no message' "$(cat errors)" ''
holds 'the last angle is beyond the turn' "$(tail -n 1 samples | json /dev/stdin angle_deg) >= 360"
holds 'the first angle is before the run-up' "$(head -n 1 samples | json /dev/stdin angle_deg) < -90"
ok 'the stage is at standstill' stood
is 'two events' "$(wc -l <events)" 2
ok 'with both times' grep -Eq '"utc":"20[0-9-]+T[0-9:.]+Z","t_monotonic_s":[0-9.]+,"event":"end"' events

# A controller has no reference after power-on, and setting its zero creates none.
stage_down
stage_up --acceleration 5000 --max-speed 720
for try in 1 2; do
  fails 65 'not referenced: .*--home, or run `vam-stage home`' stage spin --speed 360 --run-up 0.25
  fails 65 'not referenced' stage spin --speed 360 --plan
done
fails 65 'not referenced' stage move --angle 3
is 'no motion and no setting' "$(grep -Ec '"moving"|POS 1' truth)" 0
stage home

# A second user is refused at once, with the pid of the first.
LD_PRELOAD=$shim vam-stage spin --device "gcs:$PWD/stage" --speed 1 >/dev/null &
first=$!
await turning
if chrt -r 2 true 2>/dev/null; then
  urgency() { chrt -p "$1" | sed -n 's/.*priority: //p'; }
  is 'real-time priority, that of the guardian higher' "$(urgency $first) $(urgency "$(pgrep -P $first)")" '1 2'
else
  echo '# no leave for real-time priorities: not tried'
fi
start=$(date +%s%N)
fails 75 "in use by process $first;" stage status
holds 'within a second' "$(date +%s%N) - $start < 1e9"
kill -9 $first 2>/dev/null; wait $first
is 'a user of the device is killed' $? 137
sleep 0.1
ok 'the device is free again' stage status
stage status >state
is 'and the stage is at standstill' "$(json state moving)" false
stage_down

# Any user can open the simulated line, one after the other. Root, who has all permissions, becomes nobody for this.
anybody() { if [ "$(id -u)" -eq 0 ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi; }
mkdir plain; chmod 777 plain; chmod 755 .
cat >twice.sh <<'SH'
cd plain; VAM_LOCK_DIR=$PWD; export VAM_LOCK_DIR
vam-sim stage --link line --die-with-parent >path &
for try in 1 2 3 4 5 6 7 8 9; do [ -s path ] || sleep 1; done
for user in first second; do LD_PRELOAD=$1 vam-stage status --device "gcs:$PWD/line" >$user || exit; done
kill $!
SH
if anybody vam-stage --version >/dev/null 2>&1; then
  quiet 'the simulated line serves every user' anybody sh twice.sh "$shim"
else
  echo '# nobody may not run these programs: not tried'
fi

# Baud rates are detected, and the wait for a silent line is bounded.
stage_up --baud 9600
stage identify >about
is 'the baud rate is found' "$(json about model)" C-863.11
LD_PRELOAD=$shim vam-stage identify --device "gcs:$PWD/stage?baud=115200" 2>errors
is 'a wrong baud rate gives a malformed reply or none' "$(case $? in 75 | 76) echo refused ;; esac)" refused
stage_down

# The second controller of a daisy chain: every command is addressed to it, the stop command of the guardian included.
stage_up --address 2 --acceleration 5000 --max-speed 720
LD_PRELOAD=$shim vam-stage spin --home --device "gcs:$PWD/stage?address=2" --speed 1 >/dev/null &
chained=$!
await turning
kill -9 $chained; wait $chained 2>/dev/null
await stood
ok 'after SIGKILL a stage in a chain is at standstill' stood
stage_down

# A GRBL board that is reset when its port is opened has lost its position.
stage_up --protocol grbl --reset-at-open
for try in 1 2 3; do
  fails 65 'not referenced: the position of its zero is unknown; give --home, or run `vam-stage home`' \
    env LD_PRELOAD=$shim vam-stage spin --device "grbl:$PWD/stage" --speed 60
done
is 'no motion, and the board is not unlocked' "$(grep -Ec '"moving"|[$]X' truth)" 0
stage_down

# A GRBL board without homing switches: its zero is where it stands, for one command.
stage_up --protocol grbl --no-switches --reset-at-open --acceleration 5000 --max-speed 720
board() { verb=$1; shift; LD_PRELOAD=$shim vam-stage $verb --device "grbl:$PWD/stage?home=here" "$@"; }
fails 64 'home=there is not one of switch, here' vam-stage home --device "grbl:$PWD/stage?home=there"
fails 76 'no homing switches, [$]22=0.; add [?]home=here' env LD_PRELOAD=$shim vam-stage home --device "grbl:$PWD/stage"
fails 65 'not referenced' board spin --speed 360
fails 65 'home=here: its zero lasts for one command' board home
fails 65 'home=here: .*give --relative' board move --home --angle 90
quiet 'a motion by an angle' board move --relative --angle 30 --speed 360
board spin --home --speed 360 --run-up 0.25 --rate 100 >samples
is 'home=here: spin' "$?" 0
holds 'from where it stood' "$(head -n 1 samples | json /dev/stdin angle_deg) < -90 && $(tail -n 1 samples | json /dev/stdin angle_deg) >= 360"
stage_down
stage_up --protocol grbl
fails 65 'finds its switches .[$]22=1.; omit home=here' board spin --home --speed 60
stage_down

# A GRBL board instead.
stage_up --protocol grbl --acceleration 5000 --max-speed 720
fails 64 'not one of X, Y, Z' vam-stage identify --device "grbl:$PWD/stage?axis=A"
LD_PRELOAD=$shim vam-stage spin --home --device "grbl:$PWD/stage" --speed 360 --run-up 0.25 --rate 1 >samples
is 'one sample per second does not count as a hang' $? 0
holds 'GRBL rotates, too' "$(tail -n 1 samples | json /dev/stdin angle_deg) >= 360"
ok 'and is at standstill' stood
stage_down

# A Zaber stage, the second of its chain: it moves only when homed, and every command has its address.
for old in '' --old-firmware; do
  stage_up --protocol zaber $old --address 2 --acceleration 5000
  zaber() { verb=$1; shift; LD_PRELOAD=$shim vam-stage $verb --device "zaber:$PWD/stage?address=2" "$@"; }
  fails 65 'not referenced' zaber spin --speed 360
  fails 75 'no answer' env LD_PRELOAD=$shim vam-stage identify --device "zaber:$PWD/stage"
  fails 76 'BADAXIS' env LD_PRELOAD=$shim vam-stage identify --device "zaber:$PWD/stage?address=2&axis=2"
  fails 64 'axis' env LD_PRELOAD=$shim vam-stage identify --device "zaber:$PWD/stage?axis=X"
  zaber spin --home --speed 360 --run-up 0.25 --rate 1 >samples
  holds "Zaber${old:+ ($old)} rotates, too" "$(tail -n 1 samples | json /dev/stdin angle_deg) >= 360"
  ok 'and is at standstill' stood
  LD_PRELOAD=$shim vam-stage spin --device "zaber:$PWD/stage?address=2" --speed 1 >/dev/null & chained=$!
  await turning
  kill -9 $chained; wait $chained 2>/dev/null
  await stood
  ok 'after SIGKILL a Zaber stage is at standstill' stood
  stage_down
done
fails 64 'steps_per_deg' vam-stage identify --device tic:
fails 69 'no such device|not available' vam-stage identify --device 'tic:?steps_per_deg=10'

# Injected faults: the error names the fault, and the stage is at standstill.
spoilt() {  # spoilt STATUS REGEX FAULT
  stage_up --acceleration 5000 --max-speed 720 --start-angle 1 --fault "$3"
  fails "$1" "$2" stage spin --home --speed 360 --run-up 0.25
  case $3 in unplug*) ;; *) await stood; ok "$3: the stage is at standstill" stood ;; esac
  stage_down
}
spoilt 76 'was answered' garbage@POS?:20
spoilt 75 'no end of the answer' truncated@POS?:20
spoilt 75 'no answer' late@POS?:20
spoilt 75 'no answer' silent@ERR?:4
spoilt 76 'controller 7 instead of 1' wrong-sender@POS?:20
spoilt 76 'refused with error 17' error@VEL
spoilt 69 'unplugged' unplug@POS?:20
spoilt 69 'unplugged' power-loss@POS?:20
spoilt 76 'was expected' block@POS?:80
spoilt 76 'is blocked' block@POS?:2

# A full disk as output.
fails 74 'write failed' sh -c 'vam-stage follow --device sim: --duration 1 >/dev/full'
fails 64 'device: names no serial port' vam-stage status --device gcs:
done_testing
