# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS ci COST 60
# One judge: what vam-optimize says of its light, vam-score says of the dose that vam-dose makes of it, in the same words
# and figures, whatever the part, the beam and the exposure; what meets a goal prints.
# shellcheck disable=SC2086
. "$VAM_SOURCE/tests/tools/testlib.sh"

cat >same.py <<'END'
import json, re, sys
two = light, dose = [json.load(open(name)) for name in ("light.json", "dose.json")]
number, close = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?"), float(sys.argv[1])  # words are rounded to 2 places or more
text, numbers = ([f(one["verdict"]) for one in two] for f in (lambda said: number.sub("#", said), number.findall))
wrong = [] if text[0] == text[1] and all(abs(float(a) - float(b)) < max(0.02 * abs(float(a)), close) for a, b in zip(*numbers)) else text
for key in ("ver pw latitude min_part max_void part_pieces print_pieces print_pieces_least print_pieces_most broken_voxels "
            "shut_voxels holes firm_holes outside_gelled_voxels prints").split():
    a, b = (one.get(key, 0) / (key[:3] in ("min", "max") and one.get("print_threshold") or 1) for one in two)
    if abs(a - b) > close: wrong.append((key, a, b))
sys.exit("\n# ".join(map(str, wrong)) or 0)
END
for seed in 0 1 2; do  # lumps
  $npy of lumps.npy 20,20,20 "max(0, min(1, 3 * (sin(7 * $seed + 0.6 * i) + sin(5 * $seed + 0.7 * j + 0.2 * i) + sin(3 * $seed + 0.8 * k)) -
    1.5 - ((i - 9.5) ** 2 + (j - 9.5) ** 2 + (k - 9.5) ** 2) / 12))"
  vam-convert lumps.npy --voxel 0.3 --stretch-z 1 -o random$seed.vdb 2>.log/lumps
done
vam-slice --shape cylinder:diameter=4,height=2.25 --voxel 0.5 -o round.vdb  # its end slices are covered by a half or so
vam-slice --shape hollow-cylinder:outer=5,inner=3,height=2 --voxel 0.3 -o tube.vdb
judged() {  # judged PART OPTIONS...
  judged_part=$1; shift; rm -f dose.json
  vam-optimize "$judged_part.vdb" --angles 36 "$@" -o light.exr --report light.json 2>.log/light
  vam-dose light.exr --like "$judged_part.vdb" -o dose.vdb 2>.log/dose
  vam-score dose.vdb --target "$judged_part.vdb" --report dose.json >table 2>.log/score
  case "$*" in *half*) close=1e-3 ;; *) close=1e-5 ;; esac  # floats of 11 bits; or in another order
  python3 same.py $close >said 2>&1; report $? "$judged_part $*: $(json light.json verdict | sed 's/[:;].*//')"; sed 's/^/# /' said
}
resin='--set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05'
for part in round tube random0 random1 random2; do
  for geometry in vial parallel; do
    judged $part --geometry $geometry --method fbp --half
    judged $part --geometry $geometry --method dose-norm $resin
    judged $part --geometry $geometry --iterations 2
    judged $part --geometry $geometry --iterations 2 $resin --turns 3 --half
    judged $part --geometry $geometry --iterations 4 --max-intensity 0.17 --bits 3
  done
done
for how in '--bits 1' '--bits 8 --set optimize.full_scale=0.01' '--set projector.telecentric=true'; do
  judged round --method dose-norm $how
done
python3 "$VAM_SOURCE/tests/corpus/make.py" part sheet 0.2 sheet.off && vam-slice sheet.off --voxel 0.2 -o sheet.vdb 2>.log/sheet
rm -f said
for more in '--iterations 0' ''; do
  vam-optimize sheet.vdb --geometry parallel --angles 60 --until 'ver=0,pw>=0.1' $more -o light.exr --report light.json 2>>said
  holds "the figures of a goal are met" "$(json light.json pw) >= 0.1 && $(json light.json ver) == 0"
  echo "$(json light.json stopped_by) $(json light.json verdict | sed 's/:.*//')" >>met
done
is "but not the goal while the part is torn" "$(tr '\n' ' ' <met)" 'iterations will not print as designed goal may print '
ok "and where it stays so that is said" grep -q 'sheet.vdb: does not print as designed after 0 iterations: ' said
vam-optimize sheet.vdb --angles 36 --iterations 0 --tolerances -o light.exr --report light.json 2>said
ok "no deviation ends what fails already" sh -c 'grep -q "^ *.verdict.: .will not print.*; no deviation ends it, as it does not print with the printer as set" light.json && ! grep -q ends_at light.json'
done_testing
