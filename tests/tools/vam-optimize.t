# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS ci COST 120
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape disc-grid --voxel 0.1 -o part.vdb || exit 1

# Every method of the table, as completion offers them.
methods=$(vam-optimize --completion bash | sed -n "s/.*--method) .*-W .auto \([^']*\).*/\1/p")
holds "there are methods" "$(echo $methods | wc -w) >= 7"
for method in $methods; do
  few='--iterations 3'; [ $method != fbp ] || few=
  quiet "$method" vam-optimize --method $method --angles 90 $few --report $method.json part.vdb -o $method.exr
  holds "$method separates most of the part" "$(json $method.json iou) > 0.9"
done
quiet "dose-norm as usual" vam-optimize --method dose-norm --angles 90 --report dn.json part.vdb -o dn.exr
holds "dose-norm widens the process window of fbp" "$(json dn.json pw) > $(json fbp.json pw)"
vam-optimize --method dose-norm --angles 90 --set projector.telecentric=true --report level.json part.vdb -o level.exr
is "with level rays a part of constant cross-section needs a few slices, its ends included" \
  "$([ "$(json level.json distinct_slices)" -le 5 ] && echo yes)" yes

quiet "auto is apg up to the knee" vam-optimize --angles 90 --report auto.json part.vdb -o auto.exr
is "auto reaches its goal" "$(json auto.json stopped_by)" goal
holds "no voxel is wrong" "$(json auto.json ver) == 0"
vam-optimize --method apg --angles 90 --iterations "$(json auto.json iterations)" part.vdb -o apg.exr
is "with apg's pixels" "$(tail -c 20000 auto.exr | cksum)" "$(tail -c 20000 apg.exr | cksum)"
quiet "beyond the knee" vam-optimize --angles 90 --iterations 40 --report long.json part.vdb -o apg.exr
holds "all iterations are done, and no worse" "$(json long.json iterations) == 40 && $(json long.json latitude) >= $(json auto.json latitude)"
holds "its report has the deviation of the surface" \
  "$(json auto.json surface.mean_mm) ^ 2 < 0.01 ^ 2 && $(json auto.json surface.rms_mm) < 0.025"

resin='--set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05'
quiet "unlimited" vam-optimize --angles 90 $resin --set optimize.surface=free --max-intensity 0 --report spikes.json part.vdb -o spikes.exr
quiet "limited by default" vam-optimize --angles 90 $resin --set optimize.surface=free --report limited.json part.vdb -o limited.exr
holds "a limit prints at least three times as fast" "3 * $(json limited.json duration_s) <= $(json spikes.json duration_s)"
holds "at more than half of the latitude" "$(json limited.json latitude) > 0.5 * $(json spikes.json latitude)"
quiet "a print of three turns" vam-optimize --angles 90 $resin --turns 3 --report turns.json part.vdb -o turns.exr
is "the print takes three turns" "$(json turns.json turns)" 3
vam-dose turns.exr --like part.vdb $resin --exposure-plan -o dose.vdb --report plan.json
is "vam-dose plans the same" "$(json plan.json turns)" 3
quiet "the shortest" vam-optimize --angles 90 $resin --shortest --report shortest.json part.vdb -o shortest.exr
holds "the shortest print has less intensity than the usual one" \
  "$(json shortest.json peak_intensity) < 0.8 * $(json limited.json peak_intensity)"
holds "the shortest print meets the same conditions" "$(json shortest.json ver) == 0 && $(json shortest.json pw) >= 0.055"
vam-slice --shape cylinder:diameter=4,height=2 --voxel 0.5 -o small.vdb
quiet '--shortest of another method has the conditions of auto' \
  vam-optimize --method apg --shortest --angles 24 --report small.json small.vdb -o small.exr
