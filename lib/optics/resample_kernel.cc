// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/private/resample_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::optics::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {
constexpr int vectors = resample_lanes / vector_floats;
}

void mix_columns(const float* columns, long stride, const float* weights, int count, int rows, float* out) {
  for (int r = 0; r < rows; ++r, columns += resample_lanes, out += resample_lanes) {
    Vector sum[vectors] = {};
    for (int k = 0; k < count; ++k) {
#pragma GCC unroll 4
      for (int v = 0; v < vectors; ++v) sum[v] += weights[k] * load(columns + k * stride + v * vector_floats);
    }
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) store(out + v * vector_floats, sum[v]);
  }
}

void shift_rows(const float* column, int rows, int start, int sense, const float* weights, float* out) {
  int r = start;
  for (int a = 0; a < rows; ++a, out += resample_lanes) {
    const float* at = column + static_cast<long>(r) * resample_lanes;
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v, at += vector_floats) {
      Vector sum = weights[0] * load(at);
      sum += weights[1] * load(at + resample_lanes);
      sum += weights[2] * load(at + 2 * resample_lanes);
      sum += weights[3] * load(at + 3 * resample_lanes);
      store(out + v * vector_floats, sum);
    }
    r += sense;
    if (r == rows) r = 0;
    if (r < 0) r = rows - 1;
  }
}

}  // namespace vam::optics::VAM_SIMD
