# SPDX-License-Identifier: GPL-3.0-or-later
# judge.sh KIND MM: what the tools say of a little part of make.py, with the printer of $VAM_PRINTER: the verdicts of
# vam-plan, and of vam-optimize and vam-score for a short run, of the part on the same voxels.
set -e -o pipefail
judged=0
python3 "$corpus/make.py" part "$1" "$2" part.off
vam-slice part.off --voxel 0.2 -o part.vdb --report slice.json
vam-optimize part.vdb --angles 60 --iterations 6 --patience 0 --report light.json | vam-dose --like part.vdb |
  vam-score --target part.vdb --report score.json >table || judged=$?  # which refuses what is too thin for the voxels
vam-plan part.off --voxel 0.2 --report plan.json >told
sed -n 's/^verdict *\(will not print\|will print\|unknown\).*/\1/p' told | tr ' ' - >plan
rm part.off part.vdb table told
exit $judged
