# SPDX-License-Identifier: GPL-3.0-or-later
# Files that show that they are what was written, and what they were made from.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH

flip() {  # flip FILE BYTE TO: one bit of it, counted from the end where negative
  python3 - "$@" <<'PY'
import sys
data = bytearray(open(sys.argv[1], 'rb').read())
data[int(sys.argv[2])] ^= 4
open(sys.argv[3], 'wb').write(data)
PY
}

box 6 6 3 >a.off
vam-slice a.off --voxel 0.3 -o part.vdb
vam-sinogram part.vdb -o sino.exr
ok 'part and sinogram are intact' vam-check part.vdb sino.exr
cp .log/out chain
is 'part and sinogram are sealed' "$(grep -c ', sealed [0-9a-f]\{16\}$' chain)" 2
part=$(sed -n "s/^part.vdb: grid 'target', sealed //p" chain)
is 'the sinogram names its part' "$(grep "^  $part  vam-slice .*  (part.vdb)\$" chain | sort -u | wc -l)" 1
is 'the chain names the sinogram' "$(grep -c '^  [0-9a-f]\{16\}  vam-sinogram .*  (sino.exr)$' chain)" 1
is 'another part has a different seal' "$(vam-slice a.off --voxel 0.4 -o b.vdb && vam-check b.vdb | grep -c "$part")" 0

flip sino.exr -500 bad.exr
fails 65 'bad.exr: image [0-9]* is damaged: a row of RLE is too short; create it again' vam-check bad.exr
fails 65 'bad.exr: image [0-9]* is damaged' vam-resample bad.exr -o frames.exr
vam-sinogram part.vdb --compression none -o plain.exr
flip plain.exr -500 changed.exr
fails 65 'changed.exr: image [0-9]* changed after it was written \(sealed [0-9a-f]{8}, read [0-9a-f]{8}\); create it again' vam-check changed.exr
fails 65 'changed.exr: image [0-9]* changed' vam-resample changed.exr -o frames.exr
ok '--fast checks headers only' vam-check --fast bad.exr
for file in sino.exr plain.exr pipe.exr own.exr; do
  case $file in pipe.exr) vam-sinogram part.vdb >pipe.exr;; own.exr) $exr make own.exr;; esac
  ok "--fast of $file" vam-check --fast $file
  head -c -1 $file >cut.exr
  fails 65 'cut.exr: is cut off after [0-9]* bytes, before the last of its [0-9]* images ends' vam-check --fast cut.exr
  { cat $file; printf junk; } >long.exr
  fails 65 'long.exr: trailing data after the last image, from byte [0-9]* on' vam-check --fast long.exr
done
cat sino.exr sino.exr >two.exr
fails 65 'another stack follows the last image' vam-resample two.exr -o x.exr
vam-check two.exr >out 2>err
is 'two stacks in a file are said' "$? $(cat err)" \
  '0 vam-check: warning: two.exr: holds 2 stacks, one behind the other, as a live capture does; tools that read one refuse it'

# Of what follows each other on a stream each is judged by itself: what is sealed stays so beside what is not.
python3 - <<'PY'
data = open('part.vdb', 'rb').read()
assert data.count(b'vam:seal') == 1 and data.count(b'vam:facts_seal') == 1
open('own.vdb', 'wb').write(data.replace(b'vam:seal', b'was:seal').replace(b'vam:facts_seal', b'was:facts_seal'))
PY
vam-sinogram part.vdb >pipe.exr
flip pipe.exr -2000 flipped.exr
flip part.vdb -40 flipped.vdb
for kind in vdb exr; do
  sealed=part.vdb; [ $kind = vdb ] || sealed=pipe.exr
  seal=$(vam-check $sealed | sed -n '1s/.*, sealed //p')
  is "$kind: unsealed after sealed on a pipe" "$(cat $sealed own.$kind | vam-check - | sed -n 's/^stdin: .*, //p' | tr '\n' ' ')" \
    "sealed $seal unsealed "
  is "$kind: sealed after unsealed on a pipe" "$(cat own.$kind $sealed | vam-check - | sed -n 's/^stdin: .*, //p' | tr '\n' ' ')" \
    "unsealed sealed $seal "
  cat own.$kind $sealed >both.$kind
  is "$kind: and in a file" "$(vam-check both.$kind 2>.log/err | sed -n 's/^both.*, //p' | tr '\n' ' ')" "unsealed sealed $seal "
  for order in "own.$kind flipped.$kind" "flipped.$kind own.$kind"; do
    fails 65 'stdin: .*(changed|damaged)' sh -c "cat $order | vam-check -"
  done
