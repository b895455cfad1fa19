# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-convert: arrays, images and videos of other programs in, arrays out; anybody's projections judged.
. "$VAM_SOURCE/tests/tools/testlib.sh"

shown() { $npy show "$1" >shown; cat shown; }
back() { vam-convert --voxel 0.5 "$@" | vam-convert >b.npy; shown b.npy; }  # back ARGUMENT...: the voxels of an array
values() { seq 0 "$(($1 - 1))" | awk '{ printf " %d", $1 % 101 } END { print "" }'; }

# Every type and order: the same numbers in [z][y][x].
want="2 3 4 <f4$(values 24)"
for kind in '|u1' '|i1' '<u2' '>u2' '<i2' '<u4' '>i4' '<i8' '>u8' '<f2' '>f2' '<f4' '>f4' '<f8' '>f8'; do
  $npy make a.npy "$kind" 2,3,4
  is "$kind in C order" "$(back a.npy --grid weight)" "$want"
  $npy make f.npy "$kind" 2,3,4 F
  is "$kind in Fortran order" "$(back --grid weight <f.npy)" "$want"
done
$npy make p.npy '<f4' 3,4
$npy make a.npy '<f4' 2,3,4
is 'axes in another order' "$(back a.npy --axes xyz --grid weight | cut -d' ' -f1-8)" '4 3 2 <f4 0 12 4 16'
is 'an axis from its end' "$(back a.npy --axes z-yx --grid weight | cut -d' ' -f1-9)" '2 3 4 <f4 8 9 10 11 4'
is 'all three' "$(back a.npy --axes=-z-y-x --grid weight | cut -d' ' -f5-7,28)" '23 22 21 0'
is 'values divided' "$(back a.npy --full-scale 100 | cut -d' ' -f5,6,28)" '0 0.01 0.23'
python3 -c 'import zipfile
with zipfile.ZipFile("two.npz", "w") as z: z.write("a.npy", "dose.npy"); z.write("p.npy", "plan/e.npy"); z.write("p.npy", "text")'
is 'from a pipe' "$(back --array dose --grid weight <two.npz)" "$want"
fails 64 "'z--yx' is not an order of the letters zyx" vam-convert a.npy --voxel 0.5 --axes z--yx
misuse --array 'arrays alone in a file' vam-convert a.npy --array dose --voxel 0.5 -o x.vdb

# Where it lies.
vam-convert a.npy --voxel 0.5 --grid weight -o a.vdb
is 'the middle is on the axis' "$(vam-view a.vdb --export /dev/stdout | grep -a '^space origin')" 'space origin: (-0.75,-0.5,-0.25)'
vam-convert a.npy --voxel 0.5 --grid weight --origin 1,2,3 -o a.vdb
is 'or where it is put' "$(vam-view a.vdb --export /dev/stdout | grep -a '^space origin')" 'space origin: (1,2,3)'
ok 'whole' vam-check a.vdb

