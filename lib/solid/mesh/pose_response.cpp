// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/pose_response.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace vam::solid {

namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

Vector7d row_of(const SurfaceSample& place, const Vector3& middle, double reach, bool with_scale) {
  const Vector3 arm = (1 / reach) * (place.point - middle);
  const Vector3 turn = cross(arm, place.normal);
  const Vector3& n = place.normal;
  Vector7d row;
  row << turn[0], turn[1], turn[2], n[0], n[1], n[2], with_scale ? dot(arm, n) : 0.0;
  return row;
}

}  // namespace

struct PoseResponse::State {
  std::vector<SurfaceSample> points;
  Vector3 middle{};
  double reach = 1e-12;  // mm: unit of the arms, so that all unknowns are alike
  bool with_scale = false;
  Matrix7d inverse = Matrix7d::Zero();
};

PoseResponse::PoseResponse(std::span<const SurfaceSample> points, bool with_scale) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.points.assign(points.begin(), points.end());
  s.with_scale = with_scale;
  for (const auto& p : points) s.middle = s.middle + (1.0 / static_cast<double>(points.size())) * p.point;
  for (const auto& p : points) s.reach = std::max(s.reach, length(p.point - s.middle));
  Matrix7d normal = Matrix7d::Zero();
  for (const auto& p : points) {
    const Vector7d row = row_of(p, s.middle, s.reach, with_scale);
    normal += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix7d> solver(normal);
  const double floor = 1e-6 * solver.eigenvalues().maxCoeff();
  for (int k = 0; k < 7; ++k) {
    if (solver.eigenvalues()[k] <= floor) continue;
    const Vector7d direction = solver.eigenvectors().col(k);
    s.inverse += direction * direction.transpose() / solver.eigenvalues()[k];
  }
}

PoseResponse::~PoseResponse() = default;
PoseResponse::PoseResponse(PoseResponse&&) noexcept = default;

PoseResponse::Motion PoseResponse::of(std::span<const double> distances_mm) const {
  const State& s = *state_;
  Vector7d right = Vector7d::Zero();
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    right -= distances_mm[i] * row_of(s.points[i], s.middle, s.reach, s.with_scale);
  }
  const Vector7d found = s.inverse * right;
  Motion motion;
  for (int k = 0; k < 7; ++k) motion[k] = k < 3 || k == 6 ? found[k] / s.reach : found[k];
  return motion;
}

double PoseResponse::at(const Motion& motion, const SurfaceSample& place) const {
  const Vector7d row = row_of(place, state_->middle, 1, state_->with_scale);
  double sum = 0;
  for (int k = 0; k < 7; ++k) sum += row[k] * motion[k];
  return sum;
}

}  // namespace vam::solid
