# SPDX-License-Identifier: GPL-3.0-or-later
# stage.sh WORDS -- vam-sim stage OPTIONS...: what vam-stage WORDS does with that simulator on ./port, through the library
# that lets it pass for a serial port.
words=
while [ "$1" != -- ]; do words="$words $1"; shift; done
shift
"$@" --link port --die-with-parent >told 2>refused &
until [ -e port ] || ! kill -0 $! 2>/dev/null; do sleep 0.02; done
[ -e port ] || { wait $!; status=$?; cat refused >&2; rm -f told refused; exit $status; }
LD_PRELOAD=$(vam-sim stage --shim) vam-stage $words
status=$?
kill $!
wait $!
rm -f told refused
exit $status
