// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation axis in the camera's image, and the radius of the circle on which the vial (or a bead) moves.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "base/stats/measured.hpp"

namespace vam::metrology {

/// Column of the bright thing's middle, in each of `bands` bands of rows, top to bottom; a band without one has none
/// (NaN). See half_maximum().
[[nodiscard]] std::vector<double> bright_middles(const Image& frame, int bands);

/// The same of its centroid: several times less noise where its top is round, as that of a bead, but uneven light
/// shifts it, as a whole, by a constant.
[[nodiscard]] std::vector<double> bright_centroids(const Image& frame, int bands);

struct TurnScan {
  int rows = 0;                             // of the images
  std::vector<double> angle_deg;            // of the stage, of each frame
  std::vector<std::vector<double>> middle;  // [band][frame], columns
};

struct CameraAxis {
  stats::Measured column;     // of the axis at the middle row
  stats::Measured tilt_deg;   // positive: the axis' lower end towards higher columns; n = 0 with fewer than two bands
  stats::Measured wobble_px;  // radius of the circle that the thing describes
  stats::Measured phase_deg;  // stage angle at which it is furthest towards high columns, 0...360
  int bands = 0;              // that were seen in at least three quarters of the frames
};

/// In each band, column = axis + a cos(theta) + b sin(theta) + a second harmonic (perspective's), by least squares; a
/// line through the bands' axes gives column and tilt. Throws Fault::data: no band is seen in three quarters of the
/// frames, or the frames leave a gap of more than 90 degrees.
[[nodiscard]] CameraAxis find_camera_axis(const TurnScan& scan);

}  // namespace vam::metrology
