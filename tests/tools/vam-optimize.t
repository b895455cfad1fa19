. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape disc-grid --voxel 0.1 -o part.vdb || exit 1
value() { json "$1" "$2"; }

for method in fbp dose-norm cal osmo pm bclp apg; do
  quiet "$method" vam-optimize --method $method --angles 90 --iterations 3 --report $method.json part.vdb -o $method.exr
  holds "$method separates most of the part" "$(value $method.json iou) > 0.9"
done
quiet "fbp without iterations" vam-optimize --method fbp --angles 90 --report fbp.json part.vdb -o fbp.exr
quiet "dose-norm as usual" vam-optimize --method dose-norm --angles 90 --report dn.json part.vdb -o dn.exr
holds "dose-norm widens the process window of fbp" "$(value dn.json pw) > $(value fbp.json pw)"
is "a part of constant cross-section costs a few slices, its ends included" \
  "$([ "$(value dn.json distinct_slices)" -le 5 ] && echo yes)" yes

quiet "auto is apg until the part prints with room to spare" vam-optimize --angles 180 --report auto.json part.vdb -o auto.exr
is "its goal" "$(value auto.json stopped_by)" goal
holds "no voxel errs" "$(value auto.json ver) == 0"

quiet "a handle around a screwdriver" sh -c 'vam-slice --shape handle --insert-shape screwdriver --voxel 0.4 -o handle.vdb &&
  vam-optimize --angles 180 --report handle.json handle.vdb -o handle.exr'
holds "every voxel of it is right" "$(value handle.json ver) == 0"
is "all of it can be lit" "$(value handle.json dark_part_voxels)" 0

quiet "in the vial's own light" vam-optimize --geometry vial --angles 180 --method apg --iterations 10 --report vial.json part.vdb -o vial.exr
quiet "and by way of parallel light" vam-optimize --geometry parallel --angles 180 --method apg --iterations 10 part.vdb -o parallel.exr
vam-resample parallel.exr -o resampled.exr
for how in vial resampled; do
  vam-dose $how.exr --like part.vdb -o dose.vdb && vam-score dose.vdb --target part.vdb --report judged-$how.json >table
done
is "its print has no error" "$(value judged-vial.json ver)" 0.0
holds "the judge of chief rays sees what the optimiser saw" "$(value judged-vial.json pw) > $(value vial.json pw) - 0.01"
holds "and a wider window than after resampling" "$(value judged-vial.json pw) > $(value judged-resampled.json pw)"
fails 65 'already.*leave vam-resample out' vam-resample vial.exr -o twice.exr
fails 64 '--columns: has no meaning with --geometry vial' vam-optimize --geometry vial --columns 100 part.vdb -o out.exr
fails 65 'none of its 1024 columns' vam-optimize --geometry vial --set projector.axis_column=9000 part.vdb -o out.exr

absorbing="--set resin.absorption_per_mm=0.1"
for how in exact disc none; do
  quiet "absorption: $how" vam-optimize --angles 180 --method apg --iterations 15 --absorption $how $absorbing part.vdb -o light.exr
  vam-dose light.exr --like part.vdb $absorbing -o dose.vdb 2>/dev/null && vam-score dose.vdb --target part.vdb --report $how.json >table
done
holds "the judge sees the absorption in the loop" "$(value exact.json pw) > $(value none.json pw) + 0.05"
is "and no error" "$(value exact.json ver)" 0.0

ok "through pipes" sh -c 'vam-optimize --method dose-norm --angles 90 <part.vdb | cat >piped.exr'
ok "the pipe's file is complete" vam-resample piped.exr -o projector.exr
vam-optimize --method dose-norm --angles 90 --threads 1 --compression none part.vdb -o one.exr
vam-optimize --method dose-norm --angles 90 --threads 2 --compression none part.vdb -o one2.exr && mv one2.exr two.exr
is "1 and 2 threads give the same pixels" \
  "$(tail -c 200000 one.exr | cksum)" "$(tail -c 200000 two.exr | cksum)"

quiet "trace" vam-optimize --method cal --angles 90 --iterations 4 --trace trace.csv part.vdb -o cal.exr
is "the trace has a header and a line for every iterate" "$(wc -l <trace.csv)" 6
is "its columns" "$(head -n 1 trace.csv)" iteration,ver,pw,ipdr,cv,iou
quiet "going on" vam-optimize --method cal --angles 90 --init cal.exr --iterations 4 --report on.json part.vdb -o on.exr
quiet "until a goal" vam-optimize --method cal --angles 90 --until 'iou>=0.5' --report goal.json part.vdb -o goal.exr
is "stops there" "$(value goal.json stopped_by)" goal
quiet "grey levels" vam-optimize --method fbp --angles 90 --bits 3 --error-feedback part.vdb -o grey.exr

fails 64 'no method is called|not among|magic' vam-optimize --method magic part.vdb -o out.exr
fails 64 '0.9 is not below --dose-high 0.8' vam-optimize --dose-low 0.9 --dose-high 0.8 part.vdb -o out.exr
fails 64 "no figure is called 'vre'" vam-optimize --until 'vre<=0' part.vdb -o out.exr
fails 64 '--power' vam-optimize --method pm --power 0.5 part.vdb -o out.exr
fails 64 '--peak' vam-optimize --peak 1 part.vdb -o out.exr
fails 64 '--angles' vam-optimize --angles 0 part.vdb -o out.exr
fails 64 'is also the input' vam-optimize part.vdb -o part.vdb
fails 66 'absent.vdb' vam-optimize absent.vdb -o out.exr
fails 65 '90 angles' vam-optimize --angles 80 --init cal.exr part.vdb -o out.exr
fails 65 'projector' vam-optimize --angles 90 --init projector.exr part.vdb -o out.exr
fails 65 'light reaches only' vam-optimize --set vial.radius_mm=5 part.vdb -o out.exr
head -c 3000 part.vdb >cut.vdb
fails 65 'cut.vdb' vam-optimize cut.vdb -o out.exr
fails 65 'cal.exr' vam-optimize cal.exr -o out.exr
fails 73 'nowhere' vam-optimize part.vdb -o nowhere/out.exr
fails 74 'space' vam-optimize --angles 90 part.vdb -o /dev/full
fails 66 'none.toml' vam-optimize --printer none.toml part.vdb -o out.exr

done_testing
