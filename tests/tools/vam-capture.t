# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# vam-capture: series, resumed folders, marks of lost frames, and bad input.
. "$VAM_SOURCE/tests/tools/testlib.sh"
sim='sim:?pace=virtual&lit=0.1&speed=90&noise=0.004'
take="vam-capture --device $sim --binning 12 --fps 10"

fails 64 'have no angles' $take --view-step 10 --log why -o views/
fails 64 'neither binning' vam-capture --device v4l2:/dev/null --binning 2 --frames 1 -o views.exr
vam-capture --device v4l2:/dev/no-video --frames 1 -o views.exr --log why 2>said
is 'the error is logged' "$(json why event) $(json why status)" 'error 69'
rm why
fails 73 'cannot be written' $take --frames 1 --log missing/log -o views.exr

# The camera is that of the printer file; a simulated one is used only if it is named, and its frames are marked.
fails 64 'camera: no device is set; give --device, or camera.device in the printer file, .*; sim: is a simulated one' vam-capture --frames 1 --log why -o views.exr
printf '[camera]\ndevice = "v4l2:/dev/no-video"\n' >camera.toml
fails 69 'no-video' vam-capture --printer camera.toml --frames 1 -o views.exr
fails 64 "camera.device: 'usb:1': unknown device scheme; use one of aravis:, v4l2:, replay:, sim:" vam-capture --set camera.device=usb:1 --frames 1 -o views.exr
ok 'a simulated capture' vam-capture --set "camera.device=$sim" --binning 30 --frames 2 -o marked/ --log marked.log --report marked.json
is 'is marked in manifest, log and report' "$(head -n 1 marked/manifest.jsonl | grep -c '"simulated":true') $(grep -c '"event":"begin".*"simulated":true' marked.log) $(json marked.json camera.simulated)" '1 1 true'
$take --frames 1 --compression none -o marked.exr
is 'and in a stack' "$($exr attr marked.exr vam:history | grep -c 'frames of a simulated camera')" 1

for name in x.png x.vdb x.mkv; do
  fails 64 "--output: '$name' must end in .exr" vam-capture --device 'sim:?pace=virtual' --frames 2 -o $name
done

# A stack, and the same frames out of it again.
quiet 'a stack of frames' $take --frames 12 -o views.exr
quiet 'from a recording' vam-capture --device replay:views.exr --frames 12 -o again.exr --compression none
quiet 'and again' vam-capture --device replay:again.exr --frames 12 -o twice.exr --compression none
quiet 'a stack on a pipe' sh -c 'vam-capture --device replay:views.exr --frames 12 | cat >piped.exr'
$exr sum again.exr >sum1
$exr sum piped.exr >sum2
same 'has the same pixels' sum1 sum2
is 'of this size' "$(cut -d' ' -f1-3 sum1)" '12 60 45'

# A stage at a fixed, known angle.
$take --angle 270 --frames 1 --compression none -o fixed.exr
is 'its angle is recorded' "$($exr attr fixed.exr vam:angle_deg)" 270

# Lost and incomplete frames are reported, counted and marked.
lossy='sim:?pace=virtual&drop=3,4&incomplete=6'
vam-capture --device "$lossy" --binning 12 --frames 10 -o lossy.exr --report lossy.json --log lossy.log --compression none 2>said
is 'a capture with losses has status 0' $? 0
ok 'lost frames are reported' grep -q '2 frames dropped and 1 incomplete' said
is 'and reported' "$(json lossy.json frames) $(json lossy.json dropped) $(json lossy.json incomplete)" '10 2 1'
is 'and logged' "$(grep -c '"event":"dropped","first":3,"last":4' lossy.log) $(grep -c '"event":"incomplete","number":6' lossy.log)" '1 1'
python3 - "$VAM_SOURCE" >marks <<'PY'
import sys, struct, runpy
source = sys.argv[1]
sys.argv = ["exr.py", "attr", "lossy.exr", "vam:kind"]  # it runs as a program
read = runpy.run_path(source + "/tests/tools/exr.py")["read"]
heads = read("lossy.exr")[0]
number = lambda head, name: struct.unpack("<i", head[name])[0]
print(" ".join(str(number(h, "vam:number")) + "!" * number(h, "vam:incomplete") for h in heads))
PY
is 'every image has its number, and the incomplete one its mark' "$(tail -n 1 marks)" '0 1 2 5 6! 7 8 9 10 11'
fails 75 '2 frames dropped and 1 incomplete' vam-capture --device "$lossy" --binning 12 --frames 10 --max-lost 2 -o lost.exr

fails 75 'gap.exr: 1 of 20 .*; a folder' vam-capture --device 'sim:?pace=virtual&drop=10' --binning 12 --fps 10 --speed 90 --view-step 9 --turns 0.5 -o gap.exr

