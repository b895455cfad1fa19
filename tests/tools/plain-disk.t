# SPDX-License-Identifier: GPL-3.0-or-later
# On a file system without files that have no name (NFS, vfat) outputs are whole or absent, too, and nothing is left.
. "$VAM_SOURCE/tests/tools/testlib.sh"
sanitized && { echo 'AddressSanitizer insists on coming first'; exit 77; }
plain() { LD_PRELOAD=$VAM_BUILD/lib/vam-test/no_tmpfile.so "$@"; }

box 4 4 1 >box.off
vam-slice box.off --voxel 0.2 -o part.vdb && mv part.vdb want.vdb
quiet 'a new file' plain vam-slice box.off --voxel 0.2 -o part.vdb
same 'is the same' want.vdb part.vdb
quiet 'in place of an older one' plain vam-slice box.off --voxel 0.2 -o part.vdb
quiet 'also of voxels in a scratch file' plain vam-slice --shape disc-grid --voxel 0.08 -o large.vdb
mkdir tmp
TMPDIR=$PWD/tmp quiet 'in $TMPDIR' plain vam-slice --shape disc-grid --voxel 0.08 -o large.vdb
is 'where nothing is left' "$(ls -A tmp)" ''
quiet 'a folder' plain vam-project --pattern star -o frames/
fails 65 'damaged|mesh' plain vam-slice want.vdb -o x.vdb
is 'nothing but the outputs is there' "$(ls -A | tr '\n' ' ')" '.log box.off frames large.vdb part.vdb tmp want.vdb '

# Killed between the creation and the rename.
if strace -qq -o .log/trace -e trace=write true 2>.log/err; then
  for signal in TERM KILL; do
    echo old >part.vdb
    strace -f -qq -o .log/trace -E LD_PRELOAD="$VAM_BUILD/lib/vam-test/no_tmpfile.so" -e trace=fsync \
      -e inject=fsync:signal=$signal:when=1 vam-slice box.off --voxel 0.2 -o part.vdb 2>.log/err
    is "SIG$signal: the old file" "$(cat part.vdb)" old
  done
  is 'SIGKILL leaves a temporary file' "$(ls -A | grep -c '^\.vam-')" 1
  quiet 'which the next run there removes' plain vam-slice box.off --voxel 0.2 -o part.vdb
fi
# Whatever is written: killed at its end, what was there stays, and the next run sweeps and completes.
if strace -qq -o .log/trace -e trace=write true 2>.log/err; then
  mkdir each && cd each && mkdir .log
  tiny_print light.exr
  vam-sinogram ../want.vdb --angles 8 -o sino.exr
  while read -r call name command; do
    rm -rf "$name"; case $name in */) mkdir "$name" ;; *) echo old >"$name" ;; esac
    strace -f -qq -o .log/trace -E LD_PRELOAD="$VAM_BUILD/lib/vam-test/no_tmpfile.so" -e trace=$call \
      -e inject=$call:signal=KILL:when=1 $command -o "$name" 2>.log/err
    is "$command: killed" "$(cat "$name" 2>/dev/null || ls -A "$name") $(ls -A | grep -c '^\.vam-')" \
      "$(case $name in */) ;; *) echo old ;; esac) 1"
    ok 'the next run' plain $command -o "$name"
    is 'leaves its output alone' "$(ls -A | grep -c '^\.vam-') $(head -c 3 "$name" 2>/dev/null | grep -c old)" '0 0'
  done <<'EOF'
fsync figure.png vam-view sino.exr
fsync print.mkv vam-project light.exr --printer printer.toml
fsync new.exr vam-sinogram ../want.vdb --angles 8
fsync new.npy vam-convert ../want.vdb
fsync deviation.ply vam-sdf ../box.off ../want.vdb
fsync page.html vam-report sino.exr
syncfs frames/ vam-project light.exr --printer printer.toml
EOF
  # Nor does one that is killed between two names: they change places at once.
  strace -f -qq -o .log/trace -e trace=renameat2 -e inject=renameat2:signal=KILL:when=1 \
    vam-project light.exr --printer printer.toml -o frames/ 2>.log/err
  is 'killed as it replaces a folder' "$(ls frames | wc -l) $(ls -A | grep -c '^\.vam-')" '578 1'
  ok 'the next run' vam-project light.exr --printer printer.toml -o frames/
  is 'leaves the folder alone' "$(ls frames | wc -l) $(ls -A | grep -c '^\.vam-')" '578 0'
  rm -rf captured
  ok 'images of a camera' plain vam-capture --printer printer.toml --set camera.device=sim: --frames 3 -o captured
  is 'and nothing else' "$(ls -A captured | grep -c '^\.')" 0
  cd ..
  rm -rf each
fi
# One that has ended and has not been waited for, as in a container without an init.
sh -c 'true & echo $! >.log/zombie; exec sleep 60' & parent=$!
await grep -qs '^State:.*Z' /proc/"$(await test -s .log/zombie; cat .log/zombie)"/status
mkdir ".vam-$(cat .log/zombie)-0" && touch ".vam-$(cat .log/zombie)-0/frame.png"
mkdir ".vam-$parent-0"
quiet 'a run beside what a zombie has left' vam-slice box.off --voxel 0.2 -o part.vdb
is 'removes it, and nothing of one that runs' "$(ls -A | grep '^\.vam-')" ".vam-$parent-0"
mkdir ".vam-$(cat .log/zombie)-1"
quiet 'a run that replaces nothing' vam-slice box.off --voxel 0.2 -o new.vdb
is 'removes it, too' "$(ls -A | grep '^\.vam-')" ".vam-$parent-0"
kill $parent; rmdir ".vam-$parent-0"
is 'nothing else is left' "$(ls -A | grep '^\.vam-')" ''
done_testing
