# SPDX-License-Identifier: GPL-3.0-or-later
# Every file states the version of its format; each tool refuses a newer one with both numbers, and reads one without.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH

cat >edit.py <<'PY'
"""edit.py newer|bare FILE OUT: the version counted up, or its name changed by a letter, in whatever kind of file."""
import re, sys, zlib
how, name, out = sys.argv[1:]
data = open(name, "rb").read()
def up(match):
    return match[1] + (b"%d" % (int(match[2]) + 1) if how == "newer" else match[2])
for tag in (rb"(vam:version(?:\x06\0\0\0string|\0string\0)\x01\0\0\0)(\d)", rb"(VAM_VERSION\x44\x87.{1,8}?)(\d)"):
    data = re.sub(tag, up if how == "newer" else lambda m: m[0].replace(b"ERSION", b"ERSIOX", 1).replace(b"ersion", b"ersiox"),
                  data, flags=re.S)
data = re.sub(rb'("schema": ?"vam-[a-z-]+/)(\d+)', up, data)
data = re.sub(rb"(\nversion = |vam:version:=)(\d+)", up, data)
if data[1:4] == b"OMV":
    data = bytes([data[0] + 1]) + data[1:]
at = 0
while data[:4] == b"\x1a\x45\xdf\xa3" and (at := data.find(b"\x12\x54\xc3\x67", at + 1)) > 0:  # sums of Matroska's tags
    if data[at - 2:at] == b"\x53\xab" or b"\xbf\x84" not in data[at + 5:at + 15]:  # only named
        continue
    wide = 9 - data[at + 4].bit_length()
    size = int.from_bytes(data[at + 4:at + 4 + wide], "big") & ~(1 << 7 * wide)
    begin, end = at + 10 + wide, at + 4 + wide + size
    data = data[:begin - 4] + zlib.crc32(data[begin:end]).to_bytes(4, "little") + data[begin:]
open(out, "wb").write(data)
PY
newer() { for file; do python3 edit.py newer "$file" "new.${file##*/}"; ! cmp -s "$file" "new.${file##*/}" || report 1 "$file states a version"; done; }
end='; install newer VAM tools$'

# Files of all kinds
vam-slice --print-printer -o printer.toml
printer='--printer printer.toml --set projector.columns=48 --set projector.rows=24 --set projector.pixel_mm=0.2 --set projector.axis_column=23.5 --set projector.axis_row=11.5'
vam-slice --shape cylinder:diameter=3,height=1 --voxel 0.25 --report slice.json -o part.vdb
vam-optimize part.vdb $printer --angles 24 --iterations 2 -o light.exr 2>.log/err
vam-dose light.exr --like part.vdb $printer -o dose.vdb
vam-sinogram part.vdb --angles 24 -o sino.exr
vam-project light.exr $printer -o print.mkv 2>.log/err
vam-view part.vdb --export part.nrrd
for size in 1 2 3; do
  printf '{"schema":"vam-sdf/1","a":%s,"expanded_uncertainty":{"a":0.1}}' $size >run$size.json
