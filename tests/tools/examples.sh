# The examples of a tool's manual page run. usage: examples.sh TOOL
. "$VAM_SOURCE/tests/tools/testlib.sh"
tool=$1
PATH=$VAM_SOURCE/scripts:$PATH  # vam-print

awk '/^\.Sh /{inside = ($2 == "EXAMPLES")} inside && /^\.Ed/{code = 0} inside && code{print} inside && /^\.Bd/{code = 1}' \
  "$VAM_SOURCE/man/$tool.1" | sed -e 's/^\\&//' -e 's/\\e/\\/g' >commands
[ $tool != vam-print ] || sed -i '/drm:/,$d' commands  # its other examples name real devices
[ -s commands ]; report $? "$tool: the page has examples"
mkdir examples
(cd examples && sh -e ../commands) >.log/example 2>&1; status=$?
report $status "$tool: the examples run"
[ $status -eq 0 ] || sed 's/^/# /' .log/example | tail -n 10
is "$tool: the examples use no former spelling" "$(grep ' is now ' .log/example)" ''
done_testing
