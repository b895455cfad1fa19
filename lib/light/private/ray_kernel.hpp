// The inner loops of the vial's light, once per instruction set. Slices lie side by side, 16, 32 or 64 of them: a
// chunk.
#pragma once

namespace vam::light {

inline constexpr int ray_block = 16;  // rays are looked up in blocks: arrays of them are as long as whole blocks
inline constexpr int most_blocks = 16;

/// What the table holds of a point, at one height.
struct alignas(32) RayNode {
  float column;    // in columns
  float row;       // in rows
  float zoom;      // rows per slice
  float strength;  // T density e^{-mu path}: fluence in the resin per intensity in the image plane
  float edge;      // of a voxel's edge across the ray, in columns
  float cosine;    // of the ray's angle in plan
  float sine;
  float unused;
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
  bool climbs;
  int taps;  // at most
};

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

/// The light on a tile: columns of `rows` floats each.
struct TileColumns {
  float* light;
  const float* ends_mm;   // where a pixel's ray meets an insert, as `light`; null: none of them does
  const float* depth_mm;  // [tap][ray] of the voxel on the ray of that tap's column
  int rows;               // whole slabs of them, most_tile_rows at most
};

inline constexpr int most_tile_rows = 192;

/// Zeros between the voxels of a tile, which are `width` floats each: slices that nothing lights.
inline constexpr int voxel_gap = 48;

#define VAM_RAY_KERNELS                                                                                              \
  /* The exact mean of box pixels over a square voxel: its shadow is a trapezoid. */                                 \
  void aim_rays(const RayNode* nodes, const RaySource* sources, int count, const RayFrame& frame, RayTaps& taps);    \
  /* to[c][i] = from[c][i], i < count <= 16, of columns that are 16 floats and `pitch` floats long; soon the columns \
     `next` floats further on will be wanted */                                                                      \
  void copy_columns(const float* from, int columns, int count, int pitch, long next, float* to);                     \
  /* to[c][i] += from[c][i], the other way */                                                                        \
  void add_columns(const float* from, int columns, int count, int pitch, long next, float* to);                      \
  /* voxel[e] += sum over columns k of weight[k][e] * light[cell[e] + k], between rows linearly where rays climb */  \
  void gather_rays(const TileColumns& columns, const RayTaps& taps, const int* voxel, int count, int width,          \
                   bool climbs, float* voxels);                                                                      \
  /* Its transpose. */                                                                                               \
  void scatter_rays(const float* voxels, const RayTaps& taps, const int* voxel, int count, int width, bool climbs,   \
                    const TileColumns& columns);

namespace baseline {
VAM_RAY_KERNELS
}
namespace avx2 {
VAM_RAY_KERNELS
}
namespace avx512 {
VAM_RAY_KERNELS
}
#undef VAM_RAY_KERNELS

}  // namespace vam::light
