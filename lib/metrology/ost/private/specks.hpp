// SPDX-License-Identifier: GPL-3.0-or-later
// Specks on window or lens stay where they are while the print turns.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

// Sinograms of one stretch of heights, columns x an even number of angles over a turn, axis in the middle.

/// Rays that specks hide, at all angles, [height][column]. A pixel differs from the other end of its lines by more than
/// its row does, in the median of eight parts of the turn, of which bubbles pass few, and at a third of the angles: it
/// and two pixels around it are a speck's.
[[nodiscard]] RayMask speck_rays(const std::vector<Image>& sinograms);

/// Replaces them by the line seen from the other end, or, where a speck hides that, too, by the rays around them.
void replace_specks(const RayMask& specks, std::vector<Image>& sinograms);

/// Marks, in one mask an angle, the lines that specks hide at either end where a ray beside these is marked.
void propagate_mask(const RayMask& specks, int width, std::vector<RayMask>& marked);

}  // namespace vam::metrology