done
cat own.exr sino.exr >both.exr
seal=$(vam-check sino.exr | sed -n '1s/.*, sealed //p')
is 'the chain of the later one' "$(vam-check both.exr 2>.log/err | grep -c "^  $seal  vam-sinogram .*  (both.exr)$")" 1

# What follows the last image of an unsealed stack, through a pipe whose writer takes its time.
for rest in 'printf junk' 'cat own.exr'; do
  fails 65 'stdin: (trailing data after|another stack follows) the last image' sh -c "{ cat own.exr; sleep 0.2; $rest; } | vam-resample -o x.exr"
done
python3 - <<'PY'
data = open('sino.exr', 'rb').read()
at = data.find(b'vam:pixel_mm\0double\0') + 24
open('head.exr', 'wb').write(data[:at + 5] + bytes([data[at + 5] ^ 1]) + data[at + 6:])
PY
fails 65 'head.exr: the header of part 0 changed' vam-check --fast head.exr
flip part.vdb -40 bad.vdb
fails 65 "bad.vdb: .*(grid 'target' changed|damaged)" vam-check bad.vdb
ok 'headers of a volume' vam-check --fast part.vdb

vam-check bad.exr part.vdb head.exr >out 2>err
is 'all files are checked' "$? $(grep -c 'part.vdb' out) $(wc -l <err) $(grep -c 'warning: head.exr' err)" '65 2 2 1'
vam-sinogram part.vdb | vam-check >out
is 'a pipe is verified against its seals' "$? $(grep -c '^stdin: stack of [0-9]* images, sealed [0-9a-f]\{16\}$' out)" '0 1'
vam-sinogram part.vdb >pipe.exr
flip pipe.exr -2000 cut.exr
fails 65 'stdin: image [0-9]* changed|stdin: the seals' sh -c 'vam-check <cut.exr'
head -c -16 pipe.exr >cut.exr
fails 65 'is cut off' vam-check cut.exr

$exr make foreign.exr
is 'a file of another program is reported as unsealed' "$(vam-check foreign.exr | head -n 1) $?" \
  'foreign.exr: stack of 3 images, unsealed 0'
ok 'other tools read an unsealed file' vam-resample foreign.exr -o r.exr
is 'a mesh is unsealed' "$(vam-check a.off)" 'a.off: file of another kind, unsealed'

vam-view part.vdb -o seen.png
is 'a whole PNG image' "$(vam-check seen.png)" 'seen.png: a PNG image, unsealed'
head -c 60 seen.png >cut.png
fails 65 'cut.png: the PNG is damaged: it is truncated' vam-check cut.png
fails 65 'stdin: the PNG is damaged: it is truncated' sh -c 'vam-check <cut.png'

# A volume that states an impossible stretch.
for stretch in 1e300 nan 2x -1; do
  python3 - "$stretch" <<'PY'
import struct, sys
data = open('part.vdb', 'rb').read().replace(b'vam:seal', b'was:seal').replace(b'vam:facts_seal', b'was:facts_seal')
at = data.index(b'string', data.index(b'vam:stretch_z')) + 6
size, = struct.unpack_from('<I', data, at)
open('stretched.vdb', 'wb').write(data[:at + 4] + sys.argv[1].encode().rjust(size) + data[at + 4 + size:])
PY
  for command in 'vam-sdf stretched.vdb part.vdb --isovalue 0.5' 'vam-check --fast stretched.vdb' 'vam-sinogram stretched.vdb -o x.exr' \
    'vam-convert stretched.vdb -o x.npy' 'vam-optimize stretched.vdb --method fbp -o x.exr'; do
    fails 65 "stretched.vdb: grid 'target' states vam:stretch_z ' *$stretch', which is not a factor of 0.1 to 10" $command
  done
done

# ---- records, reports, printer files -------------------------------------------------------------------------------
vam-slice --print-printer --set vial.radius_mm=11.5 -o printer.toml
is 'a printer file is unsealed by default' "$(vam-check printer.toml)" 'printer.toml: printer file, unsealed'
vam-check --seal printer.toml && vam-check --seal printer.toml
is 'a printer file is sealed once' "$(grep -c '^# sealed xxh3:' printer.toml) $(vam-check printer.toml)" \
  '1 printer.toml: printer file, sealed'
