# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# Limits of the system: threads refused, processes, two standard inputs, a volume in place of a mesh.
. "$VAM_SOURCE/tests/tools/testlib.sh"

box 4 4 1 >box.off
ok 'a part' vam-slice box.off --voxel 0.2 -o part.vdb
if sanitized || ! strace -f -o /dev/null true 2>/dev/null; then
  echo '# no threads are refused here: sanitized, or no strace'
else
  refused_from() {  # refused_from N COMMAND...: the Nth thread and those that follow
    from=$1; shift
    strace -f --seccomp-bpf -o /dev/null -e trace=clone3 -e inject=clone3:error=EAGAIN:when="$from"+ "$@"
  }
  refused() { refused_from 1 "$@"; }
  # The library of OpenVDB that writes logs would start four threads before main().
  quiet 'one thread does, where the system gives no more' refused vam-slice box.off --voxel 0.2 -o alone.vdb
  ok 'and the part is the same' vam-score alone.vdb --grid target --target part.vdb --require 'iou>=1'
  refused vam-slice box.off --voxel 0.2 | cat >alone.vdb
  ok 'through a pipe, too' vam-score alone.vdb --grid target --target part.vdb --require 'iou>=1'
  fails 64 '^vam-slice: .*unknown option' refused vam-slice --vox 1 box.off -o x.vdb
  fails 65 '^vam-slice: part.vdb: is a volume' refused vam-slice part.vdb -o x.vdb
  quiet 'also for sinograms' refused vam-sinogram part.vdb --angles 8 -o alone.exr
  quiet 'and stacks' refused vam-resample alone.exr -o resampled.exr
  # Tools without volumes need no thread but their own.
  quiet 'a tool without volumes starts with one thread' refused_from 1 vam-convert cut alone.exr --slices 1/2 -o half.exr
  fails 71 '^vam-convert: needs more threads than the system gives; raise its limit \(ulimit -u\), or use --threads 1$' \
    refused_from 2 vam-convert cut alone.exr --slices 1/2 --threads 2 -o half.exr
  fails 71 'figure: needs one thread more than the system gives; raise its limit' refused vam-view part.vdb -o x.png
fi
nobody() { setpriv --reuid=54321 --regid=54321 --clear-groups "$@"; }  # who has no other process
chmod 711 .
if sanitized || ! nobody vam-slice --version >/dev/null 2>&1; then
  echo '# no limit of processes is tried here: sanitized, or not root'
else
  for processes in 1 2 3; do
    nobody prlimit --nproc=$processes vam-slice --shape cylinder:diameter=4,height=1 --voxel 0.2 >one.vdb 2>one.err; status=$?
    is "a part by a user of $processes processes and threads" "$status $(cat one.err)" '0 '
    ok 'which is whole' vam-check one.vdb
  done
  is 'one that is parsed apart needs two' \
    "$(nobody prlimit --nproc=1 vam-slice - --voxel 0.2 <box.off 2>&1 >/dev/null | grep -Ec '^vam-slice: .*(process|thread)')" 1
  nobody prlimit --nproc=2 vam-slice - --voxel 0.2 --threads 1 <box.off >two.vdb 2>two.err; status=$?
  is 'and two do' "$status $(cat two.err)" '0 '
fi
if ! sanitized; then
  within() {  # within KIB ENDS REGEX COMMAND: in so many KiB of addresses its end is one of ENDS, 'STATUS MATCHING-LINES|...';
    # 127, or 139 also for a version, if libraries do not fit, and 71 if they fit and cannot start
    timeout 60 sh -c "ulimit -v $1; exec $4" 2>bounded >found </dev/null; status=$?
    case "|$2|" in *"|$status $(grep -v warning: bounded | grep -Ec "$3")|"*) return ;; esac
    [ $status -eq 139 ] && { sh -c "ulimit -v $1; exec ${4%% *} --version" >/dev/null 2>&1; [ $? -eq 139 ]; } && return
    odd=$((odd + 1)); echo "# $1 KiB, $4: $status"; sed 's/^/# /' bounded
  }
  odd=0; none_odd() { is "$1" $odd 0; odd=0; }  # none_odd NAME: of those since the last
  for mib in 8 $(seq 60 4 120); do within $((mib * 1024)) '71 1|0 0|127 1' . 'vam-slice --version'; done
  none_odd 'a start in 8 to 120 MiB of addresses is done or refused in one line'
  for kib in 64 96 255; do
    is "a stack of $kib KiB is refused" "$(sh -c "ulimit -s $kib; exec vam-slice --shape cylinder --voxel 0.5 -o x.vdb" 2>&1; echo $?)" \
      "vam-slice: needs a stack of 256 KiB, and the limit is $kib KiB; raise it (ulimit -s)
