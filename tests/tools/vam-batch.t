# SPDX-License-Identifier: GPL-3.0-or-later
# A queue of parts: what is missing is made, in pieces too, and what fails is named.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH

box 3 3 2 >box.off
vam-slice --print-printer --set projector.telecentric=true -o level.toml
queue() {  # queue LINE...: parts.tsv, its cells apart by |
  printf '%s\n' "$@" | tr '|' '\t' >parts.tsv
}
optimize='--method dose-norm --angles 12'
queue 'part|name|printer|slice|optimize|pieces' '# a comment' "box.off|one|level.toml|--voxel 0.2|$optimize|1" '' \
  "box.off|two|level.toml|--voxel '0.2'|$optimize|2"
vam-batch --plan parts.tsv >plan
is '--plan prints the commands' "$(grep -c '^vam-' plan)" 8
[ ! -e batch ]; report $? 'and makes nothing'
quiet 'a queue is made' vam-batch --jobs 2 parts.tsv
is 'a line for each part' "$(cut -f 1 batch/summary.tsv | tr '\n' ' ')" 'name one two '
is 'with its figures' "$(awk -F '\t' 'NR > 1 && $2 >= 0 && $4 > 0.5' batch/summary.tsv | wc -l)" 2
vam-optimize batch/two.vdb --method dose-norm --angles 12 --printer level.toml | vam-convert join -o whole.exr
same 'joined pieces are the undivided stack' batch/two.exr whole.exr
is 'a second run does nothing' "$(vam-batch --plan parts.tsv | grep -c '^vam-')" 0
is 'the beginning of each result is kept' "$(cut -f 1 batch/begun.tsv | grep '^batch/two' | sort | tr '\n' ' ')" \
  'batch/two.1.exr batch/two.2.exr batch/two.exr batch/two.json batch/two.vdb '
rm batch/two.2.exr
is 'a lost piece is made again' "$(vam-batch --plan parts.tsv | grep '^vam-' | cut -d ' ' -f 1 | tr '\n' ' ')" 'vam-optimize vam-convert vam-dose '
quiet 'and joined' vam-batch parts.tsv
same 'in the same bytes' batch/two.exr whole.exr
sed -i '3s/--angles 12/--angles 10/' parts.tsv
is 'other settings make one part again' "$(vam-batch --plan parts.tsv | grep '^vam-' | cut -d ' ' -f 1 | tr '\n' ' ')" 'vam-slice vam-optimize vam-dose '

echo junk >batch/one.state
quiet 'with no checkpoint of the former ones' vam-batch -- parts.tsv
queue 'part|name|slice|optimize' "box.off|empty|--voxel 0.4 --unit \"\" '\\x' \\y|$optimize"
is 'empty words and quoted backslashes are kept' "$(vam-batch --plan parts.tsv | sed -n 's/.*--unit \(.*\) -o .*/\1/p')" "'' \\\\x y"
queue 'part|printer' 'box.off|opencal,vial-16'
is 'presets are a printer' "$(vam-batch --plan parts.tsv | grep -c '^vam-.*--printer opencal,vial-16')" 3
queue 'part|slice' 'box.off|--voxel 0.4'
is '$VAM_PRINTER is followed' "$(VAM_PRINTER=level.toml vam-batch --plan parts.tsv | grep -c '^vam-.*--printer level.toml')" 3

# ---- one run at a time, which ends with its tools ----------------------------------------------------------------------
cat >endless <<'SH'
#!/bin/sh
# Makes nothing for a minute.
[ "$2" = --version ] || { echo $$ >pid; exec sleep 60; }
SH
chmod +x endless
vam-batch --folder held --prefix ./endless parts.tsv 2>errors & batch=$!
await test -s pid
fails 75 'held: another vam-batch makes it' vam-batch --folder held parts.tsv
kill $batch; wait $batch; is 'SIGTERM ends it' $? 143
! kill -0 "$(cat pid)" 2>/dev/null; report $? 'and its tools'

# ---- what fails ------------------------------------------------------------------------------------------------------
cat >twice <<'SH'
#!/bin/sh
# Fails the first time.
[ -e tried ] || case $1 in vam-dose) touch tried; exit 1 ;; esac
exec "$@"
SH
chmod +x twice
vam-batch --prefix ./twice parts.tsv 2>errors; is 'what fails is tried again' "$? $([ -e tried ] && echo tried)" '0 tried'
queue 'part|optimize|slice|name' "box.off|$optimize|--voxel 0.4|good" 'box.off|--angles 0||bad'
vam-batch --retries 0 parts.tsv 2>errors; is 'a part that fails is named' "$? $(grep -c '^vam-batch: bad: is incomplete' errors)" '1 1'
[ -s batch/good.json ]; report $? 'the others are made'
queue 'part|optimize' "box.off|--method 'cal' \$(touch pwned) ; touch pwned & \`touch pwned\`"
vam-batch --retries 0 parts.tsv >/dev/null 2>&1
[ ! -e pwned ] && [ ! -e batch/pwned ]; report $? 'no cell is run'

