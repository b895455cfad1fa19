// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/circle.hpp"

#include "base/error.hpp"

namespace vam::model {

namespace {

/// Without a radius.
Circle about_axis(const Grid& grid) {
  return {-grid.origin_mm[0] / grid.voxel_mm, -grid.origin_mm[1] / grid.voxel_mm, 0};
}

double rim_px(const Grid& grid, const Circle& at) {
  const double rim = 0.5 + std::min({at.axis_x, at.axis_y, grid.nx - 1 - at.axis_x, grid.ny - 1 - at.axis_y});
  if (rim <= 0) throw Error{Fault::data, "the rotation axis (x = y = 0) is not inside the grid; centre the part"};
  return rim;
}

}  // namespace

Circle judged_circle(const Grid& grid, double radius_mm) {
  Circle circle = about_axis(grid);
  (void)rim_px(grid, circle);
  circle.radius = radius_mm / grid.voxel_mm;
  return circle;
}

Circle writable_circle(const Grid& grid, double radius_mm) {
  Circle circle = judged_circle(grid, radius_mm);
  circle.radius = std::min(circle.radius, rim_px(grid, circle));
  return circle;
}

}  // namespace vam::model
