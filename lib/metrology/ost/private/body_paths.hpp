// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies that rays show, and what rays pass of them.
#pragma once

#include <span>
#include <vector>

#include "base/aligned_memory.hpp"
#include "base/image.hpp"
#include "metrology/ost/private/back_projection.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// The volume of sinograms as bodies of one density, that of most of what they show. Bubbles that were not removed
/// leave streaks in it, and fainter places in bodies: values from a quarter to three quarters of the density are
/// stretched to 0 to 1 of it, so that edges, at half, stay where they are.
class BodyPaths {
 public:
  /// Sinograms of the grid's slices, columns x angles over a turn. A place that is seen through, by rays below `dark`,
  /// is empty: a bubble is there in few views.
  BodyPaths(const ClimbingRays& rays, const model::Grid& grid, const std::vector<Image>& sinograms, float dark);
  /// Line integrals along the rays of a column and angle, of heights from slice `first` on, mm times density, by sums
  /// in steps of so many voxels. Beyond the first and last slice bodies are as there.
  void along(int column, int angle, int first, int step, std::span<float> out) const;

 private:
  [[nodiscard]] float density_of(const model::Volume& volume) const;
  void carve(const std::vector<Image>& sinograms, float dark, float density, model::Volume& volume) const;
  void keep(const model::Volume& volume, float density);
  void add(double x, double y, double start, double slope, std::span<float> out) const;

  ClimbingRays rays_;
  model::Grid grid_;
  double reach_ = 0;                                // of the bodies from the axis, voxels
  std::vector<float, CacheAligned<float>> values_;  // [y][x][slice]
  std::vector<char> occupied_;                      // [y][x]: a body within the next voxel to the right and up
};

}  // namespace vam::metrology
