// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <numbers>

#include "solid/mesh/private/icp.hpp"

namespace vam::solid {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct PrincipalAxes {
  Vector3d centre;
  Matrix3d axes;    // columns, ascending spread, right-handed
  Vector3d spread;  // standard deviations
};

PrincipalAxes principal_frame(const std::vector<Vector3d>& points) {
  PrincipalAxes frame;
  frame.centre = mean_of(points);
  Matrix3d covariance = Matrix3d::Zero();
  for (const auto& p : points) covariance += (p - frame.centre) * (p - frame.centre).transpose();
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance / static_cast<double>(points.size()));
  frame.axes = solver.eigenvectors();
  if (frame.axes.determinant() < 0) frame.axes.col(0) *= -1;
  frame.spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  return frame;
}

// Rotations, in the reference's principal frame, that the second moments cannot tell from the identity.
std::vector<Matrix3d> undetermined_turns(const Vector3d& spread) {
  constexpr double alike = 0.1;  // relative difference of spreads up to which the axes may be mixed up
  const bool low_pair = spread[1] - spread[0] < alike * spread[1];
  const bool high_pair = spread[2] - spread[1] < alike * spread[2];
  std::vector<Matrix3d> turns{Matrix3d::Identity()};
  if (low_pair && high_pair) {
    constexpr int coarse_deg = 30;
    for (int a = 0; a < 90; a += coarse_deg) {
      for (int b = 0; b < 90; b += coarse_deg) {
        for (int c = 0; c < 90; c += coarse_deg) {
          if (a + b + c == 0) continue;
          const double rad = std::numbers::pi / 180;
          turns.push_back(
              (Eigen::AngleAxisd(a * rad, Vector3d::UnitX()) * Eigen::AngleAxisd(b * rad, Vector3d::UnitY()) *
               Eigen::AngleAxisd(c * rad, Vector3d::UnitZ()))
                  .toRotationMatrix());
        }
      }
    }
  } else if (low_pair || high_pair) {
    constexpr int steps = 18;  // that a short ICP can bridge: a quarter turn is in the 24 already
    const Vector3d axis = low_pair ? Vector3d::UnitZ() : Vector3d::UnitX();
    for (int k = 1; k < steps; ++k)
      turns.push_back(Eigen::AngleAxisd(k * std::numbers::pi / 2 / steps, axis).toRotationMatrix());
  }
  return turns;
}

}  // namespace

std::vector<Matrix3d> cube_rotations() {
  std::vector<Matrix3d> rotations;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d m = Matrix3d::Zero();
      for (int r = 0; r < 3; ++r) m(r, order[r]) = (signs >> r & 1) != 0 ? -1 : 1;
      if (m.determinant() > 0) rotations.push_back(m);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return rotations;
}

Vector3d mean_of(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

std::vector<Motion> starting_poses(const std::vector<Vector3d>& print, const std::vector<Vector3d>& reference,
                                   bool with_scale) {
  const PrincipalAxes from = principal_frame(print);
  const PrincipalAxes to = principal_frame(reference);
  std::vector<Motion> poses;
  for (const Matrix3d& turn : undetermined_turns(to.spread)) {
    for (const Matrix3d& cube : cube_rotations()) {
      Motion& pose = poses.emplace_back();
      if (with_scale) pose.scale = to.spread.norm() / from.spread.norm();
      pose.rotation = to.axes * turn * cube * from.axes.transpose();
      pose.shift = to.centre - pose.scale * (pose.rotation * from.centre);
    }
  }
  return poses;
}

}  // namespace vam::solid