is 'and ends when they are met' "$(json small.json stopped_by)" goal
vam-optimize --method dose-norm --angles 24 --bits 8 --set optimize.full_scale=0.01 small.vdb -o small.exr 2>clipped
ok 'full grey below the peak is a warning' grep -q 'the peak intensity of .* exceeds optimize.full_scale 0.01 and is clipped' clipped
vam-optimize --angles 60 --iterations 1 --max-intensity 0.12 part.vdb -o out.exr 2>missed.txt
is "a part that does not print for its maximum intensity is reported" "$(grep -c 'does not print after 1 iteration: .*; more --iterations, or a --max-intensity above 0.12' missed.txt)" 1

quiet "a handle around a screwdriver" sh -c 'vam-slice --shape handle --insert-shape screwdriver --voxel 0.4 -o handle.vdb &&
  vam-optimize --angles 90 --report handle.json handle.vdb -o handle.exr'
holds "no voxel of the handle is wrong" "$(json handle.json ver) == 0"
is "no voxel of the handle is in shadow" "$(json handle.json dark_part_voxels)" 0

vam-slice --shape boat --voxel 0.2 -o boat.vdb
quiet "with chief rays in the vial" vam-optimize --angles 90 --method apg --iterations 10 --report vial.json boat.vdb -o vial.exr
# A part in the corners of its volume, as of an array without a margin.
python3 - "$VAM_SOURCE/scripts" <<'PY'
import array, sys
sys.path.insert(0, sys.argv[1])
import vam
n = 24
part = array.array("f", [0 if 8 <= i < 16 and 8 <= j < 16 else 1 for k in range(2) for j in range(n) for i in range(n)])
vam.write_volume("corners.vdb", part, 0.25, shape=(2, n, n))
PY
quiet "a part in the corners of its volume" vam-optimize --geometry parallel --angles 30 --method apg --iterations 3 corners.vdb -o corners.exr
quiet "has a dose" vam-dose corners.exr --like corners.vdb -o corners-dose.vdb
quiet "with a parallel beam" vam-optimize --geometry parallel --angles 90 --method apg --iterations 10 boat.vdb -o parallel.exr
for how in footprints fourier; do
  quiet "line integrals by $how" vam-optimize --geometry parallel --angles 90 --method apg --iterations 10 --set stage.motion=stepped --set optimize.line_integrals=$how boat.vdb -o sums.exr
  vam-dose sums.exr --like boat.vdb -o dose.vdb && vam-score dose.vdb --target boat.vdb --report judged-$how.json >table
done
# 1e-3 of the largest dose lies between them at most, and a voxel's dose rises by several per cent at the surface.
holds "judged by footprints light made by either prints the same" \
  "($(json judged-fourier.json iou) - $(json judged-footprints.json iou))^2 < 0.002^2"
vam-resample parallel.exr -o resampled.exr
for how in vial resampled; do
  vam-dose $how.exr --like boat.vdb -o dose.vdb && vam-score dose.vdb --target boat.vdb --report judged-$how.json >table
done
is "the print of the vial model has no error" "$(json judged-vial.json ver)" 0.0
vam-dose vial.exr --like boat.vdb -o dose.vdb --report dosed.json
holds "all tools see the same voxels outside the part's box" "$(json vial.json outside_voxels) > 10000 &&
  $(json vial.json outside_voxels) == $(json dosed.json outside_voxels) &&
  $(json vial.json outside_voxels) == $(json judged-vial.json outside_voxels)"
holds "no voxel outside the box gels" "$(json vial.json outside_gelled_voxels) == 0 && $(json dosed.json outside_gelled_voxels) == 0 &&
  $(json judged-vial.json outside_gelled_voxels) == 0 && $(json vial.json outside_max_dose) < 0.8"
holds "the largest dose there is the same to the judges and that of the optimiser within 1 %" \
  "$(json dosed.json outside_max_dose) == $(json judged-vial.json outside_max_dose) &&
  ($(json dosed.json outside_max_dose) / $(json vial.json outside_max_dose) - 1)^2 < 1e-4"
is "the brightest slice limits the exposure" "$(json vial.json limited_by.0.value)" "$(json vial.json peak_intensity)"
is "without wrong voxels no face is reported as blurred" "$(json vial.json blurred_faces)" '[]'

