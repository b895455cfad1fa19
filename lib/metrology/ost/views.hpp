// SPDX-License-Identifier: GPL-3.0-or-later
// Camera views of the turning vial, made ready for reconstruction: dark and flat field, binning, rotation about the
// measured axis [OST22 sections 2.2 and 2.4].
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/image.hpp"

namespace vam::metrology {

/// One frame: columns along x_c, rows downwards along the axis, and the stage angle and the time at which it was taken.
struct CameraView {
  Image image;
  double angle_deg = 0;
  double time_s = 0;
};

/// Of each view.
[[nodiscard]] std::vector<double> angles_deg(std::span<const CameraView> views);

/// Fields that the camera adds. Empty images mean none.
struct CameraFields {
  Image dark;  // with the light off, subtracted
  Image flat;  // of an even scene, dark subtracted already; divided out, scaled to its mean
};

/// (raw - dark) / (flat / mean(flat)), then the mean of binning x binning pixels; a remainder at the right and lower
/// edge is dropped. `subject` begins messages. Throws Fault::data when sizes differ or the flat field has a pixel that
/// is not positive.
[[nodiscard]] Image corrected(Image raw, const CameraFields& fields, int binning, const std::string& subject);

/// The readings of a raw frame.
struct Exposure {
  float least = 0, most = 0;
  int pixels_at_least = 0, pixels_at_most = 0;
  int pixels = 0;

  /// Why the frame cannot be measured: no contrast at all (dark), or more than 2 % of its pixels at one and the same
  /// highest value (saturated). Empty when it can.
  [[nodiscard]] std::string problem() const;
};
[[nodiscard]] Exposure exposure_of(const Image& raw);
/// For each view that has less than a fifth of the contrast (standard deviation) of the median view, what is wrong with
/// it: the light failed, and only noise is left. Empty for the others.
[[nodiscard]] std::vector<std::string> contrast_problems(std::span<const CameraView> views);

/// The mean over even angles of one turn. Throws Fault::data when the turn is incomplete.
[[nodiscard]] Image mean_view(std::span<const CameraView> views);

/// The mean of the middle half of each pixel's values over even angles of one turn. As the mean,
/// it is its own mirror image about the axis, and what passes a pixel for less than a quarter of the turn hardly
/// counts. Of at most 120 angles. Throws as mean_view.
[[nodiscard]] Image middle_view(std::span<const CameraView> views);

/// Where the rotation axis appears: column at the middle row, and its lean in radians, positive when the axis' lower
/// end (last row) is displaced towards higher columns.
struct AxisPose {
  double column = 0;
  double tilt_rad = 0;
};

}  // namespace vam::metrology
