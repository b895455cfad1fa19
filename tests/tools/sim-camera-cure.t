#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK camera COST 110
# vam-sim camera --cure: the frames that a log says were shown, at the angles that another says, cure the resin; the
# views that vam-capture takes of it show vam-ost what is true.
. "$VAM_SOURCE/tests/tools/testlib.sh"
cat >printer.toml <<'TOML'
[projector]
columns = 96
rows = 48
pixel_mm = 0.2
axis_column = 47.5
axis_row = 23.5
throw_ratio = 5
max_intensity_mw_cm2 = 30
[vial]
radius_mm = 8
[resin]
index = 1.5
absorption_per_mm = 0.05
critical_dose_mj_cm3 = 60
[stage]
speed_deg_s = 30
[camera]
pixel_mm = 0.2
index_resin = 1.5
# end of the settings
TOML
fails 64 'cure-voxel: requires --cure' vam-sim camera --cure-voxel 0.3
fails 64 'resin.absorption_per_mm and resin.critical_dose_mj_cm3; set both' vam-sim camera --cure --set resin.absorption_per_mm=0
fails 64 "'x.png' must end in .vdb" vam-sim camera --cure --cured x.png

vam-slice --shape cylinder:diameter=5,height=4 --voxel 0.2 -o part.vdb
vam-optimize part.vdb --angles 60 --iterations 30 -o sino.exr --report light.json
vam-project sino.exr --turns 1 --accept-dose --fps 5 -o frames.mkv
# A print that was over a while ago, in step with nothing but its logs; the stage goes on for a turn of views.
python3 - "$(json light.json turns)" <<'PY'
import json, sys, time
turns = int(sys.argv[1])
speed, now, steps = 30.0, time.monotonic(), 60
begin = now - turns * 360 / speed - 20  # dark for 20 s: all radicals are spent
lit = turns * 360 / speed
with open("angles", "w") as log:
    for n in range(int((now + 200 - begin) / 0.05)):
        print(json.dumps({"t_monotonic_s": begin + 0.05 * n, "event": "angle", "angle_deg": speed * 0.05 * n,
                          "speed_deg_s": speed}), file=log)
with open("flips", "w") as log:
    for n in range(turns * steps):
        at = n * 360 / speed / steps
        print(json.dumps({"t_monotonic_s": begin + at, "event": "flip", "frame": n % steps}), file=log)
    print(json.dumps({"t_monotonic_s": begin + lit, "event": "flip", "frame": -1}), file=log)
PY
camera_up --cure --follow angles --flips flips --projected frames.mkv --cured cured.vdb --columns 96 --rows 60 \
  --noise 0.002 --log truth
ok 'a turn of views, every 6 degrees' vam-capture --device aravis:127.0.0.1 --fps 5 --frames 60 -o views/
camera_down
is 'the log has the seconds of light' "$(tail -n 1 truth | sed 's/.*"lit_s":\([0-9]*\).*/\1/')" $((12 * $(json light.json turns)))
ok 'the true state is the part' vam-sdf cured.vdb part.vdb --isovalue 1 --require 'rms<=0.12' --report true.json
ok 'a volume of the views' vam-ost views --view-step 6 -o scatter.vdb
ok 'shows it' vam-sdf scatter.vdb part.vdb --isovalue 0.04 --require 'rms<=0.15' --report seen.json
done_testing
