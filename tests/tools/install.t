# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: RESOURCE_LOCK devices COST 100
# What is installed under a user's prefix, and the packages' share of it: each tool with its manual and completions.
# debian/ knows the version and the libraries.
. "$VAM_SOURCE/tests/tools/testlib.sh"

put() { cmake --install "$VAM_BUILD" --prefix "$PWD/$1" ${2:+--component "$2"} >.log/install || report 1 "$1 is installed"; }
listed() { (cd "$1" && find . -type f | sort); }
put all
for component in tools devices documents; do put "$component" "$component"; listed "$component" >>parts; done
sort parts >sorted
listed all >whole
same 'each file is in one component' whole sorted

for tool in $(cd "$VAM_BUILD/bin" && ls); do
  missing=
  for file in "bin/$tool" "share/man/man1/$tool.1" "share/bash-completion/completions/$tool" \
    "share/zsh/site-functions/_$tool" "share/fish/vendor_completions.d/$tool.fish"; do
    [ -s "all/$file" ] || missing="$missing $file"
  done
  is "$tool: program, manual, completions" "$missing" ''
done
ok 'vam-batch: script and manual' test -x all/bin/vam-batch -a -s all/share/man/man1/vam-batch.1
is 'no manual is without a tool' "$(ls all/share/man/man1 | wc -l)" "$(ls all/bin | wc -l)"
is 'what needs devices is apart' "$(ls devices/bin | tr '\n' ' ')" \
  'vam-capture vam-devices vam-print vam-sim vam-stage '
ok 'the library for its stage is beside the simulator' test -f "$(devices/bin/vam-sim stage --shim)"
aravis=$(for tool in tools/bin/*; do ldd "$tool" | grep -c libaravis; done | sort -u)
is 'no other tool loads the library of cameras' "$aravis" 0

debian=$VAM_SOURCE/debian
is 'the packages have the version of the tools' "$(sed -n '1s/^vam-tools (\(.*\)) .*/\1/p' "$debian/changelog")" \
  "$(vam-slice --version | sed -n '1s/^vam-slice \([0-9.]*\).*/\1/p')"
sed -n "/^packages='/,/^'/p" "$VAM_SOURCE/scripts/setup" | tr ' ' '\n' | grep -E '^(fonts|lib|nlohmann|zlib)' | sort >needed
sed -n '/^Build-Depends/,/^[A-Z].*:/s/^ \([a-z0-9.+-]*\).*/\1/p' "$debian/control" | grep -E '^(fonts|lib|nlohmann|zlib)' | sort >known
same 'they are built with the libraries that scripts/setup installs' needed known

done_testing
