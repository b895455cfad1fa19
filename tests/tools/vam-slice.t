# SPDX-License-Identifier: GPL-3.0-or-later
# vam-slice: shapes, meshes and images to target volumes; and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

# mesh.py NAME: a test mesh. Cubes have an edge of 4; "x" is what is wrong with it.
cat >mesh.py <<'PY'
import struct, sys
def cube(low, high):
    p = [[(high if c >> a & 1 else low) for a in range(3)] for c in range(8)]
    f = [(0,2,3),(0,3,1),(4,5,7),(4,7,6),(0,1,5),(0,5,4),(2,6,7),(2,7,3),(0,4,6),(0,6,2),(1,3,7),(1,7,5)]
    return [[p[i] for i in t] for t in f]
def stl(name, triangles):
    with open(name, "wb") as out:
        out.write(bytes(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            out.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0))
turn = lambda ts: [[t[0], t[2], t[1]] for t in ts]
c = cube(-2, 2)
stl("cube.stl", c)
stl("inside-out.stl", turn(c))
stl("lidless.stl", c[:2] + c[4:])
stl("hollow.stl", c + turn(cube(-1, 1)))
stl("twice.stl", c + c[:5])
part = lambda low, high: [[[low + (v[0] + 2) / 4 * (high - low), v[1], v[2]] for v in t] for t in c]
stl("common-sides.stl", part(-2, 1) + part(-1, 2))
stl("common-end.stl", c + part(0, 2))
stl("sheet.stl", c[:2])
stl("near.stl", [[[v[0] + 5.5, *v[1:]] for v in t] for t in c])
stl("far.stl", [[[x + 100 for x in v] for v in t] for t in c])
stl("fin.stl", c + [[[v[0] * 0.015, v[1], v[2] * 0.75 + 3] for v in t] for t in c])
stl("high.stl", [[[v[0], v[1], v[2] + 100] for v in t] for t in c])
open("quads.obj", "w").write("".join("v %g %g %g\n" % tuple((1 if n >> a & 1 else -1) for a in range(3)) for n in range(8))
    + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n")
PY
python3 mesh.py
cp cube.stl small.stl
for size in metres=0.01 inches=0.3; do  # half of their edges
  awk -v half="${size#*=}" '$1 == "v" { print "v", $2 * half, $3 * half, $4 * half; next } { print }' quads.obj \
    >"${size%=*}.obj"
done

# volume WANT COMMAND...: vam-slice reports this volume, to 1e-5 (meshes) or 2e-4 (shapes)
volume() {
  want=$1; shift
  case $* in *--shape*) within=2e-4 ;; *) within=1e-5 ;; esac
  ok "runs: $*" "$@" -o out.vdb --report report.json
  got=$(json report.json volume_mm3)
  holds "volume $want: $*" "($got - $want)^2 < ($want * $within)^2"
}

# Shapes
ok "a gyroid" vam-slice --shape gyroid --voxel 0.2 -o gyroid.vdb --report gyroid.json
holds "its size is that of the paper" "$(json gyroid.json size_mm.0) == 14 && ($(json gyroid.json size_mm.2) - 10)^2 < 1e-12"
holds "it is stretched by 1/M_vp" "($(json gyroid.json stretch_z) - 1 / (1 - 12.7 * (1 - 1 / 1.53) / 119.808))^2 < 1e-12"
volume 64 vam-slice --shape box:x=4,y=4,z=4 --voxel 0.25
volume 64 vam-slice --shape box:x=4,y=4,z=4 --voxel 0.25 --stretch-z 1
volume 8 vam-slice --shape box:x=4,y=4,z=4 --voxel 0.25 --scale 0.5
quiet "nothing on stderr" vam-slice --shape sphere --voxel 0.5 -o out.vdb
ok "to a pipe" sh -c 'vam-slice --shape ladder --voxel 0.25 | cat >pipe.vdb'
ok "from the file" vam-slice --shape ladder --voxel 0.25 --threads 1 -o file1.vdb
ok "with two threads" vam-slice --shape ladder --voxel 0.25 --threads 2 -o file2.vdb
all_but_history() { vdb_print -l "$1" | grep -v 'vam:history\|vam:facts_seal' | tail -n +2; }
is "the same voxels, by their seal, too" "$(all_but_history file1.vdb)" "$(all_but_history file2.vdb)"

