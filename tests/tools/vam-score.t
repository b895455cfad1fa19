# SPDX-License-Identifier: GPL-3.0-or-later
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape disc-grid --voxel 0.2 -o part.vdb || exit 1
vam-slice --shape hollow-cylinder --voxel 0.2 -o other.vdb || exit 1

# The coverage itself is a perfect dose.
quiet "a perfect dose" vam-score --grid target part.vdb --report perfect.json
holds "its process window is the whole dose, except for rounding" "$(json perfect.json pw) > 0.998"
is "no voxel is wrong" "$(json perfect.json ver)" 0.0
is "the print is the part" "$(json perfect.json iou)" 1.0
ok "its own target, given by name" vam-score --grid target part.vdb --target part.vdb
ok "stdin" sh -c 'vam-score --grid target --target part.vdb <part.vdb'
ok "a report on stdout" sh -c 'vam-score --report - --grid target part.vdb >out.json'
is "the report on stdout has the figures of the file" "$(json out.json mean_part)" "$(json perfect.json mean_part)"
is "a line for each figure" "$(vam-score --grid target part.vdb | grep -c '^[a-z]')" 31
ok "the last line is the verdict" sh -c 'vam-score --grid target part.vdb | tail -n 1 | grep -Eq "^verdict +will print: forgives [+]-99.8 % of dose, process window [+]0.99[0-9]* of the largest dose, VER 0 [(][0-9]+ voxels[)]; including the [0-9]+ voxels cut by the surface: process window [-+0-9.e]+, VER "'
is "the verdict counts part and surface voxels" "$(json perfect.json with_surface.voxels)" \
  $(($(json perfect.json part_voxels) + $(json perfect.json void_voxels) + $(json perfect.json surface_voxels)))
quiet "surface voxels as figures of their own" vam-score --grid target part.vdb --surface --report all.json
is "the verdict has the window of --surface" "$(json all.json pw)" "$(json perfect.json with_surface.pw)"

# Two plates with a slit of half a voxel between them: no void voxel is in it.
boxes '4 4 1' '4 4 1 0 0 1.05' >plates.off
vam-slice plates.off --voxel 0.1 --stretch-z 1 -o plates.vdb 2>sliced
ok "a slit that no voxel resolves" sh -c 'vam-score --grid target plates.vdb 2>scored >table'
ok "is no print as designed" grep -q '^verdict  *will not print as designed: .*gaps too narrow for the voxels will be shut' table
is "and that is said once" "$(cat scored)" ''
ok "with the width where it is sliced" grep -q 'plates.off: gaps of 0.05 mm are too narrow ' sliced

# A wall of 1.3 voxels in the middle of two: none is wholly inside, and what becomes of it no figure says.
boxes '3 4 1' '0.26 4 3 0 0 2' >wall.off
vam-slice wall.off --voxel 0.2 --stretch-z 1 -o wall.vdb 2>sliced
ok "a wall of which no voxel is wholly inside" grep -q 'warning: wall.off: walls of 0.26 mm are too fine for voxels of 0.2 mm, as near (.*) mm, and whether they print is not judged; voxels of 0.13 mm resolve them$' sliced
ok "may print" sh -c 'vam-score --grid target wall.vdb | grep -q "^verdict  *may print: .*; walls of 1.3 voxels are not judged; smaller voxels resolve them"'
# The same part as others would write it, without its surface.
vam-convert wall.vdb -o wall.npy 2>.log/npy && vam-convert wall.npy --voxel 0.2 -o bare.vdb 2>.log/bare
ok "so it may where only its voxels are known" sh -c 'vam-score --grid target bare.vdb | grep -q "^verdict  *may print: .*; walls and gaps too thin for the voxels are not judged: 2[0-9.]* % of the part; smaller voxels"'
vam-score --grid target wall.vdb --require 'pw>0,unresolved_part<=0.02' >table 2>why
is "can be required to be judged" "$?" 1
ok "with its share" grep -q '^vam-score: unresolved_part = 0.2[0-9]*, but unresolved_part<=0.02 is required$' why
# Such a wall on a block, and the same without its lowest layer: only voxels that the surface cuts are missing.
on_block() { boxes '3 4 1' "0.26 4 $2 0 0 $1"; }  # on_block LOW HEIGHT
on_block 1 3 >stand.off
on_block 1.2 2.8 >foot.off
for part in stand foot; do vam-slice $part.off --voxel 0.2 --stretch-z 1 -o $part.vdb 2>.log/$part; done
vam-score --grid target foot.vdb --target stand.vdb --report foot.json >table
json foot.json verdict >said
ok "a wall without foot is no print as designed" grep -q '^will not print as designed: forgives +-100 % of dose, process window +1 .*; the print is in 2 pieces, the part in 1; walls are cut or missing: 40 voxels that the part fills by half or more do not cure, most at x, y, z = .* mm; ' said
is "with its pieces" "$(for key in part_pieces print_pieces broken_voxels; do json foot.json $key; done | tr '\n' ' ')" "1 2 40 "
holds "at the threshold that is reported" "$(json foot.json print_threshold) > 0"
vam-score --grid target foot.vdb --target stand.vdb --require 'pw>0,broken_voxels<=0' >table 2>why
is "can be required to be whole" "$? $(cat why)" "1 vam-score: broken_voxels = 40, but broken_voxels<=0 is required"
vam-score --grid target foot.vdb --target stand.vdb --require 'prints>=1' >table 2>why
is "by its verdict, too" "$? $(cat why)" "1 vam-score: prints = 0, but prints>=1 is required"
vam-score --grid target foot.vdb --target stand.vdb --surface --report seen.json >table
is "pieces are of the same print with --surface" "$(json seen.json print_pieces) $(json seen.json broken_voxels)" "2 40"
quiet "a part that will print as designed" vam-score --grid target part.vdb --target part.vdb --require 'prints>=1'
# A fin that straddles two voxels, none of which is half covered, and a slot that leaves three quarters of one free.
boxes '4 4 1' '0.1 4 1.5 0 0 1' >fin.off
vam-slice fin.off --voxel 0.2 --stretch-z 1 --no-centre --place 0 -o fin.vdb 2>.log/fin
ok "a wall that will be missing" sh -c 'vam-score --grid target fin.vdb | grep -q "^verdict  *will not print as designed: .*; [0-9.]* % of the part is in walls too thin for the voxels and will be missing"'

