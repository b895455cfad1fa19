# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-view end to end: every kind of file, sections, sheets, histogram, export, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape gyroid --voxel 0.4 -o part.vdb
quiet "a volume" vam-view part.vdb -o axial.png
holds "an image of useful size" "$($png size axial.png | cut -d' ' -f1) > 600 && $($png size axial.png | cut -d' ' -f2) > 500"
holds "anti-aliased, in greys" "$($png colours axial.png) > 50"
is "history in the image" "$($png text axial.png Comment | cut -d' ' -f1,3-)" "vam-view part.vdb -o axial.png"
quiet "the same from a pipe" sh -c 'cat part.vdb | vam-view --at 1 --plane coronal >pipe.png'
vam-view part.vdb --at 1 --plane coronal --plain -o plain.png
vam-view --at 1 --plane coronal --plain -o redirected.png <part.vdb
is "plain pixels, one a voxel" "$($png size plain.png | cut -d' ' -f3-)" "8 3"
is "a redirected file is the same" "$($png sum redirected.png)" "$($png sum plain.png)"

script -qec 'vam-view part.vdb 2>.log/terminal' /dev/null </dev/null >.log/seen
is "no image to a terminal" "$? $(cat .log/terminal)" \
  "64 vam-view: stdout: is a terminal and the output is binary; use -o FILE or a pipe"

# Sinogram: the brightest pixel of slice 2 at angle 0 is at column 44 of 64.
$exr make sino.exr width=64 height=60 count=3
ok "its slice at 0.52 mm" vam-view sino.exr --at 0.52 --plain --colours grey -o slice.png
is "one pixel a value" "$($png size slice.png)" "64 60 8 3"
is "columns to the right, angles down" "$($png get slice.png 44 0) $($png get slice.png 19 30)" "255 255 255 255 255 255"
is "from a pipe" "$(vam-view --at 0.52 --plain --colours grey <sino.exr >piped.png; $png sum piped.png)" "$($png sum slice.png)"

# The dose of a small part, with a margin around it
vam-slice --shape cylinder --voxel 0.4 -o small.vdb
vam-sinogram small.vdb --angles 24 --filter ram-lak -o small.exr; vam-dose small.exr --like small.vdb -o wider.vdb
ok "the histogram of a dose with a margin" vam-view wider.vdb --target small.vdb --dose-histogram -o wider.png

ok "what it cures" vam-view wider.vdb --target small.vdb --cure-map --sheet 4 -o cure.png
ok "at another threshold" vam-view wider.vdb --target small.vdb --cure-map --isovalue 0.2 -o cure2.png
holds "another map" "$($png sum cure.png) != $($png sum cure2.png)"
ok "the print beside the target" vam-view wider.vdb --target small.vdb --render -o print.png
ok "a movie of the print as it grows" vam-view wider.vdb --target small.vdb --render --image-size 200 -o growth.mp4
ffmpeg -v error -i growth.mp4 -vf "select='eq(n,0)+eq(n,60)+eq(n,119)+eq(n,139)'" -vsync 0 growth%d.png
shape=$(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames,color_space -of csv=p=0 growth.mp4)
is "seven seconds of it" "$shape" 'bt709,140'
# Pixels of the right half that the grey body covers: more and more, and then no more.
python3 - <<'PY' >grown
import subprocess
for n in 1, 2, 3, 4:
    raw = subprocess.run(['ffmpeg', '-v', 'error', '-i', 'growth%d.png' % n, '-vf', 'crop=iw/2-40:ih-180:iw/2+20:90',
                          '-f', 'rawvideo', '-pix_fmt', 'gray', '-'], stdout=subprocess.PIPE, check=True).stdout
    print(sum(value < 240 for value in raw))
