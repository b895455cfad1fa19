# SPDX-License-Identifier: GPL-3.0-or-later
# vam-resample end to end: maps, weights, alignment, streams, and every wrong input.
. "$VAM_SOURCE/tests/tools/testlib.sh"

$exr make virtual.exr width=64 height=60 pixel=0.26
ok "to the projector" vam-resample virtual.exr -o projector.exr
vam-resample virtual.exr >pipe.exr
is "projector columns, same angles" "$($exr sum pipe.exr | cut -d' ' -f1-3)" "3 1024 60"
is "space" "$($exr attr pipe.exr vam:space)" projector
is "pitch" "$($exr attr pipe.exr vam:pixel_mm)" 0.065
is "history" "$($exr attr pipe.exr vam:history | tail -n 1 | cut -d' ' -f1,3-)" "vam-resample virtual.exr"
vam-resample <virtual.exr >stdin.exr
is "stdin and file give the same pixels" "$($exr sum stdin.exr)" "$($exr sum pipe.exr)"
taskset -c 0 vam-resample virtual.exr >one.exr  # the history, and so the seal, has the options
vam-resample virtual.exr >two.exr
same "1 and 2 threads give identical bytes" one.exr two.exr

# A constant sinogram shows the weights: J/T of the table in [physics §2] (column at 0.065 * 650 mm).
$exr make flat.exr width=400 height=8 pixel=0.065 value=1 count=1
vam-resample flat.exr >flat-p.exr
weight=$(vam-resample --explain | awk -F, 'NR == 2 + 650 { print $6 }')
holds "a pixel is J/T" "($($exr get flat-p.exr 0 650 3) - $weight)^2 < 1e-12"
vam-resample --no-fresnel --no-jacobian flat.exr >plain-p.exr
holds "without weights it is 1" "($($exr get plain-p.exr 0 650 3) - 1)^2 < 1e-12"
holds "a ray beside the vial is 0" "$($exr get flat-p.exr 0 0 3) == 0"

# [RAY21]'s table: R = 212.37 px, D = 1843.2 px, x_p = 150 px -> x_v = 97.7162, delta = 12.7003, T = 0.94584, J = 0.64716.
vam-resample --explain --set projector.pixel_mm=1 --set projector.axis_column=512 --set vial.radius_mm=212.37 \
  --set camera.distance_mm=1000 >map.csv
is "the map is CSV" "$(head -n 1 map.csv)" "x_p_mm,x_v_mm,delta_deg,T,J,weight"
is "one line per column" "$(wc -l <map.csv)" 1025
is "the paper's ray" "$(awk -F, '$1 == 150 { printf "%.4f %.4f %.5f %.5f", $2, $3, $4, $5 }' map.csv)" "97.7162 12.7003 0.94584 0.64716"
is "telecentric: x_v = x_p / n" "$(vam-resample --explain --set projector.telecentric=true | awk -F, 'NR == 2 + 700 { printf "%.6f", $1 / $2 }')" 1.530000
ok "settings in force" vam-resample --print-printer -o printer.toml
ok "which can be read back" vam-resample --printer printer.toml --explain -o map2.csv

# Rays that climb
top=$(vam-resample --explain --row 0 | awk -F, 'NR == 2 + 650 { print $1 " " $2 " " $3 " " $4 }')
is "column and row, and where they are in the image" "$top" "650 0 9.0025 24.9275"
# At the axis: s = z / sqrt(D^2 + z^2), climb = s / sqrt(n^2 - s^2), the height that of the ray at the surface less R climb.
vam-resample --explain --row 0 --set projector.axis_column=512 | awk -F, '$1 == 512 { print $5, $6, $7, $8 }' >ray
holds "the ray through the axis climbs by Snell's law" "$(awk '{ z = 24.9275; D = 119.808; s = z / sqrt(D * D + z * z)
  climb = s / sqrt(1.53 ^ 2 - s * s); height = z * (D - 12.7) / D + 12.7 * climb
  print ($1 ^ 2 + ($2 - height) ^ 2 + ($3 - climb) ^ 2 + $4 ^ 2) }' ray) < 1e-14"
