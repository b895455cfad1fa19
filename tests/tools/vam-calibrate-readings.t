# SPDX-License-Identifier: GPL-3.0-or-later
# Readings of other instruments: a photodiode's by grey level, cured thicknesses by exposure.
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 -o ladder.vdb || exit 1
printf 'exposure_mj_cm2,thickness_um\n20,370\n20,381\n50,1168\n50,1175\n130,2004\n130,1996\n' >curve.csv
ok "working curve" vam-calibrate cure-depth curve.csv --plot curve.png --report curve.json
holds "h_a" "$(json curve.json absorbance_height_um) > 1900 && $(json curve.json absorbance_height_um) < 2100"
is "the logarithm is stated" "$(json curve.json logarithm_base)" 10
printf 'grey,reading\n0,1.2\n64,6.3\n128,25\n192,58\n255,111\n' >diode.csv
ok "response" vam-calibrate photodiode diode.csv --dark-reading 1 -o table.csv --plot response.png --report diode.json
is "dark reading subtracted" "$(tail -n 1 table.csv)" "255,110"
quiet "the table is one that correct reads" vam-curethrough correct ladder.vdb --set projector.max_intensity_mw_cm2=110 --set projector.response=table.csv -o x.exr
printf 'grey,reading\n0,0\n100,5\n200,4\n255,9\n' >falling.csv
fails 65 'the reading falls from 5 at grey 100 to 4 at grey 200' vam-calibrate photodiode falling.csv -o no.csv
done_testing