PY
holds "the print grows, then stands" "$(tr '\n' ' ' <grown | awk '{ print ($1 * 4 < $2 && $2 < $3 && $4 > 0.98 * $3 && $4 < 1.02 * $3) }') == 1"
# Its label: turns and seconds that the dose states, those that are planned for the dose of a turn, or a percentage.
cure='--set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.02'
vam-dose small.exr --like small.vdb $cure -o turn.vdb
vam-dose small.exr --like small.vdb $cure --exposure-plan -o planned.vdb
movie_label() {
  vam-view "$@" --target small.vdb $cure --render --title '' --image-size 200 -o label.mp4
  ffmpeg -v error -i label.mp4 -vf "select='eq(n,60)',crop=iw/2:24:iw/2:8" -vsync 0 -f md5 -
}
stated=$(movie_label planned.vdb)
is "turns that are stated, and that are planned" "$(movie_label turn.vdb)" "$stated"
is "also at another threshold" "$(movie_label planned.vdb --isovalue 50)" "$stated"
ok "of a dose without them a percentage" test "$(movie_label turn.vdb --isovalue 15)" != "$stated"
fails 64 '--output .mp4: requires --render' vam-view small.vdb -o x.mp4
fails 64 '--output .mp4: requires --target' vam-view small.vdb --render -o x.mp4
fails 65 'nothing prints at a threshold of 99' vam-view wider.vdb --target small.vdb --render --isovalue 99 -o x.mp4
box 2 3 1 >box.off
ok "a mesh" vam-view box.off -o box.png
printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' 'property float z' \
  'property uchar red' 'property uchar green' 'property uchar blue' 'element face 1' 'property list uchar int vertex_indices' \
  end_header '0 0 0 0 0 255' '4 0 0 0 0 255' '2 0 2 0 0 255' '3 0 1 2' >blue.ply
ok "a coloured mesh" vam-view blue.ply -o blue.png
holds "in blue" "$($png get blue.png 420 420 | awk '{ print ($1 < 5 && $2 < 5 && $3 > 80) }')"
printf '%s\n' iteration,ver,pw 1,0.1,-0.2 2,0.05,-0.1 3,0,0.02 >trace.csv
ok "a trace" vam-view trace.csv -o trace.svg
printf '%s\n' turn,open_loop_mm,closed_loop_mm 10,0.4,0.4 11,0.2,0.1 12,0.1,0.03 >table.csv
ok "any table" vam-view table.csv -o table.svg
printf '%s\n' 1,2 2,3 >bare.csv
fails 65 'bare.csv:1: no header' vam-view bare.csv -o x.png
fails 65 'no trace' vam-view table.csv --compare table.csv -o x.png
printf '%s\n' a,b,c,d,e,f 1,2,3,4,5,6 >wide.csv
fails 65 'has 6 columns' vam-view wide.csv -o x.png
mkdir -p run1 run2; cp trace.csv run1/; cp trace.csv run2/
vam-view run1/trace.csv --compare run2/trace.csv --title t -o apart.png
vam-view trace.csv --compare trace.csv --title t -o alike.png
ok 'two of one name are told apart by their folders' test "$($png sum apart.png)" != "$($png sum alike.png)"
vam-view run1/trace.csv --compare run2/trace.csv --compare trace.csv --title t -o three.png
ok 'a third one is drawn, too' test "$($png sum three.png)" != "$($png sum apart.png)"
fails 65 'compare volumes of one grid' vam-view small.vdb --compare part.vdb -o x.png
ok "a mesh without axes" vam-view blue.ply --plain --image-size 100 -o plain-blue.png
is "as many pixels, in its colours" \
  "$($png size plain-blue.png) $($png get plain-blue.png 50 50 | awk '{ print ($1 < 5 && $2 < 5 && $3 > 80) }')" "100 100 8 3 1"

