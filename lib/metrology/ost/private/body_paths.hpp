// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of rays through bodies.
#pragma once

#include <span>
#include <vector>

#include "base/compute/aligned_memory.hpp"
#include "metrology/ost/private/back_projection.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// Bodies that rays pass.
class BodyPaths {
 public:
  BodyPaths(const ClimbingRays& rays, const model::Volume& bodies);
  /// Line integrals along the rays of a column and angle, of heights from slice `first` on, mm times density, by sums
  /// in steps of so many voxels. Beyond the first and last slice bodies are as there.
  void along(int column, int angle, int first, int step, std::span<float> out) const;

 private:
  void add(double x, double y, double start, double slope, std::span<float> out) const;

  ClimbingRays rays_;
  model::Grid grid_;
  double reach_ = 0;                                // of the bodies from the axis, voxels
  std::vector<float, CacheAligned<float>> values_;  // [y][x][slice]
  std::vector<char> occupied_;                      // [y][x]: a body within the next voxel to the right and up
};

}  // namespace vam::metrology
