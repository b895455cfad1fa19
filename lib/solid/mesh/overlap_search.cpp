// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/overlap_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"

namespace vam::solid {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int cells_along = 40;  // of the largest side
constexpr double beyond = 0.1;   // of the size, by which points may leave the box

// Distance to the design on a grid, cut off, as lookups must be quick.
class DistanceGrid {
 public:
  DistanceGrid(const Bounds& box, const Surface& design) : cell_(box.largest_side() / cells_along), most_(2 * cell_) {
    for (int a = 0; a < 3; ++a) {
      low_[a] = box.low[a] - beyond * box.largest_side();
      n_[a] = ceil_int((box.high[a] - box.low[a] + 2 * beyond * box.largest_side()) / cell_) + 1;
    }
    values_.resize(product(product(n_[0], n_[1]), n_[2]));
    parallel_for(n_[2], [&](int k) {
      int start = 0;
      for (int j = 0; j < n_[1]; ++j) {
        for (int i = 0; i < n_[0]; ++i) {
          const Vector3 p{low_[0] + i * cell_, low_[1] + j * cell_, low_[2] + k * cell_};
          const Foot foot = design.closest(p, start);
          start = foot.triangle;
          values_[at(i, j, k)] = static_cast<float>(std::min(most_, length(p - foot.point)));
        }
      }
    });
  }

  [[nodiscard]] float operator()(const Vector3d& p) const {
    const int i = round_int((p[0] - low_[0]) / cell_);
    const int j = round_int((p[1] - low_[1]) / cell_);
    const int k = round_int((p[2] - low_[2]) / cell_);
    if (i < 0 || j < 0 || k < 0 || i >= n_[0] || j >= n_[1] || k >= n_[2]) return static_cast<float>(most_);
    return values_[at(i, j, k)];
  }
  [[nodiscard]] double cell() const { return cell_; }

 private:
  [[nodiscard]] std::size_t at(int i, int j, int k) const {
    return flat_index(flat_index(static_cast<std::size_t>(k), n_[1], j), n_[0], i);
  }

  double cell_;
  double most_;
  double low_[3];
  int n_[3];
  std::vector<float> values_;
};

// Rotations spread evenly [ALEXA22], about 20 degrees apart, and the 64 by quarter turns about the axes.
std::vector<Matrix3d> rotations() {
  std::vector<Matrix3d> all;
  constexpr int count = 2400;
  const double phi = std::numbers::sqrt2;
  constexpr double psi = 1.533751168755204288118041;
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5;
    const double inner = std::sqrt(s / count);
    const double outer = std::sqrt(1 - s / count);
    const double a = 2 * std::numbers::pi * s / phi;
    const double b = 2 * std::numbers::pi * s / psi;
    all.push_back(Eigen::Quaterniond(inner * std::sin(a), inner * std::cos(a), outer * std::sin(b), outer * std::cos(b))
                      .toRotationMatrix());
  }
  for (int i = 0; i < 64; ++i) {
    const auto quarters = [](int turns, const Vector3d& axis) {
      return Eigen::AngleAxisd(turns * std::numbers::pi / 2, axis).toRotationMatrix();
    };
    all.push_back(quarters(i % 4, Vector3d::UnitX()) * quarters(i / 4 % 4, Vector3d::UnitY()) *
                  quarters(i / 16, Vector3d::UnitZ()));
  }
  return all;
}

struct Candidate {
  float distance = 1e30F;
  Motion pose;
};

// The best shift of the turned points within the box.
Candidate best_shift(const std::vector<Vector3d>& print, const Matrix3d& rotation, const Bounds& box,
                     const DistanceGrid& distance) {
  constexpr int tried = 48;
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = -low;
  std::vector<Vector3d> some;
  const std::size_t every = std::max<std::size_t>(1, print.size() / tried);
  for (std::size_t i = 0; i < print.size(); ++i) {
    const Vector3d p = rotation * print[i];
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    if (i % every == 0) some.push_back(p);
  }
  const double margin = beyond * box.largest_side();
  const double pitch = 2 * distance.cell();
  Vector3d first;
  int steps[3];
  for (int a = 0; a < 3; ++a) {
    const double slack = box.high[a] - box.low[a] - (high[a] - low[a]);
    if (slack < -margin) return {};
    steps[a] = 1 + std::max(0, ceil_int(slack / pitch));
    first[a] = box.low[a] - low[a] + 0.5 * (slack - (steps[a] - 1) * pitch);
  }
  Candidate best;
  best.pose.rotation = rotation;
  for (int n = 0; n < steps[0] * steps[1] * steps[2]; ++n) {
    const int row = n / steps[0];
    const int layer = row / steps[1];
    const Vector3d shift = first + pitch * Vector3d(n % steps[0], row % steps[1], layer);
    float sum = 0;
    for (const Vector3d& p : some) sum += distance(p + shift);
    const float mean = sum / static_cast<float>(some.size());
    if (mean >= best.distance) continue;
    best.distance = mean;
    best.pose.shift = shift;
  }
  return best;
}

}  // namespace

std::vector<Motion> overlapping_poses(const std::vector<Vector3d>& print, const Bounds& box, const Surface& design,
                                      std::size_t count) {
  const DistanceGrid distance(box, design);
  const std::vector<Matrix3d> turns = rotations();
  std::vector<Candidate> found(turns.size());
  Progress progress("searching the overlap", count_of(turns));
  parallel_for(count_of(turns), [&](int i) {
    found[i] = best_shift(print, turns[i], box, distance);
    progress.tick();
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  std::vector<Motion> poses;
  for (const Candidate& candidate : found) {
    if (poses.size() == count || candidate.distance > 1e29F) break;
    poses.push_back(candidate.pose);
  }
  return poses;
}

}  // namespace vam::solid