vam-check --seal <printer.toml >piped.toml
is 'a sealed printer file passes a pipe unchanged' "$? $(cmp printer.toml piped.toml && echo same)" '0 same'
fails 74 'stdout: ' sh -c 'vam-check --seal <printer.toml >/dev/full'
ok 'a sealed printer file is read' vam-slice --print-printer --printer printer.toml -o again.toml
sed 's/^radius_mm = 11.5/radius_mm = 17.5/' printer.toml >changed.toml
fails 65 "changed.toml: changed after it was written .* remove its last line '# sealed" vam-slice --print-printer --printer changed.toml -o x.toml
fails 65 'changed.toml: changed' vam-check changed.toml
fails 65 'stdin: changed' sh -c 'vam-check --seal <changed.toml'
for damage in s/^#.sealed/#.sealex/ s/^#.sealed/sealed/ s/xxh3:/xxi3:/; do
  sed "\$$damage" printer.toml >seal.toml
  fails 65 'seal.toml: (changed|.*not TOML)' vam-check seal.toml
done
head -c -9 printer.toml >cut.toml
fails 65 'cut.toml: changed' vam-slice --print-printer --printer cut.toml -o x.toml

vam-slice a.off --voxel 0.3 --report r.json -o part.vdb
{ cat r.json; printf '\0{"a":1}'; } >z.json
fails 65 'z.json' vam-check z.json
is 'a report is sealed' "$(vam-check r.json)" 'r.json: "vam-slice/1", sealed'
sed 's/"voxel_mm": 0.3/"voxel_mm": 0.8/' r.json >s.json
fails 65 's.json: changed after it was written' vam-check s.json
python3 -c 'import json; json.dump(json.load(open("r.json")), open("t.json", "w"))'
ok 'the layout of a report is not sealed' vam-check t.json
sed 's/"voxel_mm": 0.3/"voxel_mm": 0.8, &/' r.json >twice.json
fails 65 "twice.json: has the key 'voxel_mm' twice in one object, of which only one would count; write it again" vam-check twice.json
fails 65 "twice.json: has the key 'voxel_mm' twice" vam-report part.vdb twice.json -o no.html
python3 -c 'import json; json.dump({"schema": "vam-resin/1", "isovalue": 1, "x": " " * 2**20}, open("long.json", "w"))'
fails 65 'long.json: has [0-9]* bytes; a calibration record has at most 1 MiB' vam-check long.json
# Damage by which a file is no longer of its kind.
for cut in 3 200; do
  head -c $cut r.json >cut.json
  fails 65 'cut.json: is damaged: no longer JSON' vam-check cut.json
done
for value in '[]' null 5; do
  echo "$value" >value.json
  fails 65 'value.json: holds JSON of the type (array|null|number), where records and reports are an object' vam-check value.json
done
fails 65 'stdin: is damaged: no longer JSON' sh -c 'head -c -9 r.json | vam-check'
for file in part.vdb sino.exr; do
  flip $file 1 "lost.${file##*.}"
  fails 65 "lost.${file##*.}: is damaged: does not begin as a file .${file##*.} does" vam-check "lost.${file##*.}"
done
for cut in 60 2681; do
  head -c $cut printer.toml >short.toml
  fails 65 "short.toml: is cut off after $cut bytes" vam-check short.toml
done

# A lossless video is sealed by a hash of its levels; checksums alone are those of whoever wrote it.
tiny_print light.exr
vam-project light.exr --printer printer.toml -o print.mkv 2>.log/err
ok 'a lossless video' sh -c "vam-check print.mkv | grep -Eqx 'print.mkv: video, sealed [0-9a-f]{16}'"
ok 'whose headers are checked' sh -c "vam-check --fast print.mkv | grep -Eqx 'print.mkv: video, sealed [0-9a-f]{16}'"
tiny_print dim.exr; vam-project dim.exr --printer printer.toml --full-scale 9 -o dim.mkv 2>.log/err
python3 - <<'PY'
def parts(name):  # all but the seal, and the seal: its element and the size of the segment
    data = bytearray(open(name, 'rb').read())
    begin = data.index(b'VAM_SEAL')
    tags = data.rindex(b'\x12\x54\xc3\x67', 0, begin)
    size = data.index(b'\x18\x53\x80\x67\x01') + 4
    return data[:tags], data[tags:], size
