#include "solid/mesh/align.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/private/align_starts.hpp"

namespace vam::solid {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

Vector3d to_eigen(const Vector3& v) { return {v[0], v[1], v[2]}; }
Vector3 from_eigen(const Vector3d& v) { return {v[0], v[1], v[2]}; }

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

struct Pairs {
  std::vector<Vector3d> moved;
  std::vector<Vector3d> foot;
  std::vector<Vector3d> normal;
  std::vector<double> distance;  // along the normal
  double rms = 0;                // full distances
};

Pairs pair_up(const std::vector<Vector3d>& points, const Motion& pose, const Surface& reference) {
  const std::size_t n = points.size();
  Pairs pairs{std::vector<Vector3d>(n), std::vector<Vector3d>(n), std::vector<Vector3d>(n), std::vector<double>(n), 0};
  constexpr std::size_t chunk = 256;
  const auto chunks = static_cast<int>((n + chunk - 1) / chunk);
  parallel_for(chunks, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * chunk;
    int start = 0;
    for (std::size_t i = begin; i < std::min(n, begin + chunk); ++i) {
      pairs.moved[i] = pose(points[i]);
      const Foot foot = reference.closest(from_eigen(pairs.moved[i]), start);
      start = foot.triangle;
      pairs.foot[i] = to_eigen(foot.point);
      pairs.normal[i] = to_eigen(foot.normal);
      pairs.distance[i] = (pairs.moved[i] - pairs.foot[i]).dot(pairs.normal[i]);
    }
  });
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += (pairs.moved[i] - pairs.foot[i]).squaredNorm();
  pairs.rms = std::sqrt(sum / static_cast<double>(n));
  return pairs;
}

// The bound of [HUB64]: farther points pull with constant force, so that debris turns the pose little. Not lower: to a
// bound below the print's own growth or shrinkage, opposite faces that both stand out say nothing about where the
// middle is.
double huber_bound(const Pairs& pairs) { return 2.5 * pairs.rms + 1e-12; }

// One Gauss-Newton step of the point-to-plane error [CM92; physics §13.3], linearised about `centre`: unknowns are
// rotation vector, shift and relative scale. Returns how far the step moves the farthest point.
double step(const Pairs& pairs, bool with_scale, Motion& pose) {
  const Vector3d centre = mean_of(pairs.moved);
  const double bound = huber_bound(pairs);
  Matrix7d normal = Matrix7d::Zero();
  Vector7d right = Vector7d::Zero();
  double reach = 0;
  for (std::size_t i = 0; i < pairs.moved.size(); ++i) {
    const Vector3d arm = pairs.moved[i] - centre;
    reach = std::max(reach, arm.norm());
    const double weight = std::min(1.0, bound / ((pairs.moved[i] - pairs.foot[i]).norm() + 1e-300));
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

Alignment run_icp(const std::vector<Vector3d>& points, const Surface& reference, const AlignOptions& options,
                  int max_iterations, double size, Motion& pose) {
  Alignment result;
  constexpr int patience = 3;  // pairs at edges change sides for ever: where the error rests, so may we
  double best = 1e300;
  int idle = 0;
  for (result.iterations = 0; result.iterations < max_iterations; ++result.iterations) {
    const Pairs pairs = pair_up(points, pose, reference);
    idle = pairs.rms < best * (1 - 1e-4) ? 0 : idle + 1;
    best = std::min(best, pairs.rms);
    if (step(pairs, options.with_scale, pose) < options.tolerance * size || idle == patience) {
      result.converged = true;
      break;
    }
  }
  result.rms_mm = pair_up(points, pose, reference).rms;
  result.transform = to_similarity(pose);
  return result;
}

}  // namespace

Vector3 Similarity::operator()(const Vector3& x) const {
  return {scale * dot(rotation[0], x) + shift_mm[0], scale * dot(rotation[1], x) + shift_mm[1],
          scale * dot(rotation[2], x) + shift_mm[2]};
}

std::array<std::array<double, 4>, 4> Similarity::matrix() const {
  std::array<std::array<double, 4>, 4> m{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) m[r][c] = scale * rotation[r][c];
    m[r][3] = shift_mm[r];
  }
  m[3][3] = 1;
  return m;
}

Alignment refine(const model::TriangleSoup& print, const Surface& reference, const AlignOptions& options) {
  Motion pose;
  return run_icp(points_of(print, options.samples), reference, options, options.max_iterations,
                 bounding_box(print).largest_side(), pose);
}

Alignment align(const model::TriangleSoup& print, const model::TriangleSoup& reference_mesh, const Surface& reference,
                const AlignOptions& options) {
  const std::vector<Vector3d> all = points_of(print, options.samples);
  const std::vector<Vector3d> few = points_of(print, 200);
  const double size = bounding_box(reference_mesh).largest_side();
  AlignOptions rigid = options;
  rigid.with_scale = false;

  struct Start {
    double rms;
    Motion pose;
  };
  std::vector<Start> starts;
  for (const Motion& pose : starting_poses(all, points_of(reference_mesh, options.samples), options.with_scale)) {
    starts.push_back({0, pose});
  }
  // Fewer and fewer starts are refined more and more.
  const auto keep = [&](std::size_t count, const auto& rms_of) {
    parallel_for(count_of(starts), [&](int i) {
      Start& start = starts[i];
      start.rms = rms_of(start.pose);
    });
    std::sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.rms < b.rms; });
    starts.resize(std::min(starts.size(), count));
  };
  keep(96, [&](Motion& pose) { return pair_up(few, pose, reference).rms; });
  keep(12, [&](Motion& pose) { return run_icp(few, reference, rigid, 6, size, pose).rms_mm; });
  keep(3, [&](Motion& pose) { return run_icp(few, reference, rigid, 20, size, pose).rms_mm; });
  // The best at a tenth of the points, then all points from there.
  const std::vector<Vector3d> some = points_of(print, std::max(400, options.samples / 10));
  keep(1, [&](Motion& pose) { return run_icp(some, reference, options, options.max_iterations, size, pose).rms_mm; });
  return run_icp(all, reference, options, options.max_iterations, size, starts.front().pose);
}

}  // namespace vam::solid
