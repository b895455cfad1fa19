// SPDX-License-Identifier: GPL-3.0-or-later
// Measured numbers and what follows from several of them [physics §14.2].
#pragma once

#include <vector>

namespace vam::stats {

/// A measured number with one standard deviation, out of n readings. The unit is in the name of whatever holds it.
struct Measured {
  double value = 0;
  double sigma = 0;
  int n = 0;
};

/// Mean of at least two readings with its standard error, by Student's t.
[[nodiscard]] Measured mean_of(const std::vector<double>& readings);

/// Mean by weight 1/sigma^2; its sigma grows when the parts scatter more than they say.
[[nodiscard]] Measured weighted_mean(const std::vector<Measured>& parts);

/// y = at_zero + slope x by weight 1/sigma^2, at least two points; sigmas grow as those of weighted_mean().
struct WeightedLine {
  Measured at_zero;
  Measured slope;
};
[[nodiscard]] WeightedLine weighted_line(const std::vector<double>& x, const std::vector<Measured>& y);

/// The angle of a line that moves by slope * pitch along its length.
[[nodiscard]] Measured lean_deg(const Measured& slope, double pitch);

/// Student's t at 95 % over that of the normal distribution: the factor by which a standard error from few readings
/// grows.
[[nodiscard]] double few_readings_factor(int freedom);

/// The same for a variance that is the sum of these parts, each the square of one reading: a few large ones among many
/// small ones count as few. At least 0 each; 1 where all are 0.
[[nodiscard]] double few_parts_factor(const std::vector<double>& parts);

}  // namespace vam::stats
