// The inner loops of vial_operator.cpp, once per instruction set: what one voxel takes from its chief rays, and gives
// back to them. Slices lie side by side, 16, 32 or 64 lanes.
#pragma once

namespace vam::light {

inline constexpr int vial_rows = 32;  // stage angles a call

/// Four series of a LitTable around the voxel (two radii x two directions) and the weights of the second of each pair.
struct VialSource {
  const float* x_p_mm[4];
  const float* strength[4];
  float radius_part;
  float direction_part;
};

/// From millimetres to columns of the buffer: column = scale * x_p + origin, held within [0, last].
struct VialColumns {
  float scale;
  float origin;
  float last;
  int stride;  // columns of a row
};

/// The two columns on either side of the voxel's ray, for up to vial_rows stage angles.
struct VialTaps {
  alignas(64) int cell[vial_rows];     // row * stride + column
  alignas(64) float left[vial_rows];   // weight of the cell
  alignas(64) float right[vial_rows];  // weight of the next column
};

#define VAM_VIAL_KERNELS                                                                          \
  void vial_taps(const VialSource& source, const VialColumns& columns, int rows, VialTaps& taps); \
  /* voxel += sum over rows of left * light[cell] + right * light[cell + 1] */                    \
  void vial_gather(const float* light, int lanes, const VialTaps& taps, int rows, float* voxel);  \
  /* light[cell] += left * voxel, light[cell + 1] += right * voxel for every row */               \
  void vial_scatter(const float* voxel, int lanes, const VialTaps& taps, int rows, float* light); \
  /* to[0..16) += weights[k] * from[k * from_step + 0..16) for all k */                           \
  void vial_blend(const float* from, long from_step, const float* weights, int count, float* to); \
  /* to[k * to_step + 0..16) += weights[k] * from[0..16) for all k */                             \
  void vial_spread(const float* from, const float* weights, int count, long to_step, float* to);

namespace baseline {
VAM_VIAL_KERNELS
}
namespace avx2 {
VAM_VIAL_KERNELS
}
namespace avx512 {
VAM_VIAL_KERNELS
}
#undef VAM_VIAL_KERNELS

}  // namespace vam::light
