# SPDX-License-Identifier: GPL-3.0-or-later
# What cannot be printed is refused before light is computed from it, by every tool that does.
. "$VAM_SOURCE/tests/tools/testlib.sh"

box 4 4 1 >box.off
ok 'a part' vam-slice box.off --voxel 0.2 -o part.vdb
small_printer >printer.toml
ok 'its light' vam-optimize part.vdb --method fbp --angles 24 -o light.exr
# The one value 1 of a tile in the file becomes another: a float of the archive that stands for solid. Another program
# would have written it, so it has no seal.
bad() {  # bad FILE VALUE
  python3 - part.vdb "$1" "$2" <<'PY'
import struct, sys
source, to, value = sys.argv[1:]
data = open(source, 'rb').read().replace(b'vam:seal', b'was:seal').replace(b'vam:facts_seal', b'was:facts_seal')
one, other = struct.pack('<f', 1), struct.pack('<f', float(value))
open(to, 'wb').write(data.replace(one, other))
PY
}
bad minus.vdb -3
bad huge.vdb 1e30
bad grey.vdb 3
fails 65 "minus.vdb: grid 'target' has -3 in voxel \(.*\); this is coverage, 0 to 1" vam-optimize minus.vdb -o x.exr
fails 65 "huge.vdb: grid 'target' has 1e\+30 in voxel" vam-optimize huge.vdb -o x.exr
fails 65 'coverage, 0 to 1' vam-dose light.exr --like minus.vdb -o x.vdb
fails 65 'coverage, 0 to 1' vam-sinogram minus.vdb -o x.exr
fails 65 'coverage, 0 to 1' vam-curethrough correct minus.vdb -o x.exr
fails 65 'coverage, 0 to 1' vam-score part.vdb --grid target --target minus.vdb
fails 65 "huge.vdb: grid 'target' has 1e\+30 in voxel" vam-sdf part.vdb huge.vdb --isovalue 0.5
fails 65 "minus.vdb: grid 'target' has -3 in voxel" vam-sdf minus.vdb part.vdb --isovalue 0.5
ok 'a surface beyond 1 is of a grey target' vam-sdf grey.vdb part.vdb --isovalue 1.5 --align none
fails 65 "stdin: grid 'target' occurs twice" sh -c 'cat part.vdb part.vdb | vam-optimize - -o x.exr'
cat part.vdb part.vdb >two.vdb
fails 65 "two.vdb: grid 'target' occurs twice; keep one of them, or rename it" vam-sinogram two.vdb -o x.exr
fails 65 "two.vdb: grid 'target' occurs twice; keep one of them, or rename it" vam-view two.vdb -o x.png
fails 65 "two.vdb: grid 'target' occurs twice; keep one of them, or rename it" vam-sdf two.vdb part.vdb --isovalue 0.5
fails 65 "two.vdb: grid 'target' occurs twice" vam-score two.vdb --grid target --target part.vdb
fails 65 "two.vdb: grid 'target' occurs twice" vam-curethrough model two.vdb -o x.vdb
# A transform of another program.
python3 -c '
import struct
data = open("part.vdb", "rb").read().replace(b"vam:seal", b"was:seal").replace(b"vam:facts_seal", b"was:facts_seal")
open("nan.vdb", "wb").write(data.replace(struct.pack("<d", 0.2), struct.pack("<d", float("nan"))))'
fails 65 'nan.vdb: a grid has a transform with a number that is not finite, or without an inverse; mend it' vam-check nan.vdb
ok 'vam-view still shows it' vam-view minus.vdb -o x.png

done_testing
