# SPDX-License-Identifier: GPL-3.0-or-later
# Files that are not there, cannot be written or are the input are refused alike by every tool, under their names.
. "$VAM_SOURCE/tests/tools/testlib.sh"

tiny_print light.exr
vam-slice --shape cylinder:diameter=4,height=1 --voxel 0.25 -o part.vdb
vam-sinogram part.vdb --angles 12 --filter ram-lak --negative clip -o sino.exr
vam-score part.vdb --grid target --mesh part.ply >table
while read -r input output command; do
  tool=${command%% *} ending=${output##*.}
  run() {  # run INPUT OUTPUT TOOL: the command with them
    eval "$(printf %s "$command" | sed 's/IN/"$1"/; s/OUT/"$2"/')"
  }
  fails 66 "^$tool: absent.${input##*.}: cannot open" run "absent.${input##*.}" "x.$ending" $tool
  fails 73 "^$tool: nowhere/x.$ending: cannot create: No such" run "$input" "nowhere/x.$ending" $tool
  ln -s /dev/full "full.$ending"
  fails 74 "^$tool: full.$ending: .*No space left" run "$input" "full.$ending" $tool
  rm "full.$ending"
  [ "$ending" = "${input##*.}" ] || continue
  fails 64 "^$tool: $input: is also the input; write to another file" run "$input" "$input" $tool
done <<'END'
part.ply part.vdb vam-slice IN --voxel 0.5 -o OUT
part.vdb sino.exr vam-sinogram IN --angles 8 -o OUT
sino.exr seen.exr vam-resample IN -o OUT
sino.exr dose.vdb vam-dose IN -o OUT
part.vdb dose.vdb vam-dose sino.exr --like IN -o OUT
part.vdb print.ply vam-score IN --grid target --mesh OUT
part.vdb part.png vam-view IN -o OUT
part.vdb light.exr vam-optimize IN --geometry parallel --method fbp --angles 8 -o OUT
part.ply away.ply vam-sdf IN part.ply --align none --samples 1000 -o OUT
light.exr print.mkv vam-project IN --printer printer.toml -o OUT
part.vdb page.html vam-report IN -o OUT
part.vdb part.npy vam-convert IN -o OUT
sino.exr sino.exr vam-convert cut IN --slices 0:2 -o OUT
part.vdb dose.vdb vam-curethrough model IN --quiet -o OUT
part.ply plan.json vam-plan IN --no-preview --report OUT
END
done_testing
