// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/range.hpp"

#include "testing.hpp"

using vam::stats::range_of;

TEST_CASE("the least and the largest of any number of values") {
  std::mt19937 draw(3);  // NOLINT(cert-msc51-cpp): the same values every time
  std::uniform_real_distribution<float> value(-5, 5);
  for (const std::size_t count : {1, 2, 15, 16, 17, 100}) {
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<float> values(count);
      for (float& v : values) v = value(draw);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      CHECK(range_of(values) == std::pair{*low, *high});
    }
  }
}
