# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RESOURCE_LOCK camera COST 250
# scripts/lab: every command of vam-lab(7), in order, on the simulated bench; and what Control-C leaves.
. "$VAM_SOURCE/tests/tools/testlib.sh"
lab=$VAM_SOURCE/scripts/lab
exec 9>"${XDG_RUNTIME_DIR:-/tmp}/vam-gige-test.lock"; flock -w 300 9  # its camera has GigE Vision's port, which is the machine's

fails 64 'lab: --fast: unknown option' "$lab" --fast
mkdir taken
fails 73 'lab: taken: exists' "$lab" taken

# Control-C while the camera sees and the stage turns: it reaches the whole foreground, as a terminal does it.
cat >interrupt.py <<'PY'
import json, os, signal, subprocess, sys, time
lab = subprocess.Popen([sys.argv[1], 'stopped'], stderr=open('stopped.err', 'w'), stdout=subprocess.DEVNULL, start_new_session=True,
                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
until = time.time() + 120
def turned():  # in the first scan, whose views the camera takes meanwhile
    try: return any(json.loads(line).get('angle_deg', 0) >= 180 for line in open('stopped/scans/angles.jsonl'))
    except (OSError, ValueError): return False
while time.time() < until and not turned(): time.sleep(0.05)
bench = subprocess.run(['ps', '--ppid', str(lab.pid), '-o', 'pid='], capture_output=True, text=True).stdout.split()
began = time.time()
os.killpg(lab.pid, signal.SIGINT)
status = lab.wait(60)
left = [pid for pid in bench if os.path.exists(f'/proc/{pid}/exe') and os.access(f'/proc/{pid}/exe', os.R_OK)]
print(status, len(bench) >= 4, len(left), time.time() - began < 10)
PY
is 'Control-C: status, bench running, left behind, at once' "$(python3 interrupt.py "$lab")" '130 True 0 True'
is 'and the bench is removed' "$(ls -A stopped | grep -Ec 'bench|^stage$')" 0

# A machine too busy to show every image ends a print by design; it is then repeated.
began=$(date +%s)
for attempt in 1 2 3; do
  rm -rf lab
  "$lab" >out 2>err; status=$?
  [ $status -eq 75 ] || break
  tail -n 1 err | sed 's/^/# attempt ended: /'
  began=$(date +%s)
done
is 'the whole tutorial' $status 0
[ $status -eq 0 ] || tail -n 5 err | sed 's/^/# /'
took=$(($(date +%s) - began))
echo "# in $took s"
holds 'in five minutes at most' "$took <= 300"
is 'every section was run' "$(grep -c '^== ' err)" 8
page=$VAM_SOURCE/man/vam-lab.7
is 'and every command of the page was shown' "$(grep -c '^\$ ' err)" \
  "$(awk '/^\.Sh 9/{exit} /^\.Ed/{code = 0} code{++lines} /^\.Bd/{code = 1} END{print lines}' "$page")"  # 9: cron.t
is 'the print is done' "$(json lab/print/summary.json outcome)" 'done'
holds 'with both turns' "$(json lab/print/summary.json reached.turns) > 1.95"  # the angle of the last image
is 'with the records' "$(json lab/print/summary.json calibration.edges.status)" pass
holds 'the axis in force is that of the bench' "($(json lab/records/current-edges.json values.axis_column.value) - 106.7) ^ 2 < 0.1 ^ 2"
is 'its page' "$(grep -c '<title>ended: done - print</title>' lab/print/page.html)" 1
is 'the print was captured' "$(ls lab | grep -c 'scatter.png\|dose.png')" 2
is 'the bench is removed' "$(ls -A lab | grep -Ec 'bench|^stage$')" 0
done_testing
