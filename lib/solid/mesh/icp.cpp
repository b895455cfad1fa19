// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/icp.hpp"

#include <algorithm>

#include "base/stats/median.hpp"
#include "solid/mesh/private/triangle_tree.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

Vector3d to_eigen(const Vector3& v) { return {v[0], v[1], v[2]}; }
Vector3 from_eigen(const Vector3d& v) { return {v[0], v[1], v[2]}; }

// The bound of [HUB64]: farther points pull with constant force, so that debris turns the pose little. Not lower: to a
// bound below the print's own growth or shrinkage, opposite faces that both stand out say nothing about where the
// middle is.
double huber_weight(double far, double rms) { return std::min(1.0, (2.5 * rms + 1e-12) / (far + 1e-300)); }

// The biweight of [BT74] for a part of a print, of which the cut faces lie inside the reference and match nothing.
double part_weight(double far, double deviation) {
  const double at = far / (4.685 * deviation + 1e-12);
  return at < 1 ? (1 - at * at) * (1 - at * at) : 0.0;
}

}  // namespace

Similarity to_similarity(const Motion& pose) {
  Similarity result;
  result.scale = pose.scale;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result.rotation[r][c] = pose.rotation(r, c);
  }
  result.shift_mm = from_eigen(pose.shift);
  return result;
}

std::vector<Vector3d> points_of(const model::TriangleSoup& mesh, int count) {
  std::vector<Vector3d> points;
  for (const auto& sample : sample_surface(mesh, count)) points.push_back(to_eigen(sample.point));
  return points;
}

Pairs pair_up(const std::vector<Vector3d>& points, const Motion& pose, const Surface& reference, double reach) {
  const std::size_t n = points.size();
  Pairs pairs{std::vector<Vector3d>(n), std::vector<Vector3d>(n), std::vector<Vector3d>(n),
              std::vector<double>(n),   std::vector<double>(n),   0};
  constexpr std::size_t chunk = 256;
  const auto pair = [&](std::size_t i, int& start) {
    pairs.moved[i] = pose(points[i]);
    const ClosestPoint foot = reference.closest(from_eigen(pairs.moved[i]), start);
    start = foot.triangle;
    pairs.foot[i] = to_eigen(foot.point);
    pairs.normal[i] = to_eigen(foot.normal);
    pairs.distance[i] = (pairs.moved[i] - pairs.foot[i]).dot(pairs.normal[i]);
    pairs.far[i] = (pairs.moved[i] - pairs.foot[i]).norm();
  };
  for_chunks(n, pair, chunk);
  double sum = 0;
  for (const double far : pairs.far) sum += std::pow(std::min(far, reach), 2);
  pairs.rms = std::sqrt(sum / static_cast<double>(n));
  return pairs;
}

double deviation_of(const Pairs& pairs) { return stats::robust_sigma(pairs.far); }

namespace {

// One Gauss-Newton step of the point-to-plane error [CM92; physics §13.3], linearised about `centre`: unknowns are
// rotation vector, shift and relative scale. Returns how far the step moves the farthest point.
double step(const Pairs& pairs, bool with_scale, bool part, Motion& pose) {
  const Vector3d centre = mean_of(pairs.moved);
  const double deviation = part ? deviation_of(pairs) : 0.0;
  Matrix7d normal = Matrix7d::Zero();
  Vector7d right = Vector7d::Zero();
  double reach = 0;
  for (std::size_t i = 0; i < pairs.moved.size(); ++i) {
    const Vector3d arm = pairs.moved[i] - centre;
    reach = std::max(reach, arm.norm());
    const double weight = part ? part_weight(pairs.far[i], deviation) : huber_weight(pairs.far[i], pairs.rms);
    Vector7d row;
    row << arm.cross(pairs.normal[i]), pairs.normal[i], with_scale ? arm.dot(pairs.normal[i]) : 0.0;
    normal += weight * row * row.transpose();
    right -= weight * row * pairs.distance[i];
  }
  // Directions in which the surface slides on itself (a sphere, a cylinder) get no motion: minimum-norm solution.
  const double arm_unit = reach > 0 ? reach : 1;
  Vector7d units;
  units << 1 / arm_unit, 1 / arm_unit, 1 / arm_unit, 1, 1, 1, 1 / arm_unit;
  const Matrix7d scaled = units.asDiagonal() * normal * units.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Matrix7d> solver(scaled);
  const double floor = 1e-6 * solver.eigenvalues().maxCoeff();
  Vector7d inverse = Vector7d::Zero();
  for (int k = 0; k < 7; ++k) {
    if (solver.eigenvalues()[k] > floor) inverse[k] = 1 / solver.eigenvalues()[k];
  }
  const Vector7d x = units.asDiagonal() *
                     (solver.eigenvectors() *
                      (inverse.asDiagonal() * (solver.eigenvectors().transpose() * (units.asDiagonal() * right))));
  const Vector3d turn = x.head<3>();
  const double angle = turn.norm();
  const Matrix3d rotation =
      angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3d::Identity();
  const double growth = 1 + x[6];
  pose.shift = growth * (rotation * (pose.shift - centre)) + centre + x.segment<3>(3);
  pose.rotation = rotation * pose.rotation;
  pose.scale *= growth;
  return angle * reach + x.segment<3>(3).norm() + std::abs(x[6]) * reach;
}

}  // namespace

Alignment run_icp(const std::vector<Vector3d>& points, const Surface& reference, const AlignOptions& options,
                  int max_iterations, double size_mm, Motion& pose, double reach) {
  Alignment result;
  const bool part = reach < everywhere;
  constexpr int patience = 3;  // pairs at edges change sides for ever: where the error rests, so may we
  double best = 1e300;
  int idle = 0;
  for (result.iterations = 0; result.iterations < max_iterations; ++result.iterations) {
    const Pairs pairs = pair_up(points, pose, reference, reach);
    idle = pairs.rms < best * (1 - 1e-4) ? 0 : idle + 1;
    best = std::min(best, pairs.rms);
    if (step(pairs, options.with_scale, part, pose) < options.tolerance * size_mm || idle == patience) {
      result.converged = true;
      break;
    }
  }
  result.rms_mm = pair_up(points, pose, reference, reach).rms;
  result.transform = to_similarity(pose);
  return result;
}

}  // namespace vam::solid
