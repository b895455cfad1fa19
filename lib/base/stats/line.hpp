// SPDX-License-Identifier: GPL-3.0-or-later
// The straight line through some points.
#pragma once

#include <cstddef>
#include <span>

namespace vam::stats {

/// y = mean_y + slope (x - mean_x)
struct Line {
  double weight = 0;  // of all points
  double mean_x = 0, mean_y = 0;
  double slope = 0;
  double spread = 0;  // sum weight (x - mean_x)^2

  [[nodiscard]] double at(double x) const { return mean_y + slope * (x - mean_x); }
};

/// By least squares, level where all x are the same. Weights: one a point, or none, each 1.
[[nodiscard]] inline Line straight_line(std::span<const double> x, std::span<const double> y,
                                        std::span<const double> weights = {}) {
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  Line line;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.weight += weight(i);
    line.mean_x += weight(i) * x[i];
    line.mean_y += weight(i) * y[i];
  }
  line.mean_x /= line.weight;
  line.mean_y /= line.weight;
  double common = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double away = x[i] - line.mean_x;
    line.spread += weight(i) * away * away;
    common += weight(i) * away * (y[i] - line.mean_y);
  }
  if (line.spread > 0) line.slope = common / line.spread;
  return line;
}

}  // namespace vam::stats
