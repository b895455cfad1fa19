// SPDX-License-Identifier: GPL-3.0-or-later
// Private to align: where to start from when nothing is known of the pose, where a part of a print may lie on the
// design when moments say nothing, and point-to-plane ICP from there [CM92; physics §13.3].
#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <vector>

#include "model/grid.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::solid {

struct Motion {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return scale * (rotation * x) + shift; }
};

[[nodiscard]] Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points);

/// The 24 rotations that map a cube onto itself.
[[nodiscard]] std::vector<Eigen::Matrix3d> cube_rotations();

/// Poses that take the principal axes of the one to those of the other, in all ways that their second moments cannot
/// tell apart; with_scale: their spread, too.
[[nodiscard]] std::vector<Motion> starting_poses(const std::vector<Eigen::Vector3d>& print,
                                                 const std::vector<Eigen::Vector3d>& reference, bool with_scale);

/// Rotations spread evenly [ALEXA22], about 20 degrees apart, and the 24 of a cube.
[[nodiscard]] std::vector<Eigen::Matrix3d> even_rotations();

/// Tries rotations with all shifts on a grid that keep the points within the design's box, by the mean distance of 48
/// of them to the design, distances cut off at a twentieth of its size.
class OverlapSearch {
 public:
  OverlapSearch(const Bounds& box, const Surface& design);

  /// The `count` best poses; of each rotation the `shifts` best, at least two steps of the grid apart.
  [[nodiscard]] std::vector<Motion> poses(const std::vector<Eigen::Vector3d>& print,
                                          const std::vector<Eigen::Matrix3d>& rotations, std::size_t shifts,
                                          std::size_t count) const;

 private:
  [[nodiscard]] float distance_at(const Eigen::Vector3d& p) const;

  Bounds box_;
  double most_;              // mm, at which distances are cut off, as lookups must be quick
  model::Volume distances_;  // to the design
};

[[nodiscard]] Similarity to_similarity(const Motion& pose);

/// `count` points spread over the surface.
[[nodiscard]] std::vector<Eigen::Vector3d> points_of(const model::TriangleSoup& mesh, int count);

struct Pairs {
  std::vector<Eigen::Vector3d> moved;
  std::vector<Eigen::Vector3d> foot;
  std::vector<Eigen::Vector3d> normal;
  std::vector<double> distance;  // along the normal
  std::vector<double> far;       // full distances
  double rms = 0;                // of them, cut off at `reach`
};

/// `reach` of points that are no part of what can match, for parts of a print; for a whole print every point matches.
inline constexpr double everywhere = 1e300;

/// Each point, moved by the pose, with the closest point of the reference.
[[nodiscard]] Pairs pair_up(const std::vector<Eigen::Vector3d>& points, const Motion& pose, const Surface& reference,
                            double reach = everywhere);

/// Standard deviation of normal distances with this median of their magnitudes.
[[nodiscard]] double deviation_of(const Pairs& pairs);

/// From `pose`, which becomes the final one. `size_mm`: of the print, for the tolerance.
Alignment run_icp(const std::vector<Eigen::Vector3d>& points, const Surface& reference, const AlignOptions& options,
                  int max_iterations, double size_mm, Motion& pose, double reach = everywhere);

}  // namespace vam::solid