# Frames of a projector, as EXR, images and video: the same pixels
small_printer >printer.toml
$exr make projector.exr space=projector width=64 height=36 count=3
vam-project projector.exr --bits 8 -o frames.exr; vam-project projector.exr -o frames/; vam-project projector.exr -o frames.mkv
for file in frames.exr frames frames.mkv; do
  ok "a sheet of $file" vam-view $file --sheet 6 -o sheet-$file.png
  vam-view $file --plain --high 1 -o plain-$file.png
done
is "images as the EXR" "$($png sum plain-frames.png)" "$($png sum plain-frames.exr.png)"
is "the video as the EXR" "$($png sum plain-frames.mkv.png)" "$($png sum plain-frames.exr.png)"
vam-view frames.exr --at 90 --plain -o at90.png; vam-view frames --at 90 --plain -o folder90.png
is "a frame by its angle, also of a folder with an index" "$($png sum folder90.png)" "$($png sum at90.png)"

# Dose with outline and histogram; here the part's own coverage stands for a dose
ok "the outline of the part" vam-view part.vdb --target part.vdb -o outlined.png
holds "the outline is drawn" "$($png sum outlined.png) != $($png sum axial.png)"
ok "the histogram" vam-view part.vdb --grid target --target part.vdb --dose-histogram -o histogram.png
is "the histogram is a figure" "$($png size histogram.png)" "900 600 8 3"

# Files for papers
ok "twice the density" vam-view part.vdb --dpi 192 -o fine.png
is "twice the pixels" "$($png size fine.png | cut -d' ' -f1)" "$((2 * $($png size axial.png | cut -d' ' -f1)))"
density() { python3 -c 'import struct,sys; b=open(sys.argv[1],"rb").read(); i=b.index(b"pHYs"); print(*struct.unpack(">IIB",b[i+4:i+13]))' "$1"; }
is "pixels per metre: 192 and 96 per inch" "$(density fine.png); $(density axial.png)" "7559 7559 1; 3780 3780 1"
ok "PDF" vam-view part.vdb --target part.vdb -o axial.pdf
is "a page of vectors and text, with its command" "$(head -c 5 axial.pdf) $(grep -a -c '/Subject (vam-view .* -o axial.pdf)' axial.pdf) $(grep -a -E -q '/Subtype */(TrueType|Type1)' axial.pdf && echo fonts)" "%PDF- 1 fonts"
vam-view part.vdb --target part.vdb -o again.pdf; sed s/again.pdf/axial.pdf/ again.pdf >renamed.pdf
same "the same bytes again" renamed.pdf axial.pdf
ok "SVG" vam-view part.vdb --title 'a < b' -o axial.svg
is "well-formed, with its command" "$(python3 -c 'import xml.etree.ElementTree as e; r=e.parse("axial.svg").getroot(); print(r.tag[-3:], r[0].text[:8])')" "svg vam-view"
vam-view part.vdb --title '' -o untitled.png
holds "no title takes no room" "$($png size untitled.png | cut -d' ' -f2) < $($png size axial.png | cut -d' ' -f2)"