# As high as its print is to be.
$npy of ramp.npy 10,1,1 k
quiet 'stretched' vam-convert ramp.npy --voxel 0.5 --grid weight --stretch-z 1.5 -o tall.vdb
vam-convert tall.vdb >b.npy
is 'in more slices' "$(shown b.npy | cut -d' ' -f1-3)" '15 1 1'
holds 'that rise evenly' "$(shown b.npy | awk '{ for (i = 6; i < 18; ++i) { d = $(i + 1) - $i - 2 / 3; worst = d * d > worst ? d * d : worst }; print worst + ($12 - 4.5) ^ 2 }') < 1e-9"
is 'the factor is recorded' "$(vam-check --verbose tall.vdb 2>/dev/null | grep -c stretch; vam-view tall.vdb --export /dev/stdout | grep -a '^space origin')" "$(printf '1\nspace origin: (0,0,-3.5)')"
vam-convert ramp.npy --voxel 0.5 --full-scale 9 -o short.vdb 2>err
is 'a target that is not is told' "$(grep -c 'ramp.npy: the print will be 3.7 % too short.*--stretch-z 1.038[0-9]* corrects it' err)" 1
quiet 'as it is, if so meant' vam-convert ramp.npy --voxel 0.5 --full-scale 9 --stretch-z 1 -o short.vdb
$npy of low.npy 1,1,2 'i or -5e-5'
quiet 'a value that rounding left just below 0' vam-convert low.npy --voxel 0.5 --stretch-z 1 -o low.vdb
ok 'is taken by those that read targets' vam-sinogram low.vdb -o low.exr
$npy of low.npy 1,1,2 'i or -2e-4'
fails 65 "low.npy: grid 'target' has -0.0002 in voxel .0, 0, 0." vam-convert low.npy --voxel 0.5 --stretch-z 1 -o none.vdb
$npy make one.npy '<f4' 1,3,4
quiet 'a plane stays one, however low' vam-convert one.npy --voxel 0.5 --grid weight --stretch-z 0.1 -o low.vdb
vam-convert low.vdb >b.npy
is 'with its values' "$(shown b.npy)" "1 3 4 <f4$(values 12)"
fails 64 'vam-convert: low.nrrd: a volume or stack is written as .npy; vam-view --export writes a volume as NRRD' vam-convert low.vdb -o low.nrrd
$npy make grey.npy '<u1' 3,4,5
vam-convert grey.npy --voxel 0.5 --stretch-z 1 -o grey.vdb 2>err
is 'grey levels taken as coverage are told' "$(cat err)" 'vam-convert: warning: grey.npy: its values reach 59, where a full voxel is 1; if they are grey levels, give --full-scale 255'
$npy make zero.npy '|u1' 1,1,1
vam-convert zero.npy --voxel 0.5 --stretch-z 1 -o zero.vdb 2>err
is 'an empty target is told' "$(cat err)" 'vam-convert: warning: zero.npy: its values reach 0, where a full voxel is 1, and nothing of it is part; check the array'
vam-convert grey.npy --voxel 0.5 --stretch-z 1 --full-scale 65535 -o zero.vdb 2>err
is 'and one by a wrong scale' "$(grep -c 'reach 0.0009.*, and nothing of it is part; check the array and --full-scale$' err)" 1
quiet 'but not other empty volumes' vam-convert zero.npy --voxel 0.5 --grid weight -o zero.vdb

# What is refused.
: >empty.vdb
fails 65 'empty.vdb: is empty; the program that should have written it failed' vam-convert empty.vdb -o x.npy
fails 64 'stdin: the kind of data is not given; use --voxel MM' sh -c 'vam-convert <a.npy'
fails 64 'x.exr: a volume is written as .vdb' vam-convert a.npy --voxel 1 -o x.exr
fails 64 'x.vdb: a stack is written as .exr' vam-convert a.npy --geometry parallel -o x.vdb
fails 64 'x.tif: a volume or stack is written as .npy' vam-convert a.vdb -o x.tif

# Patterns of Dr.TVAM: an EXR file an angle, of intensities, the top row first.
mkdir patterns
for a in 0 1 2 3 4 5 6 7; do $exr image patterns/000$a.exr 4 3 "50.0 * $a + 10 * y + x"; done
$npy of patterns.npy 8,3,4 '50.0 * k + 10 * (2 - j) + i'
for how in 'parallel --pixel 0.1' 'parallel --pixel 0.1 --from drtvam' 'vial --axis-column 1.5 --set projector.response=[[0,0],[0.5,0.2],[1,1]]'; do
  vam-convert patterns --geometry $how -o exr.exr
  vam-convert patterns.npy --axes azx --geometry $how -o npy.exr 2>/dev/null
  for kind in exr npy; do vam-convert $kind.exr -o $kind.npy; done
  same "the same as their array: $how" exr.npy npy.npy
done