# A wide lid far above a short lens, with little time
vam-slice --shape cylinder:diameter=14,height=20 --voxel 0.4 --set projector.throw_ratio=0.6 -o lid.vdb
vam-optimize --angles 60 --method dose-norm --set projector.throw_ratio=0.6 --set stage.motion=stepped lid.vdb -o lid.exr --report lid.json 2>lid.txt
is "a warning names blurred faces, their width and the tilt that helps" \
  "$(grep -c 'warning: lid.vdb: climbing rays blur 2 horizontal faces of the part, .* 12.4 mm wide, over .* voxels .*--rotate [0-9]*,0,0' lid.txt)" 1
holds "the report contains the blurred faces" "$(json lid.json blurred_faces.0.blur_voxels) > 2 && $(json lid.json blurred_faces.0.wrong_voxels) > 0 &&
  $(json lid.json blurred_faces_remedy.tilt_deg) >= 2"
holds "vam-dose confirms the process window" "$(json judged-vial.json pw) > $(json vial.json pw) - 0.001"
holds "the process window is wider than after resampling" "$(json judged-vial.json pw) > $(json judged-resampled.json pw)"
fails 65 'outside its columns 0 to 1023' vam-optimize --geometry vial --set projector.axis_column=9000 part.vdb -o out.exr

absorbing="--set resin.absorption_per_mm=0.1"
for how in exact disc none; do
  quiet "absorption: $how" vam-optimize --angles 90 --method apg --iterations 15 --geometry parallel --set optimize.absorption_model=$how $absorbing part.vdb -o sinogram.exr
  vam-dose sinogram.exr --like part.vdb $absorbing -o dose.vdb 2>/dev/null && vam-score dose.vdb --target part.vdb --report $how.json >table
done
holds "vam-dose confirms the absorption in the loop" "$(json exact.json pw) > $(json none.json pw) + 0.05"
is "absorption in the loop leaves no wrong voxel" "$(json exact.json ver)" 0.0

blurring="--set resin.psf_mm=0.12"
for blur in true false; do
  quiet "blur: $blur" vam-optimize --geometry parallel --angles 90 --iterations 25 --patience 0 --set optimize.blur=$blur $blurring part.vdb -o sinogram.exr
  vam-dose sinogram.exr --like part.vdb $blurring -o dose.vdb 2>/dev/null && vam-score dose.vdb --target part.vdb --report "blur-$blur.json" >table
done
holds "projections compensated for the blur print" "$(json blur-true.json pw) > 0 && $(json blur-true.json ver) == 0"
holds "projections without compensation do not print" "$(json blur-false.json pw) < 0"

ok "through pipes" sh -c 'vam-optimize --geometry parallel --method dose-norm --angles 90 <part.vdb | cat >piped.exr'
ok "the pipe's file is complete" vam-resample piped.exr -o projector.exr
vam-optimize --method dose-norm --angles 90 --threads 1 --compression none part.vdb -o one.exr
vam-optimize --method dose-norm --angles 90 --threads 2 --compression none part.vdb -o one2.exr && mv one2.exr two.exr
is "1 and 2 threads give the same pixels" \
  "$(tail -c 200000 one.exr | cksum)" "$(tail -c 200000 two.exr | cksum)"

quiet "trace" vam-optimize --method cal --angles 90 --iterations 4 --trace trace.csv part.vdb -o cal.exr
is "the trace has a header and a line for every iterate" "$(wc -l <trace.csv)" 6
is "its columns" "$(head -n 1 trace.csv)" iteration,latitude,ver,pw,ipdr,cv,iou
quiet "resuming" vam-optimize --method cal --angles 90 --init cal.exr --iterations 4 --report on.json part.vdb -o on.exr
quiet "until a goal" vam-optimize --method cal --angles 90 --until 'iou>=0.5' --report goal.json part.vdb -o goal.exr
is "it stops there" "$(json goal.json stopped_by)" goal
quiet "grey levels" vam-optimize --method fbp --angles 90 --bits 3 --set optimize.dither=true part.vdb -o grey.exr

