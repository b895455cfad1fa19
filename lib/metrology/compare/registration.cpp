// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/registration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/constants.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::metrology {

namespace {

constexpr int samples = 20000;
constexpr std::size_t parts = 16;  // two by two by four

std::vector<std::size_t> parts_of(const std::vector<solid::SurfaceSample>& points) {
  solid::Bounds box;
  for (const auto& one : points) box.add(one.point);
  const auto cell = [&](const Vector3& at, std::size_t d, double count) {
    const double place = count * (at[d] - box.low[d]) / std::max(box.size()[d], 1e-9);
    return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1));
  };
  std::vector<std::size_t> part;
  for (const auto& one : points) {
    part.push_back((cell(one.point, 0, 2) * 2 + cell(one.point, 1, 2)) * 4 + cell(one.point, 2, 4));
  }
  return part;
}

/// Observability of a rotation about the axis, and of a shift along it: mean of abs(n . v), 0 if the surface slides on
/// itself. The facets of a round surface leave some 0.001.
struct Observability {
  double turn = 0;
  double shift = 0;
};

Observability grip_of(const std::vector<solid::SurfaceSample>& points, const Vector3& middle) {
  double moved = 0;
  double way = 0;
  double lifted = 0;
  for (const auto& [point, normal, triangle] : points) {
    const double x = point[0] - middle[0];
    const double y = point[1] - middle[1];
    moved += std::pow(normal[1] * x - normal[0] * y, 2);
    way += x * x + y * y;
    lifted += normal[2] * normal[2];
  }
  return {moved / std::max(way, 1e-12), lifted / static_cast<double>(points.size())};
}

/// x -> x + turn x (x - middle) + shift + growth (x - middle), and how far the surface lies outside by itself: too much
/// light, or an isovalue that is not the gel's, are no scale.
enum Component : int { turn_x, turn_y, turn_z, shift_x, shift_y, shift_z, growth, outside, components };
using Motion = Eigen::Matrix<double, components, 1>;

Motion row_of(const solid::SurfaceSample& sample, const Vector3& middle) {
  const Vector3 at = sample.point - middle;
  const Vector3 turn = cross(at, sample.normal);
  Motion row;
  row << turn[0], turn[1], turn[2], sample.normal[0], sample.normal[1], sample.normal[2], dot(at, sample.normal), -1;
  return row;
}

struct Fit {
  Motion motion = Motion::Zero();
  Motion variance = Motion::Zero();  // by parts of the surface, whose errors are independent
};

using NormalMatrix = Eigen::Matrix<double, components, components>;

/// Edges that the camera or the resin has rounded lie far out: weights of [BT74], from the median of what is left.
std::vector<double> weights_of(const std::vector<solid::SurfaceSample>& points, const std::vector<float>& distances,
                               const Vector3& middle, const Motion& motion) {
  std::vector<double> left;
  for (std::size_t i = 0; i < points.size(); ++i) {
    left.push_back(std::abs(static_cast<double>(distances[i]) + row_of(points[i], middle).dot(motion)));
  }
  const double limit = std::max(4.685 * stats::robust_sigma(left), 1e-9);
  for (double& one : left) one = one < limit ? std::pow(1 - one * one / (limit * limit), 2) : 0.0;
  return left;
}

Fit fit(const std::vector<solid::SurfaceSample>& points, const std::vector<float>& distances, const Vector3& middle) {
  const std::vector<std::size_t> part = parts_of(points);
  Fit result;
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    const auto weights = weights_of(points, distances, middle, result.motion);
    NormalMatrix normal = NormalMatrix::Zero();
    Motion right = Motion::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Motion row = row_of(points[i], middle);
      normal += weights[i] * row * row.transpose();
      right -= weights[i] * static_cast<double>(distances[i]) * row;
    }
    const Eigen::CompleteOrthogonalDecomposition<NormalMatrix> solver(normal);
    result.motion = solver.solve(right);
    std::array<Motion, parts> errors;
    errors.fill(Motion::Zero());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Motion row = row_of(points[i], middle);
      errors[part[i]] -= weights[i] * (static_cast<double>(distances[i]) + row.dot(result.motion)) * row;
    }
    result.variance.setZero();
    for (const Motion& one : errors) result.variance += solver.solve(one).cwiseAbs2();
  }
  return result;
}

}  // namespace

Registration registration(const model::TriangleSoup& print, const solid::Surface& design, double pixel_mm) {
  const solid::Alignment found = solid::refine(print, design, {.with_scale = true, .samples = samples});
  const solid::Similarity& pose = found.transform;
  auto points = solid::sample_surface(print, samples);
  std::vector<Vector3> sampled;
  std::vector<Vector3> places;
  Vector3 middle{};
  for (auto& one : points) {
    sampled.push_back(one.point);
    one.point = pose(one.point);
    one.normal = {dot(pose.rotation[0], one.normal), dot(pose.rotation[1], one.normal),
                  dot(pose.rotation[2], one.normal)};
    places.push_back(one.point);
    middle = middle + (1.0 / static_cast<double>(points.size())) * one.point;
  }
  const auto [motion, variance] = fit(points, design.signed_distances(places), middle);
  const auto sigma = [&, &spread = variance](Component c) { return std::sqrt(spread[c]); };
  const int n = static_cast<int>(points.size());
  Registration result;
  result.angle_deg = {deg_per_rad * (std::atan2(pose.rotation[1][0], pose.rotation[0][0]) + motion[turn_z]),
                      deg_per_rad * sigma(turn_z), n};
  double reach_mm = 0;
  for (const Vector3& one : places) reach_mm += length(one - middle) / static_cast<double>(n);
  constexpr double surface_px = 0.2;  // by which faces of unlike directions lie unlike in a reconstruction
  const double growth_sigma = std::hypot(sigma(growth), surface_px * pixel_mm / reach_mm);
  result.scale = {pose.scale * (1 + motion[growth]), pose.scale * growth_sigma, n};
  Vector3 before{};
  for (const Vector3& one : sampled) before = before + (1.0 / static_cast<double>(n)) * one;
  const Vector3 after = middle + Vector3{motion[shift_x], motion[shift_y], motion[shift_z]};
  result.middle_z_mm = before[2];
  result.z_mm = {after[2] - before[2], sigma(shift_z), n};
  // Turned and grown about the axis, the middle would be there.
  const double turned = result.angle_deg.value / deg_per_rad;
  const double x = result.scale.value * (before[0] * std::cos(turned) - before[1] * std::sin(turned));
  const double y = result.scale.value * (before[0] * std::sin(turned) + before[1] * std::cos(turned));
  result.aside_mm = std::hypot(after[0] - x, after[1] - y);
  const Vector3 upright{pose.rotation[0][2], pose.rotation[1][2], pose.rotation[2][2]};
  const Vector3 tilted = upright + cross({motion[turn_x], motion[turn_y], motion[turn_z]}, upright);
  result.tilt_deg = deg_per_rad * std::atan2(std::hypot(tilted[0], tilted[1]), tilted[2]);
  result.outside_mm = motion[outside];
  result.rms_mm = found.rms_mm;
  constexpr double least_grip = 0.01;
  const Observability grip = grip_of(points, middle);
  if (!found.converged) {
    result.failure = "the print was not brought onto the design in " + std::to_string(found.iterations) + " iterations";
  } else if (grip.turn < least_grip) {
    result.failure = "the part is round about its axis, so that its angle cannot be found; take another part";
  } else if (grip.shift < least_grip) {
    result.failure = "the part has no faces across the axis, so that its height cannot be found; take another part";
  }
  return result;
}

}  // namespace vam::metrology
