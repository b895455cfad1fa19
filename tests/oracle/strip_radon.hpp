// SPDX-License-Identifier: GPL-3.0-or-later
// Slow and obvious parallel projection: the area of (unit pixel) intersected with (detector strip of width 1), by
// clipping the square's corners as a polygon, in double precision.
#pragma once

#include <vector>

namespace vam::oracle {

/// Area of the unit square centred on (x, y) that lies in |X cos + Y sin - t| <= 1/2.
double strip_area(double x, double y, double theta_rad, double t);

/// Image nx x ny (x fastest), axis at pixel (axis_x, axis_y); result columns x angles (columns fastest) with the axis
/// at column (columns - 1) / 2; weight e^{alpha u} with u = -x sin + y cos of the pixel's centre.
struct StripRadon {
  int nx, ny, columns;
  double axis_x, axis_y;
  std::vector<double> theta_rad;
  double alpha_per_px = 0;
  [[nodiscard]] std::vector<double> forward(const std::vector<double>& image) const;
  [[nodiscard]] std::vector<double> adjoint(const std::vector<double>& sinogram) const;
};

}  // namespace vam::oracle