vam-score --grid target part.vdb --require 'pw>1.5,ver<=0' >table 2>why
is "an unmet condition is status 1" $? 1
ok "an unmet condition is reported with its value" grep -Eq "^vam-score: pw = [0-9.]+, but pw>1.5 is required$" why
holds "the table is printed before the reason" "$(wc -l <table) > 10"
quiet "at a critical dose" vam-score --grid target part.vdb --critical-dose 0.5 --report at.json
is "all of the part cures" "$(json at.json cured_part)" 1.0

quiet "the print as a mesh" vam-score --grid target part.vdb --mesh print.ply
is "a PLY with faces" "$(head -c 400 print.ply | grep -ac 'element face')" 1
for ending in stl obj 3mf; do
  quiet "the same as $ending" vam-score --grid target part.vdb --mesh print.$ending
  holds "is the same surface" "$(vam-sdf print.$ending print.ply --align none --samples 20000 --report apart.json 2>/dev/null; json apart.json print_to_design.max_abs_mm) < 1e-5"
done
is 'the 3MF is a package of sound parts, its model in mm' "$(python3 - <<'PY'
import xml.etree.ElementTree, zipfile
with zipfile.ZipFile("print.3mf") as package:
    print(package.testzip(), *package.namelist(), end=" ")
    model = [xml.etree.ElementTree.fromstring(package.read(name)) for name in package.namelist()][-1]
core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
points = sum(1 for _ in model.iter(core + "vertex"))
corners = [int(t.get(v)) for t in model.iter(core + "triangle") for v in ("v1", "v2", "v3")]
print(model.tag == core + "model", model.get("unit"), max(corners) == points - 1, min(corners))
PY
)" 'None [Content_Types].xml _rels/.rels 3D/3dmodel.model True millimeter True 0'
is "OBJ counts corners from 1" "$(head -n 3 print.obj | cut -d' ' -f1 | tr -d '\n')" '#vv'
quiet "the print as points" vam-score --grid target part.vdb --mesh points.ply --ply-as points
is "a PLY with dose at every vertex" "$(head -c 600 points.ply | grep -ac 'quality')" 1

# Grey targets: coverage stands for a dose
quiet "a grey target met" vam-score --grid target part.vdb --grey-target --report grey.json
is "by all voxels" "$(json grey.json ver) $(json grey.json cv)" "0.0 0.0"
ok "in words" sh -c 'vam-score --grid target part.vdb --grey-target | grep -q "^verdict  *met: 100 % of [0-9]* voxels are within 0.1 of the target"'
vam-slice --shape disc-grid --voxel 0.4 -o coarse.vdb 2>.log/coarse
for rule in met below free; do
  set -- --grey-target --void $rule --band 0.3
  [ $rule != below ] || set -- "$@" --dose-low 0.4
  vam-optimize "$@" --angles 60 --iterations 10 --report want-$rule.json coarse.vdb 2>.log/optimize | vam-dose --like coarse.vdb -o $rule.vdb
  vam-score "$@" $rule.vdb --target coarse.vdb --report is-$rule.json >.log/score
  # Of two programs, whose doses differ by rounding.
  for figure in ver pw ipdr cv; do
    holds "void $rule: $figure is that of vam-optimize" "($(json is-$rule.json $figure) - $(json want-$rule.json $figure)) ^ 2 < 1e-8"
  done
