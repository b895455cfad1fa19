# SPDX-License-Identifier: GPL-3.0-or-later
# Each example of a tool's manual page runs alone, as if pasted into an empty folder. usage: examples.sh TOOL
. "$VAM_SOURCE/tests/tools/testlib.sh"
tool=$1
PATH=$VAM_SOURCE/scripts:$PATH  # vam-print

sed -e 's/^\\&//' -e 's/\\e/\\/g' "$VAM_SOURCE/man/$tool.1" |
  awk '/^\.Sh /{inside = ($2 == "EXAMPLES")} /^\.Ed/{code = 0} code{print >("example-" n)} inside && /^\.Bd/{code = 1; ++n}'
[ -s example-1 ]; report $? "$tool: the page has examples"
for example in example-*; do
  if grep -q 'drm:' "$example"; then continue; fi  # it names a real device
  mkdir alone
  (cd alone && sh -e "../$example") >.log/example 2>&1; status=$?
  report $status "$tool: $example runs alone"
  [ $status -eq 0 ] || sed 's/^/# /' .log/example | tail -n 10
  is "$tool: $example does not warn" "$(grep 'warning: ' .log/example)" ''
  rm -rf alone
done
done_testing