# Interrupted again and again, later each time, until it completes: the same bytes as in one run.
vam-optimize --angles 30 --iterations 12 --patience 0 --trace whole.csv --report whole.json part.vdb -o whole.exr
attempt() { timeout -s INT "$1" vam-optimize --angles 30 --iterations 12 --patience 0 --trace parts.csv \
  --report parts.json --checkpoint run.state part.vdb -o parts.exr; }
for seconds in 0.2 0.3 0.5 0.8 1.2 3 10 60; do
  attempt $seconds && break
  [ -e parts.exr ] && break
done
is "the pixels of an interrupted run" "$(tail -c 20000 parts.exr | cksum)" "$(tail -c 20000 whole.exr | cksum)"
same "its trace" parts.csv whole.csv
same "its report" parts.json whole.json
is "its state is removed on completion" "$(ls run.state 2>/dev/null)" ""

interrupted() {  # interrupted STATE ARGUMENTS...: stopped by a signal once it has left that state; $status
  state=$1; shift
  for seconds in 0.5 1 2 5 20 60; do
    timeout --preserve-status -s INT $seconds vam-optimize "$@" --iterations 100000 --patience 0 --checkpoint $state -v \
      small.vdb -o never.exr 2>.log/interrupted
    status=$?
    [ ! -e $state ] || return 0
  done
}
endless() { timeout 60 vam-optimize --iterations 100000 --patience 0 "$@"; }  # but for the error that is expected
interrupted run.state --angles 24
is "interrupted, it ends by the signal" "$status" 130
grep -q '^vam-optimize: interrupted; run.state has its state, from which the same command resumes$' .log/interrupted; report $? 'and says how it goes on'
is "interrupted, it leaves its state and no result" "$(ls run.state never.exr 2>/dev/null)" run.state
for other in '--angles 36' '--angles 24 --dose-high 0.9' '--angles 24 --weights small.vdb' '--angles 24 --set optimize.dither=true --bits 8'; do  # any option counts
  fails 65 'of another job' vam-optimize $other --checkpoint run.state small.vdb -o out.exr
done
fails 65 'of another job' endless --angles 24 --until 'ver<=0' --checkpoint run.state small.vdb -o out.exr
# Files count by what they hold.
vam-optimize --iterations 2 --angles 30 small.vdb -o start.exr
interrupted init.state --angles 30 --init start.exr
vam-optimize --method fbp --angles 30 small.vdb -o start.exr
fails 65 'init.state.*of another job' endless --angles 30 --init start.exr --checkpoint init.state small.vdb -o out.exr
python3 - <<'EOF'
bytes = bytearray(open("run.state", "rb").read())
bytes[-400:-396] = b"\x00\x00\xc0\x7f"
open("nan.state", "wb").write(bytes)
open("cut.state", "wb").write(bytes[:3000])
EOF
fails 65 'nan.state: .*NaN' endless --angles 24 --checkpoint nan.state small.vdb -o out.exr
fails 65 'cut.state' endless --angles 24 --checkpoint cut.state small.vdb -o out.exr
{ cat run.state; echo more; } >long.state
fails 65 'long.state: damaged .something follows its end' endless --angles 24 --checkpoint long.state small.vdb -o out.exr
mkfifo fifo.state
fails 65 'fifo.state: is not a regular file' endless --angles 24 --checkpoint fifo.state small.vdb -o out.exr
ln -s gone gone.state
fails 66 'gone.state: links to a file that is gone' endless --angles 24 --checkpoint gone.state small.vdb -o out.exr
unseen=0
for trial in $(seq 12); do
  python3 - "$trial" <<'EOF'
import random, sys
random.seed(int(sys.argv[1]))
data = bytearray(open("run.state", "rb").read())
at = random.randrange(len(data)) if random.random() < 0.5 else random.randrange(2000)
if random.random() < 0.3: del data[at:]
else: data[at] ^= 1 << random.randrange(8)
open("flipped.state", "wb").write(data)
EOF
  timeout 10 vam-optimize --angles 24 --iterations 100000 --patience 0 --checkpoint flipped.state small.vdb -o out.exr 2>.log/err; status=$?
  [ "$status $(wc -l <.log/err)" = '65 1' ] || { unseen=$((unseen + 1)); echo "# trial $trial: status $status"; }
