// SPDX-License-Identifier: GPL-3.0-or-later
// Sums light from the columns of a tile to its voxels and back, compiled once per instruction set.
#pragma once

#include "light/rays/ray_taps.hpp"

namespace vam::light {

/// The light on a tile: columns of `pitch` floats each, of which `rows` from number `first` on reach the voxels.
struct TileColumns {
  float* light;
  const float* ends_mm;    // where a pixel's ray meets an insert, as `light`; null: none of them does
  const float* depth_mm;   // [tap][ray] of the voxel on the ray of that tap's column
  int pitch, first, rows;  // whole slabs, most_tile_rows at most
};

inline constexpr int most_tile_rows = 192;

/// Zeros before, between and after the voxels of a tile, which are `width` floats each: slices that nothing lights.
constexpr int voxel_gap(bool climbs) { return climbs ? 48 : 0; }

#define VAM_RAYS_KERNELS                                                                                               \
  /* voxel[e] += sum over columns k of weight[k][e] * light[cell[e] + k], between rows linearly where rays climb */    \
  void gather_rays(const TileColumns& columns, const RayTaps& taps, const VoxelRay* rays, int count, int width,        \
                   bool climbs, float* voxels);                                                                        \
  /* Its transpose. */                                                                                                 \
  void scatter_rays(const float* voxels, const RayTaps& taps, const VoxelRay* rays, int count, int width, bool climbs, \
                    const TileColumns& columns);

namespace baseline {
VAM_RAYS_KERNELS
}
namespace avx2 {
VAM_RAYS_KERNELS
}
namespace avx512 {
VAM_RAYS_KERNELS
}
#undef VAM_RAYS_KERNELS

}  // namespace vam::light
