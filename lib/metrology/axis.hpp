// Finding the rotation axis in the views themselves.
#pragma once

#include "metrology/views.hpp"

namespace vam::metrology {

/// What was found, with one standard deviation.
struct AxisEstimate {
  AxisPose pose;
  double column_sigma = 0;
  double tilt_sigma_rad = 0;
  int rows = 0;  // image rows that had enough contrast to count
};

/// The mean of evenly spaced views over a full turn is symmetric about the axis: P(t, theta + pi) = P(-t, theta), and
/// refraction and perspective map columns oddly about the axis, so they keep the symmetry. Each row's centre of
/// symmetry is found by least squares; a line through the centres, weighted by their precision, gives column and tilt.
/// Nothing needs to be known of the optics, and an even background does no harm.
/// Throws Fault::data when no row has contrast or the axis is outside the image.
[[nodiscard]] AxisEstimate find_axis(const Image& mean_view);

}  // namespace vam::metrology
