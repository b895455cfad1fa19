// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/columns_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {

constexpr int slab = 16;

/// to[i] = from[i], i < count < 16: in pieces of constant lengths, which need no call.
inline void copy_few(const float* from, int count, float* to) {
  for (int piece = slab / 2; piece > 0; piece /= 2) {
    if ((count & piece) == 0) continue;
    __builtin_memcpy(to, from, static_cast<unsigned>(piece) * sizeof(float));
    from += piece;
    to += piece;
  }
}

}  // namespace

void copy_columns(const float* from, int columns, int count, int pitch, long next, float* to) {
  if (count == slab) {
    for (int c = 0; c < columns; ++c, from += slab, to += pitch) {
      __builtin_prefetch(from + next);
      for (int v = 0; v < slab; v += vector_floats) store(to + v, load(from + v));
    }
    return;
  }
  for (int c = 0; c < columns; ++c, from += slab, to += pitch) {
    copy_few(from, count, to);
  }
}

void add_columns(const float* from, int columns, int count, int pitch, long next, float* to) {
  if (count == slab) {
    for (int c = 0; c < columns; ++c, from += pitch, to += slab) {
      __builtin_prefetch(to + next, 1);
      for (int v = 0; v < slab; v += vector_floats) store(to + v, load(to + v) + load(from + v));
    }
    return;
  }
  for (int c = 0; c < columns; ++c, from += pitch, to += slab) {
    for (int i = 0; i < count; ++i) to[i] += from[i];
  }
}

namespace {

/// half > 0: that many neighbours, in registers; 0: `neighbours` of them.
template <int half>
inline void spread(const float* weights, int neighbours, int count, const float* from, float* to) {
  const int rows = half > 0 ? half : neighbours;
  for (int v = 0; v < count; v += vector_floats) {
    Vector sum = weights[0] * load(from + v);
#pragma GCC unroll 4
    for (int k = 1; k <= rows; ++k) sum += weights[k] * (load(from + v - k) + load(from + v + k));
    store(to + v, sum);
  }
}

}  // namespace

void spread_rows(const float* weights, int half, int count, const float* from, float* to) {
  if (half == 1) return spread<1>(weights, half, count, from, to);
  if (half == 2) return spread<2>(weights, half, count, from, to);
  if (half == 3) return spread<3>(weights, half, count, from, to);
  spread<0>(weights, half, count, from, to);
}

}  // namespace vam::light::VAM_SIMD
