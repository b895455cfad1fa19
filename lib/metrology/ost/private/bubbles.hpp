// SPDX-License-Identifier: GPL-3.0-or-later
// Bubbles pass through the views. They are distinguished from the print by consistency over the angles: a line is seen
// twice a turn, from either end, and a bubble is seldom there both times.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/back_projection.hpp"
#include "metrology/ost/private/ray_mask.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// Sinograms of one stretch of heights, those of the grid's slices, columns x an even number of angles over a turn,
/// axis in the middle. A ray that is brighter than the same line from the other end, anywhere within two columns and
/// `rows[k]` heights of it, by more than 6 deviations of the noise and 3 % of the brightest, both as means of 3 x 3
/// rays, has passed a bubble. It gets the value of the other end. Rays near bubbles at both ends of a line, or near one
/// where `specks` hide the other, and those that are brighter than all bodies in the volume of these rays, are limited
/// to what they pass of the bodies [MEY10]. Where bubbles are more than 10 % of the rays nothing is replaced. Returns
/// the share.
double remove_bubbles(const ClimbingRays& rays, const model::Grid& grid, const RayMask& specks,
                      std::vector<Image>& sinograms, std::span<const int> rows);
inline constexpr double most_bubbles = 0.1;

}  // namespace vam::metrology
