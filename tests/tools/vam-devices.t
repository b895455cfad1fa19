# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK camera COST 110
# vam-devices: every kind of device is found with its device string and with the reason why it cannot be used, in 3 s.
. "$VAM_SOURCE/tests/tools/testlib.sh"
ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0  # what is preloaded for the simulated bus keeps 16 bytes
unset DISPLAY WAYLAND_DISPLAY
# A device on a bus or a network replies within a second, which a busy machine may miss.
found() {  # found NAME REGEX COMMAND...: the command lists it, in one of five tries
  name=$1; regex=$2; shift 2
  for try in 1 2 3 4 5; do "$@"; grep -q -- "$regex" list && break; done
  ok "$name" grep -q -- "$regex" list
}
list() { vam-devices "$@" >list 2>err; }
row() { grep -A1 -- "  *$1 " list | tr -s ' \n' ' '; }
bus() { umockdev-wrapper "$VAM_BUILD/usb_host" "$1" told vam-devices >list 2>err; }

best=9e9
for try in 1 2 3; do  # a busy machine may hold up one
  start=$(date +%s%N)
  list --report found.json; status=$?
  best=$(awk "BEGIN { took = $(date +%s%N) - $start; print (took < $best ? took : $best) }")
  awk "BEGIN { exit !($best < 3e9) }" && break
done
is 'the list of devices, without messages' "$status $(cat err)" '0 '
holds 'in 3 s' "$best < 3e9"
is 'every kind, also one without devices' "$(cut -c1-8 list | tr -d ' ' | sort -u | grep -c .)" 4
is 'and in a report' "$(json found.json schema)" vam-devices/1
list --report -
is 'which replaces the list on standard output' "$(json list schema)" vam-devices/1
fails 64 '' vam-devices ttyUSB0
fails 73 'missing' vam-devices --report missing/x.json

# Every option that a device accepts is in the manual, and those of simulators are named as those of their programs.
vam-devices --man | tr -s ' \n' ' ' >page
accepted() { "$@" 2>&1 | sed -n 's/.* options: \(.*\))$/\1/p' | tr -d ,; }
{
  for scheme in gcs tic grbl zaber sim; do echo "$scheme $(accepted vam-stage identify --device "$scheme:?none=1")"; done
  for scheme in aravis v4l2 replay sim; do echo "$scheme $(accepted vam-capture identify --device "$scheme:?none=1")"; done
  for scheme in drm null; do echo "$scheme $(accepted vam-project --pattern grey -o "$scheme:?none=1")"; done
  for scheme in dlpc350 dlpc900 sim; do echo "$scheme $(accepted vam-project --pattern grey -o null: --light "$scheme:?none=1")"; done
  for scheme in relay sim; do echo "$scheme $(accepted vam-project --pattern grey -o null: --set "projector.relay=$scheme:?none=1")"; done
} >schemes
is 'every scheme lists its options when one is unknown' "$(wc -l <schemes) $(awk 'NF < 2' schemes)" '16 '
while read -r scheme options; do
  for option in $options; do grep -q "$scheme:.* $option=" page || echo "$scheme $option"; done
done <schemes >undocumented
is 'every option is in the manual' "$(cat undocumented)" ''
{
  for option in $(accepted vam-stage identify --device 'sim:?none=1'); do
    vam-sim stage --help=all | grep -q -- "--$(echo "$option" | tr _ -) " || echo "vam-sim stage $option"
  done
  for option in $(accepted vam-capture identify --device 'sim:?none=1'); do
    case $option in bits | pace) continue ;; esac  # of what is no program
    vam-sim camera --help=all | grep -Eq -- "--$(echo "$option" | tr _ -)( |$)" || echo "vam-sim camera $option"
  done
} >unlike
is 'the simulators have the same names' "$(cat unlike)" ''

# A stage on a serial port: free, probed, in use, without permission, and no stage at all.
shim=$(vam-sim stage --shim)
stage_up
list --port "$PWD/stage"
is 'a port that the system does not list' "$(row "gcs:$PWD/stage")" ''
ok 'can be given' grep -q "^stage *gcs:$PWD/stage$" list
for protocol in gcs grbl zaber; do
  stage_down; stage_up --protocol $protocol
  LD_PRELOAD=$shim vam-devices --port "$PWD/stage" --probe >list 2>err
  ok "$protocol: it reports its identity" grep -Eq "^stage +$protocol:$PWD/stage +[A-Z].*simulated" list
  is "$protocol: and does not move" "$(grep -c '"event":"moving"' truth)" 0
