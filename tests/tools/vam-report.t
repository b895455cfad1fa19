# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# One page from the files of a print: what is on it, that nothing from outside becomes an element, and what a browser
# makes of it.
. "$VAM_SOURCE/tests/tools/testlib.sh"

box 5 3 2 >part.off
vam-slice part.off --voxel 0.25 -o part.vdb
vam-optimize part.vdb --angles 60 --iterations 8 --trace trace.csv --report light.json -o light.exr
vam-dose light.exr --like part.vdb -o dose.vdb
vam-score dose.vdb --target part.vdb --report score.json >table
vam-view part.vdb -o part.png

ok 'a page of a whole print' vam-report part.vdb light.exr dose.vdb light.json score.json trace.csv part.png -o report.html
is 'the page begins with the verdict of vam-score' "$(sed -n 's/.*<p class="verdict [a-z]*">\(.*\)<.p>/\1/p' report.html)" "$(sed -n 's/; dose and time are relative without.*//; s/^verdict *//p' table)"
is 'the page loads nothing' "$(grep -Eoc 'src="[^d]|href=|@import|url\(|https?:' report.html)" 0
for words in 'Part and print' 'target, sections across z' 'dose, sections across y' 'Projections' 'Sinograms' \
  'Dose in part and void' 'Convergence' 'score.json, vam-score/1' 'vam-optimize 0' 'part.png'; do
  ok "it has: $words" grep -q -- "$words" report.html
done
# Merged facets would leave the surface by more than a voxel, and colours between their corners would be guessed.
cat >edges.py <<'PY'
import array, base64, json, math, re, sys
box = re.search(r'class="body".*?<script[^>]*>(.*?)</script>', open(sys.argv[1]).read(), re.S).group(1)
low, high, layers = json.loads(box)
for places, _, corners in layers:
    places, corners = array.array("H", base64.b64decode(places)), array.array("H", base64.b64decode(corners))
    points = [[a + (b - a) * n / 65535 for a, b, n in zip(low, high, places[at:at + 3])] for at in range(0, len(places), 3)]
    print(max(math.dist(points[corners[at]], points[corners[at + 1]]) for at in range(0, len(corners), 3)) < 3 * 0.25)
PY
is 'the surfaces have a corner in each voxel that they cut' "$(python3 edges.py report.html | tr '\n' ' ')" 'True True '
is 'the page says what its size is of' \
  "$(grep -o 'surface, where voxels of 0.25 mm are half covered, spans 5 x 3 x [^ ]* mm along x, y and z' report.html)" \
  'surface, where voxels of 0.25 mm are half covered, spans 5 x 3 x 1.97 mm along x, y and z'
ok 'the same page again' vam-report part.vdb light.exr dose.vdb light.json score.json trace.csv part.png -o again.html
is 'the pages are identical except for the file name' "$(sed 's/again\.html/report.html/g' again.html | cmp - report.html && echo same)" same
# A fin of 0.1 mm on 0.25 mm voxels, of which none is half covered, is there, and its section with what prints.
boxes '4 4 2 0 0 -1' '0.1 4 2' >fin.off
vam-slice fin.off --voxel 0.25 -o fin.vdb 2>/dev/null
vam-sinogram fin.vdb --angles 30 --filter ram-lak --negative clip | vam-dose --like fin.vdb -o fin-dose.vdb
ok 'a page of a part with a fin' vam-report fin.vdb fin-dose.vdb -o fin.html
is 'the design has the fin' "$(grep -o 'spans 4 x 4 x [0-9.]* mm' fin.html | grep -c 'x \(2.9\|3\)')" 1
ok 'sections of what prints' grep -q 'Part as printed, sections across z' fin.html
vam-slice --shape box:x=4,y=4,z=2 --insert-shape box:x=1,y=1,z=4 --voxel 0.25 --cut-insert -o held.vdb
ok 'a page of a part with an insert' vam-report held.vdb -o held.html
ok 'says that it is shown' grep -q 'The insert is green' held.html
# A target that is a dose for every voxel, here met nowhere but in the void, and one beyond the coverage of a part.
vam-score dose.vdb --target part.vdb --grey-target --band 0.2 >table.grey
ok 'a page of a grey target' vam-report part.vdb dose.vdb --grey-target --band 0.2 -o grey.html
is 'the page begins with the verdict of vam-score --grey-target' \
  "$(sed -n 's/.*<p class="verdict bad">\(.*\)<.p>/\1/p' grey.html)" "$(sed -n 's/^verdict *//p' table.grey)"
is 'it has its figures, and nothing that prints' "$(grep -c '<th>cv</th>' grey.html) $(grep -c 'Part as printed' grey.html)" '1 0'
vam-convert dose.vdb --stretch-z 1 -o dose.npy 2>/dev/null || vam-convert dose.vdb -o dose.npy
vam-convert dose.npy --voxel 0.25 --stretch-z 1 --value-unit mJ/cm3 -o prescribed.vdb
fails 65 "dose: is in relative, but the target is in mJ/cm3; make both in mJ/cm3" vam-report prescribed.vdb dose.vdb --grey-target -o x.html
mkdir folder && cp part.vdb dose.vdb score.json part.off folder
ok 'a page of a folder' vam-report folder -o folder.html --title 'A box'
is 'the page has its title' "$(grep -c '<title>A box</title>' folder.html)" 1
ok 'a page of a part only' vam-report part.vdb -o alone.html
is 'the page of a part says that it is not judged' "$(grep -c '<p class="verdict">Not judged: ' alone.html)" 1
vam-plan --shape box:x=3,y=2,z=1 --report plan.json >table.plan
ok 'a page of a plan' vam-report plan.json -o plan.html
is 'begins with its verdict' "$(sed -n 's/.*<p class="verdict good">plan.json: \(.*\)<.p>/\1/p' plan.html)" "$(sed -n 's/^verdict *//p' table.plan)"
ok 'a page of frames' sh -c 'vam-project light.exr --set projector.fps=2.5 -o frames.exr && vam-report frames.exr -o frames.html'
is 'frames can be played' "$(grep -c '>play<' frames.html)" 1
vam-report part.vdb | head -c 100 >/dev/null; report 0 'to head'

# An inspection: print, design and report of vam-sdf.
awk 'NR < 3 { print; next } NF == 3 { print 1.04 * $1, 1.02 * $2, $3; next } { print }' part.off >print.off
vam-sdf print.off part.off --align none --region top=plane:-9,-9,1.5,9,9,2.5 --scale-uncertainty 0.5 --require 'rms<=0.01' \
  -o deviation.ply --report inspection.json 2>/dev/null
ok 'a page of an inspection' vam-report deviation.ply part.off inspection.json -o inspection.html
is 'it begins with the verdict' "$(sed -n 's/.*<p class="verdict \([a-z]*\)">The print does not conform.*/\1/p' inspection.html)" bad
is 'it loads nothing' "$(grep -Eoc 'src="[^d]|href=|@import|url\(|https?:[^/]*//[^w]' inspection.html)" 0
for words in 'Print and design' 'section across z' '5.2 .* 0.052 mm (design 5 mm)' '3.06 .* 0.031 mm (design 3 mm)' 'expanded uncertainty, k = 2' \
  'top.flatness_mm' 'The last bin holds all beyond'; do
  ok "it has: $words" grep -q -- "$words" inspection.html
done
ok 'a page of the design and the report' vam-report part.off inspection.json -o design.html
is 'the design has no uncertainty' "$(grep -c 'Dimensions have expanded uncertainties' inspection.html design.html | tr '\n' ' ')" 'inspection.html:3 design.html:0 '
# A step at half height: the section would follow its face.
boxes '10 8 1 0 0 -1' '4 4 1' >step.off
ok 'a page of a part with a step' vam-report step.off -o step.html
ok 'its section lies beside the step' grep -q 'section across z at 0.06 mm' step.html
ok 'the others in the middle' grep -q 'section across x at 0 mm' step.html
sed 's/"guard_band": false/"guard_band": true/' inspection.json >damaged.json
fails 65 'damaged.json' vam-report deviation.ply damaged.json -o x.html

hostile='<img src=x onerror=document.title=1>&"'\''.vdb'
cp part.vdb "$hostile"
printf '%s\n' '{"</script><script>document.title=2</script>": "<b onmouseover=x>", "list": ["<i>"]}' >bad.json
ok 'a page of files with hostile names' vam-report "$hostile" bad.json --title '</title><script>document.title=3</script>' -o hostile.html
is 'hostile names create no elements' "$(grep -Ec '<img src=x|<b onm|<i>|<script>document' hostile.html)" 0

fails 64 'more than once; give files' vam-report -
mkdir empty && fails 65 'empty: contains no volume' vam-report empty
fails 64 'report.pdf' vam-report part.vdb -o report.pdf
sed 's/"ver": [^,]*/"ver": 0.5/' score.json >edited.json
fails 65 'edited.json' vam-report part.vdb edited.json -o x.html
printf 'iteration,ver,pw\n0,nan,1\n' >nan.csv
fails 65 "ver 'nan' is not a number" vam-report nan.csv
python3 -c 'print("{\"seal\":\"xxh3:00\",\"a\":" + "[" * 100000 + "]" * 100000 + "}")' >deep.json
fails 65 'deep.json: is not a volume' vam-report deep.json
vam-slice part.off --voxel 0.3 -o other.vdb
fails 65 'voxel' vam-report other.vdb dose.vdb -o x.html

# As a browser shows it, over file://. The policy forbids what a test adds, so that it stands in a copy without it.
find_browser
look() {
  timeout 60 "$browser" --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --enable-logging=stderr \
    --user-data-dir="$PWD/.log/browser" "$@" 2>.log/browser.err
}
told() {  # told PAGE SCRIPT: what SCRIPT leaves in `said` there; view is the page's canvas, pixels() what is on it
  {
    sed 's/<meta http-equiv="Content-Security-Policy"[^>]*>//; s|</body></html>||' "$1"
    cat <<'PAGE'
<p id="said"></p><script>
let said;
const view = document.querySelector('canvas');
const pixels = () => {
  const copy = document.createElement('canvas'), flat = copy.getContext('2d');
  copy.width = view.width; copy.height = view.height; flat.drawImage(view, 0, 0);
  return flat.getImageData(0, 0, copy.width, copy.height).data;
};
PAGE
    printf '%s\n' "$2" "document.getElementById('said').textContent = said;</script></body></html>"
  } >told.html
  look --dump-dom "file://$PWD/told.html" | sed -n 's/.*<p id="said">\([^<]*\).*/\1/p'
}
for page in report inspection; do
  look --dump-dom "file://$PWD/$page.html" >/dev/null
  is "no message on the console of the browser: $page" "$(grep -c CONSOLE .log/browser.err)" 0
done
is 'the slider moves; both bodies are drawn and rotate' "$(told report.html "
const slider = document.querySelector('.series input'), image = document.querySelector('.series img'), before = image.src;
slider.value = 0; slider.dispatchEvent(new Event('input'));
const drawn = () => {
  const values = pixels();
  let count = 0;
  for (let i = 0; i < values.length; i += 4) if (values[i] + values[i + 1] + values[i + 2] < 700) ++count;
  return 4 * count / values.length;
};
const design = drawn(), still = view.toDataURL();
document.querySelectorAll('.body input')[1].click();
const print = drawn(), other = view.toDataURL();
view.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}));
said = [image.src !== before, design > 0.05, print > 0.05, still !== other, view.toDataURL() !== other].join(' ');")" \
  'true true true true true'
is 'the insert is drawn in green' "$(told held.html '
const values = pixels();
let count = 0;
for (let i = 0; i < values.length; i += 4) if (values[i + 1] > 2 * values[i] + 40) ++count;
said = 4 * count > 0.01 * values.length;')" true
box 20 12 8 >box.off
vam-report box.off -o box.html
is 'the faces of a box are of one grey each' "$(told box.html '
const values = pixels(), counts = new Array(256).fill(0);
for (let i = 0; i < values.length; i += 4) ++counts[values[i]];
counts[255] = 0;
const drawn = counts.reduce((a, b) => a + b), faces = counts.sort((a, b) => b - a).slice(0, 3).reduce((a, b) => a + b);
said = drawn > 1000 && faces > 0.95 * drawn ? "flat" : `${faces} of ${drawn}`;')" flat
done_testing
