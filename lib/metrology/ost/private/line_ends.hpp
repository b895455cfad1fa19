// SPDX-License-Identifier: GPL-3.0-or-later
// Lines that look different from their two ends, and which of the ends is wrong.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

// Sinograms: one a height, all of the same columns and of an even number of angles, four at least; `rows` has one
// number a height.

/// Rays of an angle that are brighter by `least` than the other end of their line and all near there: within two
/// columns and `rows[k]` heights. Empty: none.
[[nodiscard]] RayMask bright_rays(const std::vector<Image>& sinograms, std::span<const int> rows, int angle,
                                  float least);

/// Gives rays that dirt hides for a few views, and those within 3 pixels of them, the brighter value of both ends of
/// their line: rays darker by `least` than the other end and all near there, and than the mean of the fourth angles
/// before and after, from which the other end does not differ by half as much. What passes the other end is a bubble
/// there.
void restore_dark_rays(std::vector<Image>& sinograms, std::span<const int> rows, float least);

}  // namespace vam::metrology