done
stage_down; stage_up
LD_PRELOAD=$shim vam-stage follow --device "gcs:$PWD/stage" >/dev/null & user=$!
await sh -c 'grep -q . "$VAM_LOCK_DIR"/* 2>/dev/null && grep -q POS truth'
list --port "$PWD/stage"
ok 'a stage in use: its user is named' grep -q "! .*/pts/.*in use by process $user\|! $PWD/stage: in use by process $user" list
kill -TERM $user; wait $user 2>/dev/null
stage_down
: >port; chmod 660 port
if [ "$(id -u)" = 0 ] && chgrp dialout port 2>/dev/null; then
  chmod 711 . && setpriv --reuid 65534 --regid 65534 --clear-groups vam-devices --port "$PWD/port" >list 2>err
  ok 'a port without permission: the group to join is named' grep -q '! not permitted to this user; run `sudo usermod -aG dialout' list
else
  echo '# not root, or no group dialout: nothing is tried without permission'
fi
list --port /dev/null
ok 'a device that is no serial port' grep -q '! is not a serial port' list
list --port "$PWD/nowhere"
ok 'a port that does not exist' grep -q "! $PWD/nowhere: No such file" list

# USB: stage and light engines.
found 'a Tic' '^stage *tic:00312345?steps_per_deg=N  Pololu' bus tic:
found 'a DLPC350' '^light *dlpc350:LCR4500  Texas' bus dlpc350:
found 'a DLPC900' '^light *dlpc900:' bus dlpc900:
is 'no command is sent' "$(grep -cv '"bits":0\|asleep' told 2>/dev/null)" 0

# Everything off, whatever state the rest is in.
off() { LD_PRELOAD=$shim vam-devices off --set "stage.device=$where" --light none "$@"; }
spin() {  # spin PROTOCOL OPTIONS...: a stage that turns for a tool; $user, and its guardian $guardian
  where=$1:$PWD/stage; stage_up --protocol "$@"
  LD_PRELOAD=$shim vam-stage spin --device "$where" --turns 50 --speed 30 --home >/dev/null 2>user.err & user=$!
  await sh -c 'grep -q "angle_deg.*speed" truth'
  guardian=$(pgrep -P $user)
}
for protocol in gcs grbl zaber; do
  spin $protocol
  kill -9 $guardian $user; wait $user 2>/dev/null
  is "$protocol: a stage that nobody guards is stopped" "$(off) $(stood; echo $?)" "stage    $where  stopped 0"
  is "$protocol: and again" "$(off) $(stood; echo $?)" "stage    $where  stopped 0"
  stage_down
done
spin gcs
ok 'a tool that still drives it is asked to end' off
wait $user 2>/dev/null
is 'and does, by that signal' "$? $(stood; echo $?)" '143 0'
LD_PRELOAD=$shim vam-stage follow --device "$where" >/dev/null 2>&1 & user=$!
await sh -c 'grep -q . "$VAM_LOCK_DIR"/*pts* 2>/dev/null'; sleep 0.2
kill -STOP $user
ok 'one that does not answer is killed' off
wait $user 2>/dev/null
is 'by that' $? 137
stage_down
for frozen in guardian 'tool with its guardian'; do
  spin gcs
  kill -STOP $guardian; [ "$frozen" = guardian ] && kill -9 $user || kill -STOP $user
  start=$(date +%s%N)
  is "a $frozen that is frozen is killed, and the stage stopped" "$(off) $(stood; echo $?)" "stage    $where  stopped 0"
  holds 'in time' "$(date +%s%N) - $start < 6e9"
  wait $user 2>/dev/null
  stage_down
done
for pause in 0 0.1 0.2 0.3; do
  spin gcs --reply-delay 60
  kill -9 $guardian $user; wait $user 2>/dev/null
  off >first 2>&1 & first=$!
  sleep $pause
  second=$(off 2>&1); wait $first
  is "two at once, $pause s apart" "$? $(cat first), $second $(stood; echo $?)" "0 stage    $where  stopped, stage    $where  stopped 0"
  stage_down
