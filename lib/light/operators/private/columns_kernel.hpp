// SPDX-License-Identifier: GPL-3.0-or-later
// Copies columns of light from the sinogram to a tile and back, compiled once per instruction set.
#pragma once

namespace vam::light {

#define VAM_COLUMNS_KERNELS                                                                                    \
  /* to[c][i] = from[c][i], i < count <= 16, of columns that are 16 floats and `pitch` floats long; prefetches \
     the columns `next` floats further on */                                                                   \
  void copy_columns(const float* from, int columns, int count, int pitch, long next, float* to);               \
  /* to[c][i] += from[c][i], the other way */                                                                  \
  void add_columns(const float* from, int columns, int count, int pitch, long next, float* to);                \
  /* to[i] = weights[0] from[i] + weights[k] (from[i - k] + from[i + k]), k <= half, i < count, whole slabs */ \
  void spread_rows(const float* weights, int half, int count, const float* from, float* to);

namespace baseline {
VAM_COLUMNS_KERNELS
}
namespace avx2 {
VAM_COLUMNS_KERNELS
}
namespace avx512 {
VAM_COLUMNS_KERNELS
}
#undef VAM_COLUMNS_KERNELS

}  // namespace vam::light