# A folder keeps the captured frames; repeating the command captures only the missing ones.
vam-capture --device "$lossy" --binning 12 --frames 10 -o folder/ 2>said
is 'missing frames are an error' "$? $(grep -c '3 of 10 frames are missing' said)" '75 1'
is 'its dropped frames are in the manifest' "$(grep -c '"dropped":\[3,4\]' folder/manifest.jsonl)" 1
is 'the incomplete one is marked' "$(grep '"complete":false' folder/manifest.jsonl | grep -o '"number":[0-9]*')" '"number":6'
vam-capture --device "replay:views.exr" --frames 10 -o folder/ 2>said
is 'another camera is refused' "$? $(grep -c 'was captured with another setting (camera' said)" '73 1'
quiet 'a whole recording' vam-capture --device replay:views.exr --frames 12 -o whole/
cp -r whole half; rm half/000003.png half/00001*.png  # one is deleted; the capture was killed before two more
head -n 11 whole/manifest.jsonl >half/manifest.jsonl
printf '{"frame":10,"file":"0000' >>half/manifest.jsonl
vam-capture --device replay:views.exr --frames 12 -o half/ 2>said
is 'resumes, and says which images are new' "$? $(cat said)" \
  '0 vam-capture: warning: half/: keeps 9 images of an earlier capture; new are 000003.png, 000010.png to 000011.png; if the scene has changed since, capture all into another folder'
is 'and captures only the missing frames' "$(tail -n 4 half/manifest.jsonl | sed 's/,"file.*//;s/,"dropped.*//' | tr '\n' ' ')" \
  '{"frame":3 {"frame":10 {"frame":11 {"frames":12 '
