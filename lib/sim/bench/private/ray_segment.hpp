// SPDX-License-Identifier: GPL-3.0-or-later
// The stretch of a ray that lies in a box of voxels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/grid.hpp"
#include "sim/bench/private/climbing_ray.hpp"

namespace vam::sim {

/// A ray in units of voxels, the lower corner of voxel 0 at 0, and from where to where (mm) it is between the voxels
/// `low` and `high` (one behind the last) of a grid, on its way through the resin. Empty: to <= from.
struct RaySegment {
  std::array<float, 3> at{};
  std::array<float, 3> along{};
  double from_mm = 0;
  double to_mm = 0;
};

[[nodiscard]] inline RaySegment passage(const ClimbingRay& ray, const model::Grid& grid, const int (&low)[3],
                                        const int (&high)[3]) {
  RaySegment way;
  way.to_mm = ray.length_mm;
  for (std::size_t a = 0; a < 3; ++a) {
    const double start = (ray.at[a] - grid.origin_mm[a]) / grid.voxel_mm + 0.5;
    const double pace = ray.along[a] / grid.voxel_mm;
    way.at[a] = static_cast<float>(start);
    way.along[a] = static_cast<float>(pace);
    constexpr double level = 1e-9;  // voxels per mm: too few for a vial to have a face on the way
    if (std::abs(pace) < level) {
      if (start < low[a] || start >= high[a]) way.to_mm = 0;
      continue;
    }
    const double one = (low[a] - start) / pace;
    const double other = (high[a] - start) / pace;
    way.from_mm = std::max(way.from_mm, std::min(one, other));
    way.to_mm = std::min(way.to_mm, std::max(one, other));
  }
  return way;
}

}  // namespace vam::sim
