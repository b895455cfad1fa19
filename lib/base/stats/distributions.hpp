// SPDX-License-Identifier: GPL-3.0-or-later
// Student's t and Fisher's F, which turn standard errors into confidence intervals, and the normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace vam::stats {

/// P(|T| > |t|) with `freedom` > 0 degrees of freedom.
[[nodiscard]] double student_tail(double t, double freedom);

/// The t that |T| exceeds with probability `tail` in (0, 1): student_quantile(0.05, 10) = 2.228.
[[nodiscard]] double student_quantile(double tail, double freedom);

/// P(F > f) with `upper` and `lower` degrees of freedom.
[[nodiscard]] double f_tail(double f, double upper, double lower);

/// Full width at half maximum of the density, 2 (2 ln 2)^(1/2) standard deviations.
inline constexpr double fwhm_per_sigma = 2.3548200450309493;

/// P(X <= x) of a standard normal X.
[[nodiscard]] inline double normal_integral(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace vam::stats