# Meshes
volume 64 vam-slice cube.stl --voxel 0.25
volume 64 vam-slice cube.stl --voxel 0.23 --rotate 30,40,50
volume 64 vam-slice far.stl --voxel 0.25
volume 64 vam-slice inside-out.stl --voxel 0.25
is "triangles flipped" "$(json report.json repair.triangles_flipped)" 12
volume 56 vam-slice hollow.stl --voxel 0.25
is "a cavity" "$(json report.json repair.cavities)" 1
volume 64 vam-slice twice.stl --voxel 0.25
is "duplicates" "$(json report.json repair.duplicates_dropped)" 5
for shared in common-sides common-end; do
  volume 64 vam-slice $shared.stl --voxel 0.23
  quiet 'which is nothing to warn of' vam-slice $shared.stl --voxel 0.23 -o out.vdb
done
volume 64 vam-slice lidless.stl --voxel 0.25
volume 64 vam-slice cube.stl --voxel 0.25 --fill vote
volume 8 vam-slice quads.obj --voxel 0.25
volume 1000 vam-slice quads.obj --unit cm --scale 0.5 --voxel 0.25
volume 216 vam-slice cube.stl --fit 6 --voxel 0.25
volume 64 sh -c 'vam-slice --voxel 0.25 "$@" <cube.stl' -
ok "repairs are reported" sh -c 'vam-slice twice.stl --voxel 0.5 -o out.vdb 2>&1 | grep -q "dropped 5 duplicate triangles"'
ok "a majority is reported" sh -c 'vam-slice lidless.stl --voxel 0.5 -o out.vdb 2>&1 | grep -q "4 boundary edges remain; the inside is determined by majority"'
ok "an open mesh is wrapped" vam-slice lidless.stl --fill wrap --wrap 0.4,0.05 --voxel 0.25 -o out.vdb --report report.json
is "by so much" "$(json report.json wrap.offset_mm)" 0.05
holds "it is larger by no more than the offset" "$(json report.json volume_mm3) > 64 && $(json report.json volume_mm3) < 4.1^3"
ok "which is said" sh -c 'vam-slice lidless.stl --fill wrap --voxel 0.4 --verbose -o out.vdb 2>&1 | grep -q "4 open edges .* larger by up to 0.05 mm"'
for size in 0.4,0 0.4,0.003 0.4,0.5 -0.4,-0.1; do
  fails 64 '--wrap: an offset of .* from ALPHA/100 to ALPHA' vam-slice lidless.stl --fill wrap --wrap=$size -o x.vdb
done
fails 65 'lidless.stl: its wrap .* give --wrap' vam-slice lidless.stl --fill wrap --wrap 0.001,0.0001 -o x.vdb
quiet "a closed mesh needs no warning" vam-slice cube.stl --voxel 0.5 -o out.vdb
ok "the largest size that fits" vam-slice cube.stl --fit-writable --voxel 0.25 -o out.vdb --report report.json
holds "it fills the circle except for half the diagonal of a voxel" \
  "($(json report.json radius_mm) + 0.25 / sqrt(2) - $(json report.json writable_radius_mm))^2 < 1e-12"
ok "the writable circle" vam-slice cube.stl --extent writable --voxel 0.25 -o out.vdb --report report.json
is "its voxels fill the circle" "$(json report.json voxels.0)" 70

ok "the y axis of the file upwards" vam-slice --shape box:x=2,y=4,z=6 --up y --mirror x --voxel 0.25 -o out.vdb --report report.json
holds "y points up" "($(json report.json size_mm.2) - 4)^2 < 1e-12"
says() {  # says REGEX COMMAND...: succeeds with one warning that matches
  regex=$1; shift
  ok "warns '$regex': $*" sh -c '"$@" 2>said && [ "$(wc -l <said)" -eq 1 ]' - "$@"
  ok "so it says" grep -Eq -- "warning: .*$regex" said
}
says 'metres.obj: no voxel .*is its unit m[?]' vam-slice metres.obj --voxel 0.1 -o out.vdb
says 'inches.obj: the part is only 0.6 mm large; is its unit cm or in[?]' \
  vam-slice inches.obj --voxel 0.1 -o out.vdb
awk '$1 == "v" { print "v", $2 * 3000, $3 * 3000, $4 * 3000; next } { print }' quads.obj >microns.obj
fails 65 'microns.obj: 6000 x .* is its unit um[?] --unit states it; else give --scale' \
  vam-slice microns.obj --voxel 0.1 -o out.vdb
