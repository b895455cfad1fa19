#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# vam-print --correct: a print in real time on simulated devices, whose resin absorbs more and whose lamp is weaker than
# planned, gets new light once it begins to scatter, and ends by it; without a record that fits it goes on until --until.
. "$VAM_SOURCE/tests/tools/testlib.sh"
. "$VAM_SOURCE/tests/tools/printlib.sh"
sed -e 's/^max_intensity_mw_cm2.*/max_intensity_mw_cm2 = 3/' \
  -e "s|^speed_deg_s.*|device = \"sim:?acceleration=1000\&log=$PWD/truth\"\nspeed_deg_s = 60|" \
  -e 's/^\[camera\]/&\ndevice = "aravis:127.0.0.1"\naxis_column = 32.5/' \
  "$VAM_SOURCE/tests/tools/curing_printer.toml" >printer.toml
export VAM_PRINTER=$PWD/printer.toml
vam-slice --shape gyroid:cell=6,sheet=1.2,diameter=7,height=5 --voxel 0.2 -o part.vdb
vam-optimize --angles 60 part.vdb -o whole.exr
vam-project whole.exr --fps 10 --turns 1 -o whole.mkv
echo '{"schema":"vam-working-curve/1","isovalue":0.04,"saturation":0.08,"critical_dose_mj_cm3":60,"rate_per_mj_cm3":0.07,"delay_s":1}' >curve.json
print() { vam-print whole.exr --display null: --uncalibrated --run-up 0.5 --max-missed 0.9 --max-missed-lit 0.9 --view-step 6 --target part.vdb "$@"; }
fails 64 'correct: requires --until' print --correct --run none
fails 64 'correct: requires --resin' print --correct --until 'missing<=1' --isovalue 0.04 --run none
fails 64 'axis-sigma: requires --correct' print --axis-sigma 1 --run none
echo '{"schema":"vam-resin/1","isovalue":0.04}' >resin.json
fails 65 'resin.json: not a record of vam-calibrate working-curve' print --correct --until 'missing<=1' --resin resin.json --run none
fails 64 'turns: is 2, but the sinogram is planned for' print --correct --until 'missing<=1' --resin curve.json --turns 2 --run none

one_print() {  # one_print RUN: with the options of vam-print that follow
  run=$1; shift; rm -f truth
  vam-sim-camera --die-with-parent --cure --cure-voxel 0.25 --cure-delay 1 --inhibitor-diffusion 0 --follow truth \
    --flips "$run/flips.jsonl" --projected whole.mkv --columns 66 --rows 46 --noise 0.002 --background 0.01 \
    --set resin.absorption_per_mm=0.07 --set projector.max_intensity_mw_cm2=2.6 >address 2>camera.err &
  camera=$!
  await test -s address
  print --run "$run" "$@" 2>errors
  status=$?
  kill $camera; wait $camera 2>/dev/null
}
one_print corrected --correct --until 'missing<=0.01' --resin curve.json --turns 14
sed 's/^/# /' errors
cut -c 1-180 corrected/renewed.jsonl | sed 's/^/# /'
is 'a corrected print ends by its light' "$status $(json corrected/summary.json outcome)" '0 complete, corrected'
ok 'new light was made' grep -q '"event":"renewed"' corrected/renewed.jsonl
is 'for each turn that the log of flips has' "$(grep -c '"event":"frames",.*turn-[0-9]*[.]exr' corrected/flips.jsonl | awk '{ print ($1 >= 1) }')" 1
is 'within one turn' "$(sed -nE 's/.*"event":"renewed".*"seconds":([0-9.]+).*/\1/p' corrected/renewed.jsonl | awk '$1 > 6' | wc -l)" 0
ok 'all is in the run folder, with its hashes' sh -c 'cd corrected && sha256sum --check --quiet SHA256SUMS && ls renewed/sensitivity.vdb plan.json'
done_testing
