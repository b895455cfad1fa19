# SPDX-License-Identifier: GPL-3.0-or-later
# camera.sh vam-sim camera OPTIONS...: three frames of it, taken by vam-capture. There is one camera a machine: it waits for
# that of another.
for try in $(seq 120); do
  "$@" --die-with-parent >address 2>refused &
  until [ -s address ] || ! kill -0 $! 2>/dev/null; do sleep 0.05; done
  [ ! -s address ] || break
  wait $! || status=$?
  grep -q 'is in use' refused || break
  sleep 0.5
done
cat refused >&2
[ -s address ] || exit $status
vam-capture --device aravis:127.0.0.1 --fps 20 --frames 3 -o views
status=$?
kill $! 2>/dev/null
wait $!
rm address refused
exit $status
