// SPDX-License-Identifier: GPL-3.0-or-later
// The middle of some numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vam::stats {

/// Standard deviations in the median of the magnitudes of normal deviates.
inline constexpr double sigmas_per_median = 1.4826;

/// Of an even count the upper of the two in the middle. There must be one.
template <class Number>
[[nodiscard]] double median(std::vector<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Standard deviation about `centre` by the median of the distances from it: outliers hardly count. There must be a
/// value.
template <class Number>
[[nodiscard]] double robust_sigma(std::vector<Number> values, Number centre = 0) {
  for (Number& value : values) value = std::abs(value - centre);
  return sigmas_per_median * median(std::move(values));
}

}  // namespace vam::stats
