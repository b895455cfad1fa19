// SPDX-License-Identifier: GPL-3.0-or-later
// Point-to-plane ICP from a given start [CM92; physics §13.3].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solid/mesh/align.hpp"
#include "solid/mesh/private/align_starts.hpp"

namespace vam::solid {

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
