// SPDX-License-Identifier: GPL-3.0-or-later
// Finding the rotation axis in the views themselves.
#pragma once

#include <span>

#include "metrology/ost/views.hpp"

namespace vam::metrology {

/// Result, with one standard deviation.
struct AxisEstimate {
  AxisPose pose;
  double column_sigma = 0;
  double tilt_sigma_rad = 0;
};

/// The mean of evenly spaced views over a full turn is its own mirror image about the axis: P(t, theta + pi) = P(-t,
/// theta), and refraction and perspective map columns oddly about the axis, so they keep the symmetry. Column and tilt
/// minimise the difference of the two halves (Gauss-Newton from the centre of mass, far differences hardly
/// counted [physics §8]).
/// Nothing needs to be known of the optics, and an even background does no harm.
/// Throws Fault::data when the view has no contrast beyond its noise, or the axis leans by more than 30 degrees.
[[nodiscard]] AxisEstimate find_axis(const Image& mean_view);

/// The same from the mean view, or, where that leaves a hundredth of a pixel or more, as where bubbles pass, from the
/// middle view, which they hardly draw away. The mean view counts where the middle view shows no axis or a less certain
/// one: it lacks thin parts beside the axis, which pass a pixel for less than a quarter of the turn.
[[nodiscard]] AxisEstimate find_axis(std::span<const CameraView> views);

}  // namespace vam::metrology
