# SPDX-License-Identifier: GPL-3.0-or-later
# Each tool's manual page: the committed one is what the tool prints, and it is clean. The pages of section 7 are clean,
# and what they refer to is there. Examples are run by examples.sh.
. "$VAM_SOURCE/tests/tools/testlib.sh"

fails 64 "update-man: unexpected argument 'vam-slice'" "$VAM_SOURCE/scripts/update-man" vam-slice
for source in "$VAM_SOURCE"/tools/vam-*.cpp; do
  tool=$(basename "$source" .cpp)
  page=$VAM_SOURCE/man/$tool.1
  "$tool" --man | sed '/^\.Dd /d' >"$tool.1"
  sed '/^\.Dd /d' "$page" >committed.1
  same "$tool: the committed page is the tool's (scripts/update-man)" committed.1 "$tool.1"
  complaints=$(mandoc -Tlint "$page" | grep -v 'referenced manual not found')
  is "$tool: mandoc -Tlint is silent" "$complaints" ""
  ok "$tool: --help" "$tool" --help
  mv .log/out "$tool.help"
  lines=$(wc -l <"$tool.help")
  ! grep -q -- '--help=all$' "$tool.help" || holds "$tool: what is usual is told in short" "$lines <= 56"
  ok "$tool: --version" "$tool" --version
  grep -q "$tool" "$VAM_SOURCE/README.md"; report $? "$tool: in README"
  for shell in bash zsh fish; do "$tool" --completion $shell >"$tool.$shell" || report 1 "$tool: --completion $shell"; done
  ok "$tool: bash accepts its completion" bash -n "$tool.bash"
done

if command -v groff >/dev/null; then  # what man(1) of most Linux systems formats with
  for page in "$VAM_SOURCE"/man/*.[1-9]; do
    is "$(basename "$page"): groff is silent" "$(groff -mdoc -Tutf8 -Kutf8 "$page" 2>&1 >/dev/null | head -n 3)" ""
  done
fi

# "Default: none" is the value none; an option that has no default states none.
undue=$(awk '/^\./ { body = "" } /^Default: none/ && body !~ /One of (.*, )?none[,.]/ { print FILENAME ": " FNR } { body = body " " $0 }' "$VAM_SOURCE"/man/*.1)
is 'no page says "Default: none" of an option without a value none' "$undue" ""

for script in vam-batch; do
  page=$VAM_SOURCE/man/$script.1
  is "$script: mandoc -Tlint is silent" "$(mandoc -Tlint "$page" | grep -v 'referenced manual not found')" ""
  ok "$script: --help" "$VAM_SOURCE/scripts/$script" --help
  for option in $("$VAM_SOURCE/scripts/$script" --help | grep -o -- '--[a-z-]*' | sort -u); do
    grep -q "Fl -${option#--} " "$page" || grep -q "Fl -${option#--}\$" "$page"; report $? "$script: $option is in the manual"
  done
  grep -q "$script" "$VAM_SOURCE/README.md"; report $? "$script: in README"

  mkdir -p installed/bin installed/share/man/man1  # as packages have it
  cp "$VAM_SOURCE/scripts/$script" installed/bin
  gzip -c "$page" >"installed/share/man/man1/$script.1.gz"
  "installed/bin/$script" --man >"$script.1"
  same "$script: --man shows a compressed page" "$page" "$script.1"
done

# A page of a tool is short beside its options; theory, measured figures and protocols stand in section 7.
words() { awk '/^\.\\" <options>/ { options = 1 } /^\.\\" <\/options>/ { options = 0 } !options { n += NF - /\\e$/ } END { print n }' "$1"; }
printf '.Sh A\n.\\" <options>\n.It Fl x\n.\\" </options>\none two\n' >counted.1
is 'words are counted beside the options' "$(words counted.1)" 6
for page in "$VAM_SOURCE"/man/*.1; do
  name=$(basename "$page" .1)
  holds "$name: words beside its options" "$(words "$page") <= 900"
done
# A line of a page has 78 columns; what cron, systemd and scripts/lab read is one line.
is 'no command is longer than a line of man' "$(awk '/^\.Bd/ { code = 1; most = /offset/ ? 67 : 73; next } /^\.Ed/ { code = 0 }
  code { line = $0; gsub(/\\[e&]/, "x", line); if (length(line) > most) print FILENAME ": " FNR }' \
  "$VAM_SOURCE"/man/*.1 "$VAM_SOURCE"/man/vam-tutorial.7 "$VAM_SOURCE"/man/vam.7 | grep -c .)" 0
is 'vam-batch: only options are marked as such' "$(sed -n '/^\.\\" <options>/,/^\.\\" <\/options>/p' "$VAM_SOURCE/man/vam-batch.1" | grep '^\.It' | grep -v '^\.It Fl')" ''

for page in "$VAM_SOURCE"/man/*.7; do
  name=$(basename "$page" .7)
  is "$name: mandoc -Tlint is silent" "$(mandoc -Tlint "$page" | grep -v 'referenced manual not found')" ""
  sed -n 's/^\.Xr \([a-z0-9-]*\) \([17]\).*/\1.\2/p' "$page" | sort -u >references
  while read -r reference; do
    [ -f "$VAM_SOURCE/man/$reference" ]; report $? "$name: refers to $reference"
  done <references
  grep -q "$name" "$VAM_SOURCE/README.md"; report $? "$name: in README"
done

done_testing
