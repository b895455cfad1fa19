# SPDX-License-Identifier: GPL-3.0-or-later
# The whole chain: files or one pipe give the same voxels and pixels; the number of threads does not matter.
. "$VAM_SOURCE/tests/tools/testlib.sh"

voxels() { vam-view "$1" --export "$1.nrrd" && sed '1,/^$/d' "$1.nrrd" | cksum; }  # the data behind the NRRD header

# A projector of few pixels, of which frames are made quickly.
vam-slice --print-printer --set projector.pixel_mm=0.26 --set projector.columns=256 --set projector.rows=192 -o coarse.toml
VAM_PRINTER=$PWD/coarse.toml; export VAM_PRINTER
ok 'slice' vam-slice --shape ball-in-cage --voxel 0.3 -o part.vdb
ok 'optimize' vam-optimize --geometry parallel part.vdb --angles 90 --iterations 8 -o sino.exr
ok 'resample' vam-resample sino.exr -o frames.exr
ok 'dose' vam-dose frames.exr --like part.vdb -o dose.vdb
ok 'project' vam-project frames.exr -o shown.exr

vam-slice --shape ball-in-cage --voxel 0.3 | tee part2.vdb | vam-optimize --geometry parallel --angles 90 --iterations 8 | tee sino2.exr | vam-resample |
  tee frames2.exr | vam-dose --like part.vdb -o dose2.vdb; report $? 'one pipe'
is 'the same part' "$(voxels part2.vdb)" "$(voxels part.vdb)"
is 'the same dose' "$(voxels dose2.vdb)" "$(voxels dose.vdb)"
ok 'project from the teed stack' vam-project frames2.exr -o shown2.exr
is 'the same frames' "$(voxels shown2.exr)" "$(voxels shown.exr)"
ok 'tee leaves a valid EXR' exrheader sino2.exr

for threads in 1 2; do
  vam-slice --shape ball-in-cage --voxel 0.3 --threads $threads -o t$threads.vdb &&
    vam-optimize t$threads.vdb --angles 90 --iterations 8 --threads $threads -o t$threads.frames.exr &&
    vam-dose t$threads.frames.exr --like t$threads.vdb --threads $threads -o t$threads.dose.vdb
  report $? "the chain with $threads threads"
done
is 'threads do not change the part' "$(voxels t1.vdb)" "$(voxels t2.vdb)"
is 'threads do not change the dose' "$(voxels t1.dose.vdb)" "$(voxels t2.dose.vdb)"

done_testing
