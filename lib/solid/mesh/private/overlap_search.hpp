// SPDX-License-Identifier: GPL-3.0-or-later
// Private to align: where a part of a print may lie on the design when moments say nothing.
#pragma once

#include <memory>
#include <vector>

#include "solid/mesh/geometry.hpp"
#include "solid/mesh/private/align_starts.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::solid {

/// Rotations spread evenly [ALEXA22], about 20 degrees apart, and the 24 of a cube.
[[nodiscard]] std::vector<Eigen::Matrix3d> even_rotations();

/// Tries rotations with all shifts on a grid that keep the points within the design's box, by the mean distance of 48
/// of them to the design, distances cut off at a twentieth of its size.
class OverlapSearch {
 public:
  OverlapSearch(const Bounds& box, const Surface& design);
  ~OverlapSearch();

  /// The `count` best poses; of each rotation the `shifts` best, at least two steps of the grid apart.
  [[nodiscard]] std::vector<Motion> poses(const std::vector<Eigen::Vector3d>& print,
                                          const std::vector<Eigen::Matrix3d>& rotations, std::size_t shifts,
                                          std::size_t count) const;

 private:
  class DistanceGrid;
  Bounds box_;
  std::unique_ptr<DistanceGrid> distance_;
};

}  // namespace vam::solid
