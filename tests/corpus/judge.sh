# SPDX-License-Identifier: GPL-3.0-or-later
# judge.sh KIND MM [preview]: what the tools say of a little part of make.py, with the printer of $VAM_PRINTER: the
# verdicts of vam-plan, of vam-optimize and vam-score for a short run and, on request, of vam-optimize --preview.
python3 "$corpus/make.py" part "$1" "$2" part.off
vam-slice part.off --voxel 0.2 -o part.vdb --report slice.json
vam-optimize part.vdb --angles 60 --iterations 6 --patience 0 --report light.json | vam-dose --like part.vdb |
  vam-score --target part.vdb --report score.json >table
vam-plan part.off --report plan.json >told
sed -n 's/^will it print *\([a-z]*\).*/\1/p' told >plan
if [ $# -gt 2 ]; then
  vam-optimize --preview part.vdb >told
  sed -n 's/^verdict *\(will not print\|may not print\|will print\|may print\).*/\1/p' told | tr ' ' - >preview
fi
rm part.off part.vdb table told
