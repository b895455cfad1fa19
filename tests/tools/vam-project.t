# SPDX-License-Identifier: GPL-3.0-or-later
# vam-project end to end: forms of output, time, place, grey, flatland, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

small_printer >printer.toml
$exr make part.exr space=projector width=64 height=36 count=3   # slices at z = 0, 0.26, 0.52 mm, brightest 1, 2, 3

# Forms
quiet "a folder of images" vam-project part.exr -o frames/
$exr make between.exr space=projector width=64 height=36 count=3 row=0.4
vam-project between.exr -o between/ 2>err
is "slices that are no whole rows are reported" "$(grep -c 'between.exr: its slices are 1.54 rows .*; vam-slice --voxel 0.52 makes' err)" 1
is "one frame per time step" "$(ls frames | grep -c png)" 36
is "the first names" "$(ls frames | head -n 2 | tr '\n' ' ')" "00000.png 00001.png "
is "size and depth" "$($png size frames/00000.png)" "64 8 8 1"
is "the index" "$(sed -n '1p;3p' frames/frames.csv | tr '\n' ' ')" "file,time_s,angle_deg 00001.png,1,10 "
is "its time and rate in the image" "$($png text frames/00001.png vam:time_s) $($png text frames/00001.png vam:fps)" "1 1"
is "history in the image" "$($png text frames/00000.png vam:history | tail -n 1 | cut -d' ' -f1,3-)" "vam-project part.exr -o frames/"
ok "an EXR stack" vam-project part.exr -o frames.exr --compression none
is "frames of the projector" "$($exr attr frames.exr vam:kind) $($exr attr frames.exr vam:space)" "frames projector"
is "row 0 is at the top: z = 5 rows of 0.26 mm" "$($exr attr frames.exr vam:z_mm) $($exr attr frames.exr vam:row_mm)" "1.3 -0.26"
vam-project <part.exr >pipe.exr
is "stdin and stdout give the same pixels" "$($exr sum pipe.exr)" "$($exr sum frames.exr)"
ok "a lossless video" vam-project part.exr -o print.mkv
ok "a video for viewing" vam-project part.exr -o look.mp4
is "FFV1 at the projector's rate" "$(ffprobe -v error -count_frames -show_entries stream=codec_name,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 print.mkv)" "ffv1,gray,1/1,36"
ffmpeg -v error -i print.mkv -f rawvideo -pix_fmt gray video.raw
for i in 00000 00001 00035; do $png sum frames/$i.png; done | tr '\n' ' ' >images.sums
python3 - >video.sums <<'PY'
data = open("video.raw", "rb").read()
print(*[sum(data[512 * n:512 * n + 512]) for n in (0, 1, 35)], end=" ")
PY
same "video and images have the same pixels" images.sums video.sums
packets() { ffmpeg -v error -i "$1" "$2" "$3" -level 3 -slices 4 -slicecrc 1 -g 1 -f framecrc - | grep -v '^#' | cut -d, -f5-; }
packets print.mkv -c:v copy >own.packets
packets print.mkv -c:v ffv1 >libav.packets
same "and the bytes of FFmpeg's encoder" own.packets libav.packets
if sanitized; then
  echo '# the memory of a sanitizer is not measured'
