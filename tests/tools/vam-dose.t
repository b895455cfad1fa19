# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-dose end to end: both models, the volume, absolute doses and times, blur, streams, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

ok "a part" vam-slice --shape disc-grid:height=0.4 --voxel 0.1 -o part.vdb
ok "projections of the part" vam-sinogram part.vdb --filter ram-lak --negative clip -o virtual.exr
ok "resampling to the projector" vam-resample virtual.exr -o frames.exr
quiet "dose of projector sinograms" vam-dose frames.exr --like part.vdb -o dose.vdb --report report.json
is "its model is chief rays" "$(json report.json model)" "chief rays"
quiet "the dose of level rays" vam-dose --in-plane frames.exr --like part.vdb -o level.vdb --report level.json
is "its model is level chief rays" "$(json level.json model)" "level chief rays"
quiet "the parallel dose" vam-dose virtual.exr --like part.vdb -o parallel.vdb --report parallel.json
is "its model is back-projection" "$(json parallel.json model)" parallel
a=$(json level.json part_dose_per_turn_mean_relative); b=$(json parallel.json part_dose_per_turn_mean_relative)
holds "the corrected print receives the parallel dose" "($a / $b - 1)^2 < 0.02^2"
ok "the simulated print matches the part" vam-score dose.vdb --target part.vdb --require 'iou>=0.95'
vam-resample virtual.exr --set projector.telecentric=true | vam-dose --set projector.telecentric=false --like part.vdb -o wrong.vdb
fails 1 iou vam-score wrong.vdb --target part.vdb --require 'iou>=0.95'

# Grey levels: black and white, each pixel to the nearer one or with errors that cancel.
peak=$(python3 -c 'import json; print(json.load(open("report.json"))["full_scale"])')
for grey in '' '--bits 1' '--bits 1 --dither 1' '--bits 1 --dither 9'; do
  vam-dose frames.exr --like part.vdb --full-scale $peak $grey | vam-score --target part.vdb | awk '/^pw / { print $2 }'
done >windows
holds "diffusion is nearer to the window of all greys, and turns are nearer still" \
  "$(sed -n 2p windows) < $(sed -n 3p windows) && $(sed -n 3p windows) < $(sed -n 4p windows) && $(sed -n 4p windows) > $(sed -n 1p windows) - 0.01"

# Streams and threads
vam-dose <frames.exr --like part.vdb >stdin.vdb
ok "stdin to stdout" vam-score stdin.vdb --target part.vdb
# The identity of an archive depends on its history, so the command must be the same: one core stands for one thread.
taskset -c 0 vam-dose --like part.vdb frames.exr >one.vdb
vam-dose --like part.vdb frames.exr >two.vdb
ok "the dose from a pipe is a volume" vam-score one.vdb --target part.vdb
same "1 and 2 threads give identical bytes" one.vdb two.vdb

# Misalignment, and its compensation by the same options
holds "a column offset degrades the dose" "$(vam-resample virtual.exr --column-offset 12 | vam-dose --like part.vdb | vam-score --target part.vdb | awk '/^iou/ { print $2 }') < 0.9"
vam-resample virtual.exr --column-offset 12 --angle-offset 10 --reverse >moved.exr
vam-dose moved.exr --column-offset 12 --angle-offset 10 --reverse --like part.vdb -o moved.vdb
ok "the same offset compensates it" vam-score moved.vdb --target part.vdb --require 'iou>=0.95'

# Absolute: uniform intensity of 3.8 mW/cm2 in a telecentric bath of the resin's index, 36 s a turn: on the axis
# mu I 36 s e^{-mu R} = 0.5/cm * 3.8 * 36 * e^{-0.635} = 36.25 mJ/cm3, without the loss at the window.
$exr make flat.exr space=projector width=1024 height=8 pixel=0.065 row=0.065 value=0.5 count=1
flat="--set projector.telecentric=true --set bath.index=1.53 --set resin.absorption_per_mm=0.05 --set resin.critical_dose_mj_cm3=100"
ok "absolute dose" vam-dose flat.exr $flat --size 0.065 -o flat.vdb --report flat.json
window=$(vam-resample --explain --set projector.telecentric=true --set bath.index=1.53 | awk -F, 'NR == 500 { print $4 }')
holds "closed form on the axis" "($(json flat.json dose_per_turn_max_mj_cm3) / (36.2488 * $window) - 1)^2 < 1e-6"
is "turns" "$(json flat.json turns_to_critical_max)" 3.0
is "seconds" "$(json flat.json duration_to_critical_max_s)" 108.0
ok "half the intensity at full scale 1" vam-dose flat.exr $flat --size 0.065 --full-scale 1 -o half.vdb --report half.json
holds "gives half the dose" "($(json half.json dose_per_turn_max_mj_cm3) / $(json flat.json dose_per_turn_max_mj_cm3) - 0.5)^2 < 1e-10"

