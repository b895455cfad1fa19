# SPDX-License-Identifier: GPL-3.0-or-later
# Helpers of the end-to-end tests (POSIX sh). A test sources this file, runs in a fresh scratch directory that is
# removed at the end, prints TAP and ends with done_testing.
set -u
LC_ALL=C PYTHONDONTWRITEBYTECODE=1; export LC_ALL PYTHONDONTWRITEBYTECODE
unset VAM_PRINTER
# What keeps step with clocks or devices is in memory: a disk that is busy with others would hold it up.
if [ -w /dev/shm ] && grep -Eq '^# ctest: .*(clock|long|devices)' "$0"; then export TMPDIR=/dev/shm; fi
scratch=$(mktemp -d "${TMPDIR:-/tmp}/vam-test.XXXXXX") || exit 1
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
mkdir -p .log/locks
VAM_LOCK_DIR=$scratch/.log/locks; export VAM_LOCK_DIR  # to the locks a test is a machine of its own
ASAN_OPTIONS=verify_asan_link_order=0; export ASAN_OPTIONS  # what is preloaded to stand for a device comes first
number=0
failures=0

exr="python3 -S $VAM_SOURCE/tests/tools/exr.py"  # stacks, images and arrays without our own readers and writers
png="python3 -S $VAM_SOURCE/tests/tools/png.py"
npy="python3 -S $VAM_SOURCE/tests/tools/npy.py"

sanitized() { ldd "$(command -v vam-slice)" | grep -q libasan; }  # by AddressSanitizer, which changes calls and memory

