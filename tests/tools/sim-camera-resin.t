#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK camera COST 110
# vam-sim camera --cure: each option of the resin does what it says to the true state, by closed forms of the conversion
# p / p_c = (1 - 0.7^x) / 0.3, x = (D / D_c - h) / (1 - h), h being the inhibitor's share.
. "$VAM_SOURCE/tests/tools/testlib.sh"
cat >printer.toml <<'TOML'
[projector]
columns = 32
rows = 16
pixel_mm = 0.4
axis_column = 15.5
axis_row = 7.5
telecentric = true
max_intensity_mw_cm2 = 24
[vial]
radius_mm = 4
[resin]
index = 1.5
absorption_per_mm = 0.02
critical_dose_mj_cm3 = 60
[camera]
pixel_mm = 0.2
index_resin = 1.5
# end of the settings
TOML
# 20 s of light on a stage that stood, long ago; then it turns, as the state is written at every quarter turn.
python3 - <<'PY'
import json, time
now = time.monotonic()
with open("angles", "w") as log:
    print(json.dumps({"t_monotonic_s": now - 100, "event": "standing", "angle_deg": 0}), file=log)
    for n in range(6000):
        print(json.dumps({"t_monotonic_s": now + 0.05 * n, "event": "angle", "angle_deg": 18 * n, "speed_deg_s": 360}),
              file=log)
with open("flips", "w") as log:
    for at, frame in (90, 0), (70, -1):
        print(json.dumps({"t_monotonic_s": now - at, "event": "flip", "frame": frame}), file=log)
PY
capture() { timeout 20 vam-capture --device aravis:127.0.0.1 --fps 20 --frames 1 -o "$1/" >said 2>&1; }
state() {  # state NAME OPTIONS...: of the middle, the lowest and the highest voxel on the axis x; of all the mean
  name=$1; shift
  camera_up --cure --cure-voxel 0.5 --follow angles --flips flips --columns 64 --rows 40 --cured "$name.vdb" "$@"
  capture "views-$name"
  camera_down
  vam-convert "$name.vdb" -o "$name.npy"
  python3 - "$name.npy" >"$name.json" <<'PY'
import json, math, re, struct, sys
data = open(sys.argv[1], "rb").read()
start = 10 + struct.unpack_from("<H", data, 8)[0]
nz, ny, nx = map(int, re.search(rb"\((\d+), (\d+), (\d+)\)", data[:start]).groups())
values = struct.unpack_from("<%df" % (nz * ny * nx), data, start)
x = lambda k: math.log(1 - 0.3 * values[(k * ny + ny // 2) * nx + nx // 2]) / math.log(0.7)
json.dump({"middle": x(nz // 2), "low": x(0), "high": x(nz - 1), "mean": sum(values) / len(values)}, sys.stdout)
PY
}
near() {  # near NAME FILE KEY EXPRESSION: within 2 %
  holds "$1" "($(json "$2.json" "$3") / ($4) - 1) ^ 2 < 0.02 ^ 2"
}

state usual --pattern grey
dose() { echo "(0.5 + 0.5 * $(json usual.json "$1"))"; }  # D / D_c
holds 'about twice the critical dose on the axis, as the vial is a lens' "$(dose middle) > 1.6 && $(dose middle) < 2.4"
state induction --pattern grey --induction 0.2
near 'a lower induction leaves more' induction middle "($(dose middle) - 0.2) / 0.8"
state gradient --pattern grey --inhibition-gradient 1
near 'a gradient leaves the middle as it was' gradient middle "$(json usual.json middle)"
near 'it has less inhibitor below' gradient low "($(dose low) - 0.25) / 0.5"
near 'and more above' gradient high "($(dose high) - 0.75) / 0.5"
state lamp --pattern grey --lamp-drift=-3
near 'a lamp that fades by 100 % in 20 s gives half the light' lamp middle "($(dose middle) / 2 - 0.5) / 0.5"
state delay --pattern grey --cure-delay 10000
holds 'radicals that live for hours have hardly begun' "$(json delay.json middle) < 0.05 * $(json usual.json middle)"
state lifetime --pattern grey --set resin.dose_lifetime_s=10000
holds 'also by the lifetime of the printer file' "$(json lifetime.json middle) < 0.05 * $(json usual.json middle)"
state row --pattern row --width 2
state diffusion --pattern row --width 2 --inhibitor-diffusion 0.1
holds 'inhibitor comes in where few rows are lit' "$(json diffusion.json middle) < 0.85 * $(json row.json middle)"

camera_up --flips none --glow 0 --columns 64 --rows 40 --specks 8
capture specks
camera_down
holds 'specks differ from an even image' "$($png colours "$(ls specks/*.png)") > 4"

echo '{"t_monotonic_s":1.0,"event":"frames","turn":3,"sinogram":"new.exr"}' >>flips
camera_up --cure --follow angles --flips flips --pattern grey
is 'a sinogram that is not there ends it' "$? $(grep -c 'new.exr: cannot open' camera.err)" '66 1'
exec 9>&-
done_testing