ok 'which it is' vam-slice microns.obj --unit um --voxel 0.1 -o out.vdb
fails 65 '^vam-slice: quads.obj: 200 x 200 x 200 mm, .*\); give --scale' vam-slice quads.obj --scale 100 --voxel 0.1 -o out.vdb
python3 - <<'PY'
import zipfile
lines = open("quads.obj").read().split("\n")
v = [l.split()[1:] for l in lines if l.startswith("v")]
f = [[int(i) - 1 for i in l.split()[1:]] for l in lines if l.startswith("f")]
with zipfile.ZipFile("inch.3mf", "w") as out:
    out.writestr("3D/3dmodel.model", '<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
        '<resources><object id="1"><mesh><vertices>' + "".join('<vertex x="%s" y="%s" z="%s"/>' % tuple(p) for p in v) +
        "</vertices><triangles>" + "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % t for q in f
        for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))) + '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>')
PY
volume 64 vam-slice inch.3mf --scale 0.078740157480315 --voxel 0.25
for z in 5 -5 200; do
  vam-slice --shape box:x=6,y=6,z=4 --insert-shape box:x=4,y=4,z=2 --insert-at 0,0,$z --voxel 0.4 -o above.vdb 2>said
  is "an insert at z = $z mm, beyond the light, is told and left out" "$? $(grep -c 'misses the part; it measures 4 x 4 x 2 mm.*left out$' said) $(grep -c 'no voxel' said)" '0 1 0'
done
fails 65 'box:x=4,y=4,z=4: the insert and its clearance of 0.2 mm take all of the part; check --insert-unit' \
  vam-slice --shape box:x=4,y=4,z=4 --insert-shape cylinder:diameter=12,height=12 --cut-insert 0.2 --voxel 0.2 -o x.vdb
vam-slice --shape sphere:diameter=6 --insert cube.stl --insert-scale 0.01 --voxel 0.2 -o x.vdb 2>said
ok 'a tiny insert is told' grep -q 'cube.stl: the insert is only 0.0[0-9]* mm large, less than a voxel of 0.2 mm; check --insert-unit and --insert-scale' said
quiet 'a setting without a leading zero' vam-slice --shape sphere:diameter=6 --set projector.pixel_mm=.2 --voxel .2 -o x.vdb
fails 64 "projector.pixel_mm=.1.5: '.1.5' is not a value" vam-slice --shape sphere --set projector.pixel_mm=.1.5 -o x.vdb
fails 64 '--unit: inch.3mf states its unit' vam-plan inch.3mf --unit in --no-preview
fails 64 '--insert-unit: inch.3mf states its unit, .*give --insert-scale' \
  vam-slice quads.obj --insert inch.3mf --insert-unit in --voxel 0.25 -o out.vdb
quiet "a requested size causes no warning" vam-slice inches.obj --scale 1 --voxel 0.1 -o out.vdb
says 'no voxel .*covered to 0.33 at most.; voxels of' \
  vam-slice --shape box:x=4,y=4,z=0.1 --stretch-z 1 --voxel 0.15 -o out.vdb
says 'fin.stl: [0-9.]+ % of the part is in walls too thin for the voxels: between z = [0-9.]+ and [0-9.]+ mm no voxel of theirs is half covered, .*; voxels of 0.03' \
  vam-slice fin.stl --voxel 0.15 -o out.vdb --report report.json
# 0.06 mm thick, 4 mm wide, 2.5 mm above the cube: 0.6 mm3, of which up to two layers touch voxels of the cube.
holds "the volume of the fin is reported" "$(json report.json lost_volume_mm3) > 0.52 && $(json report.json lost_volume_mm3) < 0.6"

# Two plates 0.05 mm apart, wherever the voxels of 0.1 mm lie: 4 x 4 x 0.05 mm3, of which the open rim is no gap.
plates() {  # plates Z APART: the lower one ends at that height
  boxes "4 4 1 0 0 $(awk "BEGIN { print $1 - 1 }")" "4 4 1 0 0 $(awk "BEGIN { print $1 + $2 }")"
}
for z in 0 0.02 0.05 0.08; do
  plates $z 0.05 >plates.off
  says 'plates.off: gaps of 0.05 mm are too narrow for the voxels: between z = -?0[.0-9]* and 0.[12] mm no voxel of theirs is more than three quarters free, and they will be printed shut; voxels of 0.02[0-9]* mm' \
    vam-slice plates.off --no-centre --stretch-z 1 --voxel 0.1 -o out.vdb --report report.json
  holds "its volume is reported, at $z" "$(json report.json lost_gaps_mm3) > 0.7 && $(json report.json lost_gaps_mm3) < 0.8"
  plates $z 0.2 >plates.off
  quiet "two voxels hold a free one, at $z" vam-slice plates.off --no-centre --stretch-z 1 --voxel 0.1 -o out.vdb
