# SPDX-License-Identifier: GPL-3.0-or-later
# trials: 100
# Every fault of the disk x every tool that writes: each output is the old file or the new one, whole; the new ones if
# and only if the status is 0; nothing else is left but after SIGKILL, and the failure is reported in one line. A tenth of the
# table by default; VAM_TRIALS=100 (ctest --preset long) is the whole of it.
. "$VAM_SOURCE/tests/tools/testlib.sh"
sanitized && { echo 'AddressSanitizer writes, too: no call can be counted'; exit 77; }
strace -qq -o .log/trace -e trace=write true 2>.log/err || { echo 'strace may not trace here: nothing is tried'; exit 77; }
every=$((100 / ${VAM_TRIALS:-10}))

vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1 -o part.vdb
vam-slice --shape cylinder:diameter=6,height=1 --extent writable --voxel 0.2 --stretch-z 1 -o standard.vdb
vam-slice --shape ladder:rungs=2 --voxel 0.1 --stretch-z 1 -o ladder.vdb
box 4 4 2 >box.off
vam-sinogram part.vdb --angles 36 --filter ram-lak --negative clip -o sinogram.exr
vam-resample sinogram.exr -o projector.exr
vam-dose sinogram.exr --like part.vdb -o dose.vdb
printf '%s\n' '[projector]' 'columns = 64' 'rows = 32' 'pixel_mm = 0.2' 'axis_column = 31.5' 'axis_row = 15.5' 'fps = 1' >small.toml
vam-resample sinogram.exr --printer small.toml -o small.exr
vam-project small.exr --printer small.toml -o views
vam-convert part.vdb -o array.npy

commands() {  # "OUTPUT... | COMMAND", a line each
  cat <<'LIST'
out.vdb|vam-slice box.off --voxel 0.2 -o out.vdb
out.vdb out.json|vam-slice box.off --voxel 0.2 -o out.vdb --report out.json
out.exr|vam-sinogram part.vdb --angles 8 -o out.exr
out.exr|vam-resample sinogram.exr -o out.exr
out.exr|vam-resample sinogram.exr --compression zip --half -o out.exr
out.exr out.json out.csv|vam-optimize part.vdb --method osmo --iterations 2 --angles 24 -o out.exr --report out.json --trace out.csv
out.vdb|vam-dose sinogram.exr --like part.vdb -o out.vdb
out.ply out.json|vam-score dose.vdb --target part.vdb --mesh out.ply --report out.json
out.ply out.csv out.json|vam-sdf box.off part.vdb --align icp --design-isovalue 0.5 --samples 2000 -o out.ply --histogram out.csv --report out.json
out.png|vam-view part.vdb -o out.png
out.html|vam-report part.vdb dose.vdb sinogram.exr -o out.html
out.nrrd|vam-view part.vdb --export out.nrrd
out.exr|vam-project small.exr --printer small.toml -o out.exr
out.mkv|vam-project small.exr --printer small.toml -o out.mkv
out.toml|vam-project --print-printer -o out.toml
out.vdb out.json|vam-ost views --view-step 10 --pixel 0.26 --no-refraction -o out.vdb --report out.json
out.exr out.json|vam-curethrough correct ladder.vdb --set projector.max_intensity_mw_cm2=110 -o out.exr --report out.json
out.vdb|vam-curethrough model ladder.vdb --set projector.max_intensity_mw_cm2=110 -o out.vdb
out.exr|vam-capture --device sim:?pace=virtual --binning 12 --frames 2 -o out.exr
out.npy|vam-convert part.vdb -o out.npy
out.vdb|vam-convert array.npy --voxel 0.2 -o out.vdb
out.json|vam-calibrate resin standard.vdb --diameter 6 -o out.json
LIST
}
faults='write:error=ENOSPC:when=1 write:error=ENOSPC:when=2 write:error=ENOSPC:when=3+ write:error=EIO:when=1
  write:error=EIO:when=2 write:error=EDQUOT:when=1 write:error=EFBIG:when=2 pwrite64:error=EDQUOT:when=1 write:error=EINTR:when=1
  pwrite64:error=EIO:when=1 pwrite64:error=ENOSPC:when=1 fsync:error=EIO:when=1 fsync:error=ENOSPC:when=1
  fsync:error=EDQUOT:when=1 linkat:error=EIO linkat:error=EACCES:when=1 linkat:error=ENOSPC:when=1 rename:error=EIO:when=1
  rename:error=EACCES rename:error=ENOSPC rename:error=EROFS
  write:signal=SIGKILL:when=1 write:signal=SIGKILL:when=2 fsync:signal=SIGKILL:when=1 linkat:signal=SIGKILL:when=1
  rename:signal=SIGKILL:when=1 write:signal=SIGTERM:when=1 fsync:signal=SIGINT:when=1 rename:signal=SIGHUP:when=1'

old() { for file in $outputs; do echo old >"$file"; done; }

is_new() { cmp -s "$1" ".log/want/$1" || { [ "$tool" = vam-capture ] && vam-check "$1" 2>/dev/null | grep -qv unsealed; }; }  # which has times

judge() {  # judge STATUS CALL: prints what is wrong
  changed=0; spoilt=
  for file in $outputs; do
    if is_new "$file"; then changed=$((changed + 1)); elif [ "$(cat "$file")" != old ]; then spoilt=$file; fi
  done
  [ -z "$spoilt" ] || echo "$spoilt is neither the old file nor the new one"
  cmp -s .log/out .log/printed; printed=$?
  [ "$1" -ne 0 ] || [ $changed -eq "$count" ] || echo 'status 0, but not all is new'
  [ "$1" -ne 0 ] || [ $printed -eq 0 ] || echo 'status 0, but not all is printed'
  [ "$1" -ne 137 ] || return
  [ -z "$(ls -A | grep '^\.vam-')" ] || echo "left behind: $(ls -A | grep '^\.vam-' | tr '\n' ' ')"
  case $1 in 0 | 129 | 130 | 143) return ;; esac
  [ $changed -lt "$count" ] || [ $printed -ne 0 ] || echo "status $1, but all is new"
  if [ "$2" = write ] && [ ! -s .log/err ]; then return; fi  # the fault hit the message, too
  [ "$(grep -c "^$tool: " .log/err)" -eq 1 ] || echo "not said in a line: $(head -n 3 .log/err | tr '\n' ' ')"
}

tried=0
place=0
mkdir .log/want
commands >.log/commands
while IFS='|' read -r outputs command; do
  tool=${command%% *}
  count=$(echo "$outputs" | wc -w)
  rm -f out.*
  if ! $command >.log/out 2>.log/err </dev/null; then report 1 "$command"; sed 's/^/# /' .log/err; continue; fi
  mv .log/out .log/printed
  rm -f .log/want/*
  for file in $outputs; do mv "$file" .log/want/; done
  old; $command >.log/out 2>.log/err </dev/null  # a second time, over older files: what is written does not depend on it
  problems=$(judge 0 "")
  for fault in $faults; do
    place=$((place + 1))
    [ $((place % every)) -eq 0 ] || continue
    tried=$((tried + 1))
    old
    strace -f $(stops "$fault") -qq -o .log/trace -e trace="${fault%%:*}" -e inject="$fault" $command >.log/out 2>.log/err </dev/null
    found=$(judge $? "${fault%%:*}")
    [ -z "$found" ] || problems="$problems
# $fault: $found"
    rm -rf .vam-*
  done
  [ -z "$problems" ]; report $? "$command"
  [ -z "$problems" ] || echo "# $problems"
done <.log/commands
echo "# $tried faults"
done_testing
