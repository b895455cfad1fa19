// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/grid_place.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace vam::model {

std::optional<std::array<int, 3>> place_in(const Grid& whole, const Grid& part) {
  constexpr double rounding = 1e-3;  // voxels: origins that other programs compute as floats err by 3e-5 at 500 voxels
  const std::array<int, 3> outer{whole.nx, whole.ny, whole.nz};
  const std::array<int, 3> inner{part.nx, part.ny, part.nz};
  const int most = std::max({whole.nx, whole.ny, whole.nz});
  if (!(std::abs(part.voxel_mm / whole.voxel_mm - 1) < rounding / most)) return std::nullopt;
  std::array<int, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = (part.origin_mm[axis] - whole.origin_mm[axis]) / whole.voxel_mm;
    if (!(place > -0.5 && place < outer[axis])) return std::nullopt;
    first[axis] = round_int(place);
    if (std::abs(place - first[axis]) >= rounding || first[axis] + inner[axis] > outer[axis]) return std::nullopt;
  }
  return first;
}

bool same_voxels(const Grid& grid, const Grid& other) {
  return grid.nx == other.nx && grid.ny == other.ny && grid.nz == other.nz && place_in(grid, other).has_value();
}

}  // namespace vam::model