done
is 'a cut or a flipped bit anywhere in a state is an error' $unseen 0
cp part.vdb other.vdb
fails 65 'not a checkpoint' vam-optimize --checkpoint other.vdb part.vdb -o out.exr

vam-slice --shape disc-grid --voxel 0.4 -o coarse.vdb
quiet "a front" vam-optimize --angles 60 $resin --tradeoff front.csv coarse.vdb -o front.exr
is "its columns" "$(head -n 1 front.csv)" max_intensity,duration_s,turns,latitude,pw,ver,iou,peak_intensity,efficiency,latitude_tolerances
holds "it has eight limits" "$(wc -l <front.csv) >= 9"
is "a brighter peak takes more time" "$(sed 1d front.csv | cut -d, -f2 | sort -g | cksum)" \
  "$(sed 1d front.csv | cut -d, -f2 | cksum)"
is "no peak is above its limit" "$(sed 1d front.csv | awk -F, '$8 > 1.0001 * $1' | wc -l)" 0
holds "more intensity has a wider window" "$(sed -n '$p' front.csv | cut -d, -f4) > $(sed -n 2p front.csv | cut -d, -f4)"
vam-slice --shape cylinder:diameter=4,height=2 --voxel 0.8 -o tiny.vdb
quiet "of a resin that is not known" vam-optimize --angles 12 --tradeoff plain.csv tiny.vdb -o front.exr
is "there are no seconds" "$(sed 1d plain.csv | cut -d, -f2,3 | sort -u)" ,
quiet "a front as an image, with tolerances" vam-optimize --angles 12 --robust lamp=3% --set optimize.yield_printers=0 $resin \
  --tradeoff front.png tiny.vdb -o front.exr
is "it is an image" "$(head -c 8 front.png | od -An -c | tr -d ' ')" '211PNG\r\n032\n'
fails 64 'front.txt' vam-optimize --tradeoff front.txt coarse.vdb -o out.exr
vam-optimize --angles 12 --tradeoff nowhere/out.csv tiny.vdb -o kept.exr 2>.log/nowhere
is "a front that cannot be written leaves the projections" \
  "$? $(grep -c nowhere/out.csv .log/nowhere) $([ -s kept.exr ] && echo kept)" "73 1 kept"

# The proof.
quiet "a proof" vam-optimize --angles 24 --certify proof.vdb --report proved.json small.vdb -o proved.exr
holds "no light is better than the bound" "$(json proved.json certificate.least_void_over_part) > 0 &&
  $(json proved.json certificate.least_void_over_part) <= $(json proved.json certificate.unlimited_void_over_part) &&
  $(json proved.json certificate.least_void_over_part) <= $(json proved.json certificate.void_over_part)"
ok "its weights are a volume to look at" vam-view proof.vdb -o proof.png
quiet "the widest window of limited light" vam-optimize --method minimax --iterations 80 --patience 0 --angles 24 \
  --report widest.json small.vdb -o widest.exr
holds "the window is within its bound" "$(json widest.json least_void_over_part) > 0.3 &&
  $(json widest.json least_void_over_part) <= $(json widest.json max_void) / $(json widest.json min_part)"
fails 65 "certificate" vam-optimize --weights proof.vdb part.vdb -o out.exr
is 'the help fits on a screen, with a dozen options' \
  "$(vam-optimize --help | awk '/^  -/ && !/--version/ { n++ } END { print (NR <= 30), (n <= 14) }')" '1 1'
fails 64 'p.exr' vam-optimize --certify p.exr part.vdb -o out.exr

# A budget of time.
quiet "in three seconds" vam-optimize --angles 60 --budget 3 --until 'pw>=0.9' --iterations 100000 --patience 0 --report budget.json coarse.vdb -o out.exr
is "time stops the run" "$(json budget.json stopped_by)" time
holds "its light is of use" "$(json budget.json iou) > 0.95"
vam-optimize --angles 60 --budget 0.01 --max-intensity 0.12 part.vdb -o out.exr 2>short.txt
is "which is named where it is too short" "$(grep -c 'does not print after [0-9]* iterations* within --budget: .*; a larger --budget' short.txt)" 1

