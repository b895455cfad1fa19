# SPDX-License-Identifier: GPL-3.0-or-later
# Pieces of an optimisation, joined: the bytes of the undivided run.
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape gyroid:diameter=1.6,height=9 --voxel 0.1 -o part.vdb || exit 1  # more slices than a pass has
n=94
optimised() {  # optimised NAME PIECES OPTIONS...: in pieces and as a whole
  name=$1 pieces=$2; shift 2
  vam-optimize part.vdb "$@" | vam-convert join -o "$name.exr"
  for i in $(seq "$pieces"); do vam-optimize part.vdb "$@" --slices "$i/$pieces" -o "$name.$i.exr" || echo '# failed'; done
  vam-convert join $(seq "$pieces" | sed "s/.*/$name.&.exr/") -o "$name.joined.exr"
  same "$name: $pieces pieces are the undivided stack" "$name.exr" "$name.joined.exr"
}
optimised parallel 2 --geometry parallel --angles 24
optimised unaligned 3 --geometry parallel --angles 24 --method dose-norm
optimised raised 2 --geometry parallel --angles 12 --method apg --until 'pw>=0.5' --iterations 26 --patience 0 2>/dev/null
optimised blurred 3 --set projector.telecentric=true --angles 24 --method apg --iterations 3 --set resin.psf_mm=0.1 2>/dev/null
vam-optimize part.vdb --geometry parallel --angles 24 --iterations 2 --slices 0:3 -o low.exr --report low.json 2>/dev/null
is 'the report is that of the piece' "$(json low.json distinct_slices)" 3

fails 64 '^vam-optimize: --slices: rays that climb, or spread along z, couple all slices, and light of a piece differs from that of the whole part by a tenth of the peak or more' \
  vam-optimize part.vdb --slices 0:9 -o x.exr
fails 64 'level rays .projector.telecentric without projector.half_angle_deg' \
  vam-optimize part.vdb --set projector.telecentric=true --set projector.half_angle_deg=0.3 --slices 0:9 -o x.exr
for option in '--budget 3' '--bits 8' '--robust lamp=3%' '--certify x.vdb' '--tradeoff x.csv'; do
  misuse --slices "${option%% *}" \
    vam-optimize part.vdb --slices 0:9 $option
done
fails 65 "part.vdb: has $n slices, too few for --slices 90:500" \
  vam-optimize part.vdb --geometry parallel --slices 90:500 -o x.exr

done_testing
