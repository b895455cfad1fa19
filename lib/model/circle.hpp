// SPDX-License-Identifier: GPL-3.0-or-later
// The disc of a slice that light reaches.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/grid.hpp"

namespace vam::model {

/// In voxels of the slice.
struct Circle {
  double axis_x = 0;
  double axis_y = 0;
  double radius = 0;
  [[nodiscard]] bool contains(int x, int y) const {
    const double dx = x - axis_x;
    const double dy = y - axis_y;
    return dx * dx + dy * dy <= radius * radius;
  }
};

/// Half the way through a circle at that distance from its centre; 0 beyond it.
[[nodiscard]] inline double half_chord(double radius, double offset) {
  return std::sqrt(std::max(0.0, radius * radius - offset * offset));
}

/// The circle of that radius, also where it passes the sides of the grid: void in the grid's corners is resin. Throws
/// as writable_circle.
[[nodiscard]] Circle judged_circle(const Grid& grid, double radius_mm);

/// The circle of that radius (optics::writable_radius_mm), at most the circle inside the grid. Throws Fault::data when
/// the rotation axis (x = y = 0) is not inside the grid.
[[nodiscard]] Circle writable_circle(const Grid& grid, double radius_mm);

}  // namespace vam::model