# Printers off their settings.
off='axis=2px,index=0.02,angle=1deg,radius=0.5%,lamp=2%,psf=0.1mm'
before=
robust() { $before vam-optimize --set projector.columns=128 --set projector.axis_column=63.5 --angles 30 --iterations 8 --robust "$off" --set optimize.yield_printers=4 "$@" small.vdb; }
quiet "for printers off their settings" robust --report robust.json --threads 1 -o robust.exr
is "each tolerance is judged" "$(grep -c margin_of_threshold robust.json)" 13
is "a yield is reported" "$(grep -c '"yield": ' robust.json)" 1
holds "the part prints as set" "$(python3 -c 'import json; print(json.load(open("robust.json"))["robust"]["nominal"]["wrong"])') == 0"
robust --report again.json --threads 2 -o again.exr
is "1 and 2 threads give the same pixels for them" \
  "$(tail -c 20000 robust.exr | cksum)" "$(tail -c 20000 again.exr | cksum)"
same "and the same report" robust.json again.json
for seconds in 0.2 0.3 0.5 0.8 1.2 2 4 60; do
  before="timeout -s INT $seconds"
  robust --report parts.json --checkpoint robust.state -o robust-parts.exr && break
  [ -e robust-parts.exr ] && break
done
is "the pixels of such a run, interrupted" \
  "$(tail -c 20000 robust-parts.exr | cksum)" "$(tail -c 20000 robust.exr | cksum)"
same "its figures" parts.json robust.json
fails 64 "no tolerance is called 'colour'; there are axis" vam-optimize --robust colour=3 part.vdb -o out.exr
fails 64 "'axis=0.5': the unit must be px; write for example" vam-optimize --robust axis=0.5 part.vdb -o out.exr
python3 "$VAM_SOURCE/tests/tools/scans.py" beam beam
records='--set calibration.folder=cal'
fails 64 'no calibration.folder' vam-optimize --robust calibration part.vdb -o out.exr
mkdir -p cal
fails 65 'cal: has no record of edges, latency or beam' vam-optimize $records --robust calibration part.vdb -o out.exr
fails 64 "'lamp=3': the unit must be %" vam-optimize $records --robust calibration,lamp=3 part.vdb -o out.exr
vam-calibrate beam beam --pixel 0.0035 --first -6.35 --spacing 1.27 $records
quiet "tolerances of the records" vam-optimize --angles 30 --iterations 10 $records --robust calibration,lamp=3% \
  --set optimize.yield_printers=0 --report recorded.json coarse.vdb -o recorded.exr
is "those that there are" "$(json recorded.json robust.single.0.name) $(json recorded.json robust.single.1.name)" "lamp psf"
is "the others are named" "$(json recorded.json robust.exact)" "['axis', 'index', 'angle', 'radius']"