is "horizontal rays do not climb" "$(vam-resample --explain --row 0 --set projector.telecentric_rows=true | awk -F, '$7 > 0' | wc -l)" 1
is "the middle row is that of the map" \
  "$(vam-resample --explain --row 383 --set projector.axis_row=383 | awk -F, 'NR > 1 { print $3 "," $5 "," $8 "," $9 }' | cksum)" \
  "$(vam-resample --explain | awk -F, 'NR > 1 { print $1 "," $2 "," $3 "," $4 }' | cksum)"
fails 64 'rows are 0 ... 767' vam-resample --explain --row 768 -o x.csv
$exr make tall.exr width=64 height=60 pixel=0.26 row=0.26 count=51
vam-resample tall.exr -o tall-p.exr 2>tall.err
is "a part that is too tall for horizontal rays is resampled with one warning" "$(wc -l <tall.err)" 1
grep -Eq "tall.exr: the projector's rays climb, by up to 2\.[34].* voxels" tall.err; report $? "the warning states the deviation"
quiet "level rays need none" vam-resample --set projector.telecentric_rows=true tall.exr -o level.exr
quiet "parallel ones neither" vam-resample --set projector.telecentric=true tall.exr -o level.exr
quiet "nor do a few slices" vam-resample virtual.exr -o few.exr

# Alignment
vam-resample --column-offset 10 virtual.exr >moved.exr
is "the image moves by the column offset" "$($exr get moved.exr 1 610 7)" "$($exr get pipe.exr 1 600 7)"
vam-resample --angle-offset 6 virtual.exr >turned.exr
holds "one angle step is one row" "($($exr get turned.exr 1 600 7) - $($exr get pipe.exr 1 600 8))^2 < 1e-8"
vam-resample --reverse virtual.exr >reversed.exr
vam-resample --set stage.direction=-1 virtual.exr | $exr sum - >reversed-sum
is "--reverse is the other stage.direction" "$($exr sum reversed.exr)" "$(cat reversed-sum)"
holds "--reverse reverses the angles" "($($exr get reversed.exr 1 600 7) - $($exr get pipe.exr 1 600 53))^2 < 1e-8"
vam-resample --interpolation linear virtual.exr >linear.exr
holds "linear and cubic agree on a smooth part" "($($exr get linear.exr 1 600 7) - $($exr get pipe.exr 1 600 7))^2 < 1e-4"

# Camera
$exr make camera.exr space=camera width=301 height=60 pixel=0.1 row=0.1 value=1
vam-resample --geometry parallel camera.exr >back.exr
is "as many detector bins as the camera sees" "$($exr sum back.exr | cut -d' ' -f1-3)" "3 167 60"
holds "no weights by default" "($($exr get back.exr 0 80 3) - 1)^2 < 1e-12"
vam-resample --geometry parallel --fresnel --bin-width 0.2 --detector-bins 41 camera.exr >glass.exr
holds "Fresnel losses are compensated" "($($exr get glass.exr 0 20 3) - 1 / 0.95611555)^2 < 1e-10"

# 5,000 slices in constant memory
$exr make - count=50 width=16 height=16 pixel=1 >short.exr
peak() { python3 -c 'import resource,subprocess,sys
subprocess.run(sys.argv[1:], stdin=open("in.exr"), stdout=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$@"; }
cp short.exr in.exr; few=$(peak vam-resample --set projector.columns=64 --set projector.pixel_mm=0.5)
$exr make in.exr count=5000 width=16 height=16 pixel=1
many=$(peak vam-resample --set projector.columns=64 --set projector.pixel_mm=0.5)
vam-resample --set projector.columns=64 --set projector.pixel_mm=0.5 <in.exr | tee teed.exr | $exr sum - >sum
is "a stack of 5000 slices is resampled" "$(cut -d' ' -f1-3 sum)" "5000 64 16"
is "tee writes a complete stack" "$($exr sum teed.exr)" "$(cat sum)"
echo "# peak memory: $few kB for 50 slices, $many kB for 5,000"
if sanitized; then echo '# AddressSanitizer keeps what is freed: not judged'; else
  holds "in constant memory, but for the parts' headers (4 kB each)" "$many - $few < 20000 + 4 * 5000"
fi

# Wrong inputs
$exr make frames.exr kind=frames
$exr make half.exr step=3
fails 65 'frames' vam-resample frames.exr -o x.exr
fails 65 'cover 180 deg' vam-resample half.exr -o x.exr
fails 65 'window' vam-resample --set bath.index=1.5 virtual.exr -o x.exr
done_testing
