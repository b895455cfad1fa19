# SPDX-License-Identifier: GPL-3.0-or-later
# scripts/setup without the right to install: it says what to ask for. Nothing is installed here, as dpkg and sudo are
# stood in for.
. "$VAM_SOURCE/tests/tools/testlib.sh"

mkdir bin
printf '#!/bin/sh\ncase $* in *cmake) echo install ok installed ;; *) exit 1 ;; esac\n' >bin/dpkg-query
printf '#!/bin/sh\necho 1000\n' >bin/id
printf '#!/bin/sh\necho "apt-get was called" >&2\n' >bin/apt-get
chmod +x bin/*
ln -s "$(command -v sh)" "$(command -v grep)" bin/
unprivileged() { PATH=$scratch/bin "$scratch/bin/sh" "$VAM_SOURCE/scripts/setup" "$@"; }

asks='packages are missing.*ask the administrator for: apt-get install --no-install-recommends g\+\+ ninja-build .*libaravis-dev'
fails 69 "$asks\$" unprivileged tools
fails 69 "$asks lintian\$" unprivileged tools lintian
fails 69 "$asks git .* chromium\$" unprivileged

printf '#!/bin/sh\nexit 1\n' >bin/sudo
chmod +x bin/sudo
fails 69 "$asks\$" unprivileged tools

printf '#!/bin/sh\n[ "$1" = true ] || echo "$*" >>asked\n' >bin/sudo
ok 'with sudo, it installs' unprivileged tools
is 'by that command' "$(sed -n 's/^env DEBIAN_FRONTEND=noninteractive \(apt-get install\) .* g++ .*/\1/p' asked)" 'apt-get install'

done_testing