71"
  done
  ok 'one of 256 KiB does' sh -c 'ulimit -s 256; vam-slice --shape gyroid --voxel 0.5 | vam-sinogram | vam-view --image-size 100 -o x.png'
  # The libraries that draw end the process where memory or a thread is refused.
  raise='(raise|allow more|raise its limits?)'
  for mib in 160 200 220 230 240 260; do within $((mib * 1024)) '0 0|71 1' "^vam-view: .*$raise" 'vam-view part.vdb -o bounded.png'; done
  none_odd 'a figure in 160 to 260 MiB of addresses is drawn, or refused with the remedy'
  python3 -c '
n = 40000
print("OFF\n%d %d 0" % (4 * n, 4 * n))
for i in range(n): print("0 0 %d\n1 0 %d\n0 1 %d\n0.2 0.2 %f" % (i, i, i, i + 0.5))
for i in range(0, 4 * n, 4): print("3 %d %d %d\n3 %d %d %d\n3 %d %d %d\n3 %d %d %d" % (i, i + 2, i + 1, i, i + 1, i + 3, i + 1, i + 2, i + 3, i + 2, i, i + 3))' >many.off
  raise='(MiB of addresses are in use, the limit is [0-9]+ MiB; raise it|limit of [0-9]+ MiB of addresses leaves; raise it|raise its limits?)'
  for mib in $(seq 110 10 180); do
    within $((mib * 1024)) '71 1|127 1' "^vam-sdf: .*($raise .ulimit|shared libraries)" 'vam-sdf many.off part.vdb --align none -o bounded.ply'
  done
  none_odd 'a deviation in 110 to 180 MiB of addresses is refused with the limit'
  # Threads of the libraries throw where nobody catches, their initialisers where nothing can be thrown, and the reader
  # of volumes takes what it cannot have for damage.
  small_printer >small.toml
  vam-optimize --printer small.toml part.vdb --method fbp --angles 24 -o light.exr
  while read -r command; do
    for kib in $(seq 70000 400 100000); do within "$kib" '0 0|71 1|127 1' . "$command"; done
  done <<'EOF'
vam-dose --printer small.toml light.exr --like part.vdb -o bounded.vdb
vam-optimize part.vdb --geometry parallel --method fbp --angles 8 -o bounded.exr
vam-check part.vdb light.exr
vam-score part.vdb --grid target --target part.vdb
vam-report part.vdb light.exr -o bounded.html
EOF
  none_odd 'in 70000 to 100000 KiB of addresses a tool is done, or refused in one line'
  rm -f bounded* found small.toml light.exr many.off
fi
# Few open files: all of it or one line with the remedy, and figures are the same.
if ! sanitized; then
  tiny_print few.exr
  vam-sinogram part.vdb --angles 8 -o few-sino.exr
  vam-view few-sino.exr -o few.png && mv few.png few-want.png
  vam-project few.exr --printer printer.toml -o few.mkv 2>.log/err
  refusals=0
  exec 3<&- 4<&- 5<&- 6<&- 7<&- 8<&- 9<&-  # what ctest leaves open would count, too
  for files in 4 5 7 16; do
    while read -r command; do
      prlimit --nofile=$files timeout 60 $command >.log/out 2>.log/err </dev/null; status=$?
      case "$status $(grep -vc warning: .log/err)" in
        '0 0') ;;
        '71 1') refusals=$((refusals + 1))
          grep -v warning: .log/err | grep -Eq '^vam-[a-z]*: .*: Too many open files; raise the limit \(ulimit -n\)$' && continue
          odd=$((odd + 1)); echo "# $files: $command"; sed 's/^/# /' .log/err ;;
        *) odd=$((odd + 1)); echo "# $files: $command: $status"; sed 's/^/# /' .log/err ;;
      esac
    done <<'EOF'