# NRRD
ok "export of a volume" vam-view part.vdb --export part.nrrd
python3 - >check <<'PY'
import struct
data = open("part.nrrd", "rb").read()
head, body = data.split(b"\n\n", 1)
fields = dict(line.split(": ", 1) for line in head.decode().split("\n") if ": " in line and line[0] != "#")
sizes = list(map(int, fields["sizes"].split()))
values = struct.unpack("<%df" % (len(body) // 4), body)
print(sizes[0] * sizes[1] * sizes[2] == len(values), fields["space units"], min(values), max(values))
PY
is "all voxels behind a header" "$(cat check)" 'True "mm" "mm" "mm" 0.0 1.0'
ok "export of a stack" vam-view sino.exr --export sino.nrrd
is "with its axes" "$(strings -n 6 sino.nrrd | grep -E '^(sizes|spacings|units)' | tr '\n' ';')" 'sizes: 64 60 3;spacings: 0.26 6 0.26;units: "mm" "deg" "mm";'

# Wrong inputs
printf '<!DOCTYPE html><p>hello' >page.html
fails 65 'page.html: is a web page; a volume \(VDB\), .* is needed$' vam-view page.html -o x.png
printf '\211PNG\r\n\032\n' >one.png
fails 65 'one.png: is a PNG image; .* put the images into a folder' vam-view one.png -o x.png
echo '{"schema": "vam-score/1"}' >score.json
fails 65 'score.json: is JSON \(vam-report shows reports\); a volume' vam-view score.json -o x.png
fails 65 'stdin: is empty' sh -c ': | vam-view -o x.png'
fails 65 'has no image at 9; the nearest is z = 0.52 mm' vam-view sino.exr --at 9 -o x.png
fails 64 '--output .svg: conflicts with --plain' vam-view part.vdb --plain -o x.svg
fails 64 'pixels are more than 32767 a side; reduce --image-size or --dpi' \
  vam-view part.vdb --image-size 4000 --dpi 1200 -o x.png
vam-convert part.vdb -o part.npy
$npy of dark.npy "$($npy show part.npy | cut -d' ' -f1-3 | tr ' ' ,)" 0
vam-convert dark.npy --voxel 0.4 --stretch-z 1 --grid dose -o dark.vdb 2>.log/dark
vam-convert part.npy --voxel 0.4 --stretch-z 1 -o lit.vdb 2>.log/lit
fails 65 'the dose is 0 everywhere' vam-view dark.vdb --target lit.vdb --cure-map -o x.png

# With the default printer: places in the print, and an insert
unset VAM_PRINTER; rm -f printer.toml
vam-slice --shape box:x=4,y=4,z=10 --voxel 0.5 -o box.vdb
fails 65 'it reaches from -5.057 mm to 5.057 mm' vam-view box.vdb --at 90 -o x.png
quiet "which --at takes, too" vam-view box.vdb --at 5.05 -o box.png
vam-sinogram box.vdb --angles 8 -o box.exr
fails 65 'has no image at 90; the nearest is z = 5.057 mm' vam-view box.exr --at 90 -o x.png  # as the volume's
fails 65 'has no image at 5.31; the nearest is z = 5.057 mm' vam-view box.exr --at 5.31 -o x.png
quiet "and of its sinograms" vam-view box.exr --at 5.05 -o box.png
vam-slice --shape box:x=6,y=6,z=4 --insert-shape box:x=2,y=2,z=8 --voxel 0.25 --cut-insert -o held.vdb
vam-sinogram held.vdb --filter ram-lak --negative clip -o held.exr
vam-dose held.exr --like held.vdb -o held-dose.vdb
vam-view held-dose.vdb --target held.vdb --cure-map -o held.png
row() { for x in 420 422 424 426 428 430 432 434 436 438 440; do $png get held.png $x 400; done; }
vam-view held-dose.vdb --target held.vdb --render --image-size 200 -o held.mp4
ffmpeg -v error -y -i held.mp4 -vf "select='eq(n,0)'" -vsync 0 held-first.png
for body in "held-dose.vdb --target held.vdb" held.vdb; do vam-view $body --render --title '' --image-size 200 -o body.png && cp body.png "held-${body%%.*}.png"; done
greens() {
  ffmpeg -v error -i "$1" -f rawvideo -pix_fmt rgb24 - | python3 -c '
import sys
raw = sys.stdin.buffer.read()
print(sum(g > 1.5 * r + 20 and g > b for r, g, b in zip(raw[0::3], raw[1::3], raw[2::3])))'
}
for picture in held-first held-held-dose held-held; do holds "the insert in three dimensions is green: $picture" "$(greens $picture.png) > 200"; done
is "where there is none, nothing is green" "$(greens print.png)" 0
holds "the insert of a cure map is hatched" "$(row | sort -u | grep -Ec '^[0-9]{1,2} ') > 0"
done_testing
