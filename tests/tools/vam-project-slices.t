# SPDX-License-Identifier: GPL-3.0-or-later
# vam-project with the slices of vam-curethrough: a timed sequence, to images, stack, video and screen.
. "$VAM_SOURCE/tests/tools/testlib.sh"

# 1000 mm/h and 50 um a slice are 50/9 slices per second.
light="--set projector.max_intensity_mw_cm2=110 --set projector.min_intensity_mw_cm2=0.2"
screen="--set projector.pixel_mm=0.05 --set projector.columns=240 --set projector.rows=200 --set projector.axis_column=119.5 --set projector.axis_row=99.5"
screen="$screen --set projector.max_intensity_mw_cm2=110 --set projector.min_intensity_mw_cm2=0.2"
vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 -o ladder.vdb
vam-curethrough correct ladder.vdb $light -o slices.exr --png levels
size=$($png size levels/00000.png | cut -d' ' -f1,2)
quiet "slices as images" vam-project slices.exr $screen -o shown/ --report shown.json
is "every slice once, the three extra ones at the end" "$(json shown.json frames)" 53
holds "rate = print speed / slice height" "($(json shown.json fps) - 50 / 9)^2 < 1e-12 && ($(json shown.json duration_s) - 9.54)^2 < 1e-9"
is "times in the index" "$(sed -n '1p;3p;54p' shown/frames.csv | tr '\n' ' ')" "file,time_s,angle_deg 00001.png,0.18,0 00052.png,9.36,0 "
is "the projector's size" "$($png size shown/00000.png)" "240 200 8 1"
quiet "a folder of slices" vam-project levels $screen -o again/ --report again.json
holds "its times are its rate" "($(json again.json fps) - 50 / 9)^2 < 1e-9"
for n in 00000 00020 00052; do $png sum levels/$n.png; done | tr '\n' ' ' >levels.sums
for n in 00000 00020 00052; do $png sum again/$n.png; done | tr '\n' ' ' >again.sums
same "levels stay as they are" levels.sums again.sums
quiet "full-size images" vam-project again/ $screen -o third/
is "stay where they are" "$($png get third/00020.png 119 99)" "$($png get again/00020.png 119 99)"
is "the middle of the slices is the axis" "$($png get again/00020.png 119 99)" \
  "$($png get levels/00020.png $(echo $size | awk '{ print int(($1 - 1) / 2), int(($2 - 1) / 2) }'))"
vam-project slices.exr $screen --column-offset 5 --row-offset -3 -o moved/
is "offsets move slices" "$($png get moved/00020.png 124 96)" "$($png get shown/00020.png 119 99)"
ok "a lossless video of slices" vam-project slices.exr $screen -o slices.mkv
is "50/9 frames per second" "$(ffprobe -v error -count_frames -show_entries stream=r_frame_rate,nb_read_frames -of csv=p=0 slices.mkv)" "50/9,53"
ok "an EXR stack of slices" vam-project slices.exr $screen -o sequence.exr --compression none
is "carries its rate" "$($exr attr sequence.exr vam:fps) $($exr attr sequence.exr vam:speed_mm_h)" "5.55555556 1000"
quiet "slices through a pipe" sh -c "vam-curethrough correct ladder.vdb $light | vam-project $screen -o piped.exr --compression none"
is "the same light" "$($exr get piped.exr 20 119 99)" "$($exr get sequence.exr 20 119 99)"
vam-project slices.exr $screen --print-speed 2000 -o fast.exr --compression none
is "another print speed" "$($exr attr fast.exr vam:fps) $($exr attr fast.exr vam:speed_mm_h)" "11.1111111 2000"
quiet "live, by elapsed time" vam-project levels $screen --fps 200 -o null: --report live.json
holds "shown for 53 / 200 s, about 16 blanks" "$(json live.json lit_flips) >= 10 && $(json live.json lit_flips) <= 24"
fails 64 'levels does not state its slice height; give --fps' vam-project levels $screen --print-speed 1000 -o x/
misuse --turns slices vam-project slices.exr $screen --turns 2 -o x/
misuse --from slices vam-project slices.exr $screen --from 90 -o null: --log why
vam-slice --shape disc-grid --voxel 0.4 | vam-sinogram --filter ram-lak --negative clip | vam-resample | vam-project --bits 8 --speed 120 --fps 2 -o turn.exr
fails 65 'contains frames at stage angles' vam-project turn.exr -o x/
fails 65 'voxels of 0.05 mm are not the projector.s pixels of 0.065 mm' vam-project slices.exr -o x/
fails 65 'row -[0-9]+ do not fit in 240 x 200' vam-project levels $screen --set projector.axis_row=3 -o x/
rm levels/frames.csv
fails 65 'neither print speed and slice height nor times; give --fps' vam-project levels $screen -o x/
done_testing
