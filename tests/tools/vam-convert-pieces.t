# SPDX-License-Identifier: GPL-3.0-or-later
# Pieces of stacks: cut, computed apart, joined to the bytes of the undivided stack.
. "$VAM_SOURCE/tests/tools/testlib.sh"

vam-slice --shape gyroid:diameter=1.6,height=9 --voxel 0.1 -o part.vdb || exit 1
vam-sinogram part.vdb --angles 24 -o whole.exr
n=$(vam-check whole.exr | sed -n 's/.*stack of \([0-9]*\) images.*/\1/p')
vam-convert cut whole.exr --slices 0:20 -o a.exr && vam-convert cut whole.exr --slices "20:$n" -o b.exr
quiet 'pieces are joined, in any order' vam-convert join b.exr a.exr -o joined.exr
same 'to the undivided stack' whole.exr joined.exr
is 'a piece is named' "$($exr attr a.exr vam:piece)" "0:20 of $n"
ok 'and intact' vam-check a.exr b.exr
for i in 1 2 3; do vam-convert cut whole.exr --slices $i/3; done >stream || report 1 'shares are cut'
vam-convert join <stream >piped.exr
vam-convert join <whole.exr >copied.exr
same 'shares through a pipe are the undivided stack' piped.exr copied.exr
vam-convert cut b.exr --slices 30:40 -o c.exr && vam-convert cut whole.exr --slices 30:40 -o d.exr
same 'a piece of a piece is a piece of the whole' c.exr d.exr
vam-convert join b.exr - <a.exr -o joined.exr; same 'a file and stdin' whole.exr joined.exr
vam-convert join a.exr - <b.exr -o joined.exr; same 'in any order' whole.exr joined.exr
vam-convert cut --slices 0:3 -o c.exr <a.exr && vam-convert cut whole.exr --slices 0:3 -o d.exr
same 'a piece of a piece through a pipe' c.exr d.exr
vam-convert cut b.exr --slices 30:40 -o c.exr
for piece in a b; do vam-resample $piece.exr >r$piece.exr 2>/dev/null; done
vam-convert join ra.exr rb.exr >rjoined.exr 2>errors
ok 'pieces with other histories are refused' grep -q 'differs from ra.exr in its history; join pieces of one stack' errors
for how in '-o f.exr' '--freeze f.toml' '-o null: --plan'; do
  fails 65 "ra.exr: holds 20 of $n slices \(vam:piece 0:20 of $n\); join the pieces by vam-convert join" vam-project ra.exr $how
done

$exr make frames.exr kind=frames space=camera width=6 height=5 count=4
vam-convert join frames.exr -o all.exr && vam-convert cut frames.exr --slices 0:1 -o f1.exr && vam-convert cut frames.exr --slices 1:4 -o f2.exr
vam-convert join f1.exr f2.exr -o f.exr
same 'frames are cut and joined, too' all.exr f.exr

# ---- memory: 0.5 kB for each image -----------------------------------------------------------------------------------
vam-slice --shape cylinder:diameter=0.25,height=360 --voxel 0.018 --any-height --stretch-z 1 2>/dev/null |
  vam-sinogram --angles 24 -o tall.exr
peak() {  # peak COMMAND...: its peak RSS in KiB
  python3 -c 'import os, sys
pid = os.spawnvp(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(pid, 0)
print(usage.ru_maxrss if status == 0 else "failed")' "$@"
}
if sanitized; then
  echo '# the memory of a sanitizer is not measured'
else
  low=$(peak vam-convert cut tall.exr --slices 0:1000 -o low.exr) high=$(peak vam-convert join tall.exr -o all.exr)
  same '20000 images are copied' tall.exr all.exr
  [ $((high - low)) -le $((19000 / 2)) ]; report $? "in memory that hardly grows with them: $low and $high KiB"
fi

# ---- what is no stack together ---------------------------------------------------------------------------------------
fails 65 'c.exr: holds images 30:40, but the pieces before it end at 20; the piece in between is missing' vam-convert join a.exr c.exr -o x.exr
fails 65 'c.exr: holds images 30:40, but the pieces before it end at .*; omit one of those that overlap' vam-convert join a.exr b.exr c.exr -o x.exr
fails 65 'whole.exr: is no piece of a stack \(no vam:piece\)' vam-convert join a.exr whole.exr -o x.exr
fails 64 "'5:5' is neither" vam-convert cut none.exr --slices 5:5 -o x.exr
fails 65 "stdin: ends after image 20 of $n; the other pieces are missing" sh -c 'vam-convert join <a.exr -o x.exr'
fails 65 'stdin: .*the piece in between is missing' sh -c 'cat a.exr c.exr | vam-convert join -o x.exr'
fails 65 'another stack follows, which is no piece' sh -c 'cat whole.exr whole.exr | vam-convert join -o x.exr'
vam-sinogram part.vdb --angles 36 -o other.exr && vam-convert cut other.exr --slices "20:$n" -o ob.exr
fails 65 'ob.exr: differs from a.exr in its image size' vam-convert join a.exr ob.exr -o x.exr
python3 - <<'PY'
data = open('a.exr', 'rb').read()
open('bad.exr', 'wb').write(data.replace(b'0:20 of ', b'0:19 of '))
open('odd.exr', 'wb').write(data.replace(b'0:20 of ', b'0:20 on '))
PY
fails 65 "bad.exr: the header of part 0 changed after it was written" vam-convert cut bad.exr --slices 0:5 -o x.exr
fails 65 "odd.exr: vam:piece is '0:20 on $n', not like '64:128 of 160'" vam-convert cut odd.exr --slices 0:5 -o x.exr

done_testing
