# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# The line on a terminal and the page that refreshes itself, in a real browser if there is one.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration=9000&min_angle=-1e7&max_angle=1e7"\nspeed_deg_s = 90\n' >>printer.toml
printf '[camera]\ndevice = "sim:?lit=2"\nfps = 20\nexposure_us = 5000\nbinning = 4\n# end of the settings\n' >>printer.toml
print() { vam-print frames.exr --display null: --light sim: --max-missed 0.9 --run-up 0.05 --uncalibrated --view-step 20 "$@"; }

fails 64 '^vam-print: --run-page: takes no value' vam-print frames.exr --display null: --run-page=x

# On a terminal: the line, refreshed in place, and the page.
script -qefc "TERM=dumb vam-print frames.exr --display null: --light sim: --max-missed 0.9 --run-up 0.05 --uncalibrated --view-step 20 --turns 3 --run-page --run run" typed \
  >/dev/null 2>&1 & printing=$!
await test -s run/page.html
sleep 3
if vam-status run >line; then cp run/page.html during.html; fi
wait $printing; is 'a print that is watched has status 0' $? 0
ok 'the line states the progress' grep -Eq '^(preparing|run-up, dark|printing)  turn [0-9.]+ of 3  angle [0-9.]+ deg  dose delivered [0-9.]+ %  missed [0-9]+ of [0-9]+ vertical blanks' line
holds 'the line is refreshed on the terminal' "$(tr '\r' '\n' <typed | grep -c 'dose delivered') > 2"
is 'at the end' "$(vam-status run | sed 's/  angle .* deg\(  dose delivered [0-9.]* %\).*/\1/')" 'ended: done  turn 3.00 of 3  dose delivered 100.0 %'
is 'the same with --watch, once' "$(vam-status run --watch | grep -c .)" 1
ok 'the page is among the hashes' grep -q page.html run/SHA256SUMS
ok 'and unchanged' sh -c 'cd run && sha256sum --check --quiet SHA256SUMS'
is 'and no longer refreshed' "$(grep -c http-equiv=.refresh during.html) $(grep -c http-equiv=.refresh run/page.html)" '1 0'
print --run quiet >out 2>err
is 'without a terminal no line is printed and no page written' "$? $(cat out err | grep -c .) $(ls quiet | grep -c html)" '0 0 0'

