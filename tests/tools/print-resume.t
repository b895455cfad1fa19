# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# trials: 100
# A print of a turn of which the script or a tool is killed at a random moment, and its resumption: together they show
# every frame as long as a whole print does, to one vertical blank. A fifth of VAM_TRIALS kills (10; 100: "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
trials=$((${VAM_TRIALS:-10} / 5))
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration=9000&min_angle=-1e7&max_angle=1e7"\nspeed_deg_s = 90\n' >>printer.toml
print() { vam-print frames.exr --display null: --light sim: --max-missed 0.9 --max-missed-lit 0.9 --run-up 0.05 --uncalibrated --frames-per-turn 60 "$@"; }
cat >judge.py <<'PY'
# The largest difference, over 60 stage angles, between the showing times in the first run and those in the others
# together, in vertical blanks of 1/60 s.
import json, sys
def shown(run):
    flips = [json.loads(l) for l in open(run + "/flips.jsonl") if l.endswith("}\n")]
    flips = [f for f in flips if f["event"] == "flip"] + [None]
    times = [0.0] * 60
    for now, later in zip(flips, flips[1:]):
        if now["frame"] >= 0:
            times[now["frame"]] += 60 * (later["t_monotonic_s"] - now["t_monotonic_s"]) if later else 1
    return times
whole, *parts = [shown(run) for run in sys.argv[1:]]
print("%.3f" % max(abs(w - sum(p)) for w, *p in zip(whole, *parts)))
PY
moments=$(python3 -c "import random
random.seed(14)
for n in range($trials): print('%.3f' % random.uniform(0.1, 3.8), random.choice(['print', 'project', 'stage']))")
print --turns 1 --run whole
is 'a whole print lasts a turn' "$? $(json whole/summary.json outcome)" '0 done'
number_of=0 worst=0
while read -r moment victim; do
  number_of=$((number_of + 1)) killed=killed$number_of rest=rest$number_of
  (exec vam-print frames.exr --display null: --light sim: --max-missed 0.9 --max-missed-lit 0.9 --run-up 0.05 --uncalibrated \
    --frames-per-turn 60 --turns 1 --run $killed) 2>errors & printing=$!
  await grep -qs '"frame":[0-9]' $killed/flips.jsonl
  sleep "$moment"
  case $victim in
    print) kill -KILL $printing ;;
    *) kill -KILL $(pgrep -f "[v]am-$victim .*$killed/printer.toml") ;;
  esac
  wait $printing 2>/dev/null
  for tool in '[v]am-project' '[v]am-stage'; do await sh -c "! pgrep -f '$tool.*$killed/printer.toml' >/dev/null"; done
  print --resume $killed --run $rest 2>errors; status=$?
  [ $status -eq 0 ] || sed 's/^/# /' errors
  off=$(python3 judge.py whole $killed $rest)
  echo "# $victim killed after $moment s of light: status $status, $off blanks"
  worst=$(awk "BEGIN { print ($status != 0 ? 999 : $off > $worst ? $off : $worst) }")
done <<MOMENTS
$moments
MOMENTS
echo "# worst: $worst blanks"
is 'every kill was tried' $number_of $trials
holds 'the dose differs by no more than a frame' "$worst <= 1.1"
done_testing
