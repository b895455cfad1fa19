# SPDX-License-Identifier: GPL-3.0-or-later
# vam-convert: HDF5 files, written by h5py. 77 where that is not installed.
. "$VAM_SOURCE/tests/tools/testlib.sh"

python=/usr/bin/python3
"$python" -c 'import h5py' 2>/dev/null || { echo 'h5py is not installed'; exit 77; }
values() { $npy show b.npy; }
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
    vam-convert kinds.h5 --array "$way$kind" --voxel 0.5 --grid weight | vam-convert >b.npy
    is "$way $kind" "$(values)" "$want"
  done
done
for name in szip /compact/inner/deep; do
  vam-convert kinds.h5 --array $name --voxel 0.5 --grid weight | vam-convert >b.npy
  is "$name" "$(values)" "$want"
done
vam-convert kinds.h5 --array truth --voxel 0.5 | vam-convert >b.npy
is 'truth values' "$(values)" "2 3 4 <f4$(seq 0 23 | awk '{ printf " %d", ($1 > 11) } END { print "" }')"
vam-convert kinds.h5 --array szip --axes xyz --voxel 0.5 --grid weight | vam-convert >b.npy
is 'axes in another order' "$(values | cut -d' ' -f1-8)" '4 3 2 <f4 0 12 4 16'
made one.dat <<'PY'
f["group/only"] = a
f["note"] = "text"
PY
for how in 'vam-convert one.dat' 'vam-convert <one.dat' 'cat one.dat | vam-convert'; do
  sh -c "$how --voxel 0.5 --grid weight" | vam-convert >b.npy
  is "the only array, by signature: $how" "$(values)" "$want"
done
"$python" -c 'import h5py, numpy
f = h5py.File("matlab.mat", "w", userblock_size=512); f["a"] = numpy.arange(24).reshape(2, 3, 4); f.close()
f = open("matlab.mat", "r+b"); f.write(b"MATLAB 7.3 MAT-file")'
vam-convert matlab.mat --voxel 0.5 --grid weight | vam-convert >b.npy
is 'behind the block of another program' "$(values)" "$want"

# Projections as tomography keeps them: the dose is that of the stack, to the byte.
vam-slice --shape disc-grid --voxel 0.5 -o part.vdb
vam-sinogram part.vdb --filter ram-lak --negative clip -o sino.exr
vam-convert sino.exr -o sino.npy
vam-dose sino.exr --like part.vdb | vam-convert >dose.npy
made scan.h5 <<'PY'
s = numpy.load("sino.npy")[::-1].transpose(1, 0, 2)
f.create_dataset("exchange/data", data=s, chunks=(1, *s.shape[1:]), compression="gzip")
f["exchange/data_white"] = numpy.ones((5, *s.shape[1:]), "f4")
f["exchange/theta"] = numpy.arange(360.0).astype("f4")
f["exchange/theta"].attrs["units"] = "degrees"
PY
made scan.nxs <<'PY'
s = numpy.load("sino.npy")[::-1].transpose(1, 0, 2)
flat, dark = 9 * numpy.ones((2, *s.shape[1:]), "f4"), numpy.zeros((3, *s.shape[1:]), "f4")
tomo = f.create_group("entry1/tomo_entry")
tomo.attrs["NX_class"] = "NXentry"
detector = tomo.create_group("instrument/detector")
detector["data"] = numpy.concatenate([dark, s[:100], flat, s[100:], flat])
detector["image_key"] = [2] * 3 + [0] * 100 + [1] * 2 + [0] * 260 + [1] * 2
angles = numpy.radians(numpy.concatenate([[0] * 3, numpy.arange(100), [99] * 2, numpy.arange(100, 360), [0] * 2]))
tomo["sample/rotation_angle"] = angles
tomo["sample/rotation_angle"].attrs["units"] = "rad"
tomo["data/data"], tomo["data/rotation_angle"] = detector["data"], h5py.SoftLink("/entry1/tomo_entry/sample/rotation_angle")
tomo["data"].attrs["NX_class"], tomo["data"].attrs["signal"] = "NXdata", "data"
f["entry1/reconstruction"] = numpy.zeros((2, 2, 2), "f4")
PY
for scan in scan.h5 scan.nxs; do
  vam-convert $scan --geometry parallel --pixel 0.5 -v -o back.exr 2>err
  is "$scan: its angles are reported" "$(grep -c "$scan: 360 projections from 0 deg in steps of 1 deg, by /e.*\(theta\|rotation_angle\)" err)" 1
  vam-dose back.exr --like part.vdb | vam-convert >again.npy
  same "$scan: the dose is that of the stack" dose.npy again.npy