lines() { sed 's/,"seal":.*//' $1/manifest.jsonl | sort -u; }
lines half >half.lines; lines whole >whole.lines
same 'the manifests agree' half.lines whole.lines
for file in whole/*.png; do cmp -s "$file" "half/$(basename "$file")" || echo "$file"; done >different
is 'the images are identical' "$(cat different)" ''
touch -d '2001-01-01' half/*.png
quiet 'a complete folder is not changed' vam-capture --device replay:views.exr --frames 12 -o half/
is 'no image was rewritten' "$(find half -name '*.png' -newermt 2002-01-01)" ''
mkdir other; touch other/file
fails 73 'contains files of another kind' vam-capture --device replay:views.exr --frames 12 -o other/

# A camera that sends images of another size: reported at once; earlier frames are kept and the capture is resumed.
shrinking() { vam-capture --device "sim:?pace=virtual$1" --binning 12 --frames 6 -o shrunk/; }
shrinking '&shrink=4' 2>said
is 'another size' "$? $(grep -c ': sends images of 60 x 22 pixels instead of 60 x 45;' said) $(wc -l <said)" '76 1 1'
is 'four frames are kept' "$(grep -c '"complete":true' shrunk/manifest.jsonl) $(ls shrunk | grep -c png)" '4 4'
ok 'the remaining frames are captured' shrinking ''
is 'all six' "$(grep -c '"complete":true' shrunk/manifest.jsonl)" 6
vam-capture --device 'sim:?pace=virtual' --binning 20 --frames 4 -o coarse/
cp -r whole differs; cp coarse/000003.png differs/
fails 65 'differs/000003.png: is not the image that was captured' vam-capture --device replay:differs --frames 12 -o no.exr
sed -i 's/"levels":"[0-9a-f]*"/"levels":""/;s/,"seal":"[^"]*"//' differs/manifest.jsonl
fails 65 'differs: frame 3 has 36 x 27 pixels instead of 60 x 45' vam-capture --device replay:differs --frames 12 -o no.exr

# Killed at any moment: every listed image exists, and the remaining frames can be captured.
vam-capture --device 'replay:views.exr?pace=real' --frames 12 -o killed/ & victim=$!
tries=0; until [ -s killed/manifest.jsonl ] && [ "$(wc -l <killed/manifest.jsonl)" -gt 4 ] || [ $tries -gt 500 ]; do tries=$((tries + 1)); sleep 0.01; done
kill -KILL $victim; wait $victim 2>/dev/null
for file in $(grep -o '[0-9]*\.png' killed/manifest.jsonl); do cmp -s "killed/$file" "whole/$file" || echo "$file"; done >different
is 'after kill -9 every listed image is complete' "$(cat different)" ''
ok 'and the remaining frames are captured' vam-capture --device 'replay:views.exr?pace=real' --frames 12 -o killed/
for file in whole/*.png; do cmp -s "$file" "killed/$(basename "$file")" || echo "$file"; done >different
is 'with the same result' "$(cat different)" ''

# Angles: one frame nearest to every multiple; a live stream into vam-ost.
quiet 'by angle' $take --speed 90 --view-step 9 --turns 1.1 -o turn/
is 'the number of multiples in the turns' "$(grep -c '"frame"' turn/manifest.jsonl)" 44
python3 - >worst <<'PY'
import json
lines = [json.loads(line) for line in open("turn/manifest.jsonl")][1:-1]
print(max(abs(line["angle_deg"] - 9 * line["frame"]) for line in lines))
PY
holds 'each within half a frame of its angle' "$(cat worst) <= 4.5"
echo "vam-capture --device '$sim' --binning 12 --fps 10 --speed 90 --view-step 9 --turns 1.2 --live |
  vam-ost --live -o live/ --log live.log" >live.sh
quiet 'live frames reach vam-ost' sh live.sh
holds 'which saw a turn' "$(grep -c turns live.log) >= 1"
vam-ost turn -o seen.vdb 2>said
is 'a capture folder is read by vam-ost with its angles' "$? $(grep -vc '000000.png: dark' said)" '0 0'  # no print yet

# Views of a turn that vam-ost can use, or a refusal with what to do.
fails 64 '^vam-capture: --view-step: .* up to 18 deg apart, .* 15; give --view-step 9, or --fps 15$' $take --speed 90 --view-step 12 -o odd/
fails 64 'views at multiples of 5 deg are up to 18 deg apart, and vam-ost allows 15; give --fps 36$' $take --speed 180 --view-step 5 -o odd/
for remedy in '--fps 10 --view-step 9' '--fps 15 --view-step 12'; do
  quiet "views by $remedy" vam-capture --device "sim:?pace=virtual&lit=0&speed=90" --binning 12 --speed 90 $remedy -o odd/
  ok 'are a turn to vam-ost' vam-ost odd -o odd.vdb
  rm -r odd
done

# Images and lines that were changed, exchanged, added or lost are named by what reads a folder.
ok 'a whole folder is sealed' sh -c 'vam-check turn | grep -qx "turn: capture folder of 44 images, sealed"'
$take --frames 3 -o again/
refused() {  # refused WHAT: of the folder bad, in all tools that read it, until it is completed
  vam-check bad >out 2>said
  is "65: vam-check: $1" "$? $(grep -Ec "^vam-check: (warning: )?bad/$1" said)" '65 1'
  for tool in 'vam-ost bad -o no.vdb' 'vam-convert bad --voxel 1 -o no.vdb' 'vam-capture --device replay:bad --frames 4 -o no.exr'; do
    fails 65 "^${tool%% *}: bad/$1" $tool
  done
}
spoil() { rm -rf bad; cp -r turn bad; }
again() { fails 65 "^vam-capture: bad/$1" $take --speed 90 --view-step 9 --turns 1.1 -o bad/; }
spoil; mv bad/000003.png t; mv bad/000004.png bad/000003.png; mv t bad/000004.png
refused '000003.png: is not the image that was captured \(fingerprint .[0-9a-f]{8}. in manifest.jsonl, read [0-9a-f]{8}\); restore it, or delete it and repeat vam-capture$'
again '000003.png: is not the image'
is 'the other is named, too' "$(vam-check bad 2>&1 | grep -c 'bad/000004.png: is not the image') $(vam-check bad 2>&1 | grep -c '^bad: .*, damaged$')" '1 1'
spoil; cp again/000002.png bad/000003.png; refused '000003.png: is not the image'
spoil; cp bad/000003.png bad/000044.png; refused '000044.png: has no line in manifest.jsonl; restore the manifest, or remove'
again '000044.png: has no line in manifest.jsonl; restore the manifest, or remove'
cp bad/000003.png bad/000099.png; again '000044.png: has no line in manifest.jsonl, as 1 more images'
for more in '{"frame":44,"file"' '\000\000\000\000'; do
  spoil; printf "$more" >>bad/manifest.jsonl; refused 'manifest.jsonl: has [0-9]+ bytes of no whole line behind the end of the capture; remove them'
done
$take --speed 90 --view-step 9 --turns 1.1 -o bad/ 2>said
is 'a capture says that it cuts them off' "$? $(grep -c 'warning: bad/manifest.jsonl: 4 bytes of no whole line' said)" '0 1'
same 'and does so' bad/manifest.jsonl turn/manifest.jsonl
spoil; : >bad/manifest.jsonl; touch -d '2001-01-01' bad/*.png
again 'manifest.jsonl: is empty; restore the manifest, or capture again into another folder'
is 'no image was overwritten' "$(find bad -name '*.png' -newermt 2002-01-01) $(wc -c <bad/manifest.jsonl)" ' 0'
mkdir begun; : >begun/manifest.jsonl
quiet 'without images it is a capture that was killed at once' $take --frames 2 -o begun/
ok 'a manifest stands for its folder' sh -c 'vam-check turn/manifest.jsonl | grep -qx "turn/manifest.jsonl: capture folder of 44 images, sealed" && cd turn && vam-check manifest.jsonl'
spoil; cp again/000002.png bad/000003.png; fails 65 'bad/000003.png: is not the image that was captured' vam-check bad/manifest.jsonl
spoil; rm bad/000003.png
fails 66 'bad/000003.png: is gone, but manifest.jsonl lists it; restore it, or repeat vam-capture' vam-ost bad -o no.vdb
fails 65 'bad/000003.png: is gone' vam-check --fast bad
for other in '90 --view-step 9 --lag 7' '45 --view-step 9' '90 --view-step 9 --exposure 5000' '90 --view-step 9 --pixel 0.2' '90 --view-step 4.5'; do
  fails 73 'bad/: was captured with another setting .(lag_ms 0.0, not 7.0|speed_deg_s 90.0, not 45.0|exposure_us 20000.0, not 5000.0|pixel_mm 0.[0-9]*, not 0.2|every_deg 9.0, not 4.5).; give another folder' \
    $take --turns 1.1 --speed $other -o bad/
done
$take --speed 90 --view-step 9 --turns 1.1 -o bad/ 2>said
is 'one that was deleted is captured again, and named' "$? $(sed 's/; if.*//' said)" '0 vam-capture: warning: bad/: keeps 43 images of an earlier capture; new are 000003.png'
ok 'and the folder is whole' vam-check bad
for change in '5d' '2d' '1d' '5s/"angle_deg":[0-9.]*/"angle_deg":33.5/' '5s/,"seal.*"/,"seal":"xxh3:"/' '5s/,"seal[^}]*//' '1s/,"seal[^}]*//' '46s/:44,/:43,/'; do
  spoil; sed -i "$change" bad/manifest.jsonl
  refused 'manifest.jsonl: line [0-9]*: (changed after it was written, or lines before it are gone \(|is not a manifest of|has (a|no) seal, but those before).*; restore the manifest, or capture again$'