def write(name, front, seal, size):
    data = bytearray(front) + seal
    data[size:size + 8] = (len(data) - size - 8 | 1 << 56).to_bytes(8, 'big')
    open(name, 'wb').write(data)
ours, seal, size = parts('print.mkv')
write('copy.mkv', ours, seal, size)
write('bare.mkv', ours, b'', size)
theirs, other, size = parts('dim.mkv')
assert seal != other and len(seal) == len(other)
write('changed.mkv', ours, other, size)
write('odd.mkv', ours, seal.replace(b'\x12\x54\xc3\x67', b'\x12\x54\xc3\x66'), size)
PY
same 'the seal is an element at the end' copy.mkv print.mkv
is 'without it a video is unsealed' "$(vam-check bare.mkv)" 'bare.mkv: video, unsealed; its checksums hold'
fails 65 'changed.mkv: the video changed after it was written \(sealed [0-9a-f]{8}, read [0-9a-f]{8}\); write it again' vam-check changed.mkv
fails 65 'changed.mkv: the video changed' vam-convert changed.mkv --geometry vial --printer printer.toml -o no.exr
fails 65 'odd.mkv: the video is damaged near byte' vam-check odd.mkv
if command -v ffmpeg >/dev/null; then
  ffmpeg -v error -i print.mkv -c:v ffv1 -slicecrc 1 rewritten.mkv </dev/null
  is 'nor is one that another program wrote anew' "$(vam-check rewritten.mkv)" 'rewritten.mkv: video, unsealed; its checksums hold'
  ffmpeg -v error -i print.mkv -c copy copied.mkv </dev/null
  is 'or copied' "$(vam-check copied.mkv)" 'copied.mkv: video, unsealed; its checksums hold'
  ffmpeg -v error -i print.mkv -f rawvideo ours.raw </dev/null; ffmpeg -v error -i bare.mkv -f rawvideo bare.raw </dev/null
  same 'which reads a sealed one as any other' ours.raw bare.raw
else
  echo "ok $((number += 1)) - videos that ffmpeg wrote # SKIP no ffmpeg here"
fi
{ cat print.mkv; echo more; } >long.mkv
fails 65 'long.mkv: trailing data after the video, from byte [0-9]+ on; write it again' vam-check long.mkv
vam-project light.exr --printer printer.toml -o looks.mp4 2>.log/err && mv looks.mp4 looks.mkv
is 'one without checksums, whatever its name' "$(vam-check looks.mkv | head -n 1)" 'looks.mkv: video, unsealed'

python3 -c "
import struct, sys
head = struct.pack('<qIIIB', 0x56444220, 224, 10, 0, 1) + b'6219db8d-fccc-86ea-8254-68b69b4f6c3f'
sys.stdout.buffer.write(head + struct.pack('<II', 0, 0))" >bare.vdb
fails 65 'bare.vdb: has no grids; ' vam-check bare.vdb
fails 65 'bare.vdb: has no grids; ' vam-check --fast bare.vdb
fails 65 'stdin: has no grids; ' sh -c 'vam-check <bare.vdb'
fails 65 'bare.vdb: has no grids; ' vam-curethrough model bare.vdb
vam-check bare.vdb part.vdb >out 2>.log/err
is 'beside it the others are checked' "$? $(grep -c '^part.vdb: grid' out)" '65 1'
{ cat part.vdb; echo more; } >long.vdb
fails 65 'long.vdb: trailing data after the last grid, from byte [0-9]+ on, is not a volume' vam-check long.vdb
fails 65 'stdin: trailing data after the last grid' sh -c 'vam-sinogram - -o x.exr <long.vdb'
fails 74 'No space left' sh -c 'vam-check part.vdb >/dev/full'
fails 65 'a.off' vam-check --seal a.off
mkfifo fifo
# Videos of other programs that begin later, or leave frames out, are whole.
ffmpeg -v error -f lavfi -i testsrc=size=64x48:rate=16:duration=2 -pix_fmt gray -c:v ffv1 -output_ts_offset 1.5 late.mkv
ffmpeg -v error -f lavfi -i testsrc=size=64x48:rate=16:duration=2 -vf "select='not(eq(mod(n,5),3))'" -vsync vfr -pix_fmt gray -c:v ffv1 fewer.mkv
for name in late fewer; do is "a video that is $name" "$(vam-check $name.mkv)" "$name.mkv: video, unsealed; its checksums hold"; done

fails 66 'fifo: is not a regular file; give it on standard input' vam-check fifo

done_testing
