# SPDX-License-Identifier: GPL-3.0-or-later
# What a full disk, a bad one and kill -9 leave behind, at every system call that matters: of a file the old one; of a
# capture folder one that can be resumed, to the identical result [devices guarantee 5].
. "$VAM_SOURCE/tests/tools/testlib.sh"
sanitized && { echo 'AddressSanitizer writes, too: no call can be counted'; exit 77; }
strace -qq -o .log/trace -e trace=write true 2>.log/err || { echo 'strace may not trace here: nothing is tried'; exit 77; }
inject() { fault=$1; shift; strace ${follow--f} $(stops "$fault") -qq -o .log/trace -e trace="${fault%%:*}" -e inject="$fault" "$@" 2>.log/err; }

spoilt() {  # spoilt STATUS INJECTION TOOL...: the last argument is its output, of which there is an old one
  want=$1; what=$2; shift 2
  for out; do :; done
  echo old >"$out"
  inject "$what" "$@"; status=$?
  is "$what, $1: the old file" "$status $(cat "$out")" "$want old"
  [ "$want" = 137 ] || is "$what, $1: said in a line" "$(grep -c "^$1: $out: " .log/err) $(wc -l <.log/err)" '1 1'
}
for tool in 'vam-slice --shape cylinder --voxel 0.5 -o out.vdb' 'vam-project --pattern star -o out.exr' \
  'vam-capture --device sim:?pace=virtual --binning 12 --frames 2 -o views.exr'; do
  for what in write:error=ENOSPC:when=1 write:error=EIO:when=1 fsync:error=EIO; do spoilt 74 $what $tool; done
  spoilt 73 rename:error=EIO $tool
  for call in write fsync rename; do spoilt 137 $call:signal=SIGKILL:when=1 $tool; done
done
rm -f .vam-*  # killed between link and rename, the new file stands under a name of its own
is 'nothing else is left' "$(ls -A)" "$(printf '.log\nout.exr\nout.vdb\nviews.exr')"

# A capture folder: the number of these calls in a run of two frames, but for the process that parses what is replayed.
vam-capture --device 'sim:?pace=virtual&noise=0.004' --binning 12 --frames 2 -o views.exr
take() { vam-capture --device replay:views.exr --frames 2 -o "$1/"; }
take whole
sort whole/manifest.jsonl >whole.lines
resumed() {  # resumed INJECTION STATUS: of a first run; the second one completes it
  rm -rf folder
  follow= inject "$1" vam-capture --device replay:views.exr --frames 2 -o folder/; status=$?
  take folder 2>.log/again; again=$?
  sort folder/manifest.jsonl >lines
  different=$(for file in whole/*.png; do cmp -s "$file" "folder/$(basename "$file")" || echo "$file"; done; cmp lines whole.lines)
  is "$1: resumed" "$status $again$different" "$2 0"
}
for call in fdatasync:1 fdatasync:2 fdatasync:3 fdatasync:4 fsync:1 fsync:2 write:1 write:2 write:3 write:4; do
  resumed "${call%:*}:signal=SIGKILL:when=${call#*:}" 137
done
for call in fdatasync:2 fdatasync:3 write:2 write:3; do resumed "${call%:*}:error=EIO:when=${call#*:}" 74; done
resumed write:error=ENOSPC:when=2 74
is 'where the disk is full no image is left' "$(follow= inject write:error=ENOSPC:when=2 vam-capture --device replay:views.exr --frames 2 -o full/; ls full)" manifest.jsonl
resumed fsync:error=EIO:when=2 74

# A log of flips is on the disk every second.
tiny_print frames.exr
play() { inject "$1" vam-project frames.exr -o null: --speed 120 --turns 1 --max-missed 1 --max-missed-lit 1 --log flips; }
play fdatasync:delay_exit=1000
holds 'a print of 3 s brings its log to the disk' "$(grep -c 'fdatasync.*= 0' .log/trace) >= 3"
rm flips; play fdatasync:error=EIO
is 'a disk that fails ends no print' "$? $(grep -c '"event":"end"' flips)" '0 1'
is 'and is told' "$(cat .log/err)" 'vam-project: warning: flips: cannot be brought to the disk (Input/output error); a power failure may lose its last lines'
done_testing