# ---- forecast: one worker takes the sum of all times, many as long as the longest chain ---------------------------------
mkdir told
took() {  # took TARGET SECONDS
  touch -d @100 "told/$1" && printf 'told/%s\t%s\n' "$1" $((100 - $2)) >>told/begun.tsv
}
took a.vdb 9; took a.vdb 2; took a.1.exr 8; took a.2.exr 6; took a.exr 1; took a.json 3; took b.exr 5
queue 'part|name|pieces' 'box.off|a|2' 'box.off|b|1'
forecast() { vam-batch --forecast --folder told parts.tsv | awk -F '\t' -v workers="$1" '$1 == workers { print $2, $3, $4 }'; }
is 'a worker takes the sum, with the last time of each target' "$(forecast 1)" '30.0 30.0 1.00'
# b.exr waits until the shorter piece of a is made: it runs from 8 to 13, and its score to 16.
is 'two workers' "$(forecast 2)" '16.0 32.0 0.94'
is 'many take as long as the longest chain' "$(forecast 64)" '14.0 896.0 0.03'
rm told/*.exr
fails 65 "told: has no result of the stage '(piece|join|optimize)'" vam-batch --forecast --folder told parts.tsv
fails 66 'none/begun.tsv: cannot open it; make some parts of the queue first' vam-batch --forecast --folder none parts.tsv

rm -rf batch; mkdir batch
fails 64 '^vam-batch: no queue given; see --help' vam-batch
fails 64 "--folder: 'a b' must consist of" vam-batch --folder 'a b' parts.tsv
fails 64 '--slurmy: unknown option' vam-batch --slurmy parts.tsv
refused() { queue "$3" "$4"; fails "$1" "$2" vam-batch parts.tsv; }  # refused STATUS REGEX LINE LINE
refused 65 "line 1: 'part name' is not one of the columns" 'part name' 'box.off'
refused 65 "line 1: names the column 'part' twice" 'part|part' 'box.off|box.off'
refused 65 'line 1: must name the columns, part among them' 'name' 'box'
refused 65 'line 2: has 2 cells, but the table has 1 columns' 'part' 'box.off|x'
refused 65 'line 2: has no part' 'part|name' '|x'
refused 66 'line 2: none.off: cannot open it' 'part' 'none.off'
refused 66 'line 2: opncal: is no file, and no preset.*opencal' 'part|printer' 'box.off|opncal'
refused 65 "line 2: 'a b.off' must consist of letters" 'part' 'a b.off'
refused 65 "line 2: the name '../x' must" 'part|name' 'box.off|../x'
refused 65 "line 2: pieces is '0'" 'part|pieces' 'box.off|0'
refused 65 "line 2: pieces is '501', not a whole number from 1 to 500" 'part|pieces' 'box.off|501'
refused 65 'line 2: the column slice has an open quote' 'part|slice' "box.off|--voxel '0.2"
queue 'part' 'box.off' 'box.off'
vam-batch parts.tsv 2>errors; is 'a name that is taken' "$? $(grep -c "line 3: the name 'box' is taken" errors)" '65 1'
queue 'part'; fails 65 'has no part; write one per line' vam-batch parts.tsv

queue 'part|slice|optimize' "box.off|--voxel 0.4|$optimize"; mkdir batch/summary.tsv
fails 73 'batch/summary.tsv: cannot be written' vam-batch parts.tsv
mkdir bare; for program in bash dirname readlink; do ln -s "$(command -v $program)" bare; done
fails 69 'no GNU make on this machine; install make' env PATH="$PWD/bare" bash "$VAM_SOURCE/scripts/vam-batch" parts.tsv
[ ! -e batch/log ]; report $? 'logs are those of Slurm'

printf 'part\n-dash.stl\n' >dash.tsv
fails 65 "'-dash.stl' begins with a dash; write ./-dash.stl" vam-batch --plan dash.tsv
if ! command -v sbatch >/dev/null; then
  fails 69 '--slurm: no sbatch on this machine' vam-batch --slurm parts.tsv
fi
done_testing
