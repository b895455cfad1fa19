# SPDX-License-Identifier: GPL-3.0-or-later
# vam-correct: volumes and a record to the dose that the light for the rest starts from, and what it refuses;
# tests/lib/metrology judges the fit, vam-correct-renew.t what a print makes of it.
. "$VAM_SOURCE/tests/tools/testlib.sh"
dose='50 + 15 * sin(0.6 * i) * cos(0.5 * j) * sin(0.5 * k)'  # ripples about the critical dose
$npy of dose.npy 24,24,24 "$dose"
$npy of small.npy 12,12,12 "$dose"
$npy of scatter.npy 24,24,24 "0.08 / (1 + exp((50 - 0.9 * ($dose)) / 4))"
$npy of clear.npy 24,24,24 0
volume() { vam-convert $1.npy --voxel 0.2 --grid $2 --value-unit "$3" -o $1.vdb; }
volume dose dose mJ/cm3; volume small dose mJ/cm3; volume scatter scatter 'view units per mm'; volume clear scatter 'view units per mm'
echo '{"schema":"vam-working-curve/1","isovalue":0.04,"saturation":0.08,"critical_dose_mj_cm3":50,"rate_per_mj_cm3":0.0625}' >curve.json
correct() { scatter=$1; shift; vam-correct $scatter --curve curve.json --resolution 0 "$@"; }
quiet 'a resin that needs a ninth more' correct scatter.vdb --acted dose.vdb -o delivered.vdb --sensitivity field.vdb --report report.json
is 'light may be made' "$(json report.json verdict)" go
holds 'its sensitivity' "($(json report.json sensitivity_mean) - 0.9) ^ 2 < 0.002 ^ 2 && $(json report.json sensitivity_sigma) < 0.03"
vam-convert delivered.vdb -o delivered.npy; vam-convert field.vdb -o field.npy
judged=$($npy eval 'max(abs(d - (p + 50 * (1 - 1 / s))) for d, p, s in zip(*v))' delivered.npy dose.npy field.npy)
holds 'the dose that planned light completes' "$judged < 1e-4"  # floats of 50
quiet 'the turn after it' correct scatter.vdb --acted dose.vdb --before report.json -o delivered.vdb --report later.json
holds 'is surer' "$(json later.json sensitivity_sigma) < $(json report.json sensitivity_sigma)"

rm -f none.vdb
correct clear.vdb --acted dose.vdb -o none.vdb --report held.json 2>said
is 'a volume in which nothing scatters' "$? $(grep -c 'clear.vdb: the sensitivity is known to .* % only, not 3 %' said)" '1 1'
is 'doubt is reported, and no dose is written' "$(json held.json verdict) $(ls none.vdb 2>/dev/null)" 'hold '
fails 1 'sensitivity is 0.9.*, beyond 0.952 to 1.05' correct scatter.vdb --acted dose.vdb --max-factor 1.05 -o none.vdb
vam-convert dose.npy --voxel 0.2 --grid scatter --value-unit mJ/cm3 -o lit.vdb
fails 65 'lit.vdb: its values are a dose in mJ/cm3, not scattering' correct lit.vdb --acted dose.vdb -o none.vdb
fails 64 'acted: 1 file, not the three that --column-offset requires' correct scatter.vdb --acted dose.vdb --column-offset 1 -o none.vdb
fails 65 'small.vdb: has other voxels than dose.vdb' correct scatter.vdb --acted dose.vdb --acted small.vdb --acted dose.vdb --column-offset 1 -o none.vdb
fails 65 'curve.json|vam-correct/1' correct scatter.vdb --acted dose.vdb --before curve.json -o none.vdb
sed 's/"seal".*/"x": 0/; s/"log_terms"/"terms"/' report.json >edited.json
fails 65 'edited.json: has no field of vam-correct' correct scatter.vdb --acted dose.vdb --before edited.json -o none.vdb
: >empty.json
fails 65 'empty.json' vam-correct scatter.vdb --curve empty.json --acted dose.vdb -o none.vdb
echo '{"schema":"vam-working-curve/1","isovalue":0.04,"saturation":0.08}' >half.json
fails 65 'half.json: rate_per_mj_cm3 is not a number above 0' vam-correct scatter.vdb --curve half.json --acted dose.vdb -o none.vdb
is 'nothing is left' "$(ls none.vdb 2>/dev/null)" ''
done_testing
