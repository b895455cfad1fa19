# SPDX-License-Identifier: GPL-3.0-or-later
# vam-convert: HDF5 files, written by h5py. 77 where that is not installed.
. "$VAM_SOURCE/tests/tools/testlib.sh"

python=/usr/bin/python3
"$python" -c 'import h5py' 2>/dev/null || { echo 'h5py is not installed'; exit 77; }
values() { vam-convert --voxel 0.5 --grid weight "$@" | vam-convert >b.npy; $npy show b.npy; }  # values ARGUMENT...
made() {  # made FILE: of the Python on standard input, f the file, a the numbers 0 to 23
  { printf 'import sys, numpy, h5py\na = numpy.arange(24).reshape(2, 3, 4)\nf = h5py.File(sys.argv[1], "w")\n'; cat; echo 'f.close()'; } >make.py
  "$python" make.py "$1"
}

# What h5py writes, in every packing that libhdf5 has.
want="2 3 4 <f4$(seq 0 23 | awk '{ printf " %d", $1 } END { print "" }')"
made kinds.h5 <<'PY'
for kind in ("i1", "u1", "<i2", ">i2", "<u4", ">i8", "<f2", ">f4", "<f8"):
    f["plain" + kind] = a.astype(kind)
    f.create_dataset("packed" + kind, data=a.astype(kind), chunks=(1, 2, 3), compression="gzip", shuffle=True, fletcher32=True)
f["truth"] = a > 11
f.create_dataset("szip", data=a.astype("f4"), chunks=(2, 3, 4), compression="szip")
f["compact/inner/deep"] = a
PY
for kind in i1 u1 '<i2' '>i2' '<u4' '>i8' '<f2' '>f4' '<f8'; do
  for way in plain packed; do
    is "$way $kind" "$(values kinds.h5 --array "$way$kind")" "$want"
  done
done
for name in szip /compact/inner/deep; do is "$name" "$(values kinds.h5 --array $name)" "$want"; done
is 'truth values' "$(values kinds.h5 --array truth)" "2 3 4 <f4$(seq 0 23 | awk '{ printf " %d", ($1 > 11) } END { print "" }')"
is 'axes in another order' "$(values kinds.h5 --array szip --axes xyz | cut -d' ' -f1-8)" '4 3 2 <f4 0 12 4 16'
made one.dat <<'PY'
f["group/only"] = a
f["note"] = "text"
PY
is 'the only array, by signature' "$(values one.dat)" "$want"
is 'as standard input' "$(values <one.dat)" "$want"
is 'from a pipe' "$(cat one.dat | values)" "$want"
"$python" -c 'import h5py, numpy
f = h5py.File("matlab.mat", "w", userblock_size=512); f["a"] = numpy.arange(24).reshape(2, 3, 4); f.close()
f = open("matlab.mat", "r+b"); f.write(b"MATLAB 7.3 MAT-file")'
is 'behind the block of another program' "$(values matlab.mat)" "$want"

# Projections in another order: the dose is that of the stack, to the byte.
vam-slice --shape disc-grid --voxel 0.5 -o part.vdb
vam-sinogram part.vdb --filter ram-lak --negative clip -o sino.exr
vam-convert sino.exr -o sino.npy
vam-dose sino.exr --like part.vdb | vam-convert >dose.npy
made scan.h5 <<'PY'
s = numpy.load("sino.npy").transpose(1, 0, 2)
f.create_dataset("exchange/data", data=s, chunks=(1, *s.shape[1:]), compression="gzip")
f["exchange/data_white"] = numpy.ones((5, *s.shape[1:]), "f4")
PY
vam-convert scan.h5 --array exchange/data --axes azx --view-step 1 --geometry parallel --pixel 0.5 |
  vam-dose --like part.vdb | vam-convert >again.npy
same 'the dose of a scan is that of the stack' dose.npy again.npy

# What is refused.
made bad.h5 <<'PY'
f.create_dataset("packed", data=a[0], chunks=(3, 4), compression="lzf")
PY
fails 65 'bad.h5: /packed is packed by lzf, which is not read; save it unpacked, or packed by gzip, with the program that wrote it$' \
  vam-convert bad.h5 --array packed --voxel 1 -o x.vdb
made big.h5 <<'PY'
f.create_dataset("a", (2, 12000, 12000), "u1", chunks=(1, 1000, 1000), compression="gzip")[0, 0, 0] = 1
PY
fails 71 'needs 0.5.* GiB of memory .* --memory allows 0.3 GiB' vam-convert big.h5 --voxel 1 --memory 0.3 -o x.vdb
is 'nothing is left behind' "$(ls x.* 2>/dev/null)" ''
done_testing
