// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of a bright object on a dark background, at half maximum, with sub-pixel resolution.
#pragma once

#include <optional>
#include <vector>

#include "base/image.hpp"

namespace vam::metrology {

struct Extent {
  double begin = 0;  // columns of half height
  double end = 0;
  double height = 0;    // above the ground
  double centroid = 0;  // column, of what exceeds a quarter of the height
  [[nodiscard]] double width() const { return end - begin; }
  [[nodiscard]] double middle() const { return 0.5 * (begin + end); }
};

/// The outermost crossings of half the height between the ground (median of the outer tenths) and the top (a parabola
/// over its middle), each by a line through the samples next to it. Empty when the top is not 6 times the noise of the
/// ground above it, or the thing touches an end.
[[nodiscard]] std::optional<Extent> half_maximum(const std::vector<double>& profile);

/// The mean of rows [first, last) of each column.
[[nodiscard]] std::vector<double> column_profile(const Image& image, int first, int last);

}  // namespace vam::metrology