else
  large='--pattern ramp --steps 4 --set projector.columns=2560 --set projector.rows=1600 --set projector.telecentric=true'
  peak=$(python3 -c 'import os, sys
_, status, usage = os.wait4(os.spawnvp(os.P_NOWAIT, sys.argv[1], sys.argv[1:]), 0)
print(usage.ru_maxrss if status == 0 else 1 << 30)' vam-project $large -o large.mkv)
  [ "$peak" -le 204800 ]; report $? "frames of 4 million pixels become a video in 200 MiB: $peak KiB"
  packets large.mkv -c:v copy >own.packets
  packets large.mkv -c:v ffv1 >libav.packets
  same "with the bytes of FFmpeg's encoder, too" own.packets libav.packets
fi

# The printer that it was computed for.
fails 65 'part.exr: computed for another printer: projector.axis_column 31.5, now 32; vial.radius_mm 12.7, now 6; compute it for this printer, .* --accept-printer' \
  vam-project part.exr -o other.exr --set vial.radius_mm=6 --set projector.axis_column=32
ok "a difference can be accepted" vam-project part.exr -o other.exr --set vial.radius_mm=6 --accept-printer --report other.json
is "with a warning, and in the report" "$(grep -c 'warning.*vial.radius_mm 12.7, now 6; accepted' .log/err) $(json other.json printer_differences)" "1 ['vial.radius_mm 12.7, now 6']"
is "frames name the printer that shows them" "$($exr attr other.exr vam:printer | grep -c 'vial.radius_mm=6')" 1
quiet "a new calibration of the axis does not make another printer" vam-project part.exr -o near.exr --set projector.axis_column=31.6
fails 65 'projector.axis_column: 64 is not in the image of 64 columns' vam-project part.exr -o x/ --set projector.axis_column=64 --accept-printer
$exr make silent.exr space=projector width=64 height=36 count=3 printer=none
ok "a sinogram without vam:printer" vam-project silent.exr -o silent/
is "gives a warning" "$(grep -c 'silent.exr: the attribute vam:printer is missing' .log/err)" 1
$exr make garbled.exr space=projector width=64 height=36 count=3 'printer=vial.radius_mm=wide'
fails 65 'garbled.exr: vam:printer:1: not TOML' vam-project garbled.exr -o garbled/
ok "a sinogram of vam-optimize is accepted by its printer" sh -c "vam-slice --shape disc-grid:diameter=6,height=1 --voxel 0.26 | vam-optimize --iterations 1 -o own.exr && vam-project own.exr -o own/"
fails 65 'own.exr: computed for another printer: vial.radius_mm 12.7, now 6' vam-project own.exr -o others/ --set vial.radius_mm=6
ok "one of vam-resample, too" sh -c "vam-slice --shape disc-grid:diameter=6,height=1 --voxel 0.26 | vam-sinogram --angles 90 | vam-resample -o own2.exr"
fails 65 'own2.exr: computed for another printer: resin.index 1.53, now 1.5' vam-project own2.exr -o others/ --set resin.index=1.5

# Transposition: row 5 is slice 0, rows go up; the sinogram's row n is frame n.
brightest=$($exr get pipe.exr 0 44 3)
unit=$($exr get part.exr 2 44 0)
is "rows are slices, z up" \
  "$(for r in 2 3 4 5 6; do $exr get pipe.exr 0 44 $r; done | awk "{ printf \"%.5f \", \$1 / $brightest }")" \
  "$(for s in 2 1 0; do $exr get part.exr $s 44 0; done | awk "BEGIN { printf \"0.00000 \" } { printf \"%.5f \", \$1 / $unit } END { printf \"0.00000 \" }")"
holds "frame 9 is angle 9" "($($exr get pipe.exr 9 31 5) / $brightest - $($exr get part.exr 0 31 9) / $unit)^2 < 1e-12"

# Error diffusion: black and white frames, different in each of four turns, whose sum is the required intensity.
vam-project part.exr --turns 4 --multiplier 0.5 -o smooth.exr --compression none
quiet "frames that differ from turn to turn" vam-project part.exr --turns 4 --multiplier 0.5 --bits 1 --dither 4 -o dither.exr --compression none
light() { $exr sum "$1" | awk '{ print $4 }'; }
holds "their sum is that of grey frames" "($(light dither.exr) / $(light smooth.exr) - 1)^2 < 0.03^2"
vam-project part.exr --turns 8 --multiplier 0.5 --bits 1 --dither 4 -o dither/
is "the second turn differs, the fifth does not" \
  "$(cmp -s dither/00003.png dither/00039.png; echo $?) $(for i in 00003 00147; do $png sum dither/$i.png; done | uniq | wc -l)" "1 1"
fails 64 '--dither 2: a turn has 32.7273 frames, not a whole number' vam-project part.exr --turns 2 --speed 11 --dither 2 -o out/

# Time
vam-project part.exr --turns 2.5 --speed 20 --report time.json >/dev/null
is "two and a half turns at 20 deg/s" "$(json time.json frames) $(json time.json duration_s) $(json time.json step_deg)" "45 45.0 20.0"
vam-project part.exr --turns 2 >twice.exr
is "the second turn repeats the first" "$($exr get twice.exr 40 30 5)" "$($exr get twice.exr 4 30 5)"

# Place
$exr make middle.exr space=projector width=64 height=36 count=3 reach=0
vam-project middle.exr >middle-frames.exr
vam-project middle.exr --column-offset 3 --row-offset -1 >moved.exr
is "offsets to the right and up" "$($exr get moved.exr 0 39 4)" "$($exr get middle-frames.exr 0 36 5)"
vam-project part.exr --orientation rotate-180 >turned.exr
is "rotated by 180 degrees" "$($exr get turned.exr 0 19 2)" "$($exr get pipe.exr 0 44 5)"
vam-project part.exr --set projector.orientation=flip-rows >flipped.exr
is "flipped by the settings" "$($exr get flipped.exr 0 44 2)" "$($exr get pipe.exr 0 44 5)"

# Grey
for bits in 1 2 4 10 16; do
  vam-project part.exr --bits $bits -o bits-$bits/
  depth=$bits; [ $bits = 10 ] && depth=16
  is "$bits bits a pixel" "$($png size bits-$bits/00000.png)" "64 8 $depth 1"
done
is "full grey of 2 bits" "$($png get bits-2/00000.png 44 3)" 3
vam-project part.exr --bits 2 >quantised.exr
holds "an EXR with --bits is quantised" "($($exr get quantised.exr 0 44 4) - 2 / 3)^2 < 1e-9"
printf 'grey,intensity\n0,0\n128,1\n255,4\n' >curve.csv
vam-project part.exr --set projector.response=curve.csv -o curved/
# Slice 0 wants 1/3 of full, 4/3 in the units of the response table: above grey 128 on the curve, where the linear response has 85.
holds "the inverse response" "$($png get curved/00000.png 44 5) > 140 && $($png get curved/00000.png 44 5) < 160"
is "the straight line" "$($png get frames/00000.png 44 5)" 85
vam-project part.exr --full-scale 6 -o half/
is "twice --full-scale halves the intensity" "$($png get half/00000.png 44 3)" 127
ok "clipping succeeds" vam-project part.exr --multiplier 3 -o clipped/ --report clipped.json
is "and is reported in one line" "$(grep -c 'exceed full intensity' .log/err)" 1
holds "and in the report" "$(json clipped.json clipped_fraction) > 0.1"

# Flatland
$exr make virtual.exr width=64 height=36 count=3
quiet "flatland of the middle slice" vam-project virtual.exr --flatland 0.3 -o flat.exr --compression none
holds "at 0 degrees every row is the projection" "($($exr get flat.exr 0 44 0) - $($exr get flat.exr 0 44 7))^2 < 1e-12 && $($exr get flat.exr 0 44 0) > 0.99"
fails 65 'no slice at z = 3 mm; its slices lie from 0 to 0\.52 mm' vam-project virtual.exr --flatland 3 -o x.exr
fails 65 'projector' vam-project part.exr --flatland 0 -o x.exr

# The same bytes from one and two threads
vam-project --threads 1 part.exr -o one.mkv; vam-project --threads 2 part.exr -o two.mkv
ffmpeg -v error -i one.mkv -f rawvideo one.raw; ffmpeg -v error -i two.mkv -f rawvideo two.raw
same "1 and 2 threads give identical frames" one.raw two.raw

# Wrong inputs
fails 65 'light on rows' vam-project part.exr --row-offset -4 -o x/
fails 65 'light on columns .* projector has columns 0 to 63' vam-project part.exr --column-offset 30 -o x/
$exr make wide.exr space=projector width=64 height=36 count=3 'printer=projector.columns=32 projector.pixel_mm=0.26 projector.axis_column=31.5'
fails 65 '64 columns, but the projector has 32' vam-project wide.exr --set projector.columns=32 -o x.exr
$exr make dark.exr space=projector width=64 height=36 value=0
fails 65 'all dark' vam-project dark.exr -o x.mkv
$exr make negative.exr space=projector width=64 height=36 value=-1
fails 65 'negative' vam-project negative.exr -o x.mkv
printf 'grey,intensity\n0,0\n9,2\n10,1\n' >falls.csv
fails 65 'falls.csv:4: intensity 1 at grey 10 is below 2' vam-project part.exr --set projector.response=falls.csv -o x/
fails 64 "'null2' is no kind of display" vam-project part.exr -o null2:
fails 64 "'relay' is no kind of display" vam-project part.exr -o relay:/dev/ttyUSB0
quiet 'a file whose name has colons' vam-project part.exr -o 2026-11-25T15:00.mkv
quiet 'a folder whose name has a colon' vam-project part.exr -o ./print:2/
fails 64 'frames a turn' vam-project part.exr --speed 300 -o x/
mkdir other; echo hello >other/letter.txt
fails 73 'letter.txt, which is not a frame' vam-project part.exr -o other/
ok "an older folder of frames is replaced" vam-project part.exr --turns 0.5 -o frames/
is "whole" "$(ls frames | grep -c png)" 18
is 'nothing is made of them' "$(ls | grep -c steps)" 0
done_testing
