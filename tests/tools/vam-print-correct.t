# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock RESOURCE_LOCK camera COST 250
# vam-print --correct: a print in real time on simulated devices, whose resin absorbs more and whose lamp is weaker than
# planned, gets new light once it begins to scatter, and ends by it; without a record that fits it goes on until --until.
. "$VAM_SOURCE/tests/tools/testlib.sh"
. "$VAM_SOURCE/tests/tools/printlib.sh"
sed -e 's/^max_intensity_mw_cm2.*/max_intensity_mw_cm2 = 3/' \
  -e 's/^speed_deg_s.*/speed_deg_s = 60/' \
  -e 's/^\[camera\]/&\ndevice = "aravis:127.0.0.1"\naxis_column = 32.5/' \
  "$VAM_SOURCE/tests/tools/curing_printer.toml" >printer.toml
export VAM_PRINTER=$PWD/printer.toml
vam-slice --shape gyroid:cell=6,sheet=1.2,diameter=7,height=5 --voxel 0.2 -o part.vdb
vam-optimize --angles 60 part.vdb -o whole.exr
vam-project whole.exr --fps 10 --turns 1 --accept-dose -o whole.mkv
echo '{"schema":"vam-working-curve/1","isovalue":0.04,"saturation":0.08,"critical_dose_mj_cm3":60,"rate_per_mj_cm3":0.07,"delay_s":1}' >curve.json
print() {
  case " $* " in *' --view-step '*) ;; *) set -- "$@" --view-step 6 ;; esac
  vam-print whole.exr --display null: --uncalibrated --run-up 0.5 --max-missed 0.9 --max-missed-lit 0.9 --target part.vdb \
    --set stage.device="sim:?acceleration=1000&max_speed=120&log=$PWD/truth.$run" "$@"; }
run=none
fails 64 'correct: requires --resin' print --correct --until 'missing<=1' --isovalue 0.04 --run none
fails 64 'axis-sigma: requires --correct' print --axis-sigma 1 --run none
echo '{"schema":"vam-resin/1","isovalue":0.04}' >resin.json
fails 65 'resin.json: not a record of vam-calibrate working-curve' print --correct --until 'missing<=1' --resin resin.json --run none
fails 64 'turns: is 2, but the sinogram is planned for' print --correct --until 'missing<=1' --resin curve.json --turns 2 --run none

