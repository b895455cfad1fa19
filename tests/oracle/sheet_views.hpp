// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera sees of a sheet of light in a vial that stands in air, by rays alone: the sheet is a row of strips
// between neighbouring rays of the projector, each as bright as its power over its width; the camera's rays are
// followed back into the vial and gather what shines where they lie in a strip. Slow and obvious; shares nothing with
// lib/metrology, lib/optics or calibration_scans.
#pragma once

#include <optional>
#include <vector>

namespace vam::oracle {

/// The projector's light travels along +y towards the vial's axis, x = y = 0. The camera looks at the axis along
/// the direction that is turned from +y by its azimuth, anticlockwise seen from above.
struct SheetBench {
  double radius_mm = 12.7;  // outer
  double wall_mm = 0;       // 0: no wall to be seen
  double glass_index = 1.53;
  double resin_index = 1.53;
  double absorption_per_mm = 0;             // of the sheet's light in resin, natural logarithm
  double seen_absorption_per_mm = 0;        // of what the camera sees
  std::optional<double> lens_mm = 119.808;  // to the axis; empty: telecentric
  std::optional<double> camera_mm = 200;
  double camera_rad = 1.5707963267948966;
  bool rows_spread = false;  // rays also diverge in height, and thin the light
  int strips = 2000;
  int sights = 1000;  // rays of the camera
};

/// Light between two rays of the projector.
struct SeenStrip {
  double x_mm;      // of its middle, in the plane y = 0 as if nothing were in its way
  double width_mm;  // there
  double seen;      // by the camera, of light of unit power per mm of width
};

/// All that enter the resin, by rising x; narrower towards the tangent to the vial, where they enter ever more
/// obliquely.
std::vector<SeenStrip> seen_strips(const SheetBench& bench);

/// Of a line of light, evenly lit over its width around x and blurred by a Gaussian: the sum of its strips.
double seen_line(const std::vector<SeenStrip>& strips, double x_mm, double width_mm, double sigma_mm);

}  // namespace vam::oracle
