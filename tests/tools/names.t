# SPDX-License-Identifier: GPL-3.0-or-later
# Names are data: whatever a file is called, no shell runs it, no terminal obeys it, no line breaks at it.
. "$VAM_SOURCE/tests/tools/testlib.sh"

fails 64 '--.\[31mx.\\ny: ' "$VAM_SOURCE/scripts/vam-batch" "$(printf -- '--\033[31mx\302\233\ny')"
is 'vam-batch shows no control character' "$("$VAM_SOURCE/scripts/vam-batch" "$(printf -- '--\033[31mx\302\233\ny')" 2>&1 | LC_ALL=C tr -d '[:print:]\n' | wc -c | tr -d ' ')" 0
fails 66 'no\\x1b\[31m\\nsuch\.stl: cannot open' vam-slice "$(printf 'no\033[31m\nsuch.stl')" -o x.vdb
fails 64 '--\\x07: unknown option' vam-slice "$(printf -- '--\007')"
box 4 4 1 >box.off
cp box.off ./-lead.off
quiet 'a name with a leading dash, after --' vam-slice --voxel 0.5 -o n.vdb -- -lead.off
fails 64 '^vam-slice: --voxel: unexpected argument after --; options come before it' vam-slice -o x.vdb -- -lead.off --voxel 0.5
fails 64 '^vam-view: --target: unexpected argument after --; options come before it' vam-view -- n.vdb --target n.vdb
rm -f ./-lead.off n.vdb
cp box.off "$(printf 'a\nb.off')"
ok 'a name with a newline' vam-slice "$(printf 'a\nb.off')" --voxel 0.5 -o n.vdb
grep -qa 'a\\nb\.off' n.vdb; report $? 'is one line of the history'
rm -f "$(printf 'a\nb.off')" n.vdb

mkdir made && cd made && mkdir .log || exit 1
cp "$VAM_SOURCE/Makefile.example" Makefile
for name in 'a b' 'x`id>pwned`' 'q"$HOME;touch pwned;' "it's" '$(shell touch pwned)' 'p%c#d:e=f+g' '-o' "$(printf 'n\nl')"; do
  cp ../box.off "./$name.off"
done
cp ../box.off plain.off
all=$(make -n VOXEL=0.5 all | grep -c '^vam-slice .*off ')
is 'every mesh is a part' "$all" 9
targets='plain.vdb a+20b.vdb x+60id+3Epwned+60.vdb q+22+24HOME+3Btouch+20pwned+3B.vdb it+27s.vdb
  +24+28shell+20touch+20pwned+29.vdb p+25c+23d+3Ae+3Df+2Bg.vdb +2Do.vdb n+0Al.vdb'
ok 'and is sliced' make VOXEL=0.5 $targets
[ -z "$(find .. -name 'pwned*')" ]; report $? 'no name was run'
is 'nothing is made twice' "$(make VOXEL=0.5 $targets | grep -c '^vam-slice')" 0
touch 'a b.off'
is 'a changed mesh is' "$(make VOXEL=0.5 $targets | grep '^vam-slice')" 'vam-slice .parts/a+20b.off --voxel 0.5  -o a+20b.vdb'
make clean >/dev/null
is 'clean leaves the meshes' "$(ls -A | grep -vc 'off$')" 4
cp plain.off plain.stl && mkdir .parts
fails 2 'plain.stl plain.off: each would make plain.vdb; rename all but one' make all
mv plain.stl 'a b.stl'
fails 2 'a\+20b.stl a\+20b.off: each would make a\+20b.vdb' make clean
mv 'a b.stl' "$(printf '%0100d' 0 | sed 's/0/ä/g').stl"
make all 2>errors >.log/out; is 'a name that is too long when coded ends make' $? 2
ok 'with the reason' grep -qF '+C3+A4.stl: cannot be linked to from .parts; rename the mesh' errors
cd ..

# Of what a file holds at most 64 bytes are quoted, and a zero byte does not end a line.
$npy head long.npy "{'descr': '$(printf '%060000d' 0 | tr 0 A)', 'fortran_order': False, 'shape': (2, 3, 4), }"
$npy make short.npy '<f4' 2,3,4
python3 - <<'PY'
import json, zipfile
with zipfile.ZipFile('long.npz', 'w') as archive:
    for name in 'n' * 60000, 'b': archive.write('short.npy', name + '.npy')
json.dump({'schema': 's' * 9000}, open('long.json', 'w'))
open('nul.csv', 'wb').write(b"a\0b,c\n")
PY
for file in long.npy long.npz; do
  vam-convert $file --voxel 0.5 -o x.vdb 2>.log/err
  holds "$file in $(wc -c <.log/err) bytes" "$(wc -c <.log/err) < 300 && $(grep -c '(60000 bytes)' .log/err) == 1"
done
is 'a schema that vam-check prints' "$(vam-check long.json)" "long.json: \"$(printf '%063d' 0 | tr 0 s)... (9002 bytes), unsealed"
tiny_print light.exr
echo '{"schema": "vam-resin/1", "isovalue": 1, "critical_dose_mj_cm3": -5}' >resin.json
box 2 2 2 >sound.off; vam-slice sound.off --voxel 0.5 -o sound.vdb
fails 65 'resin.json: critical_dose_mj_cm3 is -5; it must be above 0' vam-sdf sound.vdb sound.off --resin resin.json
fails 65 "nul.csv:1: 'a.x00b,c' is not the header" vam-project light.exr -o x.mkv --set projector.response=nul.csv
done_testing
