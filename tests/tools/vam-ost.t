# vam-ost: views to volume, threshold, live turns and the stop event; every wrong input. The views are a projector's
# frames read as a camera's (rays run both ways); tests/lib/metrology judges accuracy with traced rays.
. "$VAM_SOURCE/tests/tools/testlib.sh"

rig='--pixel 0.2 --set camera.distance_mm=119.808 --set camera.azimuth_deg=0'
vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1 -o design.vdb
vam-sinogram design.vdb --angles 60 >sino.exr
cat >coarse.toml <<'TOML'
[projector]
columns = 333
rows = 40
pixel_mm = 0.2
axis_column = 166
axis_row = 19.5
throw_ratio = 1.8
fps = 1.6666667
TOML
vam-resample sino.exr --printer coarse.toml -o seen.exr
vam-project seen.exr --printer coarse.toml -o views
is 'as many views as angles' "$(ls views | grep -c png)" 60

quiet 'a folder of views' vam-ost views --step 6 $rig -o scatter.vdb --report ost.json --projections sums.png
holds 'the axis is where it was put' "$(json ost.json axis_column_px) > 165.9 && $(json ost.json axis_column_px) < 166.1"
holds 'and upright' "$(json ost.json axis_tilt_deg) > -0.05 && $(json ost.json axis_tilt_deg) < 0.05"
quiet 'threshold of a standard' vam-ost threshold scatter.vdb --diameter 6 -o resin.json
holds 'the circle is seen at its size' "$(json resin.json apparent_diameter_mm) > 5.7 && $(json resin.json apparent_diameter_mm) < 6.3"
quiet 'with the record' vam-ost views --step 6 $rig --resin resin.json --mesh print.ply -o again.vdb
quiet 'the print is the design' vam-sdf print.ply design.vdb --align icp --require 'rms<=0.15'

quiet 'live' vam-ost views --step 6 $rig --live --resin resin.json --reference design.vdb \
  -o live --log log.jsonl --projections now.png --page now.html
is 'one volume a turn' "$(ls live)" scatter-0000.vdb
is 'one line a volume' "$(grep -c missing_percent log.jsonl)" 1
grep -q 'now.png' now.html; report $? 'the page shows the picture'
event=$(vam-ost views --step 6 $rig --live --resin resin.json --reference design.vdb --until 'iou>=0.5')
echo "$event" | grep -q '"event":"stop"'; report $? 'a stop event when the condition holds'

fails 64 'give their distance with --step' vam-ost views -o x.vdb
fails 64 'needs? the threshold' vam-ost views --step 6 --mesh p.ply -o x.vdb
fails 64 'needs --projections' vam-ost views --step 6 --live --page p.html
fails 64 'either --diameter or --profile' vam-ost threshold scatter.vdb
fails 65 'no print at this threshold' vam-ost views --step 6 $rig --level 99 --mesh p.ply -o x.vdb
fails 65 'the turn is incomplete' vam-ost views --step 2 $rig -o x.vdb
fails 65 'frames \(camera\) is needed' vam-ost sino.exr -o x.vdb
fails 65 'not a record' vam-ost views --step 6 $rig --resin ost.json --mesh p.ply -o x.vdb
fails 66 'absent' vam-ost absent.exr -o x.vdb
mkdir dark; cp views/* dark
first=$(ls dark | head -n 1)
python3 - "dark/$first" <<'PY'
import struct, sys, zlib
def chunk(kind, data): return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
w, h = 333, 40
open(sys.argv[1], "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 0, 0, 0, 0)) +
    chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(w) for _ in range(h)))) + chunk(b"IEND", b""))
PY
fails 65 'dark, every pixel' vam-ost dark --step 6 $rig -o x.vdb

done_testing
