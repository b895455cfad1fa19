// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of resample.cpp on 16 slices side by side, compiled once per instruction set.
#pragma once

namespace vam::optics {

inline constexpr int resample_lanes = 16;

#define VAM_RESAMPLE_KERNELS                                                                                         \
  /* out[r][16] = sum_k weights[k] * columns[k][r][16]; columns are `stride` floats apart. */                        \
  void mix_columns(const float* columns, long stride, const float* weights, int count, int rows, float* out);        \
  /* out[a][16] = sum_j weights[j] * column[(start + sense * a + j) mod rows][16]; column has 3 rows more than rows, \
     repeating the first. */                                                                                         \
  void shift_rows(const float* column, int rows, int start, int sense, const float* weights, float* out);

namespace baseline {
VAM_RESAMPLE_KERNELS
}
namespace avx2 {
VAM_RESAMPLE_KERNELS
}
namespace avx512 {
VAM_RESAMPLE_KERNELS
}
#undef VAM_RESAMPLE_KERNELS

}  // namespace vam::optics