done
spin gcs --reply-delay 60
kill -9 $guardian $user; wait $user 2>/dev/null
LD_PRELOAD=$shim vam-devices off --set "stage.device=$where" --light none 2>err & first=$!
await pgrep -P $first >half; sleep 0.1; kill -9 $(cat half); wait $first
is 'one that is killed is said to be' "$? $(grep -c "not everything is off: stage $where: .* was killed; try again" err)" '75 1'
is 'and its half a conversation is no obstacle' "$(off) $(stood; echo $?)" "stage    $where  stopped 0"
vam-sim stage --protocol relay --link relay --log opened --die-with-parent >/dev/null & relay=$!
await test -e relay
is 'an unplugged stage does not keep the relay closed' \
  "$(LD_PRELOAD=$shim vam-devices off --light none --set stage.device=gcs:/dev/ttyUSB99 --set "projector.relay=relay:$PWD/relay" 2>err; echo $?)" \
  "relay    relay:$PWD/relay  open
69"
ok 'and is named, with the remedy' grep -q 'not everything is off: stage /dev/ttyUSB99: .*; cut the power by hand$' err
kill $relay; stage_down
switch() { umockdev-wrapper "$VAM_BUILD/usb_host" "$1" told vam-devices off; }
for engine in dlpc350 dlpc900; do
  is "$engine is found and put into standby" "$(switch $engine: 2>err | cut -d' ' -f5) $(cut -d' ' -f8- err)" "$engine:LCR$([ $engine = dlpc350 ] && echo 4500 || echo 6500) "
done
for fault in silent unplug garbage; do
  switch "dlpc350:?fault=$fault" >list 2>err; status=$?
  is "$fault: $(cut -c -60 err)" "$(grep -c 'not everything is off: light .*usb:0451' err) $((status > 64))" '1 1'
done
printf '[stage\n' >broken.toml
umockdev-wrapper "$VAM_BUILD/usb_host" dlpc350: told vam-devices off --printer broken.toml >list 2>err; status=$?
is 'a printer file that cannot be read keeps no light on' "$status $(grep -c 'dlpc350:LCR4500  in standby' list) $(grep -c broken.toml err)" '65 1 1'
fails 64 'names no stage and no relay' vam-devices off
fails 69 'no such device' vam-devices off --light dlpc900:
fails 64 'unknown scheme|is not one of|use one of' vam-devices off --light laser:1
is 'simulated ones end with their tools, without a folder for locks at once' "$(VAM_LOCK_DIR=/nowhere timeout 4 vam-devices off --light none --set stage.device=sim:)" 'stage    sim:  simulated: ends with its tool'

# Screens: of a card, of another program's card, of a desktop.
mkdir -p card/dri; touch card/dri/card0
card() { FAKE_DRM=$PWD/card LD_PRELOAD=$VAM_BUILD/lib/vam-test/drm_card.so vam-devices >list 2>err; }
card; ok 'a connector with a screen' grep -q '^display *drm:HDMI-A-1  *64 x 48 at 60 Hz' list
is 'and not one without' "$(grep -c HDMI-A-2 list)" 0
FAKE_DRM_FAULT=not-master; export FAKE_DRM_FAULT
card; ok 'a card of another master' grep -q '! another program is master of the graphics card' list
unset FAKE_DRM_FAULT
screen_up 64 48
list; ok 'a desktop' grep -q '^display *sdl:0  *64 x 48 at' list
tiny_print part.exr
vam-project --pattern grey -o sdl:0 --hold 60 >/dev/null 2>&1 & user=$!
await grep -qs $user "$VAM_LOCK_DIR"/vam-sdl*
is 'a display in use' "$(vam-devices off | sed 's/ .* / /')" 'display dark'
wait $user
is 'is dark, as its tool ends' $? 143
screen_down; unset DISPLAY

# A camera on the network.
address=$(hostname -I 2>/dev/null | tr ' ' '\n' | grep -m 1 '^[0-9.]*$')
if [ -n "$address" ]; then  # Aravis does not look for cameras on the loopback
  camera_up --address "$address"
  found 'a GigE Vision camera, by its address' "^camera *aravis:$address  .*GigEVision" list
  camera_down
else
  echo '# no network: no camera is looked for there'
fi
done_testing