vam-slice box.off --voxel 0.2 -o few.vdb
vam-sinogram part.vdb --angles 8 -o few-new.exr
vam-resample few-sino.exr -o few-new.exr
vam-optimize part.vdb --geometry parallel --method fbp --angles 8 -o few-new.exr
vam-dose few-sino.exr --like part.vdb -o few.vdb
vam-score part.vdb --grid target --target part.vdb
vam-curethrough model part.vdb -o few-new.exr
vam-view few-sino.exr -o few.png
vam-convert part.vdb -o few.npy
vam-convert few.mkv --geometry parallel --pixel 1 -o few-new.exr
vam-project few.exr --printer printer.toml -o few-frames/
vam-check part.vdb few-sino.exr printer.toml few.mkv
vam-sdf box.off part.vdb --samples 2000 -o few.ply
vam-convert join few-sino.exr -o few-new.exr
vam-plan box.off
vam-report part.vdb few-sino.exr -o few.html
vam-capture --printer printer.toml --set camera.device=sim: --frames 2 -o few-captured
vam-stage status --set stage.device=sim:
EOF
  done
  none_odd 'with 4 to 16 open files a tool is done, or refused in one line'
  for files in 4 5 6; do
    fails 71 'Too many open files; raise the limit' prlimit --nofile=$files vam-project -q few.exr --printer printer.toml -o few-none/
  done
  holds 'most are refused at 4' "$refusals >= 15"
  # Fonts are files, too.
  drawn=0
  for files in 5 6 7 8; do
    prlimit --nofile=$files vam-view few-sino.exr -o few.png 2>.log/err && { cmp -s few-want.png few.png && drawn=$((drawn + 1)) || drawn=-9; }
  done
  holds 'a figure that is drawn is the same' "$drawn > 0"
  rm -rf few* printer.toml
fi
fails 64 '2 inputs are standard input' vam-score - --target -
fails 64 '2 inputs are standard input' vam-score - --target /dev/stdin
fails 64 '2 inputs are standard input' vam-view - --target - -o x.png
fails 64 '2 inputs are standard input' vam-optimize - --weights - -o x.exr
fails 64 '2 inputs are standard input' vam-ost - --flat -
fails 64 '2 inputs are standard input' vam-check - -
fails 64 '2 inputs are standard input' vam-sdf height - -
fails 64 '2 inputs are standard input' vam-curethrough model - --target -
fails 65 'part.vdb: is a volume \(OpenVDB\), not a mesh' vam-slice part.vdb -o x.vdb
fails 65 'stdin: the mesh is empty' sh -c 'timeout 60 cat /dev/zero | vam-slice - -o x.vdb'
fails 65 'stdin: not a mesh of a known format; export the part as one of' sh -c 'timeout 60 yes | vam-slice - -o x.vdb'
for device in zero urandom; do
  fails 66 "/dev/$device: is a device that never ends" vam-slice /dev/$device -o x.vdb
  fails 66 'stdin: is a device that never ends' sh -c "vam-sdf box.off - -o x.ply </dev/$device"
  for tool in vam-convert 'vam-convert --voxel 1 -o x.vdb' vam-check; do
    fails 66 "stdin: is a device that never ends; name a file" sh -c "$tool - </dev/$device"
    fails 66 "/dev/$device: is a device that never ends; name a file" $tool /dev/$device
  done
done

