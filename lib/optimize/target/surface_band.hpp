// SPDX-License-Identifier: GPL-3.0-or-later
// The unconstrained band around a part's surface.
#pragma once

#include <functional>
#include <vector>

namespace vam::optimize {

/// Voxels whose centre is within `reach_px` voxels of the surface, in three dimensions. The surface lies midway between
/// voxels of at least half coverage and the others; beyond the first and the last slice nothing is known, and no
/// surface.
class SurfaceBand {
 public:
  using Read = std::function<void(int k, int count, float* out)>;  // row-major slices of coverage, from k on

  SurfaceBand(Read read, int slices, int width, int height, double reach_px);
  /// Sets values[y * width + x] to 0 where voxel (x, y) of slice k is in the band.
  void clear(int k, float* values) const;

 private:
  using Distances = std::vector<float>;  // squared, in voxels, to the nearest voxel of a kind in the same slice
  [[nodiscard]] Distances to_kind(const std::vector<float>& slice, bool part) const;

  Read read_;
  int slices_, width_, height_;
  double reach_;  // between centres of voxels of different kinds
};

}  // namespace vam::optimize
