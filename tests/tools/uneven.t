# SPDX-License-Identifier: GPL-3.0-or-later
# A projector whose image is darker at its rim: its flat field from readings, frames that even it, and their dose.
. "$VAM_SOURCE/tests/tools/testlib.sh"

printf '%s\n' '[projector]' 'columns = 96' 'rows = 64' 'pixel_mm = 0.125' 'fps = 10' '[vial]' 'radius_mm = 7.0' '[stage]' \
  'speed_deg_s = 60' >printer.toml
# The light of a pixel, its corners 20 % and more darker than its middle, which is off that of the image.
light='(1 - 0.2 * ((column - 50) ** 2 + (row - 30) ** 2) / 52.0 ** 2)'
readings() {  # readings COLUMNS ROWS: with 0.5 in the dark
  python3 -S -c "
print('column,row,reading')
for column in ($1):
    for row in ($2): print('%d,%d,%.9g' % (column, row, 0.5 + 7 * $light))"
}
readings 0,24,48,72,95 0,16,32,48,63 >even.csv
ok 'a flat field' vam-calibrate uniformity even.csv --dark-reading 0.5 -v -o flat.exr
holds 'which says how dark it is' "$(grep -c 'darkest pixel has 0.73' .log/err) == 1"
readings 2,48,93 2,32,61 | vam-calibrate uniformity --dark-reading 0.5 -o nine.exr && vam-convert nine.exr -o nine.npy
vam-convert flat.exr -o flat.npy
light="$(echo "$light" | sed 's/column/(n % 96)/; s/row/(n \/\/ 96)/')"
for name in flat nine; do
  holds "$name: every pixel" "$($npy eval "max(abs(g - $light) for n, g in enumerate(v[0]))" $name.npy) < 1e-3"
done
fails 65 'stdin: 6 readings; at least 9 are needed, over 0.7' sh -c 'head -n 7 even.csv | vam-calibrate uniformity -o no.exr'
fails 65 'off a smooth field, more than 2 %; measure again' sh -c 'sed "s/^48,32,.*/48,32,3/" even.csv | vam-calibrate uniformity -o no.exr'
fails 65 'places of the readings: the readings do not determine' sh -c '{ echo column,row,reading; for n in 0 1 2 3 4 5 6 7 8; do echo $((n * 11)),$((n * 7)),7; done; } | vam-calibrate uniformity -o no.exr'
fails 64 "'no.png' must end in .exr" vam-calibrate uniformity even.csv -o no.png
fails 65 'even.csv: reading 1, of column 0 and row 0, is .* above the dark' vam-calibrate uniformity even.csv --dark-reading 9 -o no.exr

vam-slice --shape gyroid:diameter=7,height=3,cell=5 --voxel 0.125 -o part.vdb
vam-optimize part.vdb --angles 60 --iterations 3 -o light.exr && vam-dose light.exr --like part.vdb -o want.vdb
sed '/^fps/a flat = "flat.exr"' printer.toml >uneven.toml
vam-project light.exr --turns 1 -o plain/
ok 'frames for it' vam-project light.exr --printer uneven.toml --turns 1 -o evened/
ok 'a video for it' vam-project light.exr --printer uneven.toml --turns 1 -o evened.mkv
shown() { vam-convert $1 --geometry vial --set projector.flat= -o shown.exr && vam-convert shown.exr -o $1.npy; }; shown plain; shown evened
# Slices from below by 60 angles by columns: what pixels show, times their light, is what was to be shown.
row=$(echo "$light" | sed 's/(n \/\/ 96)/(63 - n \/\/ 5760)/')
holds 'pixels show less where they are brighter' "$($npy eval "max(abs(a * $row / 0.73454 - b) for n, (a, b) in enumerate(zip(*v)))" \
  evened.npy plain.npy) < 1.5 / 255"
judged() { vam-convert "$1" --geometry vial --set projector.flat="$2" -o shown.exr && vam-dose shown.exr --quiet --like part.vdb -o dose.vdb; }
latitude() { vam-score "$1" --target part.vdb --quiet --report r.json >/dev/null; json r.json latitude; }
vam-convert want.vdb -o want.npy && want=$(latitude want.vdb)
for frames in evened evened.mkv; do
  judged $frames flat.exr && vam-convert dose.vdb -o dose.npy
  holds "the dose of $frames" "$($npy eval "max(abs(a / p - b / q) for p in [max(v[0])] for q in [max(v[1])] for a, b in zip(*v))" dose.npy want.npy) < 0.01"
  holds "the latitude of $frames" "($(latitude dose.vdb) - $want) ^ 2 < 0.003 ^ 2"
done
judged plain flat.exr
holds 'frames that are not evened print worse' "$(latitude dose.vdb) < 0.6 * $want"
fails 65 'projector.flat: flat.exr has 96 x 64 pixels, the projector 96 x 62; run vam-calibrate uniformity' \
  vam-project light.exr --printer uneven.toml --set projector.rows=62 -o no/
fails 66 'nowhere.exr: cannot open' vam-project light.exr --set projector.flat=nowhere.exr -o no/
done_testing
