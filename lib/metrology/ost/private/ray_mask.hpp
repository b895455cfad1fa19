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

/// The same lines from their other ends.
[[nodiscard]] RayMask other_ends(RayMask marked, int width);

/// Marks what `more` marks, too; leaves marked what `other` marks, too.
void mark_too(const RayMask& more, RayMask& marked);
void keep_marked(const RayMask& other, RayMask& marked);

/// Gives marked rays, one mask an angle, what is chosen of their own value and that of the other end of their line.
void choose_ends(std::vector<Image>& sinograms, const std::vector<RayMask>& marked, float (*choose)(float, float));

/// The angle from which the lines of `angle` are seen from their other end, in the order of mirrored columns.
[[nodiscard]] inline int opposite(const Image& sinogram, int angle) {
  return (angle + sinogram.height / 2) % sinogram.height;
}

}  // namespace vam::metrology
