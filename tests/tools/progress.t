# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# Where long work stands: one line that fits the terminal, shared by the tools of a pipe; --quiet, -v, --progress.
. "$VAM_SOURCE/tests/tools/testlib.sh"

seen() { python3 "$VAM_SOURCE/tests/tools/progress.py" "$@"; }
work='vam-optimize --iterations 12 --angles 150 part.vdb'  # of some seconds
vam-slice --shape gyroid --voxel 0.2 -o part.vdb

ok 'on a terminal' seen 100 "$work" ; mv .log/out rows
grep '^vam-optimize: optimising' rows >drawn
holds 'there is a line' "$(wc -l <drawn) > 0"
is 'which says where it stands' "$(grep -Evc '^vam-optimize: optimising( at [0-9.]+ mm)? \[#* *\] ( 0 %|[ 0-9][0-9]+ %, [0-9]+:[0-9]{2} left), iteration [0-9]+, VER [0-9.e-]+, PW [0-9.e-]+\$$' drawn)" 0
is 'the time left as soon as it is known' "$(grep -c ' 0 %, 0:00 left' drawn)" 0
holds 'in the terminal' "$(awk '{ n = length($0) - 1; if (n > most) most = n } END { print most }' drawn) <= 99"
is 'and goes' "$(grep -A 1 '^vam-optimize: optimising' rows | tail -n 1 | cut -c1)" '$'
ok 'on a narrow one' seen 39 "$work"
is 'it is short' "$(grep '^optimising' .log/out | grep -Evc '^optimising( at [0-9.]+ mm)? (\[#* *\] )?[ 0-9][0-9]+ %(, [0-9]+:[0-9]{2} left)?\$$')" 0
holds 'and fits' "$(grep '^optimising' .log/out | awk '{ n = length($0) - 1; if (n > most) most = n } END { print most }') <= 38"

ok 'while another tool has the line' seen 100 "$work" taken
is 'nothing is drawn' "$(grep -c optimising .log/out)" 0
is 'and messages clear it' "$(grep -c '^\$vam-optimize: part.vdb will' .log/out)" 1
vam-slice --shape gyroid --voxel 0.12 --stretch-z 1 -o fine.vdb
ok 'the tools of a pipe' seen 80 'vam-sinogram --angles 90 fine.vdb | vam-resample | vam-dose --like fine.vdb | vam-score --target fine.vdb'
grep -o '^vam-[a-z]*: [a-z]* ' .log/out | uniq >turns
is 'take turns' "$(sort turns | uniq -d)" ''

vam-slice --shape box:x=6,y=6,z=6 --stretch-z 1 --voxel 0.3 -o box.vdb
ok 'vam-sdf' seen 80 'vam-sdf box.vdb box.vdb --isovalue 0.5 --align none --volume apart.vdb --volume-voxel 0.035'
holds 'says that it measures' "$(grep -c '^vam-sdf: measuring distances \[' .log/out) > 0"

ok 'no terminal' sh -c "$work -o x.exr"
is 'no line' "$(cat .log/err)" ''
mv x.exr plain.exr
ok '--progress none' seen 80 "$work --progress none"
is 'none' "$(grep -c optimising .log/out)" 0
ok '--quiet' seen 80 "$work --quiet --set resin.diffusion_mm2_s=1e-6"
is 'is quiet' "$(tr -d '\n' <.log/out)" ''
ok '-v' $work -v -o x.exr
is 'says what each step took' "$(grep -c '^vam-optimize: optimising.*: [0-9.]* s$' .log/err)" 1
is 'and all' "$(tail -n 1 .log/err | sed 's/[0-9.][0-9.]*/N/g')" 'vam-optimize: N s, N GiB of memory'
same 'the same bytes' plain.exr x.exr
ok '--progress json' $work --progress json -o x.exr
cat >judge.py <<'PY'
import json, sys
from collections import Counter
lines = [json.loads(line) for line in sys.stdin]
last = [line for line in lines if line["task"] == "optimising"]
print(all(a["iteration"] <= b["iteration"] and a["elapsed_s"] <= b["elapsed_s"] for a, b in zip(last, last[1:])),
      all(line["tool"] == "vam-optimize" and 0 <= line["done"] <= line["total"] for line in lines),
      all(0 <= line["ver"] <= 1 and -2 <= line["pw"] <= 1 for line in lines),
      all(("left_s" in line) == (line["done"] > 0) for line in lines), last[-1]["left_s"], len(last) > 1,
      all([line["finished"] for line in lines if line["task"] == task] == [False] * (count - 1) + [True]
          for task, count in Counter(line["task"] for line in lines).items()), lines[-1]["finished"])
PY
is 'is lines of JSON, the last of a task says so' "$(python3 judge.py <.log/err)" 'True True True True 0.0 True True True'
ok 'short work' vam-slice --shape sphere --voxel 1 --progress json -o short.vdb
is 'says so, too' "$(sed 's/[0-9.]*,"left_s"/N,"left_s"/' .log/err)" \
  '{"tool":"vam-slice","task":"slicing","done":12,"total":12,"elapsed_s":N,"left_s":0.0,"finished":true}'
# Interrupted once it has begun; without --patience 0 it may have ended by itself until then.
(exec env --default-signal=INT vam-optimize --method pm --iterations 9999 --patience 0 --angles 90 part.vdb --progress json \
  -o y.exr 2>cut) & long=$!
ok 'work begins' await grep -q '"task":"optimising".*"finished":false' cut
kill -INT $long; wait $long
is 'where it is interrupted' $? 130
is 'it is not said to be finished' "$(grep -c '"task":"optimising","done".*"finished":true' cut)" 0
done_testing