# The print at the threshold against the design: 0.1 voxels of 0.26 mm on average, RMS 0.25.
vam-slice --shape torus --voxel 0.26 -o torus.vdb && vam-optimize --angles 120 torus.vdb -o asked.exr
vam-dose asked.exr --like torus.vdb -o dose.vdb 2>/dev/null
vam-score dose.vdb --target torus.vdb --isovalue 0.8 --mesh asked.ply >table
vam-slice --shape torus --voxel 0.09 -o fine.vdb && vam-score fine.vdb --grid target --isovalue 0.5 --mesh design.ply >table
vam-sdf asked.ply design.ply --align none --samples 20000 --report asked-sdf.json >table
sdf() { python3 -c 'import json, sys; print(json.load(open("asked-sdf.json"))["print_to_design"][sys.argv[1]])' "$1"; }
holds "the print is as large as the design" "$(sdf mean_mm) >= -0.026 && $(sdf mean_mm) <= 0.026 && $(sdf rms_mm) <= 0.065"
quiet "a band around the surface" vam-optimize --angles 45 --iterations 10 --set optimize.surface_margin_mm=0.15 --report band.json part.vdb -o band.exr
quiet "surface voxels constrained, too" vam-optimize --angles 45 --iterations 10 --set optimize.surface=voxels --report surface.json part.vdb -o surface.exr
holds "judged alike, more constraints make a wider window" "$(json band.json pw) < $(json surface.json pw)"
printf 'dose,response\n0.2,0\n0.7,0.05\n0.9,0.95\n1.2,1\n' >cure.csv
quiet "a measured response" vam-optimize --method bclp --resin-response cure.csv --angles 45 --iterations 20 --report cure.json part.vdb -o cure.exr
holds "its window's middle is the threshold" "$(json cure.json threshold_dose) > 0.79 && $(json cure.json threshold_dose) < 0.81"
is "its verdict ends a run" "$(vam-optimize --grey-target --band 0.45 --angles 45 --iterations 5 -v part.vdb -o grey.exr 2>&1 | grep -cE '^vam-optimize: part.vdb not met: [0-9.]+ % of [0-9]+ voxels are within their bands around the target')" 1
vam-slice --shape cylinder:diameter=4,height=1 --voxel 0.4 -o short.vdb
is "or says that the target is met" "$(vam-optimize --grey-target --band 0.5 --angles 45 --iterations 5 -v short.vdb -o grey.exr 2>&1 | grep -cE '^vam-optimize: short.vdb met: 100 % of [0-9]+ voxels are within their bands around the target')" 1
quiet "a grey target" vam-optimize --grey-target --band 0.45 --angles 45 --iterations 20 --report grey.json part.vdb -o grey.exr
is "no doses of part and void" "$(grep -c min_part grey.json)" 0
holds "most are within their band" "$(json grey.json ver) < 0.05"
printf 'dose,response\n0.2,0\n0.7,0.5\n0.6,0.95\n' >falls.csv
fails 65 'falls.csv: .*falls back' vam-optimize --method bclp --resin-response falls.csv part.vdb -o out.exr
fails 66 "'logstic' is none of .*did you mean logistic" vam-optimize --method bclp --resin-response logstic part.vdb -o out.exr
vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 -o other.vdb
fails 65 "other.vdb: the grid of 'target' differs" vam-optimize --weights other.vdb part.vdb -o out.exr
for geometry in vial parallel; do
  fails 65 'per mm and to base e' vam-optimize --geometry $geometry --set resin.absorption_per_mm=20 part.vdb -o out.exr
done
fails 64 'use footprints' vam-optimize --geometry parallel --set optimize.line_integrals=fourier --set resin.absorption_per_mm=0.05 part.vdb -o out.exr

fails 64 'as --output does; name a file for one of them' vam-optimize part.vdb --report -
fails 64 'optimize.power' vam-optimize --method pm --set optimize.power=0.5 part.vdb -o out.exr
fails 65 '90 angles' vam-optimize --angles 80 --init cal.exr part.vdb -o out.exr
fails 65 'projector' vam-optimize --geometry parallel --angles 90 --init projector.exr part.vdb -o out.exr
fails 65 'its lens, 16.64 mm from the axis, is too close to the axis' vam-optimize --set projector.throw_ratio=0.25 boat.vdb -o out.exr
fails 65 "reaches 7.748 mm from the axis, beyond the resin's edge at 5 mm; scale" vam-optimize --set vial.radius_mm=5 part.vdb -o out.exr
# A disc of one voxel, and rows that pass below it
vam-slice --shape cylinder:diameter=6,height=0.2 --stretch-z 1 --voxel 0.2 -o disc.vdb
quiet "a disc of one voxel's height prints" vam-optimize --angles 24 --iterations 2 --set projector.telecentric=true disc.vdb -o disc.exr
fails 65 'slices span z = -0.1 ... 0.1 mm, .* rows cover' vam-optimize --angles 24 --set projector.axis_row=-200 disc.vdb -o out.exr

done_testing
