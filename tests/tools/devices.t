# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK camera COST 110
# Every device [devices guarantees 4 and 6]: one user at a time, reported with its pid within a second, free again after kill -9;
# and under cron a silent standard output, with every event a JSON line with UTC and monotonic time.
. "$VAM_SOURCE/tests/tools/testlib.sh"
ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0  # what is preloaded for the simulated bus keeps 16 bytes
mkdir -p card/dri screen
touch card/dri/card0
FAKE_DRM=$PWD/card; export FAKE_DRM
printf '[projector]\ncolumns = 64\nrows = 48\npixel_mm = 0.26\naxis_column = 31.5\naxis_row = 23.5\n' >printer.toml
shim=$(vam-sim stage --shim)
on() { device=$1; log=$2; shift 2; exec umockdev-wrapper "$VAM_BUILD/usb_host" "$device" "$log" sh -c 'exec "$@"' sh "$@"; }

Xvfb -displayfd 4 -screen 0 64x48x24 -nolisten tcp -noreset 4>number >/dev/null 2>&1 & server=$!
# Stages as the tool lists them, "gcs:PATH": behind a serial port, else on USB.
stages=$(vam-stage identify --help=all | tr -s ' \n' ' ' | sed -n 's/.*Rotation stage: \(.*\) or sim:.*/\1/p' | tr -d ',')
serial= others= servers=
for stage in $stages; do
  scheme=${stage%%:*}
  case $stage in
    *:PATH)
      serial="$serial $scheme"
      vam-sim stage --link "$scheme" --protocol "$scheme" --die-with-parent >"path.$scheme" & servers="$servers $!"
      await test -s "path.$scheme" ;;
    *) others="$others $scheme" ;;
  esac
done
ok 'the tool lists stages' test -n "$serial" -a -n "$others"
await test -s number
options() { case $1 in tic) echo '?steps_per_deg=100' ;; esac; }  # what it does not open without

# One long use of each device, whose log records its begin.
use() {  # use DEVICE LOG
  case " $serial " in *" $1 "*) exec env LD_PRELOAD="$shim" vam-stage follow --device "$1:$PWD/$1$(options "$1")" --log "$2" ;; esac
  case " $others " in *" $1 "*) on "$1:" truth vam-stage follow --device "$1:$(options "$1")" --log "$2" ;; esac
  case $1 in
    drm) exec env LD_PRELOAD="$VAM_BUILD/lib/vam-test/drm_card.so" vam-project --pattern grey -o drm:HDMI-A-1 --hold 60 --log "$2" ;;
    sdl) exec env DISPLAY=":$(cat number)" SDL_VIDEODRIVER=x11 SDL_RENDER_DRIVER=software vam-project --pattern grey -o sdl:0 --hold 60 --log "$2" ;;
    dlpc350) on dlpc350: truth vam-project --pattern grey -o null: --light dlpc350: --hold 60 --log "$2" ;;
  esac
}
begun_or_ended() { begun third.log || ! kill -0 $third 2>/dev/null; }
begun() { grep -Eq '"event":"(begin|flip)"' "$1" 2>/dev/null; }

for device in $serial $others drm sdl dlpc350; do
  rm -f "$VAM_LOCK_DIR"/*
  (use $device first.log) >out 2>err & first=$!
  await begun first.log
  pid=$(cat "$VAM_LOCK_DIR"/*)
  best=9e9
  for try in 1 2 3; do  # a busy machine may hold up one
    start=$(date +%s%N)
    (use $device second.log) >second.out 2>second.err; status=$?
    best=$(awk "BEGIN { took = $(date +%s%N) - $start; print (took < $best ? took : $best) }")
    awk "BEGIN { exit !($best < 1e9) }" && break
  done
  is "$device: the second user is refused with the pid of the first" "$status $(grep -c "in use by process $pid;" second.err)" '75 1'
  holds "$device: within a second" "$best < 1e9"
  is "$device: and so is its log" "$(tail -n 1 second.log | grep -c '"event":"error".*"status":75')" 1
  kill -9 "$pid"; wait $first 2>/dev/null
  rm -f first.log second.log
  for try in 1 2 3 4 5; do  # the guardian of the killed process holds a screen until it is dark
    rm -f third.log
    (use $device third.log) >third.out 2>third.err & third=$!
    await begun_or_ended
    begun third.log && break
    wait $third 2>/dev/null
    sleep 0.1
  done
  ok "$device: free again after kill -9" begun third.log
  kill -TERM "$(cat "$VAM_LOCK_DIR"/*)"; wait $third 2>/dev/null
  is "$device: a signal is the last event" "$(tail -n 1 third.log | grep -c '"event":"interrupted".*"signal":15')" 1
  cat third.log >>all.log; rm -f third.log
done

# A camera: an address has one user, too. Its own hold on a client that was killed ends with the heartbeat, in 3 s.
exec 9>"${XDG_RUNTIME_DIR:-/tmp}/vam-gige-test.lock"; flock -w 120 9  # the port is the machine's
for try in 1 2 3 4 5 6 7 8; do  # another program may have the port for a while
  vam-sim camera --die-with-parent >address 2>busy 9>&- & camera=$!
  await sh -c "[ -s address ] || ! kill -0 $camera 2>/dev/null"
  [ -s address ] && break
  sleep 2
done
rm -f "$VAM_LOCK_DIR"/*
look() { vam-capture --device aravis:127.0.0.1 --binning 6 --frames "$1" -o "$2" 9>&-; }
(exec vam-capture --device aravis:127.0.0.1 --frames 1000 -o first.exr) 2>err 9>&- & first=$!
await sh -c 'grep -q . "$VAM_LOCK_DIR"/* 2>/dev/null'
start=$(date +%s%N)
look 1 second.exr 2>second.err; status=$?
is 'aravis: the second user is refused with the pid of the first' "$status $(grep -c "in use by process $first;" second.err)" '75 1'
holds 'aravis: within a second' "$(date +%s%N) - $start < 1e9"
kill -9 $first; wait $first 2>/dev/null
tries=0; until look 1 third.exr 2>err || [ $tries -ge 10 ]; do tries=$((tries + 1)); sleep 0.5; done
ok 'aravis: free again after kill -9' test -s third.exr
kill -9 $camera; wait $camera 2>/dev/null

# As cron runs a tool: no input, an almost empty environment, and no output unless there is an error.
cron() { env -i PATH="$PATH" VAM_LOCK_DIR="$VAM_LOCK_DIR" "$@" </dev/null >out 2>>all.log; }
cron vam-stage home --device sim: --log -
is 'cron: homing' "$? $(cat out)" '0 '
cron vam-stage move --device sim: --home --angle 3 --log -
is 'cron: a move' "$? $(cat out)" '0 '
cron vam-project --pattern grey -o null: --hold 0.1 --light sim: --log -
is 'cron: a test pattern' "$? $(cat out)" '0 '
python3 - >judged <<'PY'
import json, re
lines = [json.loads(line) for line in open("all.log")]
good = [line for line in lines if re.fullmatch(r"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", line["utc"])
        and isinstance(line["t_monotonic_s"], float) and isinstance(line["event"], str)]
wanted = {"begin", "display", "end", "flip", "interrupted", "light"}
print(len(lines) > 20, len(lines) - len(good), wanted - {line["event"] for line in good} or "all")
PY
is 'every event is a JSON line with both times' "$(cat judged)" 'True 0 all'
kill $server $servers
done_testing