# Bytes after the last image of a stack, of one with seals and of one that is parsed in a child, in a file and a pipe.
vam-sinogram part.vdb --angles 8 -o sealed.exr
$exr make plain.exr space=virtual width=29 height=8 count=2
for stack in sealed plain; do
  ok "$stack: as it is" vam-view $stack.exr -o $stack.png
  { cat $stack.exr; echo more; } >long.exr
  fails 65 'long.exr: trailing data after the last image, from byte [0-9]+ on, is not a stack' vam-view long.exr -o x.png
  fails 65 'stdin: trailing data after the last image' sh -c 'vam-view - -o x.png <long.exr'
  cat $stack.exr $stack.exr >two.exr
  fails 65 'two.exr: another stack follows the last image, from byte [0-9]+ on' vam-view two.exr -o two.png
  ok "$stack: vam-check takes each" vam-check two.exr
done

# --memory: refused with both numbers, before it is taken.
need='[0-9]+ x [0-9]+ x [0-9]+ voxels: needs [0-9.]+ GiB of memory, but --memory leaves [0-9.]+ GiB; use [^;]*larger [^;]*, or allow more with --memory$'
box 4 4 0.01 >flat.off
vam-slice flat.off --voxel 0.002 --stretch-z 1 -o wide.vdb
fails 71 "^vam-slice: flat.off: $need" vam-slice --memory 0.4 flat.off --voxel 0.002 --stretch-z 1 -o x.vdb
fails 71 "^vam-score: target: $need" vam-score --grid target wide.vdb --target wide.vdb --memory 0.4
fails 71 "^vam-sinogram: target: $need" vam-sinogram wide.vdb --angles 8 -o x.exr --memory 0.4
fails 71 "^vam-optimize: wide.vdb: $need" vam-optimize wide.vdb --geometry parallel --method fbp --angles 8 -o x.exr --memory 0.4
vam-sinogram wide.vdb --angles 2 -o wide.exr
fails 71 "^vam-dose: wide.exr: $need" vam-dose wide.exr --like wide.vdb -o x.vdb --memory 0.4
fails 71 '^vam-optimize: part.vdb: needs 0.0156 GiB of memory, but --memory of 0.001 GiB is used up; close other programs' \
  vam-optimize part.vdb --memory 0.001 -o x.exr
fails 71 'box.off: needs 0.0156 GiB of memory, but --memory of 0.001 GiB is used up' vam-slice box.off --memory 0.001 -o x.vdb
mv part.vdb free.vdb
quiet 'a need that is met' vam-slice box.off --memory=1 --voxel 0.2 -o part.vdb
same 'the bound is of no consequence, not even for the history' free.vdb part.vdb
fails 71 '^vam-view: figure: [0-9]+ x [0-9]+ pixels: needs [0-9.]+ GiB of memory, but --memory leaves 0.[0-9]+ GiB; reduce --image-size or --dpi, or write a PDF or SVG, or allow more with --memory$' \
  vam-view part.vdb -o x.png --dpi 1200 --memory 0.1
# Projections are not kept in scratch files.
fails 71 "^vam-optimize: part.vdb: $need" vam-optimize part.vdb --angles 3600 --memory 0.1 -o x.exr
fails 71 "^vam-optimize: part.vdb: $need" vam-optimize part.vdb --geometry parallel --angles 20000 --memory 0.1 -o x.exr
# Slices that light couples are optimised together: what does not fit in memory lies in scratch files.
box 5 5 0.5 >block.off
vam-slice block.off --voxel 0.016 --stretch-z 1 -o block.vdb
coupled='vam-optimize block.vdb --set vial.radius_mm=6 --method dose-norm --angles 12 --iterations 1'
quiet 'coupled slices in memory' sh -c "$coupled -o block.exr && mv block.exr free.exr"
quiet 'coupled slices of many angles in memory' vam-optimize part.vdb --angles 900 --iterations 1 --set projector.columns=512 -o many.exr && mv many.exr want.exr
ok 'in little more than their projections' vam-optimize part.vdb --angles 900 --iterations 1 --set projector.columns=512 --memory 0.06 -o many.exr
same 'the same bytes again' want.exr many.exr
mkdir scratch
ok 'coupled slices beyond --memory' sh -c "TMPDIR=scratch $coupled --memory 0.12 -o block.exr 2>warning"
ok 'a warning with both numbers and the remedy' grep -Eq \
  '^vam-optimize: warning: block.vdb: .* voxels: needs [0-9.]+ GiB of memory, but [0-9.]+ GiB are left; what does not fit is kept in scratch files in TMPDIR or /var/tmp, which is slower; allow more with --memory$' warning
