// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal value in an image.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "plot/canvas.hpp"

namespace vam::plot {

/// A straight piece of a contour; (0, 0) is the middle of the first pixel.
struct ContourPiece {
  Spot from;
  Spot to;
};

/// Where the bilinear image crosses `level`, by marching squares; at a saddle the mean of the four pixels decides.
[[nodiscard]] std::vector<ContourPiece> contour(const Image& image, float level);

}  // namespace vam::plot
