# SPDX-License-Identifier: GPL-3.0-or-later
# A printer file that was cut off: no tool takes its own for whole, and vam-print takes nobody's.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH

vam-slice --print-printer --set vial.radius_mm=10 -o whole.toml
cp whole.toml named.json
box 4 4 1 >box.off
quiet 'a printer file is written over itself' vam-slice --print-printer --printer whole.toml -o whole.toml
same 'and says the same' whole.toml named.json
fails 64 'named.json: is also the input' env VAM_PRINTER=named.json vam-slice box.off --voxel 0.5 -o x.vdb --report named.json
mv named.json printer.toml
quiet 'also the one that is found' vam-project --print-printer -o printer.toml
fails 64 'printer.toml: is also the input' vam-slice box.off --voxel 0.5 -o printer.toml
same 'the printer file is kept' whole.toml printer.toml
rm printer.toml
ok 'what the shell makes for the output is no printer file' sh -c 'vam-slice --print-printer >printer.toml'
ok 'and is one then' vam-slice --print-printer -o again.toml
rm printer.toml again.toml
size=$(wc -c <whole.toml)
ok 'the whole file is read' vam-slice --print-printer --printer whole.toml -o again.toml
same 'and says the same' whole.toml again.toml
for part in 1 3 10 50 90 99; do
  head -c $((size * part / 100)) whole.toml >cut.toml
  fails 65 'cut.toml: is cut off after' vam-slice --print-printer --printer cut.toml -o x.toml
done
grep -v '^# end of the settings' whole.toml >cut.toml
fails 65 'is cut off after .* write it again' vam-slice --print-printer --printer cut.toml -o x.toml

printf '[projector]\nfps = 8\n[vial]\nradius_mm = 1' >hand.toml
vam-slice --print-printer --printer hand.toml -o x.toml 2>err
is 'a file by hand is warned of' "$? $(grep -c 'hand.toml: ends within a line.*\[bath\], \[resin\]' err)" '0 1'
mkdir tiny && (cd tiny && tiny_print ../frames.exr)
vam-print frames.exr --display null: --uncalibrated --printer hand.toml --run run >out 2>err
is 'and nothing is printed from it' "$? $(grep -c '^vam-print: hand.toml: ends within a line, as if it was cut off, .*; complete its last line$' err) $(ls -d run 2>/dev/null)" '65 1 '
{ echo '# bench 3, of May'; cat whole.toml; } | head -n 40 >cut.toml
fails 65 'cut.toml: is cut off after' vam-check cut.toml

# The file of an instrument as a person writes it, cut at the end of each line: what is not warned of has lost nothing, or
# a part of its last section, or is as short as what somebody writes who wants to change a few settings.
sed '/^#/d; s/ *#.*//; /= 0.0$/d; /= ""$/d; /^$/d' whole.toml >hand.toml
lines=$(wc -l <hand.toml)
begin=$(grep -n '^\[calibration\]' hand.toml | cut -d: -f1)
quiet 'whole' vam-check hand.toml
for count in $(seq $((lines - 1))); do
  head -n "$count" hand.toml >cut.toml
  vam-check cut.toml >out 2>err || echo "line $count: status $?"
  grep -q ', as if it was cut off' err || echo "$count"
done >silent
is 'and silent are the first 9 keys and the last section' "$(tr '\n' ' ' <silent)" \
  "$(seq 3 11 | tr '\n' ' ')$(seq $((begin + 1)) $((lines - 1)) | tr '\n' ' ')"
head -n $((begin - 1)) hand.toml >cut.toml
vam-print frames.exr --display null: --uncalibrated --printer cut.toml --run run >out 2>err
is 'nothing is printed from such a file, either' "$? $(grep -c "^vam-print: cut.toml: ends after \[optimize\], as if it was cut off, without \[calibration\]; add .*'# end of the settings'" err) $(ls -d run 2>/dev/null)" '65 1 '
fails 65 'cut.toml: ends after ' vam-check --seal cut.toml
echo '# end of the settings' >>cut.toml
quiet 'unless it says that it is whole' vam-slice --print-printer --printer cut.toml -o x.toml

done_testing
