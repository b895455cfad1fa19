# SPDX-License-Identifier: GPL-3.0-or-later
# A printer file that was cut off: no tool takes its own for whole, and vam-print takes nobody's.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH

vam-slice --print-printer --set vial.radius_mm=10 -o whole.toml
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
: >frames.exr
vam-print frames.exr --display null: --uncalibrated --printer hand.toml --run run >out 2>err
is 'and nothing is printed from it' "$? $(grep -c '^vam-print: hand.toml: ends within a line, as if it was cut off; complete its last line$' err) $(ls -d run 2>/dev/null)" '65 1 '

done_testing
