// SPDX-License-Identifier: GPL-3.0-or-later
// A figure over repeated prints.
#pragma once

#include <span>

#include "base/text/json_fwd.hpp"

namespace vam::metrology {

/// Mean and standard deviation, and the straight line over the prints, one after the other: its slope a print with its
/// standard error, and the probability of a slope at least as steep where there is none, by Student's t with n - 2
/// degrees of freedom [physics §14.5].
struct Trend {
  int prints = 0;
  double mean = 0;
  double spread = 0;  // standard deviation, n - 1
  double drift = 0;   // a print
  double drift_sigma = 0;
  double p = 1;
  double last = 0;
  double uncertainty = 0;  // RMS of the expanded uncertainties
};
/// At least 3 values, in the order of the prints; `uncertainties`: expanded, one a value.
[[nodiscard]] Trend trend_of(std::span<const double> values, std::span<const double> uncertainties);

[[nodiscard]] Json to_json(const Trend& trend);

}  // namespace vam::metrology
