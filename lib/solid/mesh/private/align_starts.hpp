// SPDX-License-Identifier: GPL-3.0-or-later
// Private to align: where to start from when nothing is known of the pose.
#pragma once

#include <Eigen/Dense>
#include <vector>

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

}  // namespace vam::solid