# Progress after half of the flips: the dose is that of vam-dose on the same log.
cp -r run half
rm half/SHA256SUMS half/summary.json  # which a print writes at its end
sed -i '/"event":"end"/d;/"event":"sealed"/d' half/events.jsonl
head -n $(($(wc -l <run/flips.jsonl) / 2)) run/flips.jsonl >half/flips.jsonl
unchain half/*.jsonl
last=$(tail -n 1 half/flips.jsonl | grep -o '"angle_deg":[-0-9.e]*' | cut -d: -f2)
last_s=$(tail -n 1 half/flips.jsonl | grep -o '"t_monotonic_s":[0-9.]*' | cut -d: -f2)
printf '{"t_monotonic_s":%s,"angle_deg":%s,"sigma_deg":0}\n{"t_mono' "$last_s" "$last" >half/angles.jsonl
touch half/events.jsonl
given=$(vam-status half | sed 's/.*dose delivered \([0-9.]*\) %.*/\1/')
ok 'vam-dose on it' vam-dose frames.exr --shown half --printer half/printer.toml --report dose.json -o dose.vdb
holds 'dose delivered' "($given / 100 - $(json dose.json shown_turns) / 3) ^ 2 < 0.01 ^ 2"
touch -d '1 hour ago' half/*.jsonl
ok 'watching it ends, too' sh -c 'timeout 20 vam-status half --watch >watched && grep -q "end not logged" watched'
ok 'a print that was killed' sh -c 'vam-status half | grep -q "^no log entry for 3[56][0-9][0-9] s; end not logged"'
echo '{"turns":1.5,"missing_percent":34.25,"iou":0.5}' >half/ost.jsonl
echo '{"event":"hold","volume":1,"reason":"the sensitivity is known to 9 % only"}' >half/renewed.jsonl
vam-status half --page held.html >/dev/null
ok 'the page tells why there is no new light' grep -q 'as before: the sensitivity is known to 9 % only' held.html
echo '{"event":"renewed","volume":2,"from_turn":11,"turns":2,"end":13,"sensitivity":0.953}' >>half/renewed.jsonl
mkdir half/renewed
vam-slice --shape box:x=4,y=4,z=3 --voxel 0.5 --stretch-z 1 -o box.vdb
vam-convert box.vdb -o box.npy; vam-convert box.npy --voxel 0.5 --grid sensitivity --value-unit relative -o half/renewed/sensitivity.vdb
vam-status half --page new.html >/dev/null
ok 'or from when on' grep -q 'from turn 11 on, for 2 turns: sensitivity 0.953' new.html
ok 'with the sensitivity' grep -q 'Sensitivity of the resin' new.html
rm -r half/renewed half/renewed.jsonl
ok 'live metrology' sh -c 'vam-status half | grep -q "cured 65.8 %, missing 34.2 %"'

for tool in vam-check vam-status; do
  $tool run >&- 2>err; is "$tool: nowhere to write to" "$? $(grep -c "^$tool: stdout: cannot" err)" '74 1'
done

# The dose of a run by its own sinogram.
ok 'the dose of a run' vam-dose frames.exr --shown run -o given.vdb --report given.json
ok 'by the sinogram that it links to' sh -c 'vam-dose --shown run -o own.vdb --report own.json </dev/null'
is 'is the same' "$(json own.json dose_shown_max_relative)" "$(json given.json dose_shown_max_relative)"
ok 'one that comes through a pipe goes before it' sh -c 'cat frames.exr | vam-dose --shown run -o own.vdb'
fails 64 'SINOGRAM: is missing, and run/flips.jsonl has no sinogram.exr; give the one that was shown' sh -c 'vam-dose --shown run/flips.jsonl -o x.vdb </dev/null'
cp -r run part; rm part/sinogram.exr
fails 64 'SINOGRAM: is missing, and part has no sinogram.exr' sh -c 'vam-dose --shown part -o x.vdb </dev/null'
rm -r part

# A print that has ended is held to its hashes: what was cut, changed, lost or added since is named.
spoil() { rm -rf part; cp -r run part; }
ok 'a run folder is verified' sh -c "vam-check run | grep -Eqx 'run: run folder of [0-9]+ files, sealed'"
for log in events.jsonl flips.jsonl angles.jsonl stage.jsonl capture.jsonl printer.toml summary.json project.json views/manifest.jsonl; do
  for change in 'sed -i $d' 'sed -i 1s/[a-z{]/Q/' rm; do
    [ "$change" != 'sed -i $d' ] || case $log in *.json) continue ;; esac
    spoil; $change part/$log
    what='(:1)?: (changed after the print \(its hash is not that in SHA256SUMS\); restore the original file|does not follow .*; restore it)'
    [ "$change" != rm ] || what=': is gone, but SHA256SUMS lists it; restore it'
    for tool in vam-status 'timeout 20 vam-status --watch' vam-check; do fails 65 "part/$log$what\$" $tool part; done
  done
done
spoil; printf x >>part/page.html; printf x >>part/views/000003.png; rm part/views/000004.png; echo >part/views/000099.png
vam-check part >said 2>err
is 'all that is wrong is named' "$? $(cat said | sed 's/[0-9][0-9]*/N/')" '65 part: run folder of N files, damaged'
for what in 'page.html: changed' 'views/000003.png: changed' 'views/000004.png: is gone' 'views/000099.png: is not in SHA256SUMS: it was added'; do
  ok "$what" grep -q "part/$what" err
done
is '--fast looks for names only' "$(vam-check --fast part 2>&1 | grep -c 'part/')" 2
ok 'the line needs none of these' vam-status part
spoil; echo '{"utc":"2026-11-27T10:00:00Z","resumed_by":"/prints/rest"}' >part/resumed.json
ok 'that it was resumed is no damage' vam-check part
ok 'and is said' sh -c "vam-status part | grep -q \"  resumed by '/prints/rest'\$\""
for mark in '' '{}' '{"utc":"2026-11-27T10:00:00Z","resumed_by":""}' garbage; do
  printf %s "$mark" >part/resumed.json
  fails 65 'part/resumed.json: does not say when and by which print this one was resumed' vam-check part
