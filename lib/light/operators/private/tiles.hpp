// SPDX-License-Identifier: GPL-3.0-or-later
// The voxel columns of a slice in tiles, whose light is brought together.
#pragma once

#include <vector>

#include "light/rays/ray_taps.hpp"
#include "light/rays/vial_rays.hpp"

namespace vam::light {

struct VoxelColumn {
  int i = 0, j = 0;
  /// So many quarters of a turn on, in slices of size x size voxels.
  [[nodiscard]] VoxelColumn turned(int quarters, int size) const;
};

/// Up to 8 x 8 voxel columns. It may stand for the tiles a quarter, a half and three quarters of a turn on as well,
/// VialRays::quarters(): at stage angles as far apart these have the same rays.
struct Tile {
  static constexpr int edge = 8;  // voxels
  static_assert(edge * edge * VialRays::most_rays <= ray_block * most_blocks);

  int chunk = 0;     // slices that may share the rays
  int quarters = 1;  // tiles that it stands for: of the middle voxel there is one only
  std::vector<VoxelColumn> voxels;
  std::vector<RaySource> rays;       // in whole blocks; none with poses, where every frame has other ones
  std::vector<VoxelRay> voxel_rays;  // those that light voxels
};

/// Of all voxels that light may reach.
[[nodiscard]] std::vector<Tile> tiles(const VialRays& rays);

}  // namespace vam::light
