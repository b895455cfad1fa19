// SPDX-License-Identifier: GPL-3.0-or-later
// The normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace vam::stats {

/// P(X <= x) of a standard normal X.
[[nodiscard]] inline double normal_integral(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace vam::stats