done
plates 0 0.05 >plates.off
quiet 'the voxels that are named resolve it' vam-slice plates.off --voxel 0.025 -o out.vdb
quiet 'corners between struts are no gaps' vam-slice --shape octet --voxel 0.1 -o out.vdb

# The height in the image: level with the lens, in the image, or as requested
place() { vam-slice --shape cone:bottom=8,height=6 --voxel 0.25 "$@" -o out.vdb --report report.json && json report.json place.mm; }
stretch=$(json gyroid.json stretch_z)
is "level with the lens" "$(place)" 0.0
holds "the part is raised by the requested height, in whole voxels" "($(place --place 3) - 12 * 0.25 / $stretch)^2 < 1e-12"
is "the report states that an option set the place" "$(json report.json place.by)" option
low="--set projector.axis_row=767"
# Two voxels of 0.25 mm beyond the base can be lit: its dose could not fall to the threshold within one that is dark.
holds "in an image that begins at the lens" "$(place $low) > 3.4 && $(place $low) < 3.8"
is "the report states that the place is the default" "$(json report.json place.by)" default
holds "auto puts the base of a cone level with the lens" "$(place --place auto) > 2.8 && $(json report.json place.mm) < 3.3"
is "the report states that the place was chosen" "$(json report.json place.by)" auto
quiet "a mesh is placed by auto" vam-slice cube.stl --voxel 0.25 --place auto $low -o out.vdb
ok "an insert is raised with the part" vam-slice --shape handle --insert-shape screwdriver --voxel 0.25 --place 2 -o out.vdb
fails 65 'spans z = -57.*; --place auto finds a height within them' vam-slice --shape cone --voxel 0.25 --place -50 -o x.vdb
fails 64 "'high' is neither a height" vam-slice --shape cone --voxel 0.25 --place high -o x.vdb

# Inserts
ok "a shaft in a handle" vam-slice --shape handle --insert-shape screwdriver --voxel 0.25 -o insert.vdb
ok "target and insert are two grids" sh -c 'vdb_print insert.vdb | grep -q "^insert" && vdb_print insert.vdb | grep -q "^target"'
ok "a mesh as insert, longer than the part" vam-slice cube.stl --insert hollow.stl --voxel 0.25 -o insert.vdb

cutting="vam-slice --shape box:x=6,y=6,z=4 --insert-shape box:x=2,y=2,z=8 --voxel 0.25"
quiet "an insert cut out of the part" $cutting --cut-insert 0 --report report.json -o insert.vdb
holds "the part loses the volume of the insert" "($(json report.json volume_mm3) - (144 - 16))^2 < 1e-4"
holds "part and insert touch and do not overlap" "$(json report.json insert.contact_voxels) > 500 && $(json report.json insert.shared_mm3) < 1e-6"
holds "the insert is in all slices of the part, and those whose light it shades" "($(json report.json insert.slices_of_part) - 17)^2 <= 1 && $(json report.json insert.slices) == $(json report.json voxels.2)"
under="vam-slice --shape box:x=6,y=6,z=4 --insert-shape box:x=12,y=12,z=2 --insert-at 0,0,-3 --voxel 0.25"
quiet "an insert below a part" $under --report level.json -o under.vdb
quiet "and high above the lens" $under --place 15 --report report.json -o under.vdb
vam-slice --shape box:x=6,y=6,z=4 --insert-shape cylinder:diameter=24,height=2 --insert-at 0,0,-3 --voxel 0.25 --place 15 --report wide.json -o under.vdb 2>.log/wide
vam-slice --shape box:x=6,y=6,z=4 --insert-shape cylinder:diameter=4,height=2 --insert-at 0,0,-3 --voxel 0.25 --place 15 --report narrow.json -o under.vdb 2>.log/narrow
holds "and more of it where it is wide" "$(json wide.json insert.slices) > $(json narrow.json insert.slices)"
holds "shades light that climbs through more of it" "$(json report.json insert.slices) >= $(json level.json insert.slices) + 3"
quiet "without a number, too" vam-slice --insert-shape box:x=2,y=2,z=8 --voxel 0.25 --report bare.json -o bare.vdb --cut-insert cube.stl
quiet "which is none" vam-slice --insert-shape box:x=2,y=2,z=8 --voxel 0.25 --report none.json -o none.vdb --cut-insert 0 cube.stl
is "the same part" "$(json bare.json volume_mm3)" "$(json none.json volume_mm3)"
holds "of which the insert is missing" "$(json bare.json insert.shared_mm3) < 1e-6 && $(json bare.json insert.contact_voxels) > 0"
quiet "with a clearance" $cutting --cut-insert 0.25 --report report.json -o insert.vdb
# The faces move by one voxel, the edges by 0.59 of a voxel's square for the 0.79 of a quarter of a circle.
holds "the clearance is subtracted, too" "($(json report.json volume_mm3) - (144 - 4 * (6.25 - 4 * 0.414 * 0.25^2)))^2 < 0.05^2"
is "and is free" "$(json report.json insert.clearance_shut)" 0.0
says 'the clearance of 0.1 mm is too narrow for the voxels: on [0-9]+ % of the lines from the insert to the part no voxel is more than three quarters free, and resin cures there; voxels of 0.05 mm resolve it' \
  $cutting --cut-insert 0.1 --report report.json -o insert.vdb
