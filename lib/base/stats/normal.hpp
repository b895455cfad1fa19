// SPDX-License-Identifier: GPL-3.0-or-later
// The normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace vam::stats {

/// Full width at half maximum of the density, 2 (2 ln 2)^(1/2) standard deviations.
inline constexpr double fwhm_per_sigma = 2.3548200450309493;

/// P(X <= x) of a standard normal X.
[[nodiscard]] inline double normal_integral(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace vam::stats
