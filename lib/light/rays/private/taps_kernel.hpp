// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the pixels that light a voxel from points of the ray table, compiled once per instruction set.
#pragma once

#include "light/rays/ray_taps.hpp"

namespace vam::light {

/// What the table holds of a point, at one height.
struct alignas(32) RayNode {
  float column;    // in columns
  float row;       // in rows
  float zoom;      // rows per slice
  float strength;  // T density e^{-mu path}: fluence in the resin per intensity in the image plane
  float edge;      // of a voxel's edge across the ray, in columns
  float cosine;    // of the ray's angle in plan
  float sine;
  float spread2;  // of the light about the ray: the square of the edge of the box with that variance, in columns^2
};

/// A point between four nodes of the table at stage angle 0: two radii, and two directions one after the other.
struct RaySource {
  int low_row, high_row;  // of direction 0
  int direction;
  float radius_part;
  float direction_part;
};

/// How the part stands, and what the rays of a chunk have in common.
struct RayFrame {
  int shift;       // of all directions, from stage angle 0
  int step;        // of all directions, from one stage angle to the next
  int directions;  // of a turn; the table repeats the first one after them
  float cosine;    // of the part's angle
  float sine;
  float last_column;  // columns are held within [0, last]
  float half;         // slices from the chunk's first one to its middle
  bool spreads;
  int taps;  // at most
};

#define VAM_TAPS_KERNEL                                                                                             \
  /* The exact mean of box pixels over a square voxel: its shadow is a trapezoid. Light that spreads widens it, and \
     its variance by exactly its own. */                                                                            \
  void find_taps(const RayNode* nodes, const RaySource* sources, int count, const RayFrame& frame, RayTaps& taps);

namespace baseline {
VAM_TAPS_KERNEL
}
namespace avx2 {
VAM_TAPS_KERNEL
}
namespace avx512 {
VAM_TAPS_KERNEL
}
#undef VAM_TAPS_KERNEL

}  // namespace vam::light
