# SPDX-License-Identifier: GPL-3.0-or-later
# scripts/arm64, which takes too long to be run here, names tests that there are.
. "$VAM_SOURCE/tests/tools/testlib.sh"
names=$(sed -n "s/.* -R '\(.*\)'\$/\1/p" "$VAM_SOURCE/scripts/arm64")
is 'the tests of the kernels' "$(ctest --test-dir "$VAM_BUILD" -N -R "$names" | sed -n 's/^Total Tests: //p')" \
  "$(ls "$VAM_SOURCE"/tests/lib/tomo/*_test.cpp "$VAM_SOURCE"/tests/lib/optics/*_test.cpp | wc -l)"
done_testing
