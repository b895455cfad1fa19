# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
. "$VAM_SOURCE/tests/tools/testlib.sh"

shim=$(vam-sim stage --shim)
is 'the library to preload exists' "$(test -f "$shim" && echo yes)" yes

fails 73 'cannot be written' vam-sim stage --log missing/log
fails 73 'cannot create the link' vam-sim stage --link missing/link

vam-sim stage --link stage --log truth --baud 19200 --start-angle 33 --die-with-parent >path &
simulator=$!
await test -s path
is 'the link leads to the pseudo-terminal' "$(readlink stage)" "$(cat path)"

cat >ask.sh <<'EOF'
exec 3<>"$1"; stty -F "$1" 19200 raw -echo
printf '*IDN?\nPOS? 1\nMOV 1 5\nERR?\n' >&3
for line in 1 2 3; do read -r answer <&3; echo "$answer"; done
EOF
timeout 5 sh ask.sh stage >answers
is 'without a reference angles count from power-on' "$(sed -n 2p answers)" '1=0.00000'
is 'an unreferenced axis refuses to move' "$(sed -n 3p answers)" 5
is 'its log has every command' "$(grep -c '"command"' truth)" 4

kill -TERM $simulator
wait $simulator; status=$?
is 'a signal ends it' $status 143
is 'and its link is removed' "$(test -L stage || echo gone)" gone
done_testing
