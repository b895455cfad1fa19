# SPDX-License-Identifier: GPL-3.0-or-later
# vam-convert --from: what other programs keep lies where it lies for them.
. "$VAM_SOURCE/tests/tools/testlib.sh"

foreign() { python3 "$VAM_SOURCE/tests/tools/conventions.py" "$@"; }
foreign make drtvam
quiet 'a target with a fourth axis of 1' vam-convert volume.npy --from drtvam --voxel 0.25 --stretch-z 1 -o like.vdb
dose() {  # dose [OPTION...]: does that of projections.npy lie at the blobs?
  vam-convert projections.npy --geometry parallel --pixel 0.25 "$@" -o p.exr 2>said &&
    vam-dose p.exr --like like.vdb -o d.vdb 2>>said && vam-convert d.vdb -o d.npy && foreign high d.npy -3.375,-3.375
}
for program in drtvam vamtoolbox vamtoolbox-astra vamtoolbox-cuda vamtoolbox-stl vamtoolbox-stl-astra \
  vamtoolbox-stl-cuda swissvamyknife; do
  foreign make $program
  vam-convert volume.npy --from $program --voxel 0.25 --grid weight -o v.vdb && vam-convert v.vdb -o v.npy
  corner=$(vam-view v.vdb --export /dev/stdout | grep -a '^space origin' | tr -dc '0-9.,-' | cut -d, -f1,2)
  is "the volume of $program lies where it does" "$(foreign high v.npy "$corner")" True
  is "and the dose of its projections" "$(dose --from $program)" True
  is 'from another angle it does not' "$(dose --from $program --first-angle 20)" False
done
foreign make drtvam
is 'the same by its angles and axes' "$(dose --axes a-zx --first-angle 90)" True
is 'not without them' "$(dose --axes azx)" False
dose --from drtvam -v >said.dose
is 'what is taken is told' "$(grep -c 'as of drtvam: the first projection at 90 degrees, the last at 440, the axis in column 13.5' said)" 1
fails 64 "--axes: 'a-z-' is not an order of the letters zax" vam-convert projections.npy --axes a-z- --geometry parallel -o x.exr
done_testing
