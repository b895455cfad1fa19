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

}  // namespace vam::light::VAM_SIMD
