# SPDX-License-Identifier: GPL-3.0-or-later
# The crontab line and the systemd units of vam-lab(7), as cron and systemd run them: installed, in an empty
# environment with their own PATH; the devices alone are simulated ones. And the progress on a terminal.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
page=$VAM_SOURCE/man/vam-lab.7
tools=$(dirname "$(command -v vam-stage)")
mkdir -p prefix/bin
for tool in "$tools"/vam-*; do ln -s "$tool" prefix/bin; done
cat >printer.toml <<TOML
[stage]
device = "sim:?acceleration=1000&log=$PWD/truth"
speed_deg_s = 85
[camera]
device = "sim:?follow=$PWD/truth&lit=0.001&columns=128&rows=96&part=cylinder:x=2,diameter=3,height=8"
pixel_mm = 0.26
exposure_us = 5000
[calibration]
folder = "$PWD/cal"
instrument = "simulated"
TOML
here() {  # a command of the page on this machine
  sed -e "s|/usr/local|$PWD/prefix|; s|/etc/vam|$PWD|; s|/var/log|$PWD|; s|drm:HDMI-A-1|null:|; s|dlpc350:|sim:|" -e 's|$| --scans axis|'
}
again() { rm -rf cal vam-calibrate.jsonl truth; }

# cron: sh -c, five variables.
sed -n 's|^30 6 \* \* 1-5 ||p' "$page" | here >crontab
is 'the page has a crontab line' "$(grep -c . crontab)" 1
is 'that cron would not cut at a %' "$(grep -c % crontab)" 0
for try in 1 2 3; do  # a busy machine may lose frames
  again
  env -i HOME="$PWD" LOGNAME=root SHELL=/bin/sh PATH=/usr/bin:/bin VAM_LOCK_DIR="$VAM_LOCK_DIR" /bin/sh -c "$(cat crontab)" >out 2>&1 </dev/null
  status=$?
  [ $status -eq 0 ] && break
  sed 's/^/# attempt: /' out
done
is 'cron runs it, without messages' "$status $(cat out)" '0 '
is 'with a record' "$(json cal/current-axis.json status)" pass
is 'and a log' "$(tail -n 1 vam-calibrate.jsonl | grep -c '"event":"end","scan":"axis"')" 1

# systemd: no shell, its own PATH, no HOME.
unit() { sed -n "/Pa $1/,/\.Ed/p" "$page" | sed -n '/^\[Unit\]/,/^\.Ed/p' | grep -v '^\.Ed'; }
unit .*vam-calibrate.service >vam-calibrate.service
unit vam-calibrate.timer >vam-calibrate.timer
sed -n 's/^ExecStart=//p' vam-calibrate.service | here >start
for try in 1 2 3; do
  again
  set -f
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin VAM_LOCK_DIR="$VAM_LOCK_DIR" $(cat start) >out 2>&1 </dev/null
  status=$?
  set +f
  [ $status -eq 0 ] && break
  sed 's/^/# attempt: /' out
done
is 'so does systemd' "$status $(cat out) $(json cal/current-axis.json status)" '0  pass'
if command -v systemd-analyze >.log/out; then
  sed -i "s|/usr/local|$PWD/prefix|" vam-calibrate.service
  is 'which accepts the units' "$(systemd-analyze verify --man=no ./vam-calibrate.service ./vam-calibrate.timer 2>&1 | grep vam-calibrate)" ''
  ok 'on working days' systemd-analyze calendar "$(sed -n 's/^OnCalendar=//p' vam-calibrate.timer)"
else
  echo '# no systemd-analyze: the units are not verified'
fi

# A terminal shows the scan and its duration; the line is removed at the end.
again
script -qec "$(cat crontab)" seen </dev/null >.log/out 2>&1
tr '\r' '\n' <seen >lines
is 'a terminal shows the scan and its duration' "$(grep -c 'vam-calibrate: axis, scan 1 of 1, [1-9] s' lines | awk '{ print ($1 > 1) }')" 1
is 'until its end' "$(grep -v '^Script' lines | grep . | tail -n 1 | tr -d '\033')" '[K'
done_testing
