// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/range.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

namespace vam::stats {

std::pair<float, float> range_of(std::span<const float> values) {
  constexpr std::size_t together = 16;
  std::array<float, together> low{};
  std::array<float, together> high{};
  low.fill(values.front());
  high.fill(values.front());
  std::size_t i = 0;
  for (; i + together <= values.size(); i += together) {
    for (std::size_t n = 0; n < together; ++n) {
      low[n] = std::min(low[n], values[i + n]);
      high[n] = std::max(high[n], values[i + n]);
    }
  }
  for (; i < values.size(); ++i) {
    low[0] = std::min(low[0], values[i]);
    high[0] = std::max(high[0], values[i]);
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

double mean_value(std::span<const float> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace vam::stats