same 'the same bytes' free.exr block.exr
is 'nothing is left of the scratch files in TMPDIR' "$(ls -A scratch)" ''
# A limit of file sizes is an error of writing, which leaves nothing; a response is not read without end.
fails 74 'limited.exr: cannot write' sh -c 'ulimit -f 4; vam-sinogram part.vdb --angles 90 -o limited.exr'
is 'nothing is left of it' "$(ls -A | grep -c 'limited')" 0

# What a file holds is quoted by its begin; a printer file is no stream.
python3 -c 'print("a" * 200000 + " = 1")' >long.toml
fails 65 "long.toml:1: unknown key 'a{64}\.\.\.' \(200000 bytes\)" vam-slice box.off --printer long.toml -o x.vdb
fails 64 "^vam-slice: x{2000}.* \.\.\. .*not section.key=value" vam-slice box.off --set "$(printf '%0100000d' 0 | tr 0 x)" -o x.vdb
fails 64 '-: printer settings are not read from standard input; name a file' vam-slice - --printer - -o x.vdb

# Places and intensities that no stack beside a vial has.
for wrong in row=1e30:'vam:row_mm' pixel=1e9:'vam:pixel_mm' step=1e6:'vam:angle_step_deg'; do
  $exr make wrong.exr space=projector width=64 height=8 count=2 ${wrong%%:*}
  fails 65 "wrong.exr: .*${wrong##*:}.* is 1e.*, beyond" vam-dose wrong.exr -o x.vdb
done
$exr make wrong.exr space=projector width=64 height=8 count=22 row=99
fails 65 'wrong.exr: vam:z_mm of image 21 is 2079, beyond 2000' vam-dose wrong.exr -o x.vdb
tiny_print tiny.exr
fails 66 '/dev/zero: is a device that never ends; name a file' vam-project tiny.exr --printer printer.toml --set projector.response=/dev/zero -o x.mkv
$exr make far.exr space=projector width=64 height=36 count=7500 row=0.26 reach=1 printer=none
fails 65 'projector: [0-9]+ rows of its images cross 16 slices, and 192 can' vam-dose far.exr --printer printer.toml -o x.vdb
$exr make wrong.exr space=projector width=64 height=36 count=3 value=1e30
fails 65 'wrong.exr: pixel 0, 0 of image 0 is 1e\+30, but intensities are at most 1e9' \
  vam-project wrong.exr --printer printer.toml -o x.mkv
$exr make wrong.exr space=virtual width=64 height=36 count=3 value=1e30 printer=none
fails 65 'wrong.exr: pixel 0, 0 of image 0 is 1e\+30, but intensities are at most 1e9' vam-dose wrong.exr -o x.vdb
$exr make wrong.exr space=projector width=64 height=36 count=3 value=-2
fails 65 'wrong.exr: has a value of -2 at z = [-0-9.]+ mm, 0 deg, column 0; intensity cannot be negative' \
  vam-project wrong.exr --printer printer.toml -o x.mkv
$exr make wrong.exr space=projector width=64 height=36 count=3 printer=AAAA
python3 -c '
data = open("wrong.exr", "rb").read()
at = data.rfind(b"AAAA")
open("wrong.exr", "wb").write(data[:at] + b"BBBB" + data[at + 4:])'
fails 65 'wrong.exr: image 2 has another vam:printer than image 0; all of a stack are made by the same commands' vam-check wrong.exr
$exr make large.exr space=camera kind=frames width=8192 height=8192 count=1 value=1 2>/dev/null
sanitized || fails 71 '^vam-view: needs [0-9.e-]+ GiB of memory in addition to the [0-9.e-]+ GiB in use; --memory allows 0.1 GiB$' vam-view large.exr --memory 0.1 -o x.png

done_testing