done
echo '{"utc":"2026-11-27T10:00:00Z","resumed_by":"a","resumed_by":"b"}' >part/resumed.json
fails 65 "part/resumed.json: has the key 'resumed_by' twice" vam-check part
rm part/resumed.json; mkdir part/resumed.json; fails 65 'part/resumed.json: is not a regular file' vam-check part
spoil; rm part/SHA256SUMS part/summary.json
fails 65 'part: has no SHA256SUMS and no whole summary.json, which a print writes within a minute of its end .done, by events.jsonl.; wait, or restore both' vam-check part
# A lack of the system says nothing of the folder.
prlimit --nofile=4 vam-check run 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&- >said 2>err
is 'too few open files are no damage' "$? $(cat said) $(grep -c 'Too many open files; raise the limit' err)" '71  1'

# Links: that to the sinogram is held to the hash in the events, and no other is of a print.
is 'the sinogram is a link' "$(readlink run/sinogram.exr)" "$PWD/frames.exr"
spoil; rm part/sinogram.exr; cp frames.exr part/sinogram.exr; ok 'or its copy' vam-check part
$exr make other.exr space=projector width=64 height=36 count=2
cp other.exr part/sinogram.exr; fails 65 'part/sinogram.exr: is not the sinogram of part, whose SHA-256 begins' vam-check part
ln -sf ../other.exr part/sinogram.exr; fails 65 'part/sinogram.exr: is not the sinogram of part' vam-check part
ln -sf gone part/sinogram.exr
vam-check part >said 2>err
is 'a sinogram that is gone is told' "$? $(head -n 1 said | sed 's/[0-9][0-9]*/N/') $(cat err)" \
  '0 part: run folder of N files, sealed vam-check: warning: part/sinogram.exr: links to gone, which cannot be read, so that the sinogram was not verified; restore it, or remove the link'
for name in more.json views/more.png views2; do
  spoil; ln -s ../run/views "part/$name"; fails 65 "part/$name: is not in SHA256SUMS: it was added" vam-check part
done
for change in 'events.jsonl 1s/^{/{"event":"x",/' 'flips.jsonl 1s/^{/{"event":"x",/' 'summary.json s/"outcome"/"event":1,"event":2,&/'; do
  spoil; rm part/SHA256SUMS; sed -i "${change#* }" "part/${change%% *}"
  fails 65 "part/${change%% *}.*: has the key 'event' twice in one object" vam-status part
done
spoil; rm part/SHA256SUMS
vam-status part >said 2>err
is 'a print without the list is said to be unverified' "$? $(sed 's/[0-9][0-9]* of .*/N/' err)" \
  '0 vam-status: warning: part: has no SHA256SUMS, which a print writes when it has ended: it was killed, or the list is gone; only its logs are verified: flips.jsonl is sealed up to byte N'
is 'once' "$(timeout 20 vam-status part --watch 2>&1 >x | grep -c 'has no SHA')" 1
for change in '$d' '3s/^./x/' '/events/d' '/flips/d' '1s/^/ /' '1p' '1s|\./|../|' '1s|\./|/|'; do
  spoil; sed -i "$change" part/SHA256SUMS
  ok "a list changed by $change" sh -c 'vam-check part 2>&1 | grep -Eq "SHA256SUMS: line [0-9]+: (is not a hash and the name of a file in the folder|names a file for the second time)|is not in SHA256SUMS: it was added after the print, or the list was cut"'
done
spoil; sed -i /events/d part/SHA256SUMS; fails 65 'part/SHA256SUMS: has no hash of events.jsonl; it was cut' vam-status part
spoil; : >part/SHA256SUMS; fails 65 'part/SHA256SUMS: is empty; it was cut; restore it' vam-status part
rm part/SHA256SUMS; fails 65 'part: has no SHA256SUMS, which a print writes when it has ended' vam-check part
for spoiling in ': >part/events.jsonl' 'rm part/events.jsonl' 'sed -i "\$d" part/events.jsonl'; do
  spoil; rm part/SHA256SUMS; eval "$spoiling"
  timeout 20 vam-status part --watch >said 2>err
  is "without the list: $spoiling" "$? $(grep -c '^ended: done  turn 3.00 of 3 ' said) $(grep -c 'warning: part/events.jsonl: does not tell of the end that summary.json states' err)" '0 1 1'
done