done
again 'manifest.jsonl: line 46: changed'
spoil; head -n 40 turn/manifest.jsonl >bad/manifest.jsonl; refused '000039.png: has no line in manifest.jsonl, as 4 more images'
spoil; sed -i '$d' bad/manifest.jsonl
fails 65 'bad/manifest.jsonl: does not end as that of a capture that ended: .*; repeat vam-capture, which completes it' vam-check bad
ok 'or is read with a warning' sh -c 'vam-ost bad -o seen.vdb 2>&1 | grep -q "warning: bad/manifest.jsonl: does not end"'
quiet 'the end is written' $take --speed 90 --view-step 9 --turns 1.1 -o bad/
same 'as it was' bad/manifest.jsonl turn/manifest.jsonl
# Those of other programs have no seals, or no manifest.
spoil; sed -i 's/,"seal":"[^"]*"//;$d' bad/manifest.jsonl
ok 'a folder without seals is unsealed' sh -c 'vam-check bad | grep -qx "bad: capture folder of 44 images, unsealed"'
ok 'and read' vam-ost bad -o seen.vdb
cp turn/000004.png bad/000003.png; refused '000003.png: is not the image that was captured'
rm bad/manifest.jsonl
ok 'a folder of images is one' sh -c 'vam-check bad | grep -qx "bad: folder of images, unsealed"'
for text in '' '{' '[]' '{"schema":7}' '{"schema":"vam-capture/1"}\n{}' '{"schema":"vam-capture/1"}\n{"frame":0,"number":0,"t_monotonic_s":"x"}' '{"schema":"vam-capture/1"}\n{"dropped":7}'; do
  printf "$text\n" >bad/manifest.jsonl
  fails 65 '^vam-ost: bad/manifest.jsonl: line [12]: (has no key|its key|.* is not|is not) .*; restore the manifest, or capture again$' vam-ost bad -o no.vdb
done
is 'and no words of a library' "$(cat .log/err | grep -c 'json\.exception')" 0

vam-capture --device 'sim:?speed=90' --binning 12 -o open/ 2>said & tool=$!  # without a number of frames
await grep -qs '"frame":3,' open/manifest.jsonl
kill -TERM $tool; wait $tool 2>/dev/null
is 'a folder that a signal ends is whole' "$? $(vam-check open | grep -c ', sealed$')" '143 1'
vam-capture --device 'sim:?speed=90' --binning 12 --frames 500 -o stopped.exr --log begun 2>said & tool=$!
tries=0; until [ -s begun ] || [ $tries -gt 500 ]; do tries=$((tries + 1)); sleep 0.02; done
kill -TERM $tool; wait $tool 2>/dev/null
is 'a signal ends the capture, which leaves no file' "$? $(ls | grep -c stopped)" '143 0'
ok 'its forms have the option that a stack needs' sh -c "vam-capture --help | grep -q 'vam-capture .OPTIONS. --frames N'"
done_testing
