# SPDX-License-Identifier: GPL-3.0-or-later
# Light for what is left of a dose: a print whose first half was too bright below and too dark above is completed.
. "$VAM_SOURCE/tests/tools/testlib.sh"

volumes() { python3 "$VAM_SOURCE/tests/tools/volumes.py" "$@"; }
pw() { json "$1" pw; }
resin='--set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05'
vam-slice $resin --shape gyroid:diameter=7,height=5 --voxel 0.25 -o part.vdb
vam-optimize $resin --angles 90 part.vdb -o whole.exr --report whole.json
vam-dose $resin whole.exr --like part.vdb --exposure-plan -o whole.vdb
volumes fall whole.vdb 0.5 0.8 half.vdb

rest="vam-optimize $resin --angles 90 part.vdb --delivered half.vdb --init whole.exr"
as_many="--iterations $(json whole.json iterations)"
quiet 'light for the rest' $rest $as_many -o rest.exr --report rest.json
vam-dose $resin rest.exr --like part.vdb -o turn.vdb
volumes sum half.vdb turn.vdb 1 sum.vdb
volumes sum half.vdb whole.vdb 0.5 open.vdb
for one in whole sum open half; do vam-score $resin $one.vdb --target part.vdb --report $one.score.json >/dev/null; done
holds 'half and half of the same light do not print' "$(json open.score.json ver) > 0 && $(pw open.score.json) < 0"
# As many iterations as the light of the whole part took give as wide a window.
holds 'half and the light that was computed for the rest do' "$(json sum.score.json ver) == 0 && $(pw sum.score.json) > 0.9 * $(pw whole.score.json)"
# The middle of a window of 0.12 of 71 mJ/cm3, to an eighth of its width.
holds 'at the critical dose' "($(json sum.score.json threshold) - 50) ^ 2 < 1"
# Sums of the same floats, which round to 1e-7, in another order.
holds 'as its report says' "($(pw sum.score.json) - $(pw rest.json)) ^ 2 < 1e-5 ^ 2"
holds 'which states how much there was' "($(json rest.json delivered.part_mean_percent) / (100 * $(json half.score.json mean_part) / 50) - 1) ^ 2 < 1e-5 ^ 2 && $(json rest.json delivered.void_gelled_voxels) == 0"
volumes fall whole.vdb 1.6 0 over.vdb
vam-optimize $resin --angles 90 part.vdb --delivered over.vdb --init whole.exr --iterations 2 -o late.exr --report late.json 2>late
is 'which does not print, whatever its window' "$(json late.json verdict | grep -c '^will not print at the threshold of 0.8 (void up to 1[.].*, part at least 1[.]')" 1
ok 'what has gelled in the void is a warning' grep -q 'over.vdb: [0-9]* voxels of the void have received the critical dose already, which no light can undo; stop earlier, or with less light$' late
volumes fall whole.vdb 1 0.01 tilted.vdb  # doses are alike in pairs
vam-score $resin tilted.vdb --target part.vdb --report tilted.json >/dev/null
volumes fall tilted.vdb "$(awk "BEGIN { print 50.001 / $(json tilted.json max_void) }")" 0 edge.vdb
vam-optimize $resin --angles 90 part.vdb --delivered edge.vdb --init whole.exr --iterations 1 -o late.exr 2>late
ok 'of one voxel, too' grep -q 'edge.vdb: 1 voxel of the void has received the critical dose already' late
volumes fall half.vdb 0.25 0 quarter.vdb
volumes fall half.vdb 0.75 0 rest.vdb
ok 'doses of several projections' vam-optimize $resin --angles 90 part.vdb --delivered quarter.vdb --delivered rest.vdb --init whole.exr $as_many -o two.exr --report two.json
holds 'add up' "($(json two.json delivered.part_mean_percent) - $(json rest.json delivered.part_mean_percent)) ^ 2 < 1e-6 && ($(pw two.json) - $(pw rest.json)) ^ 2 < 1e-8"
ok 'as many turns as are left' $rest --turns 1 --iterations 10 -o one.exr --report one.json
is 'which the light states, as its full scale' "$(vam-check one.exr >/dev/null; $exr attr one.exr vam:shown_turns | tr -d ' ')" 1
vam-optimize $resin --angles 90 part.vdb --delivered half.vdb --init whole.exr --turns 20 --iterations 1 -o slow.exr --report slow.json
holds 'in more turns than it takes, those that it states' "$(json slow.json turns) == 20 && ($(json slow.json duration_s) / $(json one.json duration_s) / 20 - 1) ^ 2 < 1e-12"
vam-dose $resin one.exr --like part.vdb -o once.vdb
volumes sum half.vdb once.vdb 1 total.vdb
vam-score $resin total.vdb --target part.vdb --report total.json >/dev/null
holds 'at which it completes the dose' "$(json total.json ver) == 0 && ($(json total.json threshold) - 50) ^ 2 < 1"
ok 'as many angles as the light that it begins with has' vam-optimize $resin part.vdb --delivered half.vdb --init whole.exr --iterations 1 -o same.exr
ok 'for an axis 10 columns beside' vam-optimize $resin part.vdb --column-offset 10 --angles 90 -o aside.exr --report aside.json
vam-dose $resin aside.exr --like part.vdb --exposure-plan --column-offset 10 -o aside.vdb --report there.json
vam-score $resin aside.vdb --target part.vdb --report aside.score.json >/dev/null
holds 'the projections print there' "$(json aside.score.json ver) == 0 && ($(pw aside.score.json) - $(pw whole.score.json)) ^ 2 < 0.02 ^ 2"
vam-dose $resin aside.exr --like part.vdb --exposure-plan -o aside.vdb
vam-score $resin aside.vdb --target part.vdb --report aside.score.json >/dev/null
holds 'and not where the printer file has the axis' "$(json aside.score.json ver) > 0"
is 'whose axis they state all the same' "$($exr attr aside.exr vam:printer)" "$($exr attr whole.exr vam:printer)"
holds 'are enough' "$(json one.json turns) == 1 && $(json one.json ver) == 0"

vam-dose whole.exr --set resin.absorption_per_mm=0 --like part.vdb -o relative.vdb
fails 65 "relative.vdb: the dose is in units of 'relative', not mJ/cm3" vam-optimize $resin --angles 90 part.vdb --delivered relative.vdb --init whole.exr -o none.exr
vam-dose $resin whole.exr -o other.vdb
fails 65 'other.vdb: has [0-9].* but light reaches .*compute it by vam-dose --like' vam-optimize $resin --angles 90 part.vdb --delivered other.vdb --init whole.exr -o none.exr
volumes fall whole.vdb 0.5 1.5 negative.vdb
fails 65 'a dose is 0 and more' vam-optimize $resin --angles 90 part.vdb --delivered negative.vdb --init whole.exr -o none.exr
done_testing
