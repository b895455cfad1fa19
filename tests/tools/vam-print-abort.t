# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock COST 200
# A print that is ended, from outside or by the end of one of its tools: dark and at standstill in time, with the right
# status and a summary.
. "$VAM_SOURCE/tests/tools/testlib.sh"
. "$VAM_SOURCE/tests/tools/printlib.sh"

end_by() {  # end_by SIGNAL: of the print
  ended_s=$(perl -MTime::HiRes=clock_gettime,CLOCK_MONOTONIC -e 'printf "%.4f", clock_gettime(CLOCK_MONOTONIC)')
  kill -"$1" $printing
}
in_time() {  # by the logs of light engine and table, which itself takes 20 ms to brake
  dark=$(grep bits leds | tail -n 1 | json /dev/stdin t_monotonic_s)
  still=$(grep '"standing"' truth | tail -n 1 | json /dev/stdin t_monotonic_s)
  holds "$run: dark and at standstill within 100 ms" "$dark - $ended_s < 0.1 && $still - $ended_s > 0 && $still - $ended_s < 0.1"
}
child() { pgrep -P $printing -x "$1"; }

screen_up 64 48
begin interrupt
is 'a terminal has the print in its foreground, and none of its tools' "$(pgrep -g "$(ps -o pgid= -p $printing | tr -d ' ')" -P $printing)" ''
end_by INT
aborted 130 aborted ''; in_time
begin term; kill -TSTP $printing
is 'nor does ^Z stop who watches over them' "$(ps -o stat= -p $printing | grep -c T)" 0
end_by TERM
aborted 143 aborted ''; in_time
begin hangup; end_by HUP
aborted 129 aborted ''; in_time
begin killed; tools=$(pgrep -P $printing); end_by KILL
aborted 137 '' ''; in_time
gone() { for pid in $tools; do ! kill -0 "$pid" 2>/dev/null || return 1; done; }
await gone; ok 'killed: its tools end, too' gone
begin projector-killed; kill -KILL "$(child vam-project)"
aborted 137 'project failed' ''
begin stage-killed; kill -KILL "$(child vam-stage)"
aborted 137 'stage failed' ''
screen_down
done_testing
