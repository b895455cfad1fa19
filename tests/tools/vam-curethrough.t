# SPDX-License-Identifier: GPL-3.0-or-later
# vam-curethrough from end to end: the paper's ladder, an egg shell, and wrong inputs.
. "$VAM_SOURCE/tests/tools/testlib.sh"

light="--set projector.max_intensity_mw_cm2=110 --set projector.min_intensity_mw_cm2=0.2"  # what gives the paper's figures 2 and 4

quiet "slice the ladder" vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 -o ladder.vdb

# ---- ordinary slices: one fused feature, undercured at the bottom [CURE19 fig 2]
ok "model ordinary slices" vam-curethrough model ladder.vdb $light --section ordinary.png --report ordinary.json
is "both gaps, 10 slices of 6000 columns each, are cured" "$(json ordinary.json cure_through.voxels)" 120000
holds "the bottom edge is undercured" "$(json ordinary.json undercured.voxels) > 0"
quiet "model a part from a pipe" sh -c "cat ladder.vdb | vam-curethrough model $light --report piped.json -o dose.vdb"
is "a pipe gives the same" "$(json piped.json cure_through.voxels)" 120000
ok "the dose is a volume" test -s dose.vdb

# ---- corrected [CURE19 fig 4]
quiet "correct" vam-curethrough correct ladder.vdb $light -o slices.exr --png slices --mask mask.png --report correct.json
is "three extra slices, as in the paper" "$(json correct.json extra_slices)" 3
is "no column is infeasible" "$(json correct.json infeasible.columns)" 0
is "slice and index files" "$(ls slices | wc -l)" 54
is "the last slice is shown at 52 x 0.18 s" "$(tail -n 1 slices/frames.csv)" "00052.png,9.36,0"
ok "model corrected slices" vam-curethrough model slices.exr --target ladder.vdb $light --section corrected.png --report exact.json
is "no cure-through" "$(json exact.json cure_through.voxels)" 0
is "no undercure" "$(json exact.json undercured.voxels)" 0
ok "model the 8-bit images" vam-curethrough model slices --target ladder.vdb $light --report grey.json
is "8 bits: no undercure" "$(json grey.json undercured.voxels)" 0
is "8 bits: no cure-through" "$(json grey.json cure_through.voxels)" 0
holds "8 bits: height errors fall by more than 99 %" \
  "$(json grey.json height_error.mean_error_um) < 0.01 * $(json ordinary.json height_error.mean_error_um)"

# ---- an egg shell at the paper's h_a = 2000 um and 750 mm/h: at least 85 %
quiet "slice an egg" vam-slice --shape egg-shell:length=7,diameter=5,wall=0.6,opening=1.5 --voxel 0.05 --stretch-z 1 -o egg.vdb
ok "ordinary egg" vam-curethrough model egg.vdb $light --print-speed 750 --report egg0.json
ok "corrected egg" vam-curethrough correct egg.vdb $light --print-speed 750 --png egg --report egg.json
ok "its dose" vam-curethrough model egg --target egg.vdb $light --print-speed 750 --report egg1.json
holds "height errors fall by 85 % and more" \
  "$(json egg1.json height_error.mean_error_um) <= 0.15 * $(json egg0.json height_error.mean_error_um)"

# ---- the same of the ladder, and of the bunny where its mesh is at hand ($VAM_BUNNY)
falls() {  # falls NAME FILE: by at least 85 %, with 8-bit slices
  vam-curethrough model $2 $light --print-speed 750 --report before.json >/dev/null &&
    vam-curethrough correct $2 $light --print-speed 750 --png falls-$2 2>/dev/null &&
    vam-curethrough model falls-$2 --target $2 $light --print-speed 750 --report after.json >table
  holds "height errors of $1 fall by 85 % and more" \
    "$(json after.json height_error.mean_error_um) <= 0.15 * $(json before.json height_error.mean_error_um)"
}
falls "the ladder" ladder.vdb
is "the table ends with the sum" "$(tail -n 1 table | awk '{ print $1, $2 }')" "all $(json after.json height_error.features)"
quiet "a boat" vam-slice --shape boat --fit 8 --voxel 0.05 --stretch-z 1 -o boat.vdb
falls "a boat" boat.vdb
holds "its many heights are grouped" "$(wc -l <table) <= 25 && $(wc -l <table) > 15"
if [ -f "${VAM_BUNNY:-}" ]; then
  vam-slice "$VAM_BUNNY" --rotate 90,0,0 --fit 10 --voxel 0.05 --stretch-z 1 -o bunny.vdb 2>/dev/null
  falls "the bunny" bunny.vdb
else
  echo "# skipped: the bunny; VAM_BUNNY names no mesh"
fi

# ---- the forms of the output
quiet "the response on the way out and in again" sh -c "printf 'grey,intensity\n0,0.2\n60,4\n128,25\n255,110\n' > response.csv &&
  vam-curethrough correct ladder.vdb --set projector.max_intensity_mw_cm2=110 --set projector.response=response.csv --values grey -o grey.exr &&
  vam-curethrough model grey.exr --target ladder.vdb --set projector.max_intensity_mw_cm2=110 --set projector.response=response.csv --report response.json >/dev/null"
