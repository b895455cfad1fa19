# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: COST 50
# Every command of vam-tutorial(7), vam(7) and the tour of README.md, in order, in one shell and an empty folder each. They
# write .mkv, by vam-project.
. "$VAM_SOURCE/tests/tools/testlib.sh"

commands() {  # commands PAGE: all blocks but those of the theory
  sed -e 's/^\\&//' -e 's/\\e/\\/g' "$VAM_SOURCE/man/$1.7" |
    awk '/^\.Sh /{theory = /THEORY/} /^\.Ed/{code = 0} code && !theory{print} /^\.Bd/{code = 1}'
}

mkdir tutorial entry
began=$(date +%s)
commands vam-tutorial >tutorial.sh
(cd tutorial && sh -e ../tutorial.sh) >out 2>err; status=$?
is 'the tutorial' $status 0
[ $status -eq 0 ] || tail -n 5 err | sed 's/^/# /'
echo "# in $(($(date +%s) - began)) s"
is 'without warnings but those that it explains' \
  "$(grep -v 'climbing rays blur\|of the light is above or below\|made for another printer than printer.toml\|of the planned dose, which' err)" ''
holds 'its first print prints' "$(json tutorial/score.json pw) > 0"
is 'its lens is where it was put' "$(grep -c '^119\.8' out)" 1

box 6 6 4 >entry/part.off
vam-slice --print-printer --set projector.pixel_mm=0.26 --set projector.columns=256 --set projector.rows=192 -o coarse.toml
commands vam | sed 's/part\.stl/part.off/' >entry.sh
ok 'the lines of the entry page, with another mesh' env VAM_PRINTER="$PWD/coarse.toml" sh -ec 'cd entry; . ../entry.sh'
ok 'write a video' test -s entry/print.mkv

mkdir tour
awk '/^```$/{code = 0} code{print} /^```sh$/{code = 1}' "$VAM_SOURCE/README.md" | sed 's/--voxel 0.13/--voxel 0.2/' >tour.sh
mkdir own; echo '[stage]' >own/printer.toml
ok 'the tour of README.md' sh -ec 'cd own; head -n 2 ../tour.sh | sh -e; cd ../tour; . ../tour.sh'
is 'it keeps a printer of yours' "$(cat own/printer.toml)" '[stage]'
is 'it writes what it names' "$(ls tour | tr '\n' ' ')" \
  'dose.png dose.vdb part.vdb print.mkv print.png printer.toml projector.exr report.html '

# Section 10 is for the instrument: each of its commands is one that the tools understand, and only its files are missing.
mkdir ten
sed -n -e '/^\.Sh 10/,/^\.Sh SEE/s/^\.Dl \(\\ \)*//p' "$VAM_SOURCE/man/vam-tutorial.7" | sed 's/\\e$/\\/' |
  awk '/\\$/ { sub(/\\$/, ""); printf "%s", $0; next } { print }' | grep -v '^python3 tests/' >ten.sh
holds 'section 10 has commands' "$(grep -c . ten.sh) >= 8"
while IFS= read -r line; do
  (cd ten && display=null: sh -c "$line") </dev/null >.log/ten 2>&1
  is "section 10: $line" $? 66
done <ten.sh
done_testing
