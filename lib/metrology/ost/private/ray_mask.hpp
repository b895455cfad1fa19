// SPDX-License-Identifier: GPL-3.0-or-later
// Marked rays of the sinograms of one stretch of heights.
#pragma once

#include <vector>

#include "base/image.hpp"

namespace vam::metrology {

/// The rays of one angle, [height][column]: 1 where marked. Empty: none.
using RayMask = std::vector<char>;

/// Fraction of its rays that are marked.
[[nodiscard]] double share_of(const RayMask& marked);

/// Marked places and those at most `by` pixels beside them.
[[nodiscard]] RayMask grown(const RayMask& marked, int width, int height, int by);

/// The angle from which the lines of `angle` are seen from their other end, in the order of mirrored columns.
[[nodiscard]] inline int opposite(const Image& sinogram, int angle) {
  return (angle + sinogram.height / 2) % sinogram.height;
}

}  // namespace vam::metrology
