// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

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

/// Around the box, and a little beyond it.
model::Grid search_grid(const Bounds& box) {
  const double margin = beyond * box.largest_side();
  model::Grid grid;
  grid.voxel_mm = box.largest_side() / cells_along;
  grid.origin_mm = box.low - Vector3{margin, margin, margin};
  const auto cells = [&](double side) { return ceil_int((side + 2 * margin) / grid.voxel_mm) + 1; };
  const Vector3 size = box.size();
  std::tie(grid.nx, grid.ny, grid.nz) = std::tuple(cells(size[0]), cells(size[1]), cells(size[2]));
  return grid;
}

}  // namespace

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
    : box_(box),
      most_(2 * box.largest_side() / cells_along),
      distances_(distance_band(design, search_grid(box), most_)) {}

float OverlapSearch::distance_at(const Vector3d& p) const {
  const model::Grid& grid = distances_.grid;
  const auto cell = [&](int axis) { return round_int((p[axis] - grid.origin_mm[axis]) / grid.voxel_mm); };
  const int i = cell(0);
  const int j = cell(1);
  const int k = cell(2);
  if (i < 0 || j < 0 || k < 0 || i >= grid.nx || j >= grid.ny || k >= grid.nz) return static_cast<float>(most_);
  return std::abs(distances_.slice(k)[flat_index(j, grid.nx, i)]);
}

std::vector<Motion> OverlapSearch::poses(const std::vector<Vector3d>& print, const std::vector<Matrix3d>& rotations,
                                         std::size_t shifts, std::size_t count) const {
  const double pitch = 2 * distances_.grid.voxel_mm;
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
      for (const Vector3d& p : tried.some) sum += distance_at(p + shift);
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