done
printf '{"schema":"vam-resin/1","isovalue":0.5}' >resin.json
printf '{"schema":"vam-working-curve/1","isovalue":0.04,"saturation":0.08,"critical_dose_mj_cm3":60,"rate_per_mj_cm3":0.07,"delay_s":1}' >curve.json
mkdir records views run new.records new.views new.run new.sum
printf '{"schema":"vam-calibration/1","utc":"2026-01-01T00:00:00.000Z","valid_until":"2126-01-01T00:00:00.000Z","scan":"latency","status":"pass","values":{"latency":{"value":1}}}' >records/current-latency.json
echo '{"schema":"vam-capture/1","camera":{},"columns":8,"rows":8,"bits":8,"fps":1,"exposure_us":1,"pixel_mm":0.1,"every_deg":1}' >views/manifest.jsonl
echo '{"utc":"2026-01-01T00:00:00.000Z","t_monotonic_s":1,"event":"display","schema":"vam-log/1"}
{"utc":"2026-01-01T00:00:01.000Z","t_monotonic_s":2,"event":"flip","frame":0,"angle_deg":0,"sigma_deg":0}' >flips.jsonl
echo '{"utc":"2026-01-01T00:00:00.000Z","t_monotonic_s":1,"event":"armed","turns":1,"from_deg":0,"schema":"vam-print/1"}' >run/events.jsonl
echo '{"schema": "vam-print/1", "outcome": "done", "status": 0, "turns": 1}' >summary.json
timeout --preserve-status -s INT 1 vam-optimize part.vdb $printer --angles 24 --iterations 100000 --patience 0 --checkpoint run.state -o no.exr 2>.log/err
newer part.vdb dose.vdb light.exr sino.exr print.mkv part.nrrd printer.toml slice.json run1.json resin.json curve.json flips.jsonl summary.json run.state
for file in records/current-latency.json views/manifest.jsonl run/events.jsonl; do python3 edit.py newer $file new.$file; done
for file in log:flips.jsonl log:stage.jsonl angles:angles.jsonl project:project.json; do
  mkdir "run.${file#*:}"; cp run/events.jsonl summary.json "run.${file#*:}"
  (cd "run.${file#*:}" && echo '{"t_monotonic_s":1,"schema":"vam-'"${file%:*}"'/2"}' >"${file#*:}" && sha256sum -- * >SHA256SUMS)
done
mv new.summary.json new.sum/summary.json; cp run/events.jsonl new.sum
: >new.sum/flips.jsonl

while IFS='|' read -r kind version command; do
  fails 65 "is of version $((version + 1)) of its format \($kind\), and this tool reads up to version $version$end" $command
done <<END
volume|1|vam-check new.part.vdb
volume|1|vam-check --fast new.part.vdb
volume|1|vam-sinogram new.part.vdb -o no.exr
volume|1|vam-optimize new.part.vdb -o no.exr
volume|1|vam-dose light.exr $printer --like new.part.vdb -o no.vdb
volume|1|vam-score new.dose.vdb --target part.vdb
volume|1|vam-score dose.vdb --target new.part.vdb
volume|1|vam-view new.part.vdb -o no.png
volume|1|vam-report new.part.vdb -o no.html
volume|1|vam-curethrough model new.part.vdb
volume|1|vam-sdf new.dose.vdb part.vdb --isovalue 1
volume|1|vam-convert new.part.vdb -o no.npy
stack|1|vam-check new.light.exr
stack|1|vam-check --fast new.light.exr
stack|1|vam-convert cut new.light.exr --slices 0:2 -o no.exr
stack|1|vam-dose new.light.exr $printer -o no.vdb
stack|1|vam-project new.light.exr $printer -o no.mkv
stack|1|vam-resample new.sino.exr -o no.exr
stack|1|vam-view new.light.exr -o no.png
stack|1|vam-report new.light.exr -o no.html
stack|1|vam-ost new.light.exr -o no.vdb
stack|1|vam-convert new.light.exr -o no.npy
stack|1|vam-optimize part.vdb --init new.light.exr -o no.exr
video|1|vam-check new.print.mkv
video|1|vam-convert new.print.mkv --geometry vial $printer -o no.exr
NRRD|1|vam-convert new.part.nrrd --voxel 0.25 -o no.vdb
printer file|1|vam-check new.printer.toml
printer file|1|vam-optimize part.vdb --printer new.printer.toml -o no.exr
printer file|1|vam-project light.exr --printer new.printer.toml -o no.mkv
checkpoint|6|vam-optimize part.vdb $printer --angles 24 --iterations 100000 --patience 0 --checkpoint new.run.state -o no.exr
vam-slice|1|vam-check new.slice.json
vam-slice|1|vam-report part.vdb new.slice.json -o no.html
vam-sdf|1|vam-sdf trend new.run1.json run2.json run3.json
vam-resin|1|vam-check new.resin.json
vam-resin|1|vam-sdf dose.vdb part.vdb --resin new.resin.json
vam-working-curve|1|vam-print light.exr --display null: --correct --until iou>0.9 --target part.vdb --resin new.curve.json --view-step 1
vam-calibration|1|vam-check new.records/current-latency.json
vam-calibration|1|vam-optimize part.vdb --wobble-record new.records/current-latency.json -o no.exr
vam-calibration|1|vam-project light.exr $printer --set calibration.folder=new.records -o no.mkv
vam-capture|1|vam-check new.views
vam-capture|1|vam-check new.views/manifest.jsonl
vam-capture|1|vam-ost new.views -o no.vdb
vam-log|1|vam-dose light.exr $printer --shown new.flips.jsonl -o no.vdb
vam-print|1|vam-status new.run
vam-print|1|vam-status new.sum
vam-print|1|vam-check new.run
vam-print|1|vam-check new.sum
vam-log|1|vam-check --fast run.flips.jsonl
vam-log|1|vam-check run.stage.jsonl
vam-angles|1|vam-check run.angles.jsonl
vam-log|1|vam-check new.flips.jsonl
vam-project|1|vam-check run.project.json
vam-print|1|vam-print light.exr --display null: --resume new.run
END
fails 65 "states '-1' as the version of its format .vam-slice., which is no whole number from 1 on; write it again" sh -c 'sed "s|vam-slice/1|vam-slice/-1|" slice.json | vam-check'
for nonsense in '"abc"' -1 1e9 0 1.5 true; do
  sed "s/^version = 1/version = $nonsense/" printer.toml >odd.toml
  fails 65 'odd.toml:3: states .* as the version of its format .printer file., which is no whole number' vam-plan part.vdb --printer odd.toml
