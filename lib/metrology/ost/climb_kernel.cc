// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/climb_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::metrology::VAM_SIMD {

using namespace vam::VAM_SIMD;

void climb_columns(const ShearedColumns& job) {
  Vector lane;
  for (int i = 0; i < vector_floats; ++i) lane[i] = static_cast<float>(i);
  const auto drift = static_cast<float>(job.slope - 1);
  // In fixed point of 32 bits below one, so far below that no lane's fraction is negative; none is above 2.
  constexpr double one = 4294967296.0;
  const double lowest = job.slope < 1 ? job.first + (job.slope - 1) * (vector_floats - 1) : job.first;
  const Vector spare = (drift < 0 ? -drift * static_cast<float>(vector_floats - 1) : 0.0F) + drift * lane;
  auto at = static_cast<long long>(lowest * one);
  const auto step = static_cast<long long>(job.slope * vector_floats * one);
  Vector weights[climb_heights / vector_floats][3];
  long base[climb_heights / vector_floats];
  const int vectors = job.heights / vector_floats;
  for (int v = 0; v < vectors; ++v, at += step) {
    const Vector part = static_cast<float>(static_cast<unsigned>(at)) * static_cast<float>(1 / one) + spare;
    const Vector none = part - part;
    const Vector above = part - 1.0F > none ? part - 1.0F : none;
    base[v] = at >> 32;
    weights[v][0] = 1.0F - part + above;
    weights[v][1] = part - 2 * above;
    weights[v][2] = above;
  }
  for (int c = 0; c < job.columns; ++c) {
    const float* column = job.in + c * job.in_stride;
    float* out = job.out + c * climb_heights;
    for (int v = 0; v < vectors; ++v) {
      const float* in = column + base[v];
      store(out + v * vector_floats,
            weights[v][0] * load(in) + weights[v][1] * load(in + 1) + weights[v][2] * load(in + 2));
    }
  }
}

void place_tile(const TilePlace& job) {
  using Whole = int __attribute__((vector_size(vector_floats * 4), may_alias, aligned(4)));
  Vector i;  // of the vector's lanes, across and down
  Vector j;
  for (int n = 0; n < vector_floats; ++n) {
    i[n] = static_cast<float>(n % climb_tile);
    j[n] = static_cast<float>(n / climb_tile);
  }
  const Vector none = i - i;
  const Vector last = none + job.last;
  for (int q = 0; q < climb_tile * climb_tile; q += vector_floats) {
    const Vector row = job.t + (j + static_cast<float>(q / climb_tile)) * job.step_y;
    const Vector t = row + (i + static_cast<float>(q % climb_tile)) * job.step_x;
    const Vector inside = t < none ? none : t > last ? last : t;
    const Whole base = __builtin_convertvector(inside, Whole);
    const Vector high = load(job.gain + q) * (t - __builtin_convertvector(base, Vector));
    *reinterpret_cast<Whole*>(job.base + q) = base;
    store(job.low + q, load(job.gain + q) - high);
    store(job.high + q, high);
  }
}

namespace {

// `together` vectors of heights at once, so that an angle's weights are loaded once for all of them.
template <int together>
void add_heights(const TileSum& job, int q, int z) {
  float* sums = job.sums + static_cast<long>(q) * climb_heights + z;
  Vector sum[together];
#pragma GCC unroll 4
  for (int v = 0; v < together; ++v) sum[v] = load(sums + v * vector_floats);
  for (int m = 0; m < job.angles; ++m) {
    const int entry = m * job.columns + q;
    const float* from = job.shifted + m * job.angle_stride + static_cast<long>(job.base[entry]) * climb_heights + z;
    const float low = job.low[entry];
    const float high = job.high[entry];
#pragma GCC unroll 4
    for (int v = 0; v < together; ++v) {
      sum[v] += low * load(from + v * vector_floats) + high * load(from + climb_heights + v * vector_floats);
    }
  }
#pragma GCC unroll 4
  for (int v = 0; v < together; ++v) store(sums + v * vector_floats, sum[v]);
}

}  // namespace

void add_tile(const TileSum& job) {
  constexpr int few = climb_step / vector_floats;
  constexpr int many = 4;
  for (int q = 0; q < job.columns; ++q) {
    int z = 0;
    for (; z + many * vector_floats <= job.heights; z += many * vector_floats) add_heights<many>(job, q, z);
    for (; z < job.heights; z += climb_step) add_heights<few>(job, q, z);
  }
}

}  // namespace vam::metrology::VAM_SIMD
