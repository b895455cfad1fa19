# Limits of the system: threads refused, two standard inputs, a volume in place of a mesh.
. "$VAM_SOURCE/tests/tools/testlib.sh"

box 4 4 1 >box.off
ok 'a part' vam-slice box.off --voxel 0.2 -o part.vdb
if sanitized || ! strace -f -o /dev/null true 2>/dev/null; then
  echo '# no threads are refused here: sanitized, or no strace'
else
  # The library of OpenVDB that writes logs starts four threads before main(); without them it ends the process.
  refused() { strace -f -o /dev/null -e trace=clone3 -e inject=clone3:error=EAGAIN:when=5+ "$@"; }
  quiet 'one thread does, where the system gives no more' refused vam-slice box.off --voxel 0.2 -o alone.vdb
  ok 'and the part is the same' vam-score alone.vdb --grid target --target part.vdb --require 'iou>=1'
  quiet 'also for sinograms' refused vam-sinogram part.vdb --angles 8 -o alone.exr
  quiet 'and stacks' refused vam-resample alone.exr -o resampled.exr
fi
fails 64 '2 inputs are standard input' vam-score - --target -
fails 64 '2 inputs are standard input' vam-view - --target - -o x.png
fails 64 '2 inputs are standard input' vam-optimize - --weights - -o x.exr
fails 65 'part.vdb: is a volume \(OpenVDB\), not a mesh' vam-slice part.vdb -o x.vdb

done_testing