# The light that was logged is held to the chain of its lines and to the events, without the list, too, in all that counts it.
cut_short='has [0-9]+ bytes of whole lines, but events.jsonl states [0-9]+ at [-0-9T:.]*Z; it was cut; restore it'
changed='[0-9]+: does not follow from the line before it; the log was changed; restore it'
for cut in "head -n 200" cat "grep -v '\"frame\":7,'" 'sed s/"angle_deg":1\(..[.]\)/"angle_deg":2\1/' 'sed s/"t_monotonic_s":./&1/' 'sed $!N;s/\(.*\)\n\(.*\)/\2\n\1/'; do
  spoil; rm part/SHA256SUMS
  case $cut in sed*) sed "${cut#sed }" run/flips.jsonl ;; *) eval "$cut run/flips.jsonl" ;; esac >part/flips.jsonl
  if cmp -s run/flips.jsonl part/flips.jsonl; then ok 'an unchanged log is read' vam-status part; continue; fi
  what=":$changed"; [ "$cut" != 'head -n 200' ] || what=": $cut_short"
  for tool in 'vam-status part' 'timeout 20 vam-status --watch part' 'vam-dose frames.exr --shown part -o x.vdb' 'vam-check part' 'vam-check part/flips.jsonl'; do
    fails 65 "part/flips.jsonl$what\$" $tool
  done
  (cd part && find . -type f -exec sha256sum {} + >../sums && mv ../sums SHA256SUMS)
  fails 65 "part/flips.jsonl$what\$" vam-check part
done
spoil; rm part/SHA256SUMS; unchain part/*.jsonl; sed -i '/"event":"sealed"/d' part/events.jsonl
ok 'a run without chains is read' vam-status part
is 'and said to be unsealed' "$(vam-check part | head -n 1)" 'part: run folder without SHA256SUMS, unsealed'
ok 'the log alone is held to the events, too' sh -c "vam-check run/flips.jsonl | grep -Eqx 'run/flips.jsonl: flips of a print: flips.jsonl is sealed up to byte ([0-9]+) of \1, sealed'"
spoil; rm part/SHA256SUMS; printf '{"utc' >>part/flips.jsonl; ok 'a line that was cut counts nowhere' vam-status part
rm part/flips.jsonl; fails 65 'part/flips.jsonl: is gone, but events.jsonl states [0-9]+ bytes of it; restore it' vam-status part
for spoiling in 'echo garbage >part/SHA256SUMS' ': >part/SHA256SUMS' 'rm part/angles.jsonl' 'rm part/summary.json' 'sed -i 2d part/flips.jsonl' 'sed -i /printer.toml/d part/SHA256SUMS'; do
  spoil; eval "$spoiling"
  vam-status part >said 2>err; status=$?
  fails 65 'part/(SHA256SUMS: (line 1: is not a hash|is empty|has no hash of printer.toml)|[a-z.]*: (is gone|changed after))' vam-dose frames.exr --shown part -o x.vdb
  is "vam-dose refuses what vam-status does: $spoiling" "$status $(sed 's/^vam-dose/vam-status/' .log/err)" "65 $(cat err)"
done

# A print whose end is not in the logs, and that nobody prints: it is over, whatever the times of its files say.
lost_end() { spoil; rm part/SHA256SUMS part/summary.json; sed -i '$d' part/events.jsonl; }
lost_end; touch -d '1 day' part/*.jsonl
is 'at the planned end' "$(timeout 20 vam-status part --watch | sed 's/  angle .*//')" 'end not logged  turn 3.00 of 3'
is 'no time is left' "$(vam-status part | grep -c left)" 0
lost_end; exec 8<part/events.jsonl; flock 8  # as vam-print does
is 'while it is held it goes on' "$(vam-status part | sed 's/  angle .*  / | /')" 'printing  turn 3.00 of 3 | 0:00 left'
exec 8<&-
lost_end; rm part/events.jsonl; touch -d '1 hour ago' part/*
is 'without events' "$(timeout 20 vam-status part --watch | sed 's/  angle .*//;s/for [0-9]* s/for N s/')" 'no log entry for N s; end not logged  turn 3.00 of unknown'

