# SPDX-License-Identifier: GPL-3.0-or-later
# make.sh CORPUS: how the files of this folder were made, in an empty folder, with the tools of commit a9f35f54 on the path and
# its tests/corpus. They are not made again: they stand for what users have (vam-formats(7), FORMAT VERSIONS). ../old.txt
# reads them, and the run folder ../print/run of that time.
set -e
corpus=$1
vam-slice --print-printer --set projector.columns=40 --set projector.rows=14 --set projector.pixel_mm=0.4 \
  --set projector.axis_column=19.5 --set projector.axis_row=6.5 --set projector.fps=2 -o printer.toml
vam-slice --shape handle:diameter=5,length=4,bore=2 --insert-shape cylinder:diameter=2,height=6 --printer printer.toml \
  --voxel 0.4 -o part.vdb --report slice.json
vam-sinogram part.vdb --angles 24 --filter hann --negative clip -o sinogram.exr
vam-resample sinogram.exr --printer printer.toml -o light.exr
vam-resample sinogram.exr --printer printer.toml --half --compression piz -o light-half.exr
vam-project light.exr --printer printer.toml --speed 30 --fps 2 -o frames.exr
vam-project light.exr --printer printer.toml --speed 30 --fps 2 -o print.mkv
vam-project light.exr --printer printer.toml --speed 30 --fps 1 -o frames --report project.json
vam-optimize part.vdb --printer printer.toml --angles 24 --method fbp -o optimized.exr --report optimize.json
vam-dose optimized.exr --printer printer.toml --like part.vdb -o dose.vdb --report dose.json
vam-score dose.vdb --target part.vdb --report score.json >/dev/null
vam-slice --shape box:x=3,y=3,z=2 --voxel 0.4 --stretch-z 1 -o design.vdb
for ending in 3mf obj stl ply; do
  vam-score --grid target design.vdb --mesh box.$ending >/dev/null
done
vam-view design.vdb --export design.nrrd
vam-convert design.vdb -o design.npy
vam-plan --shape box:x=3,y=3,z=2 --printer printer.toml --report plan.json >/dev/null
seq 0 23 | awk 'BEGIN { print "angle_deg,dx_mm,dy_mm,dz_mm,moves" } { print 15 * $1 ",0,0," (-$1 / 80) ",part" }' >poses.csv
vam-optimize part.vdb --printer printer.toml --angles 24 --poses poses.csv --method fbp -o posed.exr
for n in 1 2 3; do
  vam-slice --shape box:x=3.$n,y=3,z=2.1 --voxel 0.4 --stretch-z 1 -o print.vdb
  vam-sdf print.vdb design.vdb --isovalue 0.5 --align none --samples 1000 --report sdf$n.json -o away.ply \
    --volume away.vdb --volume-voxel 0.4
done
# Captures, a log, records
vam-capture --device 'sim:?pace=virtual&speed=90&lit=0' --binning 16 --fps 10 --frames 5 --pixel 0.5 --log capture.log -o views
vam-capture --device 'sim:?pace=virtual&speed=90&lit=0' --binning 16 --fps 10 --speed 90 --view-step 9 -o turn.exr
vam-ost turn.exr --voxel 0.8 --radius 4 -o print-seen.vdb --report ost.json
python3 "$corpus/../tools/scans.py" turn turn axis=61.25 wobble=2 phase=40
mkdir cal
vam-calibrate axis turn --view-step 10 --set calibration.folder=cal --set calibration.instrument=lab \
  --set calibration.valid_hours=1e6 >/dev/null
for kind in stairs risen; do
  python3 "$corpus/make.py" array $kind a.npy 60 8 8
  unit='mJ/cm3' grid=dose
  [ $kind = stairs ] || unit='view units per mm' grid=scatter
  vam-convert a.npy --voxel 0.2 --grid $grid --value-unit "$unit" -o $kind.vdb
done
vam-calibrate working-curve risen.vdb --dose stairs.vdb --lit-turns 1 --classes 12 -o curve.json >/dev/null
vam-correct risen.vdb --curve curve.json --acted stairs.vdb --resolution 0 --max-uncertainty 100 -o next.vdb --report correct.json
printf 'exposure_mj_cm2,thickness_um\n20,370\n20,381\n50,1168\n50,1175\n130,2004\n130,1996\n' |
  vam-curethrough working-curve --confidence 0.9 --report depth.json >/dev/null
printf 'grey,reading\n0,0.2\n64,5.3\n128,24\n192,57\n255,110\n' |
  vam-curethrough response --dark-reading 0.1 --irradiance-per-reading 1.1 --report photodiode.json -o response.csv >/dev/null
rm -rf a.npy print.vdb print-seen.vdb turn turn.exr sinogram.exr light.nrrd box.stl
