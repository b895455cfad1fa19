#!/bin/sh
# What vam-print decides before anything moves or shines, and what it says of a print that went otherwise than asked: on a
# simulated stage and camera, without a screen.
[ -w /dev/shm ] && TMPDIR=/dev/shm && export TMPDIR
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
tiny_print frames.exr
printf '[stage]\ndevice = "sim:?acceleration_deg_s2=9000&travel_deg=1e7"\nspeed_deg_s = 90\n' >>printer.toml
print() { vam-print frames.exr --screen null: --light sim: --uncalibrated --missed 0.9 --run-up 0.05 "$@"; }

# A sinogram for another printer.
fails 65 'frames.exr: was computed for another printer: vial.radius_mm 12.7, now 6; ' print --set vial.radius_mm=6 --run other
ok 'which can be accepted' print --set vial.radius_mm=6 --accept-printer --run accepted
is 'and is reported' "$(grep -c 'vial.radius_mm 12.7, now 6; accepted' .log/err) $(json accepted/summary.json project.printer_differences)" "1 ['vial.radius_mm 12.7, now 6']"
done_testing