done
# A band of its own in the void, and one for each voxel: 0.3 everywhere, as of a dose of a disc that all is in.
set -- --grey-target --void met --band 0.2
vam-optimize "$@" --set optimize.void_band=0.5 --angles 60 --iterations 10 --report want.json coarse.vdb 2>.log/optimize | vam-dose --like coarse.vdb -o void.vdb
vam-score "$@" --void-band 0.5 void.vdb --target coarse.vdb --report is.json >.log/score
holds 'with a band of the void the error rate is that of vam-optimize' "($(json is.json ver) - $(json want.json ver)) ^ 2 < 1e-8"
grep -q 'are within their bands around the target' .log/score; report $? 'and the verdict says so'
vam-convert coarse.vdb -o coarse.npy
$npy of band.npy "$($npy show coarse.npy | cut -d' ' -f1-3 | tr ' ' ,)" 0.3
vam-convert band.npy --voxel 0.4 --stretch-z 1 -o band.vdb 2>.log/band
vam-convert coarse.npy --voxel 0.4 --stretch-z 1 -o alike.vdb 2>.log/alike
vam-optimize --grey-target --band-volume band.vdb --angles 60 --iterations 10 --report want.json alike.vdb 2>.log/optimize | vam-dose --like alike.vdb -o banded.vdb
vam-score --grey-target --band-volume band.vdb banded.vdb --target alike.vdb --report is.json >.log/score
holds 'with a band for each voxel the error rate is that of vam-optimize' "($(json is.json ver) - $(json want.json ver)) ^ 2 < 1e-8"
vam-score --grey-target --band 0.3 banded.vdb --target alike.vdb --report one.json >.log/score
holds 'and that of the same band for all' "($(json is.json ver) - $(json one.json ver)) ^ 2 + ($(json is.json pw) - $(json one.json pw)) ^ 2 < 1e-12"
fails 65 "the grid of '.*' differs from that of the target" vam-score --grey-target --band-volume part.vdb banded.vdb --target alike.vdb
vam-optimize --grey-target --resin-response logistic --angles 60 --iterations 2 coarse.vdb 2>.log/optimize | vam-dose --like coarse.vdb -o response.vdb
fails 65 "response 'logistic' of the resin, and doses are judged here" vam-score --grey-target response.vdb --target coarse.vdb
# Once the resin is known, the dose is in mJ/cm3 and the target still relative.
absorbs='--set resin.absorption_per_mm=0.05'
vam-optimize --grey-target --angles 60 --iterations 10 $absorbs coarse.vdb -o grey.exr 2>.log/optimize
vam-dose grey.exr --like coarse.vdb $absorbs -o relative.vdb
vam-dose grey.exr --like coarse.vdb $absorbs --set resin.critical_dose_mj_cm3=50 -o absolute.vdb
for unit in relative absolute; do vam-score --grey-target --band 0.3 $unit.vdb --target coarse.vdb --report $unit.json >.log/score; done
holds "the dose in mJ/cm3 is another" "$(json absolute.json dose_unit) > 1.5 || $(json absolute.json dose_unit) < 0.7"
for figure in ver cv bias; do
  holds "but not its $figure" "($(json absolute.json $figure) - $(json relative.json $figure)) ^ 2 < 1e-10"
done
holds "the less is asked of the void, the more is met" \
  "$(json is-met.json ver) > $(json is-below.json ver) && $(json is-met.json ver) > $(json is-free.json ver)"
vam-project --pattern ramp --steps 6 --set projector.columns=40 --set projector.rows=40 --set projector.telecentric=true -o ramp/
vam-slice ramp --voxel 0.2 --stretch-z 1 -o graded.vdb 2>.log/graded
ok 'a grey target that is taken for coverage is a warning' sh -c "vam-score --grid target graded.vdb 2>&1 >table |
  grep -q 'graded.vdb: the target is grey, or its voxels are too coarse for it: 36 % of its voxels above 0 .*--grey-target'"