# Width: frames that are held while the stage turns, and the aperture of the lens
for width in 'stage.motion=stepped' 'stage.motion=held' 'stage.motion=stepped projector.half_angle_deg=1.5' 'stage.motion=interpolated projector.half_angle_deg=1.5'; do
  set --; for key in $width; do set -- "$@" --set $key; done
  vam-dose frames.exr --like part.vdb "$@" | vam-score --target part.vdb --report wide.json >/dev/null
  printf '%s %s\n' "$(json wide.json pw)" "$(json wide.json verdict | sed 's/.*; by //')"
done >widths
holds "every width takes some of the process window" \
  "$(awk 'NR == 1 { first = $1 } NR > 1 && !($1 < first) { bad = 1 } END { print bad + 0 }' widths) == 0"
is "the verdict states the width" "$(sed -n 4p widths | cut -d' ' -f2-)" \
  "light of half angle 1.5 deg, each frame over 1.54 deg of the stage"
vam-dose frames.exr --in-plane --like part.vdb --set projector.half_angle_deg=1.5 --set stage.motion=stepped | vam-score --target part.vdb --report wide.json >/dev/null
is "but not what is left out" "$(json wide.json verdict | sed 's/.*; by //')" "light of half angle 1.5 deg across only"
# What frames of a virtual projector leave that are held over 6 degrees, by 16 angles for each.
vam-sinogram part.vdb --angles 60 --filter ram-lak --negative clip -o coarse.exr
far=$(python3 - <<PY
import array, subprocess, sys
sys.path.insert(0, "$VAM_SOURCE/scripts")
import vam
values, facts = vam.read("coarse.exr")
(count, angles, width), (height, _, pitch), data = facts["shape"], facts["spacing"], values.tobytes()
rows = (4 * width * (s * angles + (j + 8) // 16 % angles) for s in range(count) for j in range(16 * angles))
vam.write_stack("fine.exr", array.array("f", b"".join(data[at:at + 4 * width] for at in rows)), pitch, height,
                space="virtual", z_start_mm=facts["origin"][0], shape=(count, 16 * angles, width))
def dose(motion, light):
    subprocess.run(["vam-dose", light, "--set", "stage.motion=" + motion, "--like", "part.vdb", "-o", "wide.vdb"], check=True)
    return array.array("f", vam.read("wide.vdb", "dose")[0].tobytes())
fine, held, thin = dose("stepped", "fine.exr"), dose("held", "coarse.exr"), dose("stepped", "coarse.exr")
print(sum((a - b) ** 2 for a, b in zip(held, fine)) / sum((a - b) ** 2 for a, b in zip(thin, fine)))
PY
)
holds "light of a virtual projector has a width, too" "$far < 0.2 ^ 2"
fails 64 'half_angle_deg' vam-dose frames.exr --like part.vdb --set projector.half_angle_deg=-1 -o out.vdb
fails 64 'half_angle_deg' vam-dose frames.exr --like part.vdb --set projector.half_angle_deg=6 -o out.vdb
fails 64 'motion' vam-dose frames.exr --like part.vdb --set stage.motion=fast -o out.vdb

# An exposure: whole turns, and the critical dose in the middle of the process window
resin="--set resin.absorption_per_mm=0.01 --set resin.critical_dose_mj_cm3=100"
ok "a turn at full intensity" vam-dose frames.exr --like part.vdb $resin -o turn.vdb --report turn.json
ok "vam-score reports the exposure" vam-score turn.vdb --target part.vdb $resin --sinogram frames.exr --report turn-score.json
quiet "a planned exposure" vam-dose frames.exr --like part.vdb $resin --exposure-plan -o planned.vdb --report plan.json
ok "the score of the planned exposure" vam-score planned.vdb --target part.vdb $resin --absolute --report planned.json
holds "full intensity, and the critical dose in the middle half of the window" "$(json plan.json multiplier) == 1 && \
  ($(json planned.json min_part) + $(json planned.json max_void) - 200)^2 < ($(json planned.json pw) / 2)^2"
holds "part cures, void does not" "$(json planned.json cured_wrong) == 0"
is "whole turns, the same from either dose" "$(json turn-score.json turns) $(json planned.json turns)" "$(json plan.json turns).0 $(json plan.json turns).0"
holds "fewer turns do not suffice" "$(json plan.json multiplier) <= 1 && $(json plan.json multiplier) * $(json plan.json turns) > $(json plan.json turns) - 1"
holds "duration of the print" "$(json plan.json duration_s) == 36 * $(json plan.json turns)"
holds "the brightest pixel" "($(json plan.json peak_intensity_mw_cm2) / (3.8 * $(json plan.json multiplier)) - 1)^2 < 1e-12"
holds "light efficiency, from either tool" "($(json plan.json efficiency) / $(json turn-score.json efficiency) - 1)^2 < 1e-8"
fails 65 "has no grid 'target'" vam-dose frames.exr --like turn.vdb $resin --exposure-plan -o x.vdb

# Blur
ok "point spread and diffusion" vam-dose frames.exr --like part.vdb --set resin.psf_mm=0.3 --set resin.diffusion_mm2_s=0.0005 --report blur.json -o blur.vdb
is "what diffusion does not stand for is said once" "$(grep -c 'warning: resin.diffusion_mm2_s.*does not stand for oxygen' .log/err)" 1
holds "sqrt(0.3^2 + 0.0005 * 36)" "($(json blur.json blur_sigma_mm) - 0.3286335)^2 < 1e-12"
vam-dose frames.exr --like part.vdb --set resin.diffusion_mm2_s=0.0005 --set resin.dose_lifetime_s=4 --report short.json -o short.vdb
holds "a lifetime of 4 s in 36" "($(json short.json blur_sigma_mm)^2 - 2 * 0.0005 * 4 * (1 - 4 / 36 * (1 - exp(-9))))^2 < 1e-16"
holds "the blur lowers the least part dose" "$(json blur.json part_dose_per_turn_min_relative) < $(json report.json part_dose_per_turn_min_relative)"
ok "--no-blur" vam-dose frames.exr --like part.vdb --set resin.psf_mm=0.3 --set resin.diffusion_mm2_s=0.0005 --no-blur --report sharp.json -o sharp.vdb
is "--no-blur neglects the blur" "$(json sharp.json part_dose_per_turn_min_relative)" "$(json report.json part_dose_per_turn_min_relative)"

# Negative intensities
vam-sinogram part.vdb --filter ram-lak | vam-resample --negative keep >negative.exr
ok "negative intensities" vam-dose negative.exr --like part.vdb -o x.vdb; rm x.vdb
is "negative intensities set to 0 are reported" "$(grep -c 'set to 0' .log/err)" 1

$exr make negative.exr space=virtual width=29 height=8 count=2 value=-1
ok "those of another program" vam-dose negative.exr -o x.vdb; rm x.vdb
is "are kept with a warning" "$(grep -c 'negative.exr: 100 % of the intensities are negative, the minimum is -1, .*; kept' .log/err)" 1

# Around an insert (overprinting): as many voxels as 128 cubed, then coarsely with a parallel beam
vam-slice --shape handle --insert-shape screwdriver --voxel 0.4 -o fine.vdb
vam-optimize --angles 90 fine.vdb -o fine.exr
quiet "a handle around a screwdriver" vam-dose fine.exr --like fine.vdb --report fine.json -o fine-dose.vdb
ok "the dose around an insert is scored" vam-score fine-dose.vdb --target fine.vdb --report fine-score.json
holds "98 % of its voxels are correct" "1 - $(json fine-score.json ver) >= 0.98 && $(json fine-score.json iou) >= 0.995"
is "no part voxel is in shadow" "$(json fine.json dark_part_voxels)" 0
holds "only an insert has a shadow" "$(grep -c dark_part_voxels report.json) == 0"
rm fine*
vam-slice --shape handle --insert-shape screwdriver --voxel 0.4 -o handle.vdb
vam-optimize --geometry parallel --angles 180 handle.vdb -o around.exr
vam-resample around.exr -o resampled.exr
for stack in around resampled; do
  vam-dose $stack.exr --like handle.vdb -o around.vdb
  vam-score around.vdb --target handle.vdb --report $stack.json >table
  holds "a parallel beam prints it, too ($stack)" "1 - $(json $stack.json ver) >= 0.98 && $(json $stack.json iou) >= 0.99"
done
vam-dose around.exr --like handle.vdb --set resin.psf_mm=0.4 -o blurred.vdb
vam-convert blurred.vdb -o blurred.npy
vam-convert handle.vdb --grid insert -o insert.npy
is "blur adds no dose to the insert, but beside it" "$($npy eval '(len(inside := [d for d, i in zip(*v) if i >= 0.5]) > 1000, max(inside),
  min(d for d, i in zip(*v) if i < 0.5) > 0)' blurred.npy insert.npy)" "True 0.0 True"
vam-slice --shape cylinder:diameter=6,height=4 --insert-shape hollow-cylinder:outer=12,inner=9,height=8 \
  --extent writable --voxel 0.4 -o hidden.vdb
vam-sinogram hidden.vdb --filter ram-lak --negative clip -o hidden.exr
ok "a part within a tube" vam-dose hidden.exr --like hidden.vdb --report hidden.json -o hidden-dose.vdb
is "voxels in shadow are reported" "$(grep -c 'the insert shadows .* from all stage angles' .log/err)" 1
holds "all part voxels are in shadow" "$(json hidden.json dark_part_voxels) == $(json hidden.json part_voxels) && $(json hidden.json part_voxels) > 0"
holds "they receive no dose" "$(json hidden.json part_dose_per_turn_mean_relative) == 0"

# Wrong inputs
$exr make camera.exr space=camera
$exr make images.exr kind=frames
$exr make flattened.exr pixel=0.1 row=0.3 printer=none
$exr make half.exr width=64 step=3
unsealed() { sed 's|vam:\(facts_\)*seal|vom:\1seal|g' "$1"; }
{ unsealed handle.vdb | sed 's|target|others|g'; unsealed part.vdb; } >mixed.vdb  # an insert of other voxels
fails 65 "mixed.vdb: the grid 'insert' has .* voxels" vam-dose frames.exr --like mixed.vdb -o x.vdb
vam-slice --shape cylinder:diameter=1,height=0.4 --voxel 0.1 -o rod.vdb
{ unsealed part.vdb; unsealed rod.vdb | sed 's|target|insert|g'; } >cropped.vdb
ok "an insert without the void around it" vam-dose virtual.exr --like cropped.vdb -o x.vdb
# Of a grey target only the voxels are needed.
vam-convert part.vdb -o part.npy
python3 -c 'import array
head, values = open("part.npy", "rb").read().split(b"\n", 1)
open("grey.npy", "wb").write(head + b"\n" + array.array("f", [20 * x for x in array.array("f", values)]).tobytes())'
vam-convert grey.npy --voxel 0.1 --stretch-z 1 --value-unit mJ/cm3 -o grey.vdb
vam-convert part.npy --voxel 0.1 --stretch-z 1 -o covered.vdb
quiet "the place of a dose" vam-dose virtual.exr --like grey.vdb -o like-grey.vdb
vam-dose virtual.exr --like covered.vdb -o like-part.vdb
for like in grey part; do vam-convert like-$like.vdb -o like-$like.npy; done
same "is that of a part" like-grey.npy like-part.npy
fails 65 "'target' is a dose for every voxel, not a part; --exposure-plan requires" \
  vam-dose virtual.exr --like grey.vdb --exposure-plan --set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05 -o x.vdb
fails 65 "grey.vdb: grid 'target' has" vam-view like-grey.vdb --target grey.vdb --cure-map -o x.png
fails 65 'in relative, but the target is in mJ/cm3; make both in mJ/cm3: .*--exposure-plan' vam-score like-grey.vdb --target grey.vdb --grey-target
fails 65 camera vam-dose camera.exr -o x.vdb
fails 65 frames vam-dose images.exr -o x.vdb
fails 65 cubes vam-dose flattened.exr -o x.vdb
fails 65 'cover 180 deg' vam-dose half.exr -o x.vdb
fails 65 'not slices of the volume' vam-dose flat.exr --like part.vdb -o x.vdb
# Light that is not negative gives no negative dose, not even by rounding.
edge='--set projector.telecentric_rows=true --set projector.columns=333 --set projector.rows=255 --set projector.pixel_mm=0.15
  --set bath.index=1.33 --set bath.window_mm=22 --set resin.absorption_per_mm=0.05'
vam-slice --shape cone:bottom=3,height=3 --voxel 0.2 $edge -o cone.vdb
vam-optimize --angles 60 --method fbp $edge cone.vdb -o cone.exr
vam-dose cone.exr --like cone.vdb $edge -o cone-dose.vdb
ok "the dose of every voxel is accepted" vam-score cone-dose.vdb --target cone.vdb $edge
vam-slice --shape cone:bottom=8,height=6 --voxel 0.3 -o cone.vdb
vam-optimize --geometry parallel --angles 24 --method fbp cone.vdb -o cone.exr
vam-dose cone.exr --like cone.vdb -o cone-dose.vdb
ok "that of parallel light, too" vam-score cone-dose.vdb --target cone.vdb
done_testing
