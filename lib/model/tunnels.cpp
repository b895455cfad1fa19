// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/tunnels.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::model {

namespace {

/// Values at the corners of a cell between eight voxels, x fastest.
using Corners = std::array<float, 8>;
/// Whether each of 3 x 3 x 3 points of a cell, half a voxel apart, reaches the level.
using Points = std::array<bool, 27>;

constexpr int corner_point(int corner) { return 2 * (corner & 1) + 6 * (corner >> 1 & 1) + 18 * (corner >> 2); }

Points solid_points(const Corners& corners, double level) {
  Points solid{};
  for (int n = 0; n < 27; ++n) {
    const std::array<int, 3> at{n % 3, n / 3 % 3, n / 9};
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto share = [&](std::size_t axis) { return (corner >> axis & 1) != 0 ? at[axis] : 2 - at[axis]; };
      value += share(0) * share(1) * share(2) * static_cast<double>(corners[corner]);
    }
    solid[n] = value >= 8 * level;
  }
  return solid;
}

/// What the first of 2 x 2 x 2 points adds: corners - edges + faces - cubes of the union of cubes around the points,
/// of those that lie beside it in the direction of the others.
int cubes_added(const std::array<bool, 8>& is) {
  const auto any = [&](std::initializer_list<int> points) {
    return std::any_of(points.begin(), points.end(), [&](int n) { return is[n]; }) ? 1 : 0;
  };
  const int corner = any({0, 1, 2, 3, 4, 5, 6, 7});
  const int edges = any({0, 2, 4, 6}) + any({0, 1, 4, 5}) + any({0, 1, 2, 3});
  const int faces = any({0, 1}) + any({0, 2}) + any({0, 4});
  return corner - edges + faces - (is[0] ? 1 : 0);
}

/// The Euler characteristic of a cell's share of the union.
int euler_of(const Points& solid) {
  int sum = 0;
  for (int n = 0; n < 8; ++n) {
    const int first = corner_point(n) / 2;
    std::array<bool, 8> is{};
    for (int m = 0; m < 8; ++m) is[m] = solid[first + corner_point(m) / 2];
    sum += cubes_added(is);
  }
  return sum;
}

int steps_apart(int a, int b) {
  return std::abs(a % 3 - b % 3) + std::abs(a / 3 % 3 - b / 3 % 3) + std::abs(a / 9 - b / 9);
}

bool touch(int a, int b) {
  return std::abs(a % 3 - b % 3) <= 1 && std::abs(a / 3 % 3 - b / 3 % 3) <= 1 && std::abs(a / 9 - b / 9) <= 1;
}

/// Of each point that is solid, or not, the least one that it hangs together with, -1 of the others. Solid points hang
/// together where their cubes touch, others by faces.
std::array<int, 27> connected(const Points& points, bool solid) {
  std::array<int, 27> least{};
  for (int n = 0; n < 27; ++n) least[n] = points[n] == solid ? n : -1;
  for (bool changed = true; changed;) {
    changed = false;
    for (int a = 0; a < 27; ++a) {
      for (int b = 0; b < 27; ++b) {
        if (least[a] < 0 || least[b] <= least[a] || (solid ? !touch(a, b) : steps_apart(a, b) != 1)) continue;
        least[b] = least[a];
        changed = true;
      }
    }
  }
  return least;
}

/// Of each corner that is solid, or not, the least one that edges of the cell lead to.
std::array<int, 8> along_edges(const Points& points, bool solid) {
  std::array<int, 8> least{};
  for (int n = 0; n < 8; ++n) least[n] = points[corner_point(n)] == solid ? n : -1;
  for (int round = 0; round < 3; ++round) {
    for (int n = 0; n < 8; ++n) {
      for (const int bit : {1, 2, 4}) {
        const int other = n ^ bit;
        if (least[n] >= 0 && least[other] > least[n]) least[other] = least[n];
      }
    }
  }
  return least;
}

bool all_alike(const std::array<int, 8>& least) {
  int first = -1;
  return std::all_of(least.begin(), least.end(), [&](int n) {
    if (n >= 0 && first < 0) first = n;
    return n < 0 || n == first;
  });
}

/// Of the runs that of this voxel. There is one.
std::size_t run_of(const std::vector<VoxelRun>& runs, int x, int y) {
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), std::pair{y, x}, [](const auto& at, const VoxelRun& run) {
        return at < std::pair{run.row, run.begin};
      });
  return static_cast<std::size_t>(after - runs.begin()) - 1;
}

}  // namespace

