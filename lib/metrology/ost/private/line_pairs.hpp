// SPDX-License-Identifier: GPL-3.0-or-later
// Effect of the turning vial's position on the views, from lines that are seen from both ends.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/camera_sinograms.hpp"

namespace vam::metrology {

inline constexpr int pair_motions = 3;  // an offset of the axis, and the run-out along x and y of the part, in columns
inline constexpr int pair_unknowns = pair_motions + 1;  // and the absorption of the scattered light, per column
using PairVector = std::array<double, pair_unknowns>;

/// Motion of the columns of each view by one unit of each unknown that moves them.
struct PairBasis {
  std::array<std::vector<ColumnMotion>, pair_motions> motion;
  double axis_column = 0;
  std::vector<double> angle_rad;  // of the part, of each view
  std::vector<double> lean;       // of each column's line from its neighbour's, in that sense, rad
  bool even_light = false;        // the views were divided by their intensities
};

/// Takes views to virtual sinograms, linearly, the axis in their middle.
using SinogramsOf = std::function<std::vector<Image>(const std::vector<Image>&)>;

/// With one standard deviation each.
struct PairFit {
  PairVector value{};
  PairVector sigma{};
  bool converged = false;
};

/// Fits the motion, and with `count` of 4 the absorption, after which each line looks alike from both of its ends.
/// `level` has a view each, columns x heights. Gauss-Newton on the differences, far ones weighted
/// down [HUB64]. Standard deviations from the scatter between ranges of angle and of offset, as the errors of
/// neighbouring lines are not independent [physics §8].
[[nodiscard]] PairFit fit_line_pairs(const std::vector<Image>& level, const PairBasis& basis, int count,
                                     const SinogramsOf& sinograms_of);

/// Do most lines on edges look more alike from both ends with the motion than without? Bubbles, which are in single
/// lines, can pull a fit away from most of them.
[[nodiscard]] bool motion_explains(const std::vector<Image>& level, const PairBasis& basis, const PairVector& value,
                                   const SinogramsOf& sinograms_of);

}  // namespace vam::metrology
