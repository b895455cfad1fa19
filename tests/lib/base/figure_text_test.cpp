// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/figure_text.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("counts are written in full, other figures in short") {
  CHECK(format_figure(2085408) == "2085408");
  CHECK(format_figure(-143728, 5) == "-143728");
  CHECK(format_figure(0) == "0");
  CHECK(format_figure(0.1293214) == "0.129321");
  CHECK(format_figure(1.4373512e5, 5) == "1.4374e+05");
  CHECK(format_figure(1e300) == "1e+300");
  CHECK(format_figure(INFINITY) == "inf");
}
