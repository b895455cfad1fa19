# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS clock COST 200
# trials: 100
# A print or a calibration of which a tool and its guardian are killed, or vam-print with one of them [devices §7]: image
# and LEDs are off, the relay is open and the stage stands within 2 s, and a line says so. A fifth of VAM_TRIALS a cause (5; 100: "long").
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:$PATH; export PATH
ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0  # what is preloaded for the simulated bus keeps 16 bytes
tiny_print frames.exr
printf 'relay = "relay:%s/relay"\n' "$PWD" >>printer.toml
printf '[stage]\ndevice = "gcs:%s/stage"\nspeed_deg_s = 180\n' "$PWD" >>printer.toml
screen_up 64 48
python3 "$VAM_SOURCE/tests/device/print_trials.py" $((${VAM_TRIALS:-5} / 5)) several >table; status=$?
screen_down
cat table
is 'every trial was dark and still in time' $status 0
is 'every cause was tried' "$(grep -c trials table)" 43
unguarded=', and no guardian says that all is safe'
said() { grep -c "^$1 killed$2; vam-devices off: light .* in standby, relay .* open, stage .* stopped$" said; }
ok 'a line says so, of each tool' test "$(said 'vam-print: project was' "$unguarded")" -ge 1 -a "$(said 'vam-print: stage was' "$unguarded")" -ge 1
ok 'also when vam-print was killed, too' test "$(said 'vam-print: vam-print and project were' "$unguarded")" -ge 1 -a "$(said 'vam-print: vam-print and stage were' "$unguarded")" -ge 1
ok 'also of a calibration' test "$(said 'vam-calibrate: a tool was' '')" -ge 1
is 'nothing was left on' "$(grep -c 'MAY BE ON' said)" 0
done_testing
