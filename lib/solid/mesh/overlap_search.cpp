// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "solid/mesh/private/icp.hpp"

namespace vam::solid {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int cells_along = 40;  // of the largest side
constexpr double beyond = 0.1;   // of the size, by which points may leave the box

struct Candidate {
  float distance;
  Motion pose;
};

// The points of a print that are tried, turned, and the shifts that keep all of it in the box.
struct TurnedPrint {
  std::vector<Vector3d> some;
  Vector3d first;  // shift
  int steps[3] = {0, 0, 0};
};

TurnedPrint turned(const std::vector<Vector3d>& print, const Matrix3d& rotation, const Bounds& box, double pitch) {
  constexpr int tried = 48;
  TurnedPrint out;
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = -low;
  const std::size_t every = std::max<std::size_t>(1, print.size() / tried);
  for (std::size_t i = 0; i < print.size(); ++i) {
    const Vector3d p = rotation * print[i];
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    if (i % every == 0) out.some.push_back(p);
  }
  for (int a = 0; a < 3; ++a) {
    const double slack = box.high[a] - box.low[a] - (high[a] - low[a]);
    if (slack < -beyond * box.largest_side()) return {};
    out.steps[a] = 1 + std::max(0, ceil_int(slack / pitch));
    out.first[a] = box.low[a] - low[a] + 0.5 * (slack - (out.steps[a] - 1) * pitch);
  }
  return out;
}

struct Shift {
  float distance;
  Vector3d mm;
};

// The best of these, no two of them within two steps of the grid.
std::vector<Shift> best_apart(std::vector<Shift> shifts, double pitch, std::size_t count) {
  std::vector<Shift> best;
  while (best.size() < count && !shifts.empty()) {
    best.push_back(*std::min_element(shifts.begin(), shifts.end(),
                                     [](const Shift& a, const Shift& b) { return a.distance < b.distance; }));
    if (best.size() == count) break;
    std::erase_if(shifts, [&](const Shift& one) { return (one.mm - best.back().mm).norm() < 2 * pitch; });
  }
  return best;
}

}  // namespace

// Distance to the design on a grid, cut off, as lookups must be quick.
class OverlapSearch::DistanceGrid {
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
          const ClosestPoint foot = design.closest(p, start);
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

std::vector<Matrix3d> even_rotations() {
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
  for (const Matrix3d& turn : cube_rotations()) all.push_back(turn);
  return all;
}

OverlapSearch::OverlapSearch(const Bounds& box, const Surface& design)
    : box_(box), distance_(std::make_unique<DistanceGrid>(box, design)) {}

OverlapSearch::~OverlapSearch() = default;

std::vector<Motion> OverlapSearch::poses(const std::vector<Vector3d>& print, const std::vector<Matrix3d>& rotations,
                                         std::size_t shifts, std::size_t count) const {
  const double pitch = 2 * distance_->cell();
  std::vector<std::vector<Candidate>> of_turn(rotations.size());
  Progress progress("searching the overlap", count_of(rotations));
  parallel_for(count_of(rotations), [&](int i) {
    const TurnedPrint tried = turned(print, rotations[i], box_, pitch);
    std::vector<Shift> all;
    for (int n = 0; n < tried.steps[0] * tried.steps[1] * tried.steps[2]; ++n) {
      const int row = n / tried.steps[0];
      const int layer = row / tried.steps[1];
      const Vector3d shift = tried.first + pitch * Vector3d(n % tried.steps[0], row % tried.steps[1], layer);
      float sum = 0;
      for (const Vector3d& p : tried.some) sum += (*distance_)(p + shift);
      all.push_back({sum / static_cast<float>(tried.some.size()), shift});
    }
    for (const Shift& shift : best_apart(std::move(all), pitch, shifts)) {
      of_turn[i].push_back({shift.distance, {1, rotations[i], shift.mm}});
    }
    progress.tick();
  });
  std::vector<Candidate> found;
  for (const auto& some : of_turn) found.insert(found.end(), some.begin(), some.end());
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  found.resize(std::min(found.size(), count));
  std::vector<Motion> motions;
  for (const Candidate& candidate : found) motions.push_back(candidate.pose);
  return motions;
}

}  // namespace vam::solid