holds "all around" "$(json report.json insert.clearance_shut) > 0.9"
quiet "the voxels that are named resolve it" vam-slice --shape box:x=3,y=3,z=1 --insert-shape cylinder:diameter=1.03,height=4 \
  --cut-insert 0.1 --voxel 0.05 -o insert.vdb
says 'overlaps the part by 16 mm3; --cut-insert subtracts it' $cutting -o insert.vdb
says 'metres.obj: the insert is only 0.02 mm large; is its unit m[?]; --insert-unit states it' \
  vam-slice cube.stl --insert metres.obj --cut-insert --voxel 0.25 -o insert.vdb
stated() { vam-slice cube.stl --insert metres.obj "$@" --voxel 0.25 -o insert.vdb 2>&1 | grep -c 'is its unit'; }
is 'a unit that is stated is none to doubt' "$(stated --insert-unit mm; stated --insert-scale 100)" "$(printf '0\n0')"
says 'small.stl: misses the part; it measures 1 x 1 x 1 mm and is centred at .5, 0, 0. mm; check --insert-unit' \
  vam-slice cube.stl --insert small.stl --insert-scale 0.25 --insert-at 5,0,0 --voxel 0.25 -o insert.vdb
says 'overlaps the part' vam-slice cube.stl --fit 8 --rotate 0,0,90 --insert small.stl --insert-unit cm --insert-scale 0.05 \
  --voxel 0.25 --report report.json -o insert.vdb
holds "the insert keeps its size" "($(json report.json insert.size_mm.0) - 2)^2 + ($(json report.json insert.size_mm.2) - 2)^2 < 1e-9"
holds "the part has its own" "($(json report.json size_mm.2) - 8)^2 < 1e-9"
centred() { vam-slice cube.stl --insert near.stl "$@" --voxel 0.25 -o insert.vdb 2>&1 | grep -o 'centred at ([^)]*)'; }
is "an insert is mirrored with its part" "$(centred --mirror x | tr -d -)" "$(centred)"
ok "to the other side" test "$(centred --mirror x)" != "$(centred)"

# Images: 6 x 4 pixels, 3 slices; the middle one half grey
mkdir stack odd black
for k in 0 1 2; do
  $png make stack/s$k.png 6 4 "$((k == 1 ? 51 : 255))"
  $png make odd/s$k.png 5 5 '255 * (y == 1)'
  $png make black/s$k.png 4 4 0
done
volume 52.8 vam-slice stack --voxel 1 --stretch-z 1
is "as many slices as images" "$(json report.json voxels.2)" 3
volume 52.8 vam-slice stack --voxel 1
volume 15 vam-slice odd --voxel 1 --stretch-z 1
is "whole voxels" "$(json report.json surface_voxels)" 0