void TunnelCounter::add_cell(const Corners& values, double level, int x, int y, Layer& layer) {
  const Points points = solid_points(values, level);
  layer.euler += euler_of(points);
  for (const bool solid : {true, false}) {
    const std::array<int, 8> least = along_edges(points, solid);
    if (all_alike(least)) continue;
    const std::array<int, 27> piece = connected(points, solid);
    for (int b = 0; b < 8; ++b) {
      for (int a = 0; a < b; ++a) {
        if (least[a] != a || least[b] != b || piece[corner_point(a)] != piece[corner_point(b)]) continue;
        const auto corner = [&](int n) { return Corner{x + (n & 1), y + (n >> 1 & 1), n >= 4}; };
        layer.joins.push_back({corner(a), corner(b), solid});
      }
    }
  }
}

/// nullptr: beyond the volume.
TunnelCounter::Layer TunnelCounter::layer(const float* below, const float* above) const {
  Layer made;
  made.solid.assign(product(width_ + 2, height_ + 2), 0);
  const auto value = [&](const float* slice, int x, int y) {  // with the margin
    const bool in = slice != nullptr && x > 0 && x <= width_ && y > 0 && y <= height_;
    return in ? slice[product(y - 1, width_) + static_cast<std::size_t>(x - 1)] : 0.0F;
  };
  const auto reaches = [this](float v) { return static_cast<double>(v) >= level_; };
  for (int y = 0; y <= height_; ++y) {
    Corners corners{};
    for (int x = -1; x <= width_; ++x) {
      int solid = 0;
      for (int n = 0; n < 8; n += 2) {
        corners[n] = corners[n + 1];
        corners[n + 1] = value(n < 4 ? below : above, x + 1, y + (n >> 1 & 1));
        solid += (reaches(corners[n]) ? 1 : 0) + (reaches(corners[n + 1]) ? 1 : 0);
      }
      made.solid[product(y, width_ + 2) + static_cast<std::size_t>(x + 1)] = reaches(corners[5]) ? 1 : 0;
      if (solid > 0 && solid < 8) add_cell(corners, level_, x, y, made);
    }
  }
  return made;
}

void TunnelCounter::add(int count, const float* slices) {
  if (count == 0) return;
  const std::size_t size = product(width_, height_);
  const std::size_t first = added_.size();
  added_.resize(first + static_cast<std::size_t>(count));
  const float* before = last_.empty() ? nullptr : last_.data();
  parallel_for(count, [&](int k) {
    added_[first + static_cast<std::size_t>(k)] =
        layer(k > 0 ? slices + product(k - 1, size) : before, slices + product(k, size));
  });
  const float* last = slices + product(count - 1, size);
  last_ = std::vector<float>(last, last + size);
}

/// The corners of joins lie in these runs and in those of the slice before.
void TunnelCounter::Pieces::add(const std::vector<VoxelRun>& runs, const std::vector<Join>& joins, bool solid) {
  const std::vector<VoxelRun> below = sets.last();
  sets.add(runs, by_faces_only);
  const std::size_t first = sets.first_of_last();
  for (const Join& join : joins) {
    if (join.solid != solid) continue;
    const auto number = [&](const Corner& at) {
      return at.above ? first + run_of(runs, at.x, at.y) : first - below.size() + run_of(below, at.x, at.y);
    };
    sets.join(number(join.from), number(join.to));
  }
  sets.forget([this](std::size_t) { ++complete; });
}

std::int64_t TunnelCounter::Pieces::count() const {
  std::int64_t all = complete;
  for (std::size_t run = 0; run < sets.runs(); ++run) all += sets.set_of(run) == run ? 1 : 0;
  return all;
}

void TunnelCounter::connect(const Layer& layer) {
  euler_ += layer.euler;
  for (const bool solid : {true, false}) {
    const auto runs = runs_of(width_ + 2, height_ + 2, [&](std::size_t i) { return (layer.solid[i] != 0) == solid; });
    (solid ? solid_ : rest_).add(runs, layer.joins, solid);
  }
}

void TunnelCounter::connect() {
  if (rest_.sets.runs() == 0) {  // what lies below the volume
    const Layer margin{std::vector<std::uint8_t>(product(width_ + 2, height_ + 2), 0), {}, 0};
    connect(margin);
  }
  for (const Layer& layer : std::exchange(added_, {})) connect(layer);
}

std::int64_t TunnelCounter::tunnels() const {
  if (last_.empty()) return 0;
  TunnelCounter all = *this;
  all.connect(layer(last_.data(), nullptr));
  return all.solid_.count() + all.rest_.count() - 1 - all.euler_;
}

}  // namespace vam::model
