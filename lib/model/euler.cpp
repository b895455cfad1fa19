// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/euler.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::model {

namespace {

/// Values at the corners of a cell between eight voxels, x fastest.
using Corners = std::array<float, 8>;

/// Whether each of 3 x 3 x 3 points of a cell, half a voxel apart, reaches the level.
std::array<bool, 27> solid_points(const Corners& corners, double level) {
  std::array<bool, 27> solid{};
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

/// Of a cell through which the surface goes; others add nothing.
int cell_added(const Corners& corners, double level) {
  const std::array<bool, 27> solid = solid_points(corners, level);
  int sum = 0;
  for (int n = 0; n < 8; ++n) {
    const int first = (n & 1) + 3 * (n >> 1 & 1) + 9 * (n >> 2);
    std::array<bool, 8> is{};
    for (int m = 0; m < 8; ++m) is[m] = solid[first + (m & 1) + 3 * (m >> 1 & 1) + 9 * (m >> 2)];
    sum += cubes_added(is);
  }
  return sum;
}

}  // namespace

/// Of all cells between two slices, and from there to beyond the edges.
std::int64_t EulerCounter::between(const float* below, const float* above) const {
  std::int64_t sum = 0;
  const auto value = [&](const float* slice, int x, int y) {
    const bool in = slice != nullptr && x >= 0 && x < width_ && y >= 0 && y < height_;
    return in ? slice[product(y, width_) + static_cast<std::size_t>(x)] : 0.0F;
  };
  for (int y = -1; y < height_; ++y) {
    Corners corners{};
    for (int x = -1; x < width_; ++x) {
      int solid = 0;
      for (int n = 0; n < 8; n += 2) {
        corners[n] = corners[n + 1];
        corners[n + 1] = value(n < 4 ? below : above, x + 1, y + (n >> 1 & 1));
        for (const float v : {corners[n], corners[n + 1]}) solid += static_cast<double>(v) >= level_ ? 1 : 0;
      }
      if (solid > 0 && solid < 8) sum += cell_added(corners, level_);
    }
  }
  return sum;
}

void EulerCounter::add(int count, const float* slices) {
  if (count == 0) return;
  const std::size_t size = product(width_, height_);
  std::vector<std::int64_t> sums(count);
  parallel_for(count, [&](int k) {
    const float* before = last_.empty() ? nullptr : last_.data();
    sums[k] = between(k > 0 ? slices + product(k - 1, size) : before, slices + product(k, size));
  });
  sum_ += std::accumulate(sums.begin(), sums.end(), std::int64_t{0});
  const float* last = slices + product(count - 1, size);
  last_.assign(last, last + size);
}

std::int64_t EulerCounter::characteristic() const { return last_.empty() ? 0 : sum_ + between(last_.data(), nullptr); }

}  // namespace vam::model
