// SPDX-License-Identifier: GPL-3.0-or-later
// Walls and gaps of a part that its voxels are too coarse for: walls that have no voxel that is half covered are not
// printed, gaps that have none that is three quarters free are printed shut.
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

/// Free shares of voxels that are free by less than three quarters, and so are their 26 neighbours. Shares below 1/64,
/// as of shells that nearly touch, are no gap, and beyond the grid all is free.
struct LostGaps {
  double voxels = 0;  // sum of free shares
  float widest = 0;   // gap, in voxels: the free shares along the axis that it is narrowest along
  int first = 0;      // slices [first, end) hold them
  int end = 0;
};

struct Lost {
  LostWalls walls;
  LostGaps gaps;
};

/// Finds them slice by slice, from the lowest up.
class LostFinder {
 public:
  explicit LostFinder(const model::Grid& grid) : grid_(grid) {}
  /// The next slices, row-major.
  void add(int count, const float* slices);
  /// Ends with the slices so far; beyond them is nothing.
  [[nodiscard]] Lost finish();

 private:
  [[nodiscard]] std::vector<const float*> open() const;
  [[nodiscard]] int first_open() const { return added_ < 2 ? -1 : added_ - 2; }
  void judge(const std::vector<const float*>& slices, int first);

  model::Grid grid_;
  std::vector<float> kept_;  // the last two slices
  int added_ = 0;
  Lost found_;
};

}  // namespace vam::solid
