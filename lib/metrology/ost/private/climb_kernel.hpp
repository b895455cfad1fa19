// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of the back-projection along climbing rays; heights are contiguous. Compiled once per instruction
// set; no standard headers.
#pragma once

namespace vam::metrology {

inline constexpr int climb_heights = 64;  // slices of one tile
inline constexpr int climb_tile = 8;      // voxel columns of one tile across and down
inline constexpr int climb_step = 16;     // heights a call are a multiple of it, whole vectors

/// Detector columns at other heights: out[c][z] = in[c](first + slope * z), linear, for z = 0 ... heights - 1.
/// `in` can be read from first - 1 to the last height + 2, slope is within 0.94 and 1.06.
struct ShearedColumns {
  const float* in;  // of the first column
  long in_stride;   // from one column to the next
  int columns;
  double first;
  double slope;
  int heights;
  float* out;  // [detector column][climb_heights]
};

/// Where the voxel columns of a tile lie among its detector columns: t of (i, j) is t + i * step_x + j * step_y, and
/// the weights of both neighbours.
struct TilePlace {
  float t;
  float step_x;
  float step_y;
  float last;         // highest base
  const float* gain;  // of each voxel column
  int* base;
  float* low;
  float* high;
};

/// sums[q][z] += sum over angles m of low * shifted[m][base][z] + high * shifted[m][base + 1][z].
struct TileSum {
  const float* shifted;  // [angle][detector column][climb_heights]
  long angle_stride;     // floats from one angle to the next
  int angles;
  int columns;       // voxel columns of the tile
  const int* base;   // [angle][voxel column]
  const float* low;  // likewise
  const float* high;
  int heights;
  float* sums;  // [voxel column][climb_heights]
};

#define VAM_CLIMB_KERNELS                        \
  void climb_columns(const ShearedColumns& job); \
  void place_tile(const TilePlace& job);         \
  void add_tile(const TileSum& job);

namespace baseline {
VAM_CLIMB_KERNELS
}
namespace avx2 {
VAM_CLIMB_KERNELS
}
namespace avx512 {
VAM_CLIMB_KERNELS
}
#undef VAM_CLIMB_KERNELS

}  // namespace vam::metrology