# A volume goes out as NRRD and comes back.
vam-slice --shape disc-grid --voxel 0.5 -o part.vdb
vam-view part.vdb --export part.nrrd
vam-convert part.vdb -o part.npy
vam-convert part.nrrd --voxel 0.5 | vam-convert >back.npy
same 'a volume by way of NRRD' part.npy back.npy
nrrd() {  # nrrd REGEX SPACINGS: says it of --voxel 0.5, or nothing where it is empty
  LC_ALL=C sed "s/^space directions.*/$2/" part.nrrd >stated.nrrd
  ok "stated voxels: $1" sh -c 'vam-convert stated.nrrd --voxel 0.5 --stretch-z 1 -o stated.vdb 2>said'
  if [ -z "$1" ]; then is 'in silence' "$(cat said)" ''; else ok 'and says so' grep -Eq "$1" said; fi
}
other() {  # other REGEX DIRECTIONS [OPTION...]: axes that are not x, y and z are refused
  LC_ALL=C sed "s/^space directions.*/$2/" part.nrrd >turned.nrrd; said=$1; shift 2
  fails 65 "turned.nrrd: has voxels $said, no cubes along x, y and z; .*: save other volumes as .npy" \
    vam-convert turned.nrrd --voxel 0.5 --stretch-z 1 "$@" -o x.vdb
}
other "'\(0.35,0.35,0\) .*'" 'space directions: (0.35,0.35,0) (-0.35,0.35,0) (0,0,0.5)'
other "'\(0.5,0,0\) .*'" 'space directions: (0.5,0,0) (0,0.5,0) (0,0,-0.5)'
other "'\(0,0.5,0\) .*'" 'space directions: (0,0.5,0) (0.5,0,0) (0,0,0.5)' --axes yxz
other "'-0.5 -0.5 -0.5'" 'spacings: -0.5 -0.5 -0.5'
other "'0.5 0.5 1'" 'spacings: 0.5 0.5 1'
nrrd '' 'space directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)'
nrrd '' 'spacings: 7 7 7\nunits: "s" "s" "s"'
nrrd 'stated.nrrd: states voxels of 0.25 mm, and is read with --voxel 0.5; give --voxel 0.25' \
  'space directions: (0.25,0,0) (0,0.25,0) (0,0,0.25)'
