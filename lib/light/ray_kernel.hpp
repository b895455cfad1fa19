// The inner loops of the vial's light, once per instruction set. Slices lie side by side, 16, 32 or 64 of them: a
// chunk.
#pragma once

namespace vam::light {

inline constexpr int tap_angles = 16;  // stage angles a call

/// The arrays of RayNodes.
struct TapNodes {
  const float* x_p_mm;
  const float* z_p_mm;  // null where rays stay level
  const float* zoom;
  const float* strength;
  const float* spacing;
  const float* cosine;
  const float* sine;
};

/// Four series around the voxel (two radii x two directions) and the weights of the second of each pair.
struct TapSource {
  long corner[4];
  float radius_part;
  float direction_part;
};

/// From image-plane millimetres to columns and rows; how the part stands.
struct TapFrame {
  float columns_per_mm;
  float column_origin;
  float last_column;  // columns are held within [0, last]
  float rows_per_mm;
  float row_origin;
  float slice_rows;     // rows per slice where d z_p / d z is 1
  float voxel_columns;  // a voxel's edge in columns where d x_p / d r is 1
  int taps;
  const float* cosine;  // of the part's angle
  const float* sine;
};

/// Where a voxel takes light from at tap_angles stage angles: columns cell, cell + 1, ... with these weights, and rows
/// row + zoom * (slice - middle of the chunk).
struct Taps {
  alignas(64) int cell[tap_angles];
  alignas(64) float row[tap_angles];
  alignas(64) float zoom[tap_angles];
  float* weight;  // [tap][angle]
  int taps;       // that are not all 0
};

/// The same weights, split between two planes of light.
struct PlaneTaps {
  alignas(64) int cell[tap_angles];
  float* weight[2];  // [tap][angle]
  int taps;
};

/// What the rays of a tile have in common at each stage angle: columns [first, last] begin a voxel's taps, and rows
/// between the planes of low and high zoom.
struct TapRange {
  alignas(64) int first[tap_angles];
  alignas(64) int last[tap_angles];
  alignas(64) float low_row[tap_angles];  // of the chunk's middle
  alignas(64) float low_zoom[tap_angles];
  alignas(64) float high_row[tap_angles];
  alignas(64) float high_zoom[tap_angles];
};

#define VAM_RAY_KERNELS                                                                                             \
  /* The exact mean of box pixels over a square voxel: its shadow is a trapezoid. */                                \
  void ray_taps(const TapNodes& nodes, const TapSource& source, const TapFrame& frame, Taps& taps);                 \
  /* Taps of `count` rays; outer: the chunk's outermost slice, from its middle. */                                  \
  void range_of(const Taps* taps, int count, float outer, TapRange& range);                                         \
  /* Columns from range.first on, weights shared between the planes by where the outermost slice falls. */          \
  void split_taps(const Taps& taps, int columns, int planes, float outer, const TapRange& range, PlaneTaps& split); \
  /* to[l] = line at row + zoom * l, linear between rows, l < width; the line is read up to 2 vectors further. */   \
  void take_rows(const float* line, float row, float zoom, int width, float* to);                                   \
  /* Its transpose: line += . */                                                                                    \
  void give_rows(const float* from, float row, float zoom, int width, float* line);                                 \
  /* voxels[voxel[e]] += sum over planes p and columns k of at[e].weight[p][k, angle] * light[(cell + k) * planes + \
     p], width floats each, for e < count */                                                                        \
  void gather_rays(const float* light, int width, int planes, const PlaneTaps* at, const int* voxel, int count,     \
                   int angle, float* voxels);                                                                       \
  /* Its transpose. */                                                                                              \
  void scatter_rays(const float* voxels, int width, int planes, const PlaneTaps* at, const int* voxel, int count,   \
                    int angle, float* light);

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
