# SPDX-License-Identifier: GPL-3.0-or-later
# vam-sinogram end to end: values with their units, filters, absorption, streams, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape cylinder:diameter=8,height=2 --voxel 0.1 --stretch-z 1 -o part.vdb
ok "a sinogram of a cylinder" vam-sinogram part.vdb -o radon.exr
vam-sinogram part.vdb >pipe.exr
set -- $($exr sum pipe.exr)
slices=$1; columns=$2
is "360 angles" "$3" 360
is "kind" "$($exr attr pipe.exr vam:kind)" sinogram
is "space" "$($exr attr pipe.exr vam:space)" virtual
is "units" "$($exr attr pipe.exr vam:units)" mm
is "pitch" "$($exr attr pipe.exr vam:pixel_mm)" 0.1
is "angle step" "$($exr attr pipe.exr vam:angle_step_deg)" 1
is "history grows" "$($exr attr pipe.exr vam:history | tail -n 1 | cut -d' ' -f1,3-)" "vam-sinogram part.vdb"
is "history keeps earlier lines" "$($exr attr pipe.exr vam:history | sed -n 1p | cut -d' ' -f1)" vam-slice
middle=$((slices / 2)); centre=$((columns / 2))
# The middle column lies within half a voxel of the axis, where the chord is the diameter to 1e-3.
holds "the chord through the axis is the diameter, in mm" "($($exr get pipe.exr $middle $centre 33) - 8)^2 < 0.02^2"
# Every row holds the mass of its slice: sum over all = volume / (voxel * voxel), 360 times.
holds "the sum is the volume of the part" "($4 * 0.1 * 0.1 / 360 / (3.14159265 * 16 * 2) - 1)^2 < 1e-3^2"

# --- filters: intensity * angle step, summed over the turn, is the part ---
vam-sinogram --filter ram-lak part.vdb >light.exr
is "units of intensity" "$($exr attr light.exr vam:units)" 1/rad
holds "intensity is negative beside the part" "$($exr get light.exr $middle $((centre + 43)) 7) < 0"
holds "intensity through the axis sums to 1" "($($exr get light.exr $middle $centre 0) * 6.2831853 - 1)^2 < 0.05^2"
vam-sinogram --filter ram-lak --negative clip part.vdb >clip.exr
is "clip leaves 0" "$($exr get clip.exr $middle $((centre + 43)) 7)" 0
is "clip keeps positive values" "$($exr get clip.exr $middle $centre 7)" "$($exr get light.exr $middle $centre 7)"
vam-sinogram --filter ram-lak --negative offset part.vdb >offset.exr
holds "offset keeps differences" "(($($exr get offset.exr $middle $centre 7) - $($exr get offset.exr $middle 2 7)) - ($($exr get light.exr $middle $centre 7) - $($exr get light.exr $middle 2 7)))^2 < 1e-12"
holds "offset leaves no negative value" "$($exr get offset.exr $middle $((centre + 43)) 7) >= 0"

# --- absorption ---
vam-sinogram --absorption 0.2 part.vdb >exponential.exr
# Through the axis: int_{-4}^{4} e^{0.2 u} du = 2 sinh(0.8) / 0.2 = 8.8811
holds "the exponential transform of the diameter" "($($exr get exponential.exr $middle $centre 0) - 8.8811)^2 < 0.02^2"
vam-sinogram --printer-absorption --set resin.absorption_per_mm=0.2 part.vdb | $exr sum - >resin
is "--printer-absorption is that of the printer file" "$(cat resin)" "$($exr sum exponential.exr)"
vam-sinogram --filter ram-lak --absorption 0.2 part.vdb >axis.exr
vam-sinogram --filter ram-lak --absorption 0.2 --at-wall --set vial.radius_mm=10 part.vdb >wall.exr
# e^{0.2 * 10} at the axis
holds "intensity at the wall" "($($exr get wall.exr $middle $centre 0) / $($exr get axis.exr $middle $centre 0) - 7.389)^2 < 0.01^2"

# --- sizes and streams ---
vam-sinogram --detector-bins 31 --angles 7 part.vdb | $exr sum - | cut -d' ' -f2,3 >size
is "number of detector bins and angles" "$(cat size)" "31 7"
vam-sinogram <part.vdb >stdin.exr
is "stdin and file give the same pixels" "$($exr sum stdin.exr)" "$($exr sum pipe.exr)"
taskset -c 0 vam-sinogram --filter hann part.vdb >one.exr  # the history, and so the seal, has the options
vam-sinogram --filter hann part.vdb >two.exr
same "1 and 2 threads give identical bytes" one.exr two.exr
quiet "success is silent" vam-sinogram part.vdb -o silent.exr

# --- wrong inputs ---
$npy of zero.npy 4,8,8 0
vam-convert zero.npy --voxel 0.5 --stretch-z 1 -o zero.vdb
fails 65 'zero.vdb: the target is empty \(no coverage anywhere\); there is nothing to project' vam-sinogram zero.vdb -o x.exr
vam-convert zero.npy --voxel 0.5 --grid dose --value-unit relative -o dark.vdb
ok 'which holds for targets' vam-sinogram --grid dose dark.vdb -o dark.exr
fails 65 'overflows' vam-sinogram --absorption 100 part.vdb -o x.exr
done_testing