done
vam-convert scan.h5 --geometry parallel --pixel 0.5 --axis-row 0 -o back.exr
is 'row 0 is at the top' "$(vam-view back.exr --export /dev/stdout | grep -a '^axis mins' | cut -d' ' -f5)" \
  "-$("$python" -c 'import numpy; print((len(numpy.load("sino.npy")) - 1) * 0.5)' | sed 's/\.0$//')"

# Stage angles.
angles() {  # angles EXPRESSION OPTION...: the second axis of the stack of 1 x 8 x 3 with them
  expression=$1; shift
  made angles.h5 <<PY
f["exchange/data"] = numpy.arange(24).reshape(8, 1, 3)
f["exchange/theta"] = $expression
PY
  vam-convert angles.h5 --geometry parallel --pixel 1 "$@" | vam-view --export /dev/stdout | grep -a '^sizes\|^axis mins\|^spacings' | tr '\n' ' '
}
is 'a turn and its start' "$(angles '90 + 45.0 * numpy.arange(8)')" 'sizes: 3 8 1 spacings: 1 45 1 axis mins: -1 90 0 '
is 'backwards, beyond a turn, a little off' "$(angles '360 - 90.0 * numpy.arange(8) + [0, 2, -2, 1, 0, 0, 3, 0]')" \
  'sizes: 3 4 1 spacings: 1 90 1 axis mins: -1 0 0 '
is 'the option goes before' "$(angles 'numpy.arange(8.0) ** 2' --view-step 45)" 'sizes: 3 8 1 spacings: 1 45 1 axis mins: -1 0 0 '
uneven() {  # uneven EXPRESSION REGEX
  angles "$1" >/dev/null 2>&1
  fails 65 "$2" vam-convert angles.h5 --geometry parallel --pixel 1 -o x.exr
}
uneven '45.0 * numpy.array([0, 1, 2, 4, 5, 6, 7, 8])' 'angles.h5: the stage angles are uneven: from projection 2 to 3 they go from 90 to 180 degrees, while the median step is 45 \(/exchange/theta\); give --view-step'
uneven '[5.0] * 8' 'from projection 0 to 1 they go from 5 to 5 degrees'
uneven '41.6 * numpy.arange(8.0)' 'the stage angles drift: that of projection [0-9]+ is [-0-9.]+ degrees beside even steps of 40'
uneven '45.0 * numpy.arange(7)' 'has 7 angles \(/exchange/theta\) of 8 projections'
uneven 'numpy.zeros(0)' 'has 0 angles \(/exchange/theta\) of 8 projections; check --axes, or give --view-step'
is 'which is given' "$(angles 'numpy.zeros(0)' --view-step 45)" 'sizes: 3 8 1 spacings: 1 45 1 axis mins: -1 0 0 '
uneven '[0, 45, numpy.nan, 135, 180, 225, 270, 315]' 'angle 2 of /exchange/theta is no angle'
uneven '22.5 * numpy.arange(8)' 'has 8 projections, 16 make a turn'

# What is refused.
made bad.h5 <<'PY'
f.create_dataset("packed", data=a[0], chunks=(3, 4), compression="lzf")
PY
refused() { fails "$2" "$3" vam-convert bad.h5 --array "$1" --voxel 1 -o x.vdb; }
refused packed 65 'bad.h5: /packed is packed by lzf, which is not read; save it unpacked, or packed by gzip, with the program that wrote it$'
made big.h5 <<'PY'
f.create_dataset("a", (2, 12000, 12000), "u1", chunks=(1, 1000, 1000), compression="gzip")[0, 0, 0] = 1
PY
fails 71 'needs 0.5.* GiB of memory .* --memory allows 0.3 GiB' vam-convert big.h5 --voxel 1 --memory 0.3 -o x.vdb
is 'nothing is left behind' "$(ls x.* 2>/dev/null)" ''
done_testing