ok 'in vam-optimize, too' sh -c "vam-optimize --angles 30 --iterations 2 graded.vdb -o taken.exr 2>&1 |
  grep -q 'graded.vdb: the target is grey'"
quiet 'which it is said to be' vam-score --grid target graded.vdb --grey-target
fails 65 'make both from the same target' vam-score --grid target part.vdb --grey-target --target other.vdb

fails 64 'cured_wrong: the critical dose is not known; give --critical-dose' \
  vam-score --grid target part.vdb --require 'ver<=1,cured_wrong<=1'
quiet "a condition on a known figure is evaluated" vam-score --grid target part.vdb --critical-dose 0.5 --require 'cured_wrong<=0'
fails 64 'duration_s: the exposure is not known' vam-score --grid target part.vdb --critical-dose 0.5 --require 'duration_s<9'
fails 64 'efficiency: requires the projections' vam-score --grid target part.vdb --require 'efficiency>0'
fails 64 'standard output holds the figures' vam-score --grid target part.vdb --mesh -
fails 64 'as --lit-fraction does; name another file' vam-score --grid target part.vdb --lit-fraction one --mesh ./one
fails 65 "other.vdb: the grid 'target' has .*; make both from the same target" vam-score --grid target part.vdb --target other.vdb
fails 65 'part.vdb' vam-score --grid target part.vdb --sinogram part.vdb

fails 64 'require: is empty' vam-score part.vdb --target part.vdb --require ''
fails 64 "'print.off' must end in .3mf or .ply" vam-score part.vdb --target part.vdb --mesh print.off

# Void in the corners of the volume is judged too, up to the writable radius; where that ends is told.
python3 - "$VAM_SOURCE/scripts" <<'PY'
import array, sys
sys.path.insert(0, sys.argv[1])
import vam
n = 60
part = array.array("f", bytes(4 * 2 * n * n))
dose = array.array("f", [0.5]) * len(part)
for k in range(2):
    for j in range(n):
        for i in range(n):
            at = (k * n + j) * n + i
            if 25 <= i < 35 and 25 <= j < 35: part[at] = dose[at] = 1
            if i < 4 and j < 4: dose[at] = 2
vam.write_volume("ct.vdb", part, 0.13, shape=(2, n, n))
vam.write_volume("cd.vdb", dose, 0.13, name="dose", shape=(2, n, n))
PY
vam-score cd.vdb --target ct.vdb --report corner.json >corner
is "what cures in the corner of a volume counts" "$(json corner.json max_void)" 2.0
is "and how far void is judged is told" "$(grep ^judged corner)" \
  'judged       all void within 3.9 mm of the axis; the volume ends before the writable radius of 8.3 mm'

# Several doses in one table, figures as rows: what one dose is scored alone is its column.
cp cd.vdb 'a_b,c.vdb'
alone=$(awk '$1 == "ver" { print $2 }' corner)
vam-score cd.vdb 'a_b,c.vdb' --target ct.vdb --table csv >csv
is 'a table for a spreadsheet' "$(head -n 1 csv)" 'figure,cd.vdb,"a_b,c.vdb"'
holds 'with the figures of each' "$(awk -F, '$1 == "ver" { print ($2 - '"$alone"') ^ 2 + ($3 - '"$alone"') ^ 2 }' csv) < 1e-9"
is 'and no empty row' "$(grep -c ',,$' csv)" 0
vam-score cd.vdb 'a_b,c.vdb' --target ct.vdb --table markdown >markdown
is 'for a page' "$(head -n 2 markdown | tr '\n' ' ')" '| figure | cd.vdb | a_b,c.vdb | |---|---:|---:| '
vam-score cd.vdb 'a_b,c.vdb' --target ct.vdb --table latex >latex
is 'for a paper' "$(sed -n '1,3p' latex | tr '\n' ' ')$(tail -n 1 latex)" '\begin{tabular}{lrr} figure & cd.vdb & a\_b,c.vdb \\ \hline \end{tabular}'
is 'its names are escaped' "$(grep -c '[^\\]_' latex)" 0
fails 1 'max_void = 2' vam-score cd.vdb 'a_b,c.vdb' --target ct.vdb --table csv --require 'max_void<=1'
fails 64 '2 doses: one is scored at a time; give --table' vam-score cd.vdb 'a_b,c.vdb' --target ct.vdb
fails 64 'table csv' vam-score cd.vdb --target ct.vdb --table csv --report t.json
fails 64 "'html' is not one of" vam-score cd.vdb --target ct.vdb --table html
fails 66 'none.vdb: cannot open' vam-score cd.vdb none.vdb --target ct.vdb --table csv
done_testing
