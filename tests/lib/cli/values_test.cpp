// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/private/values.hpp"

#include "testing.hpp"

using namespace vam::cli;

TEST_CASE("ranges are described without exponents") {
  CHECK(describe({0, 1e6}) == "0 to 1000000");
  CHECK(describe({1e-6, 1}) == "0.000001 to 1");
  CHECK(describe({-1e6, 0.25}) == "-1000000 to 0.25");
  CHECK(describe({1, 1}) == "1");
  CHECK(describe(not_zero) == "any number but 0");
  CHECK(describe({-180, 180, false, true}) == "-180 to 180, but not 0");
}