is "no cure-through after the round trip" "$(json response.json cure_through.voxels)" 0
is "no undercure after the round trip" "$(json response.json undercured.voxels)" 0
quiet "a stack of levels" vam-curethrough correct ladder.vdb $light --quantise -o levels.exr
ok "model the stack of grey levels" vam-curethrough model levels.exr --target ladder.vdb $light --report levels.json
is "the stack of grey levels has the errors of the images" "$(json levels.json height_error.mean_error_um)" "$(json grey.json height_error.mean_error_um)"
quiet "platform at the top" vam-curethrough correct ladder.vdb $light --platform top -o top.exr
ok "model the slices of --platform top" vam-curethrough model top.exr --target ladder.vdb --platform top $light --report top.json
is "no cure-through with --platform top" "$(json top.json cure_through.voxels)" 0
quiet "omega-max" vam-curethrough correct ladder.vdb $light --omega-max inf -o inf.exr
ok "model slices without a limit" vam-curethrough model inf.exr --target ladder.vdb $light --report inf.json
is "no cure-through without a limit" "$(json inf.json cure_through.voxels)" 0
quiet "layer by layer" vam-curethrough correct ladder.vdb $light --exposure-mode layered --print-speed 100 -o layered.exr
ok "its dose" vam-curethrough model layered.exr --target ladder.vdb $light --report layered.json
is "no undercure layer by layer" "$(json layered.json undercured.voxels)" 0
is "no cure-through layer by layer" "$(json layered.json cure_through.voxels)" 0
# The history, and so the seal, has the options: one core stands for one thread.
quiet "one thread" taskset -c 0 vam-curethrough correct ladder.vdb $light -o same.exr
quiet "all threads" sh -c "mkdir all && cp ladder.vdb all && cd all && vam-curethrough correct ladder.vdb $light -o same.exr"
same "any number of threads gives the same bytes" same.exr all/same.exr
quiet "projector frames" vam-curethrough correct ladder.vdb $light --full-frame --set projector.pixel_mm=0.05 -o full.exr

# ---- the gelation threshold of the printer file: D_f = 5 D_c = 576 mJ/cm3, the default without it
ok "model with resin.critical_dose_mj_cm3" vam-curethrough model ladder.vdb $light --set resin.critical_dose_mj_cm3=115.2 --report fifth.json
is "five times the gelation threshold" "$(json fifth.json process.full_cure_dose_mj_cm3)" 576.0
is "and with it the same errors" "$(json fifth.json cure_through.voxels)" 120000
ok "--full-cure-dose overrides it" vam-curethrough model ladder.vdb $light --set resin.critical_dose_mj_cm3=1 --full-cure-dose 576 --report given.json
is "the given dose" "$(json given.json process.full_cure_dose_mj_cm3)" 576.0

# ---- a catalogue
printf 'name,absorbance_height_um,full_cure_dose_mj_cm3\nclear,2000,576\ndark,300,576\n' >resins.csv
ok "catalogue" vam-curethrough correct ladder.vdb $light --catalogue resins.csv --print-speeds 1000,8000 --report catalogue.json
holds "the darker resin keeps narrower gaps open" \
  "$(json catalogue.json catalogue.2.narrowest_gap_um) < $(json catalogue.json catalogue.0.narrowest_gap_um)"
is "nothing prints beyond the speed limit" "$(json catalogue.json catalogue.1.prints)" false

# ---- sweep
ok "sweep" vam-curethrough sweep df_over_dc=4..6,omega_max=1/inf $light --plot sweep.png --report sweep.json
holds "the error is least if the assumed dose is the true one" "$(json sweep.json points.2.ratio) < 0.001"
holds "larger errors below the true dose" "$(json sweep.json points.0.ratio) > 0.1"
holds "larger errors above the true dose" "$(json sweep.json points.4.ratio) > 0.1"

is "the ratio is in the report" "$(json sweep.json points.2.df_over_dc)" 5.0

# ---- wrong inputs
fails 65 'slice height: 50 um is more than ten absorbance heights' \
  vam-curethrough correct ladder.vdb $light --absorbance-height 4 -o no.exr
printf 'grey,intensity\n0,0\n100,5\n200,4\n255,9\n' >falling.csv
fails 65 'falling.csv:4: intensity 4 at grey 200 is below 5' vam-curethrough correct ladder.vdb $light --set projector.response=falling.csv -o no.exr
fails 65 'do not match' vam-curethrough model full.exr --target ladder.vdb $light
fails 64 '--catalogue: does not apply to stacks on standard output' vam-curethrough correct ladder.vdb $light --catalogue resins.csv -o -
ok "a part thinner than a voxel" vam-slice --shape ladder --scale 0.02 --voxel 0.05 --stretch-z 1 -o thin.vdb
fails 65 'no voxel reaches a coverage of 1; there is nothing to print' vam-curethrough correct thin.vdb $light --min-coverage 1 -o no.exr
done_testing
