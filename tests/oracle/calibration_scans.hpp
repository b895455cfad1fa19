// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic calibration scans with known truth: rays traced by the vector ray tracer, pixels with shot and read noise.
// Shares nothing with lib/optics or lib/metrology.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "base/image.hpp"

namespace vam::oracle {

using Random = std::mt19937_64;

/// A vial in the field of a projector, and a camera at its side.
struct SweepTruth {
  double pixel_mm = 0.065;
  std::optional<double> lens_mm = 119.8;  // none: telecentric
  double radius_mm = 12.7;
  double wall_mm = 0;
  double glass_index = 1.53;
  double resin_index = 1.53;
  double absorption_per_mm = 0;            // of the projector's light, from where it enters the resin
  double axis_column = 511.5;              // at height 0
  double tilt_rad = 0;                     // upper end towards higher columns
  double blur_px = 1.5;                    // Gaussian sigma of the line
  double camera_mm = 200;                  // of its lens from the axis
  double camera_rad = 1.5707963267948966;  // counter-clockwise from the projector, seen from above
  double slope = 0;                        // of the camera's gain, per radian that the light turns in the vial
  double noise = 2;                        // of a pixel; the brightest are about 100
  double electrons = 10;                   // a unit of light, for the shot noise on top
};

/// What the camera sees of a lit line of width_px columns; rows have their middles at height_mm, top first.
class SweepBench {
 public:
  explicit SweepBench(const SweepTruth& truth);
  [[nodiscard]] Image frame(double line_column, double width_px, const std::vector<double>& height_mm, int columns,
                            Random& random) const;

 private:
  [[nodiscard]] double fluorescence(double x_px) const;
  SweepTruth truth_;
  double edge_mm_ = 0;                        // the outermost column that lights resin
  std::array<std::vector<double>, 2> table_;  // at the low and the high edge, by the root of the depth
};

/// An image with a bright vertical band: a flat top between two Gaussian-blurred edges.
struct BandTruth {
  int columns = 0;
  int rows = 0;
  double middle = 0;  // at the middle row
  double lean = 0;    // columns a row, downwards
  double half_width = 0;
  double blur_px = 1;
  double ground = 10;
  double light = 100;
  double noise = 2;
};
[[nodiscard]] Image bright_band(const BandTruth& truth, Random& random);

}  // namespace vam::oracle
