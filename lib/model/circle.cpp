// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/circle.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace vam::model {

Circle writable_circle(const Grid& grid, double radius_mm) {
  Circle circle{-grid.origin_mm[0] / grid.voxel_mm, -grid.origin_mm[1] / grid.voxel_mm, 0};
  const double rim =
      0.5 + std::min({circle.axis_x, circle.axis_y, grid.nx - 1 - circle.axis_x, grid.ny - 1 - circle.axis_y});
  if (rim <= 0) throw Error{Fault::data, "the rotation axis (x = y = 0) is not inside the grid; centre the part"};
  circle.radius = std::min(radius_mm / grid.voxel_mm, rim);
  return circle;
}

}  // namespace vam::model