# Folders of prints that have just begun, or were killed at once: logs that are missing, empty or cut.
without() { rm -rf part; cp -r run part; rm -f part/SHA256SUMS part/summary.json; for f; do : >part/$f.jsonl; done; }
line_of() { vam-status --quiet part 2>&1 | sed 's/  angle .* deg  / | /;s/for [0-9]* s/for N s/'; }
without; rm part/*.jsonl
is 'settings but no log yet' "$(line_of)" 'preparing  turn 0.00 of unknown | dose delivered unknown  missed 0 of 0 vertical blanks'
rm part/printer.toml; echo '{}' >part/calibration.json
is 'no settings yet' "$(line_of)" 'preparing  turn 0.00 of unknown | dose delivered unknown  missed 0 of 0 vertical blanks'
mkdir own; printf '[stage]\nspeed_deg_s = 90\n' >own/printer.toml
fails 65 'own: has no events.jsonl' vam-status own
without events
is 'events are lost: the number of turns and the dose are unknown' "$(line_of | sed 's/[0-9]* of [0-9]* vert/N of N vert/')" \
  'printing  turn 3.00 of unknown | dose delivered unknown  missed N of N vertical blanks'
without; rm part/printer.toml; sed -i '$d' part/events.jsonl
for tool in vam-status 'timeout 20 vam-status --watch' vam-check; do
  fails 65 'part/printer.toml: is gone, without which the print can be neither resumed nor its dose computed; restore it' $tool part
done
without; rm part/printer.toml
is 'the settings are lost, and with them the speed' "$(line_of | sed 's/  missed.*//')" 'ended: done  turn 3.00 of 3 | dose delivered unknown'
for log in angles flips stage; do
  for tool in vam-check vam-status; do
    without $log; fails 65 "part/$log.jsonl: $cut_short" $tool part
    rm part/$log.jsonl; fails 65 "part/$log.jsonl: is gone, but events.jsonl states" $tool part
  done
