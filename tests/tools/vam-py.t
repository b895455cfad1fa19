# SPDX-License-Identifier: GPL-3.0-or-later
# scripts/vam.py: arrays to volumes and stacks and back, with and without NumPy, and a print of one.
. "$VAM_SOURCE/tests/tools/testlib.sh"

cat >arrays.py <<'PY'
import array, math, sys
sys.path.insert(0, sys.argv[1])
import vam
if sys.argv[2] == "plain":
    vam.numpy = None
shape = (6, 30, 40)
ball = array.array("f", [0]) * math.prod(shape)
for at in range(len(ball)):
    x, y, z = at % 40, at // 40 % 30, at // 1200
    ball[at] = min(1, max(0, 9.5 - math.hypot(x - 19.5, y - 14.5))) if 0 < z < 5 else 0
rows = array.array("f", [i * 37 % 101 / 101 for i in range(3 * 36 * 64)])
as_array = lambda values, shape: values if vam.numpy is None else vam.numpy.array(values).reshape(shape)
flat = lambda values: list(values) if vam.numpy is None else values.ravel().tolist()
vam.write_volume("ball.vdb", as_array(ball, shape), 0.25, shape=shape)
values, facts = vam.read("ball.vdb", "target")
print(flat(values) == list(ball), facts["shape"] == shape, facts["spacing"], facts["origin"], facts["stretch_z"])
vam.write_volume("high.vdb", values, 0.25, shape=shape, stretch_z=1.0381)
print(vam.read("high.vdb", "target")[1]["stretch_z"], vam.read("sliced.vdb")[1]["stretch_z"])
vam.write_stack("rows.exr", as_array(rows, (3, 36, 64)), 0.26, 0.3, shape=(3, 36, 64))
values, facts = vam.read("rows.exr")
print(flat(values) == list(rows), facts["shape"], facts["spacing"], facts["origin"])
try:
    vam.write_volume("none.vdb", array.array("f", [1, 2]), 0.25)
except ValueError as error:
    print(error)
try:
    vam.write_volume("none.vdb", array.array("f", [1]), 0.25, shape=(1, 1, 1), stretch_z=0)
except ValueError as error:
    print(error)
PY
cat >want <<'END'
True True (0.25, 0.25, 0.25) (-0.625, -3.625, -4.875) 1.0
1.0381 1.038
True (3, 36, 64) (0.3, 10.0, 0.26) (-0.3, 0.0, -8.19)
shape=(slices, rows, columns) of all the values is needed
stretch_z is a factor of 0.1 to 10
END
scripts=$VAM_SOURCE/scripts
vam-slice --shape box:x=2,y=2,z=1 --voxel 0.25 --stretch-z 1.038 -o sliced.vdb
ok "with Python alone" sh -c 'python3 arrays.py "$1" plain >got' - "$scripts"
same "what was written comes back" got want
if python3 -c 'import numpy' 2>/dev/null; then
  ok "with NumPy" sh -c 'python3 arrays.py "$1" numpy >got' - "$scripts"
  same "what was written comes back, in its shape" got want
fi
ok "all are whole" vam-check ball.vdb high.vdb rows.exr
ok "the view is in mm of the print" sh -c 'vam-view high.vdb --at 9 -o x.png 2>&1 | grep -q "reaches from -0.6021 mm to 0.6021 mm"'
ok "OpenVDB's own tool reads it" sh -c 'vdb_print ball.vdb | grep -q "^target"'
quiet "it can be optimised" vam-optimize ball.vdb --angles 60 --iterations 3 -o light.exr
ok "and judged" sh -c 'vam-dose light.exr --like ball.vdb | vam-score --target ball.vdb'
is "nothing is left of what was refused" "$(ls none.vdb 2>/dev/null)" ""
done_testing
