#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# vam-calibrate working-curve: volumes and doses to the record of a resin, and what it refuses;
# tests/lib/metrology judges the fit.
. "$VAM_SOURCE/tests/tools/testlib.sh"
python3 - <<'PY'
import math, struct
def save(path, nz, ny, nx, value):
    head = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, %d), }" % (nz, ny, nx)
    head += " " * (-(len(head) + 11) % 64) + "\n"
    with open(path, "wb") as out:
        out.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode())
        out.write(struct.pack("<%df" % (nz * ny * nx), *(value(k) for k in range(nz) for _ in range(ny * nx))))
dose = lambda k: 20 + 6 * (k // 6)  # ten steps of 20 to 74 mJ/cm3
save("dose.npy", 60, 12, 12, dose)
save("scatter.npy", 60, 12, 12, lambda k: 0.08 / (1 + math.exp((50 - dose(k)) / 4)))
PY
volume() { vam-convert $1.npy --voxel 0.2 --grid $1 --value-unit "$2" -o $3.vdb; }
volume dose mJ/cm3 dose; volume dose relative relative; volume scatter 'view units per mm' scatter
quiet 'a working curve' vam-calibrate working-curve scatter.vdb --dose dose.vdb --lit-turns 1 -o curve.json
holds 'its critical dose' "($(json curve.json critical_dose_mj_cm3) - 50) ^ 2 < 0.05 ^ 2"
holds 'with a deviation' "$(json curve.json critical_dose_sigma_mj_cm3) < 0.1"
holds 'its induction dose' "($(json curve.json induction_dose_mj_cm3) - 42) ^ 2 < 0.3 ^ 2"
holds 'and its isovalue' "($(json curve.json isovalue) - 0.04) ^ 2 < 0.001 ^ 2"
is 'without a delay, from one volume' "$(grep -c delay_s curve.json) $(json curve.json volumes)" '0 1'
vam-check curve.json >checked
is 'the record is sealed' "$?" 0
quiet 'at an isovalue' vam-calibrate working-curve scatter.vdb --dose dose.vdb --lit-turns 1 --isovalue 0.02 -o low.json
holds 'the critical dose is lower' "($(json low.json critical_dose_mj_cm3) - (50 - 4 * log(3))) ^ 2 < 0.1 ^ 2"
vam-slice --shape box:x=2.4,y=2.4,z=6 --voxel 0.2 --stretch-z 1 -o block.vdb
ok 'vam-sdf takes the record' vam-sdf scatter.vdb block.vdb --resin curve.json --report sdf.json
fails 65 'doses are relative, not mJ/cm3' vam-calibrate working-curve scatter.vdb --dose relative.vdb
fails 65 'has no scatter-NNNN.vdb of vam-ost --live' vam-calibrate working-curve . --dose dose.vdb
mkdir turns; cp scatter.vdb turns/scatter-0000.vdb; cp scatter.vdb turns/scatter-0001.vdb
fails 65 'does not state its turns' vam-calibrate working-curve turns --dose dose.vdb
fails 65 'is not below the saturation 0.08' vam-calibrate working-curve scatter.vdb --dose dose.vdb --lit-turns 1 --isovalue 1
fails 64 'dose' vam-calibrate working-curve scatter.vdb
fails 66 'absent' vam-calibrate working-curve absent.vdb --dose dose.vdb
done_testing
