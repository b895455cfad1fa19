#include "optics/resample_kernel.hpp"

namespace vam::optics::VAM_SIMD {

void mix_columns(const float* columns, long stride, const float* weights, int count, int rows, float* __restrict out) {
  for (int r = 0; r < rows; ++r) {
    float sum[resample_lanes] = {};
    const float* at = columns + static_cast<long>(r) * resample_lanes;
    for (int k = 0; k < count; ++k, at += stride) {
      for (int s = 0; s < resample_lanes; ++s) sum[s] += weights[k] * at[s];
    }
    for (int s = 0; s < resample_lanes; ++s) out[static_cast<long>(r) * resample_lanes + s] = sum[s];
  }
}

void shift_rows(const float* column, int rows, int start, int sense, const float* weights, float* __restrict out) {
  const float w0 = weights[0];
  const float w1 = weights[1];
  const float w2 = weights[2];
  const float w3 = weights[3];
  int r = start;
  for (int a = 0; a < rows; ++a) {
    const float* at = column + static_cast<long>(r) * resample_lanes;
    float* to = out + static_cast<long>(a) * resample_lanes;
    for (int s = 0; s < resample_lanes; ++s) {
      to[s] =
          w0 * at[s] + w1 * at[s + resample_lanes] + w2 * at[s + 2 * resample_lanes] + w3 * at[s + 3 * resample_lanes];
    }
    r += sense;
    if (r == rows) r = 0;
    if (r < 0) r = rows - 1;
  }
}

}  // namespace vam::optics::VAM_SIMD
