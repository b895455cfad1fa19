// SPDX-License-Identifier: GPL-3.0-or-later
// Horizontal faces of a part.
#pragma once

#include <vector>

#include "model/grid.hpp"

namespace vam::light {

/// A level face, or several at one height.
struct FlatFace {
  double z_mm = 0;  // in the plane of the rotation axis, as slices are counted
  bool up = false;  // the part is below it
  double width_mm = 0;
  double area_mm2 = 0;
};

/// Finds the faces of a part slice by slice: where a voxel that is at least half covered lies on or under one that is
/// not. The width is that of the largest circle within, to 12 %; narrower ones than four voxels are none.
class FlatFaceFinder {
 public:
  explicit FlatFaceFinder(const model::Grid& grid);
  /// `count` row-major slices of coverage, in ascending order.
  void add(int count, const float* slices);
  /// After the last slice: from the lowest up.
  [[nodiscard]] std::vector<FlatFace> faces();

 private:
  using Mask = std::vector<char>;
  void compare(const Mask& above);
  void note(bool up, const Mask& face);

  model::Grid grid_;
  int slice_ = 0;  // the next one
  Mask below_;
  std::vector<FlatFace> faces_;
};

}  // namespace vam::light
