// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a part that its voxels are too coarse for: they have no voxel that is half covered, and are not printed.
#pragma once

#include <vector>

#include "model/grid.hpp"

namespace vam::solid {

/// Coverage of voxels that are covered by less than a half, and so are their 26 neighbours.
struct LostWalls {
  double voxels = 0;  // sum of coverage
  float most = 0;     // the largest one, about the thickness of the wall in voxels
  int first = 0;      // slices [first, end) hold them
  int end = 0;
};

/// Finds them slice by slice, from the lowest up.
class LostWallFinder {
 public:
  explicit LostWallFinder(const model::Grid& grid) : grid_(grid) {}
  /// The next slices, row-major.
  void add(int count, const float* slices);
  /// Ends with the slices so far; beyond them is nothing.
  [[nodiscard]] LostWalls finish();

 private:
  [[nodiscard]] std::vector<const float*> open() const;
  [[nodiscard]] int first_open() const { return added_ < 2 ? -1 : added_ - 2; }
  void judge(const std::vector<const float*>& slices, int first);

  model::Grid grid_;
  std::vector<float> kept_;  // the last two slices
  int added_ = 0;
  LostWalls found_;
};

}  // namespace vam::solid