done
without flips angles stage capture; sed -i '/"event":"sealed"/,$d' part/events.jsonl; touch -d '1 hour ago' part/*
is 'killed before light' "$(line_of)" 'no log entry for N s; end not logged  turn 0.00 of 3 | dose delivered 0.0 %  missed 0 of 0 vertical blanks'
bad=0
for log in events flips angles stage; do
  for tenths in 1 3 5 7 9; do
    without; head -c $(($(stat -c %s run/$log.jsonl) * tenths / 10)) run/$log.jsonl >part/$log.jsonl
    wanted="part/$log.jsonl: .*; it was cut; restore it$"; [ $log != events ] || wanted=' turn [0-9.]* of '
    [ "$(vam-status part 2>&1 | grep -c "$wanted")" = 1 ] || bad=$((bad + 1))
  done
done
is 'cut anywhere: one line' $bad 0
without events flips angles stage capture
ok 'a page of empty logs' vam-status part --page bare.html

# What is no file in the place of one, a link that leads nowhere, and a file beyond all sizes: one line, and no waiting.
odd=0
for name in events.jsonl flips.jsonl angles.jsonl stage.jsonl capture.jsonl ost.jsonl printer.toml calibration.json; do
  for what in 65:mkfifo 65:mkdir 66:'ln -s gone' 65:'ln -s /dev/zero' '(0|65):truncate -s 20G'; do
    without; rm -f part/$name; ${what#*:} part/$name
    timeout 2 vam-status --quiet part >.log/out 2>.log/err; status=$?
    echo $status | grep -Eqx "${what%%:*}" && [ "$(wc -l <.log/err)" = $((status > 0)) ] && continue
    odd=$((odd + 1)); echo "# $what $name: $status"; sed 's/^/# /' .log/err
  done
done
is 'links, pipes, folders and endless files for logs end at once' $odd 0
for name in sinogram.exr views/manifest.jsonl renewed.jsonl renewed/sensitivity.vdb camera.png; do
  for what in mkfifo 'truncate -s 20G'; do
    without; rm -rf part/views; mkdir -p part/views part/renewed; rm -f part/$name; $what part/$name
    timeout 4 vam-status part --page odd.html >.log/out 2>.log/err; status=$?
    case "$status $(grep -vc 'has no SHA256SUMS' .log/err)" in '0 0' | '0 1' | '65 1') continue ;; esac
    odd=$((odd + 1)); echo "# $what $name: $status"; sed 's/^/# /' .log/err
  done
done
is 'and so they do for what a page shows' $odd 0
without; echo '{"event":{},"from_turn":"x","turns":1e300}' >part/renewed.jsonl
ok 'a log of other types' vam-status part --page odd.html
rm -rf part

# Names of folder, records and outcome are escaped.
hostile='<img src=x onerror=document.title=1>&amp;"'
mv half "$hostile"
cat >"$hostile/calibration.json" <<'JSON'
{"edges": {"utc": "2026-11-22T10:00:00Z", "valid_until": "</td><script>document.title=2</script>", "status": "pa\u001bss"},
 "<b onmouseover='x'>": {"utc": 7, "valid_until": [], "status": null}}
JSON
ok 'a page of hostile names' vam-status "$hostile" --page page.html
is 'contains no element of theirs' "$(grep -Ec '<img src=x|<b onm|document\.title=2</script>' page.html)" 0
rm "$hostile/sinogram.exr"
vam-status "$hostile" --page bare.html 2>bare.err
is 'a page without sinogram, which is reported' "$? $(grep -c 'the page is written without projections and dose' bare.err) $(grep -c '<svg' bare.html)" '0 1 0'
fails 74 '/dev/full: ' vam-status run --page /dev/full
vam-status run --page - | head -c 100 >/dev/null; report 0 'a page to head'
is 'no line on standard output to a full disk' "$(vam-status run 2>&1 >/dev/full | grep -c .)" 1

# As a browser shows it, over file://, with the images.
find_browser
look() { timeout 60 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$PWD/.log/browser" "$@" 2>.log/browser.err; }
dom() { look --dump-dom "$@" >dom.html; }
dom "file://$PWD/page.html"
is 'the title is text' "$(grep -c '<title>no log entry for [0-9]* s; end not logged - &lt;img src=x onerror=document.title=1&gt;&amp;amp;"</title>' dom.html)" 1
is 'no name becomes an element' "$(grep -Ec '<b onm|<img src="x"' dom.html)" 0
look --screenshot="$PWD/page.png" --window-size=1100,1200 "file://$PWD/during.html" >/dev/null
python3 - <<'PY' >colours
import subprocess, struct, zlib
def pixels(path):
    data = open(path, 'rb').read()
    width, height = struct.unpack('>II', data[16:24])
    kind = data[25]
    at, packed = 8, b''
    while at < len(data):
        size, name = struct.unpack('>I4s', data[at:at + 8])
        if name == b'IDAT': packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, step = zlib.decompress(packed), 4 if kind == 6 else 3
    above, rows = bytearray(width * step), []
    for y in range(height):
        line = bytearray(raw[y * (width * step + 1):(y + 1) * (width * step + 1)])
        how, line = line[0], line[1:]
        for i in range(len(line)):
            left = line[i - step] if i >= step else 0
            corner = above[i - step] if i >= step else 0
            if how == 1: line[i] = line[i] + left & 255
            elif how == 2: line[i] = line[i] + above[i] & 255
            elif how == 3: line[i] = line[i] + (left + above[i] >> 1) & 255
            elif how == 4:
                p = left + above[i] - corner
                best = min((abs(p - left), 0, left), (abs(p - above[i]), 1, above[i]), (abs(p - corner), 2, corner))[2]
                line[i] = line[i] + best & 255
        rows.append(line); above = line
    return width, height, step, rows
width, height, step, rows = pixels('page.png')
red = sum(1 for row in rows for x in range(0, len(row), step) if row[x] > 180 and row[x + 1] < 40 and row[x + 2] < 40)
violet = sum(1 for row in rows for x in range(0, len(row), step) if 55 < row[x] < 85 and row[x + 1] < 40 and 75 < row[x + 2] < 120)
print(width, height, red > 20, violet > 2000)
PY
is 'the mark and the dose are drawn' "$(cat colours)" '1100 1200 True True'
# The page refreshes itself: an open browser shows a later version.
sed 's/content="2"/content="1"/' during.html >renewed.html
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$PWD/.log/open" --remote-debugging-port=0 \
  "file://$PWD/renewed.html" >/dev/null 2>&1 & viewer=$!
titles() {
  python3 -c 'import sys, urllib.request as u; print(u.urlopen("http://127.0.0.1:%s/json/list" % open(sys.argv[1]).readline().strip()).read().decode())' \
    .log/open/DevToolsActivePort 2>/dev/null
}
shows() { titles | grep -q "$1"; }
await shows '"title": "[a-z, -]* - run"'; report $? 'a browser has the page open'
sed -i 's/<title>/<title>later /' renewed.html
await shows '"title": "later [a-z, -]* - run"'; report $? 'and shows what is written later'
kill $viewer; wait $viewer 2>/dev/null
done_testing