nrrd 'states voxels of 50 mm, ' 'spacings: 50 50 50'
{ printf 'RIFF\210\023\0\0AVI LIST'; head -c 5000 /dev/zero; } >film.avi
{ printf 'GIF89a'; head -c 500 /dev/zero; } >film.gif
{ printf '\0\0\001\272'; head -c 500 /dev/zero; } >film.mpg
{ printf '\060\046\262\165\216\146\317\021'; head -c 500 /dev/zero; } >film.wmv
for kind in 'avi an AVI video' 'gif a GIF image' 'mpg an MPEG video' 'wmv a WMV video'; do
  film=film.${kind%% *} kind=${kind#* }
  fails 65 "$film: is $kind, not an array .*; convert it without loss: ffmpeg -i" vam-convert $film --voxel 1 -o x.vdb
  fails 65 "$film: is $kind, not a mesh; .*ffmpeg" vam-slice $film -o x.vdb
  fails 65 "$film: is $kind; a volume .* is needed; .*ffmpeg" vam-view $film -o x.png
  fails 65 "$film: is $kind, not a volume, mesh" vam-report $film -o x.html
  is "$film by vam-check" "$(vam-check $film)" "$film: $kind, unsealed"
done

# No beginning of a file is taken for the file, and none crashes.
statuses() {  # statuses FILE: of every fifth of its beginnings; array_test.cpp has all
  $npy cuts "$1" 5
  for cut in "$1".*; do vam-convert "$cut" --voxel 1 -o x.vdb 2>>cut.err; echo $?; done | sort | uniq -c | tr -s ' '
  rm -f "$1".*
}
$npy make cut.npy '<f4' 2,2,2
fifths() { echo $((($(wc -c <"$1") + 4) / 5)); }
is 'every fifth cut of a .npy is status 65' "$(statuses cut.npy)" " $(fifths cut.npy) 65"
is 'in one line each' "$(wc -l <cut.err)" "$(fifths cut.npy)"
is 'and none is a crash' "$(grep -c 'ended by signal\|parser failed' cut.err)" 0
python3 -c 'import zipfile
with zipfile.ZipFile("cut.npz", "w", zipfile.ZIP_DEFLATED) as z: z.write("cut.npy", "a.npy")'
is 'every fifth cut of a .npz is status 65' "$(statuses cut.npz)" " $(fifths cut.npz) 65"
is 'nothing is left behind' "$(ls x.* 2>/dev/null)" ''
python3 -c 'import zipfile
with zipfile.ZipFile("bomb.npz", "w", zipfile.ZIP_DEFLATED) as z:
  z.writestr("a.npy", open("a.npy", "rb").read() + bytes(200000000))'
fails 65 'bomb.npz: has bytes behind its 24 values' vam-convert bomb.npz --voxel 1 -o x.vdb

# Projections: a stack goes out and comes back, and its dose is the same to the byte.
vam-sinogram part.vdb --filter ram-lak --negative clip -o sino.exr
vam-convert sino.exr -o sino.npy
vam-convert sino.npy --geometry parallel --pixel 0.5 -o back.exr
vam-dose sino.exr --like part.vdb | vam-convert >dose.npy
vam-convert sino.npy --geometry parallel --pixel 0.5 | vam-dose --like part.vdb | vam-convert >again.npy
same 'the dose of an array is that of the stack' dose.npy again.npy
vam-convert back.exr >again.npy
same 'and the values are' sino.npy again.npy

# frames.csv beside images is held to: a line each, with its name, a time and an angle.
mkdir even; printf 'file,time_s,angle_deg\n' >even/frames.csv
ffmpeg -v error -f lavfi -i color=gray:s=6x4:r=1:d=4 -pix_fmt gray -start_number 0 even/%05d.png
for n in 0 1 2 3; do echo "0000$n.png,$n,$((-90 * n))" >>even/frames.csv; done
index() { sed "$1" even/frames.csv >index.csv; mv index.csv odd/frames.csv; }
like_even='--geometry parallel --pixel 1 -o odd.exr'
quiet 'an index of frames' vam-convert even $like_even
cp -r even odd
index '3s/-90/nan/'; fails 65 'odd/frames.csv:3: not a file name, a time and an angle; restore it' vam-convert odd $like_even
index '3d'; fails 65 "odd/frames.csv:3: '00002.png' is not image 1 of the folder" vam-convert odd $like_even
index 's/-180/-60/'; fails 65 'odd: the stage turns back' vam-convert odd $like_even
: >odd/frames.csv; fails 65 'odd/frames.csv:1: does not begin with' vam-convert odd $like_even
rm odd/frames.csv; quiet 'without it they make a turn' vam-convert odd $like_even
vam-convert odd $like_even --verbose 2>err
is 'which is noted' "$(grep -c 'odd: 4 frames are taken as one turn, 90 degrees each; give --view-step otherwise' err)" 1
vam-convert even $like_even --verbose 2>err
is 'but not where it is stated' "$(grep -c 'one turn' err)" 0
is 'whose angles are reported' "$(grep -c 'even: 4 projections in 1 turn from 0 deg, 4 a turn; a speed that is off by [0-9.]* % moves the last one' err)" 1

# Stage angles of eight images.
place() { grep -a '^sizes\|^axis mins\|^spacings' | tr '\n' ' '; }
mkdir eight; for n in 0 1 2 3 4 5 6 7; do cp even/00000.png eight/0000$n.png; done
angles() {  # angles COUNT EXPRESSION OPTION...: where the eight lie with that many angles, an expression of n
  python3 -c "print('file,time_s,angle_deg'); [print('%05d.png,%d,%.9g' % (n, n, $2)) for n in range($1)]" >eight/frames.csv; shift 2
  vam-convert eight --geometry parallel --pixel 1 "$@" | vam-view --export /dev/stdout | place
}
is 'a turn and its start' "$(angles 8 '90 + 45 * n')" 'sizes: 6 8 4 spacings: 1 45 1 axis mins: -2.5 90 -1.5 '
is 'backwards, beyond a turn' "$(angles 8 '360 - 90 * n')" 'sizes: 6 4 4 spacings: 1 90 1 axis mins: -2.5 0 -1.5 '
is 'the option goes before' "$(angles 8 'n ** 2' --view-step 45)" 'sizes: 6 8 4 spacings: 1 45 1 axis mins: -2.5 0 -1.5 '
uneven() {  # uneven COUNT EXPRESSION REGEX
  angles "$1" "$2" >/dev/null 2>&1
  fails 65 "$3" vam-convert eight --geometry parallel --pixel 1 -o x.exr
}
is 'uneven ones have finer rows' "$(angles 8 '45 * (n + (n > 2))')" 'sizes: 6 720 4 spacings: 1 0.5 1 axis mins: -2.5 337.75 -1.5 '
is 'as what is no whole turn has' "$(angles 8 '41.6 * n' | cut -d' ' -f1-4)" 'sizes: 6 720 4'
uneven 8 '45 * n * (n != 5)' 'eight: the stage turns back, or stands: projection 4 is shown from 157.5 to 90 degrees, while the median step is 45; give --view-step'
uneven 8 5 'eight: the stage turns back, or stands: projection 0 is shown from 5 to 5 degrees'
uneven 7 '45 * n' 'eight/frames.csv:8: the last line, of 7 for 8 images; restore it'
uneven 0 n 'eight/frames.csv:1: the last line, of 0 for 8 images; restore it'
uneven 8 '45 * n + 3e9 * (n == 2)' 'angle 2 of frames.csv is no angle; give --view-step'
uneven 8 '22.5 * n' 'has 8 projections, 16 make a turn'

# Frames of the projector, to 8 bits: the dose within one level of 255.
set="--set projector.columns=64 --set projector.rows=48 --set projector.pixel_mm=0.5"
set="$set --set projector.axis_column=30.5 --set projector.axis_row=21.5"
vam-resample sino.exr $set -o projector.exr
vam-project projector.exr $set --turns 1 --fps 12 --speed 12 -o frames
vam-project projector.exr $set --turns 1 --fps 12 --speed 12 -o film.mkv
vam-project projector.exr $set --turns 2 --fps 12 --speed 12 --orientation rotate-180 -o turned
ok 'frames of the projector' vam-convert frames --geometry vial --like part.vdb $set -o back.exr
quiet 'a video is the same' vam-convert film.mkv --view-step 1 --geometry vial --like part.vdb $set -o film.exr
ffmpeg -v error -i film.mkv -map_metadata -1 -c copy bare.mkv
vam-convert bare.mkv --geometry vial --like part.vdb $set -o turn.exr 2>err
vam-dose film.exr --like part.vdb $set --report film.json -o film.vdb
is 'whose full grey is the full light' "$(json film.json full_scale)" 1.0
quiet 'and two turns of turned frames' vam-convert turned --geometry vial --orientation rotate-180 --like part.vdb $set -o turned.exr
for name in projector back film turned; do vam-dose $name.exr --like part.vdb $set | vam-convert >$name.npy; done
same 'video and folder' film.npy back.npy
is 'the step that is assumed of a video is told' "$(cat err)" \
  'vam-convert: warning: bare.mkv: 360 frames are taken as one turn, 1 degrees each; give --view-step or --speed otherwise'
ffmpeg -v error -i film.mkv -c:v ffv1 -vf transpose=clock side.mkv
ffmpeg -v error -i film.mkv -c:v ffv1 -vf transpose=cclock other.mkv
for side in 'side 90' 'other 270'; do
  quiet "a video for a projector on its side: $side" vam-convert ${side% *}.mkv --orientation rotate-${side#* } --view-step 1 \
    --geometry vial --like part.vdb $set -o side.exr
  vam-convert film.exr -o film-slices.npy; vam-convert side.exr -o side-slices.npy
  same 'is the same' film-slices.npy side-slices.npy
done
ffmpeg -v error -i film.mkv -c:v libx264 -qp 0 -pix_fmt yuv420p film.mp4
for angle in 90 180 270; do
  ffmpeg -v error -i film.mp4 -c copy -metadata:s:v:0 rotate=$angle -y to-turn.mp4
  ffmpeg -v error -i to-turn.mp4 -c:v ffv1 -pix_fmt yuv420p -y is-turned.mkv
  for name in to-turn.mp4 is-turned.mkv; do vam-convert $name --geometry parallel --pixel 0.5 2>/dev/null | vam-convert >$name.npy; done
  same "a video that is to be shown turned by $angle degrees" to-turn.mp4.npy is-turned.mkv.npy
done
vam-convert side.mkv --view-step 1 --geometry vial --like part.vdb $set -o side.exr 2>err
is 'which is told where it is not given' "$(sed 's/.*; //' err | sort -u)" "$(printf '%s\n' 'columns and rows look exchanged' \
  'columns and rows look exchanged: give --orientation rotate-90 or rotate-270')"
compare() {  # compare ONE OTHER: are they of one size, and how far is one from another beside a factor
  $npy eval '(len(v[0]) == len(v[1]), (scale := sum(x * y for x, y in zip(*v)) / sum(y * y for y in v[1])) and
    max(abs(x - scale * y) for x, y in zip(*v)) / max(v[0]))' "$1" "$2"
}
compare projector.npy back.npy >difference; read -r sizes worst <difference
is 'doses of one size' "$sizes" True
holds "within the 8 bits: $worst of the largest dose" "$worst < 0.004 && $worst > 0"
compare turned.npy back.npy >difference; read -r sizes worst <difference
holds "turns are averaged: $worst" "$worst < 1e-5"

# Slices as images: the top row at the largest y, as vam-slice has it.
mkdir seen
for k in 0 1; do
  $png make seen/$k.png 6 6 '255 * ((x, y) in ((1, 1), (3, 3), (4, 3)))'
done
vam-slice seen --voxel 0.5 --set projector.telecentric=true -o sliced.vdb
vam-convert seen --voxel 0.5 -o converted.vdb
seen() {  # seen VOLUME: where voxels of its first slice are full
  vam-convert "$1" -o seen.npy
  corner=$(vam-view "$1" --export /dev/stdout | grep -a '^space origin' | tr -dc '0-9.,-')
  $npy eval "(n := isqrt(len(v[0]) // 2)) and tuple(sorted(
    (($corner)[0] + i % n / 2, ($corner)[1] + i // n / 2) for i in range(n * n) if v[0][i] == 1))" seen.npy
}
is 'images are slices as one sees them' "$(seen converted.vdb)" '(-0.75, 0.75) (0.25, -0.25) (0.75, -0.25)'
is 'as vam-slice reads them' "$(seen sliced.vdb)" '(-0.75, 0.75) (0.25, -0.25) (0.75, -0.25)'
python3 -c 'import struct
data, pages = b"", 2
for page in range(pages):  # 36 levels, then 9 entries: tag, type, count, value
  at = 8 + len(data)
  data += bytes(255 * ((i % 6, i // 6) in ((1, 1), (3, 3), (4, 3))) for i in range(36))
  tags = {256: 6, 257: 6, 258: 8, 259: 1, 262: 1, 273: at, 277: 1, 278: 6, 279: 36}
  data += struct.pack("<H", 9) + b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags.items())
  data += struct.pack("<I", 0 if page == pages - 1 else 48 + len(data))
open("pages.tif", "wb").write(b"II*\0" + struct.pack("<I", 44) + data)'
vam-convert pages.tif --voxel 0.5 --full-scale 255 -o paged.vdb
is 'and as pages of TIFF' "$(seen paged.vdb)" '(-0.75, 0.75) (0.25, -0.25) (0.75, -0.25)'
vam-convert pages.tif --axes zyx --voxel 0.5 --full-scale 255 -o paged.vdb
is 'whose rows --axes takes as they come' "$(seen paged.vdb)" '(-0.75, -0.75) (0.25, 0.25) (0.75, 0.25)'

# H.264 has black at 16 and white at 235 of 255, unless it states a full range; of colours the luma counts.
python3 -c 'import sys; sys.stdout.buffer.write(bytes([0] * 256 + [85] * 256 + [170] * 256 + [255] * 256) * 4)' >levels
python3 -c 'import sys; sys.stdout.buffer.write((bytes([0, 0, 0] * 512) + bytes([0, 0, 255] * 512)) * 4)' >blue
film() { name=$1 from=$2 what=$3; shift 3; ffmpeg -v error -f rawvideo -pix_fmt "$from" -s 32x32 -r 4 -i "$what" "$@" -y "$name"; }
film tv.mp4 gray levels -c:v libx264 -qp 0 -pix_fmt yuv420p
film pc.mp4 gray levels -c:v libx264 -qp 0 -pix_fmt yuvj420p
film grey.mkv gray levels -c:v ffv1 -pix_fmt gray -color_range tv
film full.mkv gray levels -c:v ffv1 -pix_fmt yuv420p -color_range pc -vf scale=out_range=full
is 'the grey one states a limited range' "$(ffprobe -v error -show_entries stream=pix_fmt,color_range -of csv=p=0 grey.mkv)" gray,tv
film blue.mp4 rgb24 blue -c:v libx264 -qp 0 -pix_fmt yuv420p
film rgb.mp4 rgb24 blue -c:v libx264rgb -qp 0
film rgb.mkv rgb24 blue -c:v ffv1 -pix_fmt bgr0
quarters() {  # quarters FILE: the mean of each 8 rows of the first frame, in thousandths
  vam-convert "$1" --geometry parallel --pixel 0.5 --view-step 90 2>quarters.err | vam-convert >quarters.npy
  $npy eval 'tuple(round(125 * sum(sum(v[0][(31 - row) * 128:][:32]) / 32 for row in range(at, at + 8)))
    for at in (0, 8, 16, 24))' quarters.npy  # [slice][angle][column], slices upwards
}
# Grey pixels are of the full range whatever is stated, as ffmpeg takes them.
for name in tv.mp4 pc.mp4 grey.mkv full.mkv; do is "levels of $name" "$(quarters $name)" '0 333 667 1000'; done
told='its brightest pixel is 11.4 % of full scale, as of images in blue alone; if that is full intensity, give --full-scale 0.114'
for name in blue.mp4 rgb.mp4 rgb.mkv; do
  is "luma of $name" "$(quarters $name)" '0 0 114 114'
  is 'full blue that is taken for dim light is told' "$(cat quarters.err)" "vam-convert: warning: $name: $told"
done
quiet 'blue with its full scale' vam-convert blue.mp4 --full-scale 0.114 --geometry parallel --pixel 0.5 --view-step 90 -o blue.exr
colour() { python3 -c 'import sys; sys.stdout.buffer.write(bytes([int(c) for c in sys.argv[1:]] * 1024) * 4)' "$@" >colour; }
colour 255 0 0; film red.mkv rgb24 colour -c:v ffv1 -pix_fmt bgr0; quarters red.mkv >red
is 'red, too' "$(grep -c 'in red alone; .* --full-scale 0.299$' quarters.err)" 1
colour 0 255 0; film green.mkv rgb24 colour -c:v ffv1 -pix_fmt bgr0; quarters green.mkv >green
is 'and green' "$(grep -c 'in green alone; .* --full-scale 0.587$' quarters.err)" 1
colour 51 51 51; film dim.mkv rgb24 colour -c:v ffv1 -pix_fmt bgr0; quarters dim.mkv >dim
is 'but not dim grey' "$(cat quarters.err)" ''

# Rays climb: rows above and below the part light it, too.
sizes() { vam-view "$1" --export /dev/stdout | grep -a '^sizes\|^axis mins' | tr '\n' ' '; }
vam-optimize part.vdb --angles 60 --iterations 4 $set -o climb.exr 2>err
vam-project climb.exr $set --turns 1 --fps 12 --speed 72 -o climb
quiet 'frames whose light climbs' vam-convert climb --geometry vial --like part.vdb $set -o risen.exr
is 'have the slices of the stack' "$(sizes risen.exr)" "$(sizes climb.exr)"
vam-convert sino.npy --geometry parallel --pixel 0.2 --like part.vdb -o short.exr 2>err
is 'slices that end within the volume are reported' \
  "$(grep -c 'sino.npy: its slices are at z = .* mm, those of part.vdb at .*, and the rest is dark; check --slice-height' err)" 1
$npy make frames.npy '<f4' 72,48,64
$npy make dense.npy '<f4' 64,72,48
$npy make tall.npy '<f4' 96,72,64
remedy() {  # remedy FILE [OPTION...]: what is to be done about its light above and below the part
  vam-convert "$@" --geometry vial --like part.vdb $set -o x.exr 2>err; sed -n 's/.*is left out; //p' err
}
is 'an array in the order of frames' "$(remedy frames.npy)" 'check --axes, as its sizes fit the projector in the order azx, and --axis-row'
is 'and of VAMToolbox' "$(remedy dense.npy)" 'check --axes, as its sizes fit the projector in the order xaz, and --axis-row'
is 'not where no order fits' "$(remedy tall.npy)" 'check --axis-row'
is 'nor where it was given' "$(remedy frames.npy --axes azx)" 'check --axis-row'
rm -f x.exr

# What is said of foreign frames moves them.
middle() { vam-convert frames --geometry parallel --pixel 0.5 "$@" -o m.exr; vam-view m.exr --export /dev/stdout | place; }
is 'a parallel beam: the middle is the axis' "$(middle)" 'sizes: 64 360 48 spacings: 0.5 1 0.5 axis mins: -15.75 0 -11.75 '
is 'another axis: its middle' "$(middle --axis-column 30.5 --axis-row 21)" 'sizes: 66 360 48 spacings: 0.5 1 0.5 axis mins: -16.25 0 -13 '
fails 64 '--pixel: 0.1 mm, but projector.pixel_mm is' vam-convert frames --geometry vial --pixel 0.1 -o x.exr
$npy of minus.npy 1,2,3 'i - 0.5 - i * j'
vam-convert minus.npy --geometry parallel --pixel 1 -o minus.exr 2>err
is 'light that no projector shows is reported' "$(grep -c 'minus.npy: has values down to -0.5' err)" 1
$npy of five.npy 1,5,1 j
vam-convert five.npy --geometry parallel --view-step 90 -o five.exr 2>said; vam-convert five.exr -o b.npy
fails 65 'five.npy: --axis-column 2 is beside its 1 columns by more than half of them; give one of -1 to 1$' vam-convert five.npy --geometry parallel --axis-column 2 -o x.exr
is 'more than a turn of parallel light is said' "$(grep -c 'warning: five.npy: 5 projections make 1.25 turns, and a sinogram of parallel light is one' said)" 1
is 'what is shown twice is as bright as on average, and counted' "$(shown b.npy) $($exr attr five.exr vam:shown_turns | tr -d ' ')" '1 4 1 <f4 2 1 2 3 1.25'
fails 64 '--speed: frames is no video, and has no times; give --view-step' vam-convert frames --geometry parallel --speed 12 -o x.exr
misuse --speed --view-step vam-convert film.mkv --geometry parallel --speed 12 --view-step 1 -o x.exr
fails 65 'has 360 projections, 720 make a turn' vam-convert frames --geometry parallel --view-step 0.5 -o x.exr
fails 65 'has light on column .* check --axis-column' vam-convert frames --geometry vial --set projector.columns=60 --set projector.pixel_mm=0.5 --axis-column 50 -o x.exr

numpy=/usr/bin/python3
if "$numpy" -c 'import numpy' 2>/dev/null; then
  "$numpy" - <<'PY'
import numpy
a = numpy.arange(24).reshape(2, 3, 4) % 101
numpy.save("c.npy", a.astype(">i2"))
numpy.save("f.npy", numpy.asfortranarray(a.astype("f8")))
numpy.savez_compressed("z.npz", dose=a)
PY
  for file in c.npy f.npy z.npz; do
    vam-convert $file --voxel 0.5 --grid weight | vam-convert >b.npy
    is "NumPy's own $file" "$("$numpy" -c 'import numpy; a = numpy.load("b.npy"); print(a.dtype, a.shape, (a.ravel() == numpy.arange(24)).all())')" \
      'float32 (2, 3, 4) True'
  done
  # A video judged as it plays, by a sum over its frames: ten turns of a part, by a motor that is 0.5 % off, and some of
  # their frames, each held until the next one.
  vam-slice --shape half-cylinder:diameter=6,height=0.3 --voxel 0.15 -o half.vdb
  vam-sinogram half.vdb --angles 400 --filter ram-lak --negative clip | vam-convert >half.npy
  cat >play.py <<'PY'
import sys, numpy
rows = numpy.load("half.npy")[0]
rows = numpy.tile(numpy.round(255 * rows / rows.max()).astype("u1"), (10, 1))
numpy.repeat(rows[:, None], 4, 1).tofile("all.raw")
for name, kept in ("all", range(4000)), ("some", [n for n in range(800) if n * n % 7 < 3]):
    rows[kept].tofile(name + ".rows")
    numpy.savetxt(name + ".times", numpy.append(kept, kept[-1] + 1) / 60)
print(rows.shape[1])
PY
  ffmpeg -v error -f rawvideo -pix_fmt gray -s "$("$numpy" play.py)x4" -r 60 -i all.raw -c:v ffv1 all.mkv
  ffmpeg -v error -i all.mkv -vf "select='lt(n,800)*lt(mod(n*n,7),3)'" -vsync vfr -c:v libx264 -qp 0 -pix_fmt yuvj420p -video_track_timescale 60 some.mp4
  played() {  # played NAME SPEED MIDDLE TURNS: that many turns, and the dose within a thousandth of its largest value
    "$numpy" "$VAM_SOURCE/tests/oracle/video_dose.py" "${1%.*}.rows" "${1%.*}.times" "$2" "$3" 48 0.15 0.15 5 >want
    quiet "$1 at $2 deg/s" vam-convert "$1" --geometry parallel --pixel 0.15 --like half.vdb --speed "$2" -o played.exr
    vam-dose played.exr --like half.vdb | vam-convert >played.npy
    turns=$($exr attr played.exr vam:shown_turns)
    worst=$("$numpy" -c 'import numpy, sys
want = numpy.fromfile("want").reshape(48, 48)
print(abs(numpy.load("played.npy")[0] * float(sys.argv[1]) / (2 * numpy.pi) - want).max() / want.max())' "$turns")
    holds "is judged as it plays: $worst of the largest dose, $turns turns" "$worst < 0.001 && ($turns - $4) ^ 2 < 1e-8"
  }
  played all.mkv 54 0.00833333333 10
  played all.mkv 54.3 0.00833333333 10.0555556
  played some.mp4 -54 0.00833333333 2
fi
done_testing