done

# Without a version
sed '/^version/d' printer.toml >bare.toml
same 'a printer file without a version is the same' printer.toml "$(vam-slice --print-printer --printer bare.toml -o again.toml; echo again.toml)"
$exr make bare.exr count=2
ok 'a stack without one is read' vam-check bare.exr
sed 's|"vam-sdf/1"|"vam-sdf"|' run1.json >bare.json
ok 'and a report' vam-sdf trend bare.json run2.json run3.json
for file in part.vdb light.exr print.mkv; do
  python3 edit.py bare $file "bare.${file##*.}"
  fails 65 'changed after it was written' vam-check "bare.${file##*.}"
done

# It goes along
vam-convert cut light.exr --slices 1/2 -o a.exr; vam-convert cut light.exr --slices 2/2 -o b.exr; vam-convert join b.exr a.exr -o whole.exr
is 'a piece states it' "$($exr attr a.exr vam:version)" 1
same 'pieces are joined to the same bytes' whole.exr light.exr
vam-convert part.vdb -o part.npy && vam-convert part.npy --voxel 0.25 --stretch-z 1 -o again.vdb && ok 'one that was converted states it' grep -aq vam:version again.vdb
cat >read.py <<'PY'
import os, sys
sys.path.insert(0, os.environ["VAM_SOURCE"] + "/scripts")
import vam
print(vam.read("part.vdb")[1]["shape"])
vam.VERSION = "0"
try:
    vam.read("part.vdb")
except ValueError as error:
    print(error)
vam.VERSION = "2"
vam.write_stack("two.exr", vam.array.array("f", [0] * 6), 0.1, 0.1, shape=(1, 2, 3))
vam.write_volume("two.vdb", vam.array.array("f", [1] * 6), 0.1, shape=(1, 2, 3))
PY
is 'vam.py reads versions up to its own' "$(python3 read.py | tail -n 1)" 'part.vdb: is of version 1 of NRRD, this vam.py reads up to 0; get a newer one'
fails 65 "is of version 2 of its format .volume.*$end" vam-check two.vdb
fails 65 "is of version 2 of its format .stack.*$end" vam-check two.exr
is 'and is of the version of these tools' "$(sed -n 's/^VERSION = "\(.*\)".*/\1/p' "$VAM_SOURCE/scripts/vam.py")" "$(sed -n 's/.*{"volume", \(.*\)},/\1/p' "$VAM_SOURCE/lib/base/text/format_version.hpp")"
done_testing
