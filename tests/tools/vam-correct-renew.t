# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# vam-correct renew in a simulated print without a clock: the resin is less sensitive at its upper end, absorbs
# more and the axis is 0.2 mm beside its place, of which the plan knows nothing.
. "$VAM_SOURCE/tests/tools/testlib.sh"
export PATH="$VAM_SOURCE/scripts:$VAM_BUILD:$PATH"

# The resin gels with 60 mJ/cm3. A judged print (vam-calibrate critical-dose, as in tests/bench/closed_loop.py) has shown
# that surfaces need 60.7 to be in their place.
sed 's/critical_dose_mj_cm3 = 60/critical_dose_mj_cm3 = 60.7/' "$VAM_SOURCE/tests/tools/curing_printer.toml" >printer.toml
export VAM_PRINTER=$PWD/printer.toml
bench='voxel=0.2 columns=66 rows=46 views=60 resin.critical_dose_mj_cm3=60'
vam-slice --shape gyroid:cell=6,sheet=1.2,diameter=7,height=5 --voxel 0.2 -o part.vdb
vam-optimize --angles 60 part.vdb -o whole.exr
vam-dose whole.exr --like part.vdb --exposure-plan -o plan.vdb --report plan.json
planned=$(json plan.json turns)

# The record of the resin, of a print as planned that is stopped when about half of it scatters: what comes then, in the
# dark, tells the critical dose from the delay.
lit=$(json plan.json turns_to_critical_all); lit=${lit%.*}
printf 'play whole.exr 0 %d +\nplay - %d %d all.exr\n' $((360 * lit)) $((360 * lit)) $((360 * lit + 1080)) |
  play_turns flips.jsonl $bench >/dev/null
vam-dose whole.exr --like part.vdb -o turn.vdb
seen="--axis-column 32.5 --tilt 0 --keep-run-out"
vam-ost all.exr --live $seen -o live
quiet 'the working curve of a print as planned' vam-calibrate working-curve live --dose turn.vdb --lit-turns "$lit" -o curve.json
holds 'has the critical dose' "($(json curve.json critical_dose_mj_cm3) - 60) ^ 2 < 4"

# begin NAME: a print in a folder of that name, whose commands go to descriptor 3.
begin() {
  rm -rf "$1"; mkdir -p "$1/ost"; cp whole.exr "$1/sinogram.exr"; mkfifo "$1/in" "$1/out"
  vam-project whole.exr --freeze "$1/printer.toml"
  (cd "$1" && exec play_turns flips.jsonl $bench $true_one) <"$1/in" >"$1/out" &
  exec 3>"$1/in" 4<"$1/out"
}
tell() { echo "$@" >&3; read -r _ <&4; }
deviation() {  # deviation NAME: RMS of the print's surface
  tell settled settled.vdb
  vam-sdf "$1/settled.vdb" part.vdb --align none --samples 20000 --isovalue 1 --report "$1.json" >/dev/null && json "$1.json" print_to_design.rms_mm
}
true_one='gradient=0.15 centre=1 resin.absorption_per_mm=0.078 projector.max_intensity_mw_cm2=0.72'
first=$(awk "BEGIN { print int(0.6 * $planned) }")

begin open
best=9
for sixth in $(seq 0 $((6 * first + 60))); do
  tell play sinogram.exr $((60 * sixth)) $((60 * sixth + 60)) -
  [ $sixth -ge $((6 * first + 12)) ] || continue
  now=$(deviation open) || continue
  if awk "BEGIN { exit !($now < $best) }"; then best=$now; elif awk "BEGIN { exit !($now > 1.2 * $best) }"; then break; fi
done
exec 3>&- 4<&-

begin closed
light=sinogram.exr end=30 held=0
for turn in $(seq 0 29); do
  [ $turn -lt $end ] || break
  if [ -f closed/renewed/turn-$turn.exr ]; then
    light=renewed/turn-$turn.exr
    end=$(sed -nE "s/.*\"from_turn\":$turn,.*\"end\":([0-9]+).*/\1/p" closed/renewed.jsonl)
  fi
  tell play $light $((360 * turn)) $((360 * turn + 360)) views.exr
  [ $turn -ge $first ] || continue
  vam-ost closed/views.exr --live $seen -o of_turn 2>/dev/null
  [ -f of_turn/scatter-0000.vdb ] || continue
  number=$(find closed/ost -name '*.vdb' | wc -l)
  mv of_turn/scatter-0000.vdb closed/ost/scatter-$(printf %04d $number).vdb
  echo "{\"turns\":$((turn + 1)),\"time_s\":$((18 * turn + 18))}" >>closed/ost.jsonl
  vam-correct renew closed --target part.vdb --curve curve.json --axis-sigma 1 --once $number || held=$((held + 1))
done
closed=$(deviation closed)
exec 3>&- 4<&-

holds 'where nothing scatters yet, the print goes on as it does' "$held > 0"
ok 'for a reason that is told' grep -q '"event":"hold".*the sensitivity is known to .* % only' closed/renewed.jsonl
ok 'then new light is made' grep -q '"event":"renewed"' closed/renewed.jsonl
axis=$(json "$(ls closed/renewed/sensitivity-*.json | tail -n 1)" axis_offset_px)
holds 'for the axis as it is' "($axis - 1) ^ 2 < 0.15 ^ 2"
holds 'and a resin that needs 5 % more light' "($(json "$(ls closed/renewed/sensitivity-*.json | tail -n 1)" sensitivity_mean) - 0.98) ^ 2 < 0.04 ^ 2"
of_the_past=$(find closed/ost -name '*.vdb' | sort | tail -n 1)
number=$(find closed/ost -name '*.vdb' | wc -l)
cp "$of_the_past" closed/ost/scatter-$(printf %04d $number).vdb
echo "{\"turns\":30,\"time_s\":540}" >>closed/ost.jsonl
vam-correct renew closed --target part.vdb --curve curve.json --axis-sigma 1 --once $number
is 'from a volume that comes again there is no new light' $? 1
is 'for the reason that is told' "$(grep -c "\"event\":\"hold\".*is the volume ${of_the_past##*/} again" closed/renewed.jsonl)" 1
echo "# open at its best $best mm, closed $closed mm"
holds 'the print deviates by less than half of the open loop, stopped at its best moment' "$closed < 0.5 * $best"
done_testing
