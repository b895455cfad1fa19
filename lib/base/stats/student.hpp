// SPDX-License-Identifier: GPL-3.0-or-later
// Student's t distribution: what turns standard errors into confidence intervals.
#pragma once

namespace vam::stats {

/// P(|T| > |t|) with `freedom` > 0 degrees of freedom.
[[nodiscard]] double student_tail(double t, double freedom);

/// The t that |T| exceeds with probability `tail` in (0, 1): student_quantile(0.05, 10) = 2.228.
[[nodiscard]] double student_quantile(double tail, double freedom);

/// P(F > f) with `upper` and `lower` degrees of freedom.
[[nodiscard]] double f_tail(double f, double upper, double lower);

}  // namespace vam::stats