report() {  # report STATUS NAME: one TAP line
  number=$((number + 1))
  if [ "$1" -eq 0 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; failures=$((failures + 1)); fi
}

ok() {  # ok NAME COMMAND...: the command succeeds
  name=$1; shift
  "$@" >.log/out 2>.log/err; status=$?
  report $status "$name"
  [ $status -eq 0 ] || { echo "# status $status: $*"; sed 's/^/# /' .log/err .log/out | head -n 20; }
}

quiet() {  # quiet NAME COMMAND...: it succeeds with nothing on stderr
  name=$1; shift
  "$@" >.log/out 2>.log/err; status=$?
  if [ $status -eq 0 ] && [ ! -s .log/err ]; then report 0 "$name"; else
    report 1 "$name"; echo "# status $status: $*"; sed 's/^/# /' .log/err | head -n 20
  fi
}

fails() {  # fails STATUS REGEX COMMAND...: that exit status, one line on stderr that matches, nothing new in the folder
  want=$1; regex=$2; shift 2
  names=$(echo * .*)
  "$@" >.log/out 2>.log/err; status=$?
  problem=
  [ "$status" -eq "$want" ] || problem="status $status instead of $want"
  { read -r _ && ! read -r another && [ -z "$another" ]; } <.log/err || problem="$problem; $(wc -l <.log/err) lines on stderr instead of 1"
  grep -Eq -- "$regex" .log/err || problem="$problem; stderr does not match '$regex'"
  [ "$names" = "$(echo * .*)" ] || problem="$problem; $(ls -A | tr '\n' ' ')instead of $names"
  if [ -z "$problem" ]; then report 0 "$want: $*"; else
    report 1 "$want: $*"; echo "# $problem"; sed 's/^/# /' .log/err | head -n 10
  fi
}

misuse() {  # misuse OPTION CAUSE COMMAND...: refused with 64 in the name of the tool and the option, for this cause (another
  # option, a kind of input), with a remedy
  wrong=$1; cause=$2; shift 2
  fails 64 "^vam-[a-z-]*: $wrong( [^:]*)?: .*$cause.*; (omit|give) " "$@"
}

is() {  # is NAME GOT WANT
  if [ "$2" = "$3" ]; then report 0 "$1"; else report 1 "$1"; echo "# got '$2', want '$3'"; fi
}

same() {  # same NAME FILE FILE: identical bytes
  if cmp -s "$2" "$3"; then report 0 "$1"; else report 1 "$1"; echo "# $2 and $3 differ"; fi
}

holds() {  # holds NAME EXPRESSION: arithmetic truth, by awk: holds "volume" "$v > 0.99 && $v < 1.01"
  if awk "BEGIN { exit !($2) }"; then report 0 "$1"; else report 1 "$1"; echo "# not true: $2"; fi
}

unchain() { sed -i 's/,"chain":"[0-9a-f]*"}$/}/' "$@"; }  # unchain LOG...: as of a program that states no chain

json() {  # json FILE KEY: the number, text or truth at that dotted key
  [ -f "$1" ] && awk -v key="$2" '/^ +[^]} ]/ {  # the files of tools have a value a line; what is none, or comes once, is left to Python
      match($0, /^ +/); d = RLENGTH / 2; value = substr($0, RLENGTH + 1); name = at[d]++; at[d + 1] = 0
      if (match(value, /^"[^"]*": /)) { name = substr(value, 2, RLENGTH - 4); value = substr(value, RLENGTH + 1) }
      path[d] = d > 1 ? path[d - 1] "." name : name
      if (path[d] == key) exit }
    END { sub(/,$/, "", value); if (path[d] != key || value !~ /^("[^"\\]*"|[-+.0-9e]+|true|false)$/) exit 1
      gsub(/"/, "", value); print value }' "$1" 2>/dev/null || python3 -IS -c 'import json,sys
value=json.load(open(sys.argv[1]))
for key in sys.argv[2].split("."): value=value[int(key)] if isinstance(value,list) else value[key]
print(str(value).lower() if isinstance(value,bool) else value)' "$1" "$2"
}

await() {  # await COMMAND...: until it succeeds, at most 10 s
  tries=0
  until "$@"; do
    [ $tries -lt 500 ] || return 1
    tries=$((tries + 1)); sleep 0.02
  done
}

screen_up() {  # screen_up WIDTH HEIGHT: an X server without a screen, its image in screen/Xvfb_screen0; $server
  mkdir -p screen
  exec 4>screen.number
  # -noreset, -nocursor: what the server itself draws when its last client goes is no part of a test.
  Xvfb -displayfd 4 -screen 0 "$1x$2x24" -fbdir "$PWD/screen" -nolisten tcp -noreset -nocursor >/dev/null 2>&1 &
  server=$!
  await test -s screen.number || { echo "# no X server"; exit 1; }
  DISPLAY=:$(cat screen.number); export DISPLAY
  export SDL_VIDEODRIVER=x11 SDL_RENDER_DRIVER=software
  ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0  # SDL unloads drivers that have not freed all
}
screen_down() { kill $server; wait $server 2>/dev/null; }

stage_up() {  # stage_up OPTIONS...: a simulated stage behind ./stage, its truth in ./truth; $stage
  rm -f truth path
  vam-sim stage --link stage --log truth --die-with-parent "$@" >path & stage=$!
  await test -s path
}
stage_down() { kill $stage; wait $stage 2>/dev/null; }
stood() { ! grep -E '"(moving|angle|standing)"' truth | tail -n 1 | grep -Eq 'moving|angle_deg.*speed'; }

camera_up() {  # camera_up OPTIONS...: vam-sim camera at its address; $camera; its status where it ends instead
  # GigE Vision's port is the machine's: tests take turns, and another program may have it for a while.
  exec 9>"${XDG_RUNTIME_DIR:-/tmp}/vam-gige-test.lock"; flock -w 120 9
  turns=0
  while :; do
    : >camera
    vam-sim camera --die-with-parent "$@" >camera 2>camera.err 9>&- & camera=$!
    until [ -s camera ] || ! kill -0 $camera 2>/dev/null; do sleep 0.02; done
    if [ -s camera ]; then camera_since=$(date +%s); return; fi
    wait $camera; status=$?
    if [ $status -ne 75 ] || [ $turns -ge 60 ]; then sed 's/^/# /' camera.err; return $status; fi
    turns=$((turns + 1)); sleep 2
  done
}
camera_down() {  # at once: its library may wait for its threads for ever
  camera_waited=$(cat /proc/$camera/task/*/schedstat 2>/dev/null |
    awk -v up=$(($(date +%s) - camera_since)) '$2 > ns { ns = $2 } END { printf "%.1f", ns / 1e7 / (up + 1) }')  # %
  kill -KILL $camera 2>/dev/null; wait $camera 2>/dev/null
  exec 9>&-
}
fairly() {  # fairly GOOD COMMAND...: the command; while GOOD fails and its camera was starved again, three times at most,
  # also where ctest, which repeats a script that failed, had these three already
  good=$1; shift
  spent=$VAM_BUILD/Testing/${0##*/}.$(cut -d' ' -f1,2,22 --output-delimiter=. /proc/$PPID/stat)  # of who runs the script
  [ ! -e "$spent" ] || { echo '# three attempts had failed before'; return 1; }
  for attempt in 1 2 3; do
    "$@"
    if eval "$good"; then return; fi
    echo "# attempt $attempt: a thread of the camera was ready to run and had no processor for $camera_waited % of the time"
    awk "BEGIN { exit !($camera_waited > 5) }" || return 1
  done
  case $spent in *'(ctest)'*) : >"$spent" ;; esac
}

stops() { case $1 in *:error=*) echo --seccomp-bpf ;; esac; }  # of strace, for a fault: at its calls alone, which is quick

find_browser() {  # $browser, without which the script ends
  browser=$(command -v chromium || command -v google-chrome) && return
  echo "ok $((number += 1)) - the page in a browser # SKIP no chromium here (scripts/setup installs it)"
  done_testing
}

box() (  # box X Y Z: an OFF mesh of that size, 12 triangles, the axis through its middle, standing on z = 0
  x=$(awk "BEGIN { print $1 / 2 }"); y=$(awk "BEGIN { print $2 / 2 }")
  printf 'OFF\n8 12 0\n'
  for z in 0 "$3"; do printf '%s\n' "-$x -$y $z" "$x -$y $z" "$x $y $z" "-$x $y $z"; done
  for corners in '0 2 1' '0 3 2' '4 5 6' '4 6 7' '0 1 5' '0 5 4' '1 2 6' '1 6 5' '2 3 7' '2 7 6' '3 0 4' '3 4 7'; do
    echo "3 $corners"
  done
)

boxes() (  # boxes 'X Y Z [DX DY DZ]'...: an OFF mesh of such boxes, each moved by DX, DY and DZ
  count=$#
  echo "OFF $((8 * count)) $((12 * count)) 0"
  for one; do
    # shellcheck disable=SC2086
    set -- $one
    box "$1" "$2" "$3" | awk -v x="${4:-0}" -v y="${5:-0}" -v z="${6:-0}" 'NR > 2 && NF == 3 { print $1 + x, $2 + y, $3 + z }'
  done
  for first in $(seq 0 8 $((8 * count - 1))); do
    box 1 1 1 | awk -v n="$first" 'NF == 4 { print 3, $2 + n, $3 + n, $4 + n }'
  done
)

tiny_print() {  # tiny_print FILE: three projections, and printer.toml with a projector of 64 x 48 pixels for them
  printf '%s\n' '[projector]' 'columns = 64' 'rows = 48' 'pixel_mm = 0.26' 'axis_column = 31.5' 'axis_row = 40' >printer.toml
  $exr make "$1" space=projector width=64 height=36 count=3
}

small_printer() {  # a projector of 64 x 8 pixels of 0.26 mm; 36 frames a turn at 1 frame per second and 10 deg/s
  printf '%s\n' '[projector]' 'columns = 64' 'rows = 8' 'pixel_mm = 0.26' 'axis_column = 31.5' 'axis_row = 5' 'fps = 1'
}

camera_bench() {  # camera_bench STAGE SPEED: printer.toml of a stage, a projector and a GigE Vision camera to be calibrated
  cat >printer.toml <<TOML
[projector]
columns = 208
rows = 96
pixel_mm = 0.1
axis_column = 103.5
axis_row = 47
telecentric = true
[vial]
radius_mm = 9
[bath]
index = 1.53
window_mm = 12
[stage]
device = "$1"
speed_deg_s = $2
[camera]
device = "aravis:127.0.0.1"
pixel_mm = 0.15
exposure_us = 2500
fps = 50
[calibration]
folder = "cal"
instrument = "simulated"
valid_hours = 1
TOML
  mkdir -p cal
}
done_testing() {
  echo "1..$number"
  [ "$number" -gt 0 ] && [ "$failures" -eq 0 ]
  exit $?
}