# Side by side, as prints mostly wait: before the GigE Vision camera one after the other, beside them some before one of
# vam-capture's own.
go() {  # go RUN OPTIONS...: that print in the background, without the camera's lock; $printing
  run=$1; shift
  (exec 9>&-; print --run "$run" "$@") 2>"$run.err" & printing=$!
}
seen() {  # seen RUN OPTIONS...: the same before the GigE Vision camera, which sees resin cure
  run=$1; rm -rf "$run" "truth.$run"
  camera_up --cure --cure-voxel 0.25 --cure-delay 1 --inhibitor-diffusion 0 --follow "truth.$run" \
    --flips "$run/flips.jsonl" --projected whole.mkv --columns 66 --rows 46 --noise 0.002 --background 0.01 \
    --set resin.absorption_per_mm=0.07 --set projector.max_intensity_mw_cm2=2.6
  go "$@"
}
seen_to_end() { seen "$@"; wait $printing; status=$?; camera_down; }
beside() {  # beside RUN OPTIONS...: the same before a camera of vam-capture's own, which sees a cylinder grow
  go "$@" --set camera.device="sim:?follow=$PWD/truth.$1&flips=$PWD/$1/flips.jsonl&part=cylinder:diameter=7,height=5&lit=20&columns=66&rows=46&noise=0.002&background=0.01"
}
lit_for() { grep '"event":"flip"' "$1/flips.jsonl" 2>/dev/null | tail -n 1 | sed -nE 's/.*"angle_deg":([0-9.]+).*/\1/p' | awk -v least="$2" '{ last = $1 } END { exit !(last >= least) }'; }
fails 64 'dark-turns: requires --view-step' vam-print whole.exr --display null: --uncalibrated --dark-turns 1 --run none
fails 64 'dark-turns: .0.8. is not a whole number' print --dark-turns 0.8 --run none
fails 64 'dark-turns: .two. is not a number' print --dark-turns two --run none
fails 64 'turns' print --turns two --dark-turns 1 --run none
fails 64 'dark-turns: conflicts with --until' print --until 'missing<=1' --isovalue 0.04 --dark-turns 1 --run none
sed 's/"critical_dose_mj_cm3":60/"critical_dose_mj_cm3":20/; s/"delay_s":1/"delay_s":100/' curve.json >other.json
beside open --correct --until 'missing<=50' --resin other.json --turns 14
open=$printing
seen lost --correct --until 'missing<=0.01' --resin curve.json --turns 14
lost=$printing
# vam-ost is lost first, then vam-print itself is killed.
killed=ost-killed-$$
beside $killed --correct --until 'missing<=0.01' --resin curve.json --turns 14
until lit_for $killed 90 || ! kill -0 $printing 2>/dev/null; do sleep 0.1; done
pkill -KILL -f -- "-o $killed/[o]st"
await grep -q 'open loop from turn' $killed.err
ok 'without vam-ost it goes on in open loop, too' lit_for $killed 90
pkill -KILL -P $printing; wait $printing 2>/dev/null
await flock -n $killed/events.jsonl true
ok 'one that is killed then leaves nothing that prints' sh -c "flock -n $killed/events.jsonl true && ! pgrep -f -- '--log $killed/[f]lips.jsonl'"
while ! lit_for lost 360 && kill -0 $lost 2>/dev/null; do sleep 0.1; done
camera_down
await grep -q 'open loop from turn' lost.err  # before there is a camera again
fairly '[ "$(ls dark/views | wc -l)" -gt 58 ]' seen_to_end dark --turns 2 --accept-dose --dark-turns 1 --view-step 18 --set stage.speed_deg_s=120
sed 's/^/# /' dark.err
is 'the light goes off after two turns, the stage after three' "$(grep '"frame":[0-9]' dark/flips.jsonl | tail -n 1 | sed -E 's/.*"angle_deg":([0-9.]+).*/\1/' | awk '{ print ($1 > 700 && $1 <= 720) }') $(tail -n 1 dark/angles.jsonl | sed -E 's/.*"angle_deg": ?([0-9.]+).*/\1/' | awk '{ print ($1 > 1079) }')" '1 1'
holds 'with views of all three' "$(ls dark/views | wc -l) > 58"
renewed_in_time() { [ $status -eq 0 ] && [ "$(sed -nE 's/.*"event":"renewed".*"seconds":([0-9.]+).*/\1/p' corrected/renewed.jsonl | awk '{ print ($1 <= 6) }' | sort -u)" = 1 ]; }
fairly renewed_in_time seen_to_end corrected --correct --until 'missing<=0.01' --resin curve.json --turns 14
sed 's/^/# /' corrected.err
cut -c 1-180 corrected/renewed.jsonl | sed 's/^/# /'
is 'a corrected print ends by its light' "$status $(json corrected/summary.json outcome)" '0 complete, corrected'
ok 'new light was made' grep -q '"event":"renewed"' corrected/renewed.jsonl
is 'for each turn that the log of flips has' "$(grep -c '"event":"frames",.*turn-[0-9]*[.]exr' corrected/flips.jsonl | awk '{ print ($1 >= 1) }')" 1
is 'within one turn' "$(sed -nE 's/.*"event":"renewed".*"seconds":([0-9.]+).*/\1/p' corrected/renewed.jsonl | awk '$1 > 6' | wc -l)" 0
ok 'all is in the run folder, with its hashes' sh -c 'cd corrected && sha256sum --check --quiet SHA256SUMS && ls renewed/sensitivity.vdb plan.json'
holds 'how often is in the summary' "$(json corrected/summary.json correction.renewed) == $(grep -c '"event":"renewed"' corrected/renewed.jsonl)"
vam-status corrected >line
ok 'its state names the turn at which it ended, and the sensitivity' awk '{ for (i = 1; i < NF; ++i) if ($i == "turn" && $(i + 2) == "of") off = $(i + 1) - $(i + 3) } END { exit !(off * off < 0.01 && /(light from turn .* sensitivity|light as before)/) }' line
wait $open
is 'with the record of another resin it goes on as planned' "$? $(json open/summary.json outcome)" '0 stopped by vam-ost'
ok 'and says so' grep -q 'not corrected: vam-dose: flips.jsonl: no light .*; see .*renewed.jsonl' open.err
is 'why, without names of scratch files' "$(grep -c '"event":"hold".*vam-correct[.]' open/renewed.jsonl)" 0
wait $lost; status=$?
sed 's/^/# /' lost.err
is 'without its camera it is completed in open loop' "$status $(json lost/summary.json outcome)" '1 complete, in open loop'
ok 'which it says at once, and at the end' sh -c 'grep -q "warning: .*; the print goes on in open loop from turn [1-9].*, as planned, to turn" lost.err && grep -q "nothing was measured after turn" lost.err'
holds 'and in the summary' "$(json lost/summary.json correction.open_loop_from) >= 1"
planned=$(json lost/plan.json turns)
holds 'for the turns of the plan' "$(json lost/summary.json reached.turns) >= $planned - 0.1 && $(json lost/summary.json reached.turns) <= $planned + 0.1"
done_testing