# Wrong inputs
fails 65 'cannot be determined.*encloses no volume' vam-slice sheet.stl --no-centre --voxel 0.3 -o x.vdb
vam-slice lidless.stl --scale 0.01 --voxel 0.3 -o x.vdb 2>tiny.txt
is "an open mesh in metres" "$?" 0
ok "is small, not open" grep -q 'no voxel of 0.3 mm is wholly inside the part, which is .* mm large' tiny.txt
fails 65 'reaches .* from the axis, beyond the writable radius of 8.301 mm .127.7 voxels.' vam-slice cube.stl --scale 5 -o x.vdb
fails 65 'omit --no-centre; give --scale 0.0572 or --fit-writable to make it fit' vam-slice far.stl --no-centre -o x.vdb
fails 65 '; give --scale 2.91 or --fit-writable to make it fit, or --extent resin to accept' vam-slice cube.stl --scale 3.2 -o x.vdb
fails 65 '; give --scale 2.91 or --fit-writable to make it fit$' vam-slice cube.stl --scale 5 -o x.vdb  # beyond the resin
ok "the stated scale fits" vam-slice cube.stl --scale 2.91 -o x.vdb
fails 65 '; give --fit 11.6 or' vam-slice cube.stl --fit 30 -o x.vdb
fails 65 '; give --voxel 1.51 to make it fit' vam-slice stack --voxel 4 -o x.vdb
ok "the stated voxel fits images" vam-slice stack --voxel 1.51 -o x.vdb
# Resin that cannot drain, until its wall is lost to the voxels
shell='egg-shell:length=9,diameter=8,wall=0.8,opening'
vam-slice --shape $shell=0 --voxel 0.2 -o egg.vdb --report egg.json 2>egg.log
holds "a closed shell traps resin" "$(grep -c '1 closed cavity of 1[0-9]* mm3 at x, y, z = .* mm, from which resin cannot drain; open it by a hole$' egg.log) == 1"
holds "which the report states" "$(json egg.json trapped_resin.cavities) == 1 && ($(json egg.json trapped_resin.volume_mm3) / 145 - 1) ^ 2 < 0.01 ^ 2"  # as with voxels half as large
vam-slice --shape $shell=2 --voxel 0.2 -o egg.vdb --report egg.json 2>egg.log
is "an opening lets it out" "$(json egg.json trapped_resin) $(grep -c cavity egg.log)" "None 0"
vam-slice --shape hollow-cylinder --voxel 0.2 -o egg.vdb --report egg.json 2>egg.log
is "so do the ends of a tube" "$(json egg.json trapped_resin) $(grep -c cavity egg.log)" "None 0"
vam-slice --shape egg-shell:length=9,diameter=8,wall=0.2,opening=0 --voxel 0.8 -o egg.vdb --report egg.json 2>egg.log
is "and a wall that no voxel shows" "$(json egg.json trapped_resin) $(grep -c cavity egg.log)" "None 0"
fails 65 'rows cover' vam-slice --shape cylinder:height=60 -o x.vdb
ok "a rod of 33,000 slices" vam-slice --shape cylinder:diameter=0.02,height=33 --voxel 0.001 --extent part -o rod.vdb
ok "which others read" vam-sinogram --angles 4 rod.vdb -o rod.exr
says 'high.stl: misses the part; .*left out' vam-slice cube.stl --insert high.stl --no-centre -o x.vdb
fails 65 'vial.s inner radius' vam-slice cube.stl --insert far.stl --no-centre -o x.vdb
fails 65 'black' vam-slice black -o x.vdb
# A name that says another format is refused, and what has it is kept.
fails 64 "'cube.stl' must end in .vdb or .toml" vam-slice --shape sphere --voxel 2 -o cube.stl
fails 64 "'x.PNG' must end in .vdb" vam-slice cube.stl -o x.PNG
ok 'another name is a name' vam-slice cube.stl -o part.v2

# Copies and others beside them keep their size; of a file that lies, they stand in rows of the upright part.
box 2 1 3 >lying.off
box 1 1 1 >small.off
quiet 'an array' vam-slice lying.off --up y --copies 2x1x2 --gap 0.4 --scale 1.5 --voxel 0.25 --stretch-z 1 -o array.vdb --report array.json
holds 'has the volume of its copies' "($(json array.json volume_mm3) / (4 * 6 * 1.5 ^ 3) - 1) ^ 2 < 0.01 ^ 2"
quiet 'two bodies' vam-slice lying.off --beside small.off --voxel 0.25 --stretch-z 1 -o two.vdb --report two.json
holds 'have that of both' "($(json two.json volume_mm3) / 7 - 1) ^ 2 < 0.01 ^ 2"
fails 65 'lying.off: .*writable' vam-slice lying.off --copies 9x9 --voxel 0.25 -o x.vdb
fails 64 'copies' vam-slice --shape sphere --copies 2x2 -o x.vdb
fails 64 'insert' vam-slice lying.off --copies 2x2 --insert small.off -o x.vdb
done_testing
