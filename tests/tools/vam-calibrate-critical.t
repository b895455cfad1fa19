# SPDX-License-Identifier: GPL-3.0-or-later
# vam-calibrate critical-dose: a ball in a dose that falls by 20 mJ/cm3 a millimetre, printed 0.1 mm too small.
. "$VAM_SOURCE/tests/tools/testlib.sh"
printf '%s\n' '[resin]' 'critical_dose_mj_cm3 = 60' 'absorption_per_mm = 0.05' >printer.toml
export VAM_PRINTER=$PWD/printer.toml
$npy of dose.npy 61,61,61 'max(0, 100 - 2 * hypot(k - 30, j - 30, i - 30))'
vam-convert dose.npy --voxel 0.1 --grid dose --value-unit mJ/cm3 -o dose.vdb
vam-convert dose.npy --voxel 0.1 --grid dose --value-unit relative -o relative.vdb
critical() { vam-calibrate critical-dose --turns 1 "$@"; }
ball() { vam-slice --shape sphere:diameter=$1 --voxel 0.1 --stretch-z 1 -o $2.vdb; }
ball 3.8 print; ball 4 design
quiet 'the dose at a surface' critical print.vdb --isovalue 0.5 --dose dose.vdb --design design.vdb -o critical.json
# Coverages of voxels place a surface within 0.005 mm.
holds 'is that of its radius' "($(json critical.json critical_dose_mj_cm3) - 62) ^ 2 < 0.1 ^ 2"
holds 'at the design it is lower' "($(json critical.json design_dose_mj_cm3) - 60) ^ 2 < 0.1 ^ 2"
holds 'and the next print needs the difference' "($(json critical.json next_critical_dose_mj_cm3) - 62) ^ 2 < 0.15 ^ 2"
holds 'the slope is stated' "($(json critical.json gradient_mj_cm3_mm) - 20) ^ 2 < 0.3 ^ 2"
vam-sdf print.vdb design.vdb --isovalue 0.5 --align none -o print.ply >/dev/null
critical print.ply --dose dose.vdb -o mesh.json
holds 'a mesh gives the same' "($(json mesh.json critical_dose_mj_cm3) - $(json critical.json critical_dose_mj_cm3)) ^ 2 < 0.02 ^ 2"
is 'without a design nothing is said of the next print' "$(grep -c next_critical mesh.json)" 0
printf 'OFF\n4 4 0\n-2 -2 -2\n2 -2 -2\n0 2 -2\n0 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >other.off
critical other.off --dose dose.vdb -o other.json 2>err; status=$?
is 'a surface that does not follow the dose is told' "$status $(grep -c 'varies by .* is no surface of this dose' err)" '1 1'
printf 'OFF\n4 4 0\n8 -2 -2\n12 -2 -2\n10 2 -2\n10 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >away.off
fails 65 'away.off: 100 % of its surface lies beyond the dose' critical away.off --dose dose.vdb
fails 65 'not mJ/cm3' critical print.ply --dose relative.vdb
fails 64 'give the isovalue' critical print.vdb --dose dose.vdb
fails 65 'no surface' critical print.vdb --isovalue 7 --dose dose.vdb
fails 64 'dose' critical print.ply
fails 66 'absent' critical print.ply --dose absent.vdb
printf "%s\n" "[resin]" "absorption_per_mm = 0.05" >printer.toml
fails 64 'requires resin.critical_dose_mj_cm3' critical print.ply --dose dose.vdb --design design.vdb
fails 65 'dose.vdb: is of no print that was made .*--turns' vam-calibrate critical-dose print.ply --dose dose.vdb
vam-calibrate critical-dose print.ply --dose dose.vdb --turns 2 -o twice.json
holds 'turns of a dose that is of one' "($(json twice.json critical_dose_mj_cm3) / $(json mesh.json critical_dose_mj_cm3) - 2) ^ 2 < 1e-6"
done_testing
