// SPDX-License-Identifier: GPL-3.0-or-later
// Slab storage: 16 slices side by side, the slice index fastest. Geometry is worked out once per (pixel, angle) and
// applied to 16 contiguous lanes; this is where the speed comes from.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/compute/aligned_memory.hpp"
#include "base/compute/slab_lanes.hpp"

namespace vam {

/// 16 images of width x height: pixel (x, y) of slice s is values[(y * width + x) * 16 + s]. An object slab has the
/// voxels of 16 z slices; a sinogram slab has width = columns and height = angles. Unused lanes are zero.
struct Slab {
  int width = 0;
  int height = 0;
  std::vector<float, CacheAligned<float>> values;

  Slab() = default;
  Slab(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h * lanes, 0.0F) {}
  float* at(int x, int y) {
    return values.data() + (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * lanes;
  }
  [[nodiscard]] const float* at(int x, int y) const { return const_cast<Slab*>(this)->at(x, y); }
};

/// Values 0 .. count - 1 of up to `wide` rows, a multiple of 4, side by side, groups `stride` apart:
/// to[i * stride + s] = rows[s][i], and 0 for rows that are not there.
void side_by_side(std::span<const float* const> rows, int count, float* to, std::ptrdiff_t stride, int wide = lanes);

/// The inverse: rows[s][i] = from[i * stride + s].
void one_by_one(const float* from, std::ptrdiff_t stride, int count, std::span<float* const> rows);

/// Copies `count` <= 16 row-major images of slab.width x slab.height, one after the other, into lanes 0..count-1 and
/// zeroes the rest.
void pack(const float* images, int count, Slab& slab);

/// The inverse of pack: lanes 0..count-1 to `count` images one after the other.
void unpack(const Slab& slab, int count, float* images);

}  // namespace vam
