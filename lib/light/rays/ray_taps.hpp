// SPDX-License-Identifier: GPL-3.0-or-later
// The projector columns and weights that light the voxels of a tile, as the kernels exchange them. Slices lie side by
// side, 16, 32 or 64 of them: a chunk.
#pragma once

namespace vam::light {

inline constexpr int ray_block = 16;  // rays are looked up in blocks: arrays of them are as long as whole blocks
inline constexpr int most_blocks = 16;
inline constexpr int most_spread_rows = 32;  // over which the light of a row spreads on either side

/// Where the voxels of a tile take light from at one stage angle: columns cell, cell + 1, ... with these weights, and
/// rows start + zoom * (slice of the chunk).
struct RayTaps {
  int* cell;
  float* start;
  float* zoom;
  float* weight;  // [tap][ray], `pitch` rays
  int pitch;
  int taps;  // that are not all 0
  int first_cell, last_cell;
  float first_row, last_row;  // of any voxel's slices
};

/// A ray of a tile and the voxel column that it lights, both by their numbers in the tile.
struct VoxelRay {
  int ray;
  int voxel;
};

}  // namespace vam::light
