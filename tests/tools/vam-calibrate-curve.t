#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# vam-calibrate working-curve: volumes and doses to the record of a resin, and what it refuses;
# tests/lib/metrology judges the fit.
. "$VAM_SOURCE/tests/tools/testlib.sh"
$npy of dose.npy 60,12,12 '20 + 6 * (k // 6)'  # ten steps of 20 to 74 mJ/cm3
$npy of scatter.npy 60,12,12 '0.08 / (1 + exp((50 - 20 - 6 * (k // 6)) / 4))'
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
fails 65 'not mJ/cm3' vam-calibrate working-curve scatter.vdb --dose relative.vdb
fails 65 'has no scatter-NNNN.vdb of vam-ost --live' vam-calibrate working-curve . --dose dose.vdb
mkdir turns; cp scatter.vdb turns/scatter-0000.vdb; cp scatter.vdb turns/scatter-0001.vdb
fails 65 'does not state its turns' vam-calibrate working-curve turns --dose dose.vdb
fails 65 'is not below the saturation 0.08' vam-calibrate working-curve scatter.vdb --dose dose.vdb --lit-turns 1 --isovalue 1
fails 64 'dose' vam-calibrate working-curve scatter.vdb
fails 66 'absent' vam-calibrate working-curve absent.vdb --dose dose.vdb

# Views of a staircase, half a turn of them before the light; radicals live for 1.5 s of a turn of 6 s. Those of a turn
# show its mean.
mkdir views
PYTHONPATH=$VAM_SOURCE/tests/tools python3 - <<'PY'
import json, math, random
from scans import write_png
per_turn = lambda k: 4 + 1.5 * (k // 4)  # ten steps of four rows, mJ/cm3
def density(k, turn):
    lit = turn - 0.5 * 50 / per_turn(k)
    dose = per_turn(k) * max(0, turn) - per_turn(k) * 0.25 * (1 - math.exp(-lit / 0.25) if lit > 0 else 0)
    return 0.08 / (1 + math.exp((50 - dose) / 4))
chord = [2 * math.sqrt(max(0, 3 ** 2 - (0.2 * (c - 23.5)) ** 2)) for c in range(48)]
random.seed(1)
with open("views/manifest.jsonl", "w") as manifest:  # as vam-capture writes it
    print('{"schema": "vam-capture/1"}', file=manifest)
    for n in range(300):
        if n % 30 == 0:
            rows = [density(39 - r, n / 30) for r in range(40)]
        write_png("views/%06d.png" % n, [[65535 * (0.002 + random.gauss(0, 0.0005) + s * c) for c in chord]
                                         for s in rows])
        print(json.dumps({"frame": n, "number": n, "t_monotonic_s": 100 + 0.2 * n, "angle_deg": 12 * n, "complete": True,
                          "levels": ""}), file=manifest)
PY
$npy of turn.npy 40,32,32 '(4 + 1.5 * (k // 4)) * (hypot(j - 15.5, i - 15.5) < 13)'
vam-convert turn.npy --voxel 0.2 --grid dose --value-unit mJ/cm3 -o turn.vdb
ok 'volumes of ten turns' vam-ost views --live --no-refraction --pixel 0.2 --axis-column 23.5 --tilt 0 -o live
curve() { vam-calibrate working-curve live --dose turn.vdb "$@"; }
quiet 'their working curve' curve --lit-from 0.5 -o delayed.json
holds 'the delay in seconds' "($(json delayed.json delay_s) - 1.5) ^ 2 < 0.05 ^ 2"  # a view is 0.2 s
holds 'and the critical dose' "($(json delayed.json critical_dose_mj_cm3) - 50) ^ 2 < 0.1 ^ 2"
quiet 'with the light from the first view on' curve -o early.json
holds 'it is half a turn longer, or more' "$(json early.json delay_s) > 4"
quiet 'in four classes' curve --lit-from 0.5 --classes 4 -o coarse.json
is 'fewer readings, one a class and turn' "$(json delayed.json readings) $(json coarse.json readings)" '100 40'
done_testing
