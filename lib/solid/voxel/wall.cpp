// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::solid {

namespace {

constexpr std::int64_t far_away = std::numeric_limits<std::int32_t>::max();
constexpr double thin_share = 0.01;

/// The grid with a layer of void around it, x fastest.
struct Field {
  std::array<int, 3> size{};
  std::vector<std::uint8_t> solid;
  std::vector<std::int32_t> nearest;  // index of the void voxel that is nearest

  [[nodiscard]] std::int64_t index(int i, int j, int k) const {
    return (static_cast<std::int64_t>(k) * size[1] + j) * size[0] + i;
  }
  [[nodiscard]] std::array<int, 3> place(std::int64_t at) const {
    return {static_cast<int>(at % size[0]), static_cast<int>(at / size[0] % size[1]),
            static_cast<int>(at / (static_cast<std::int64_t>(size[0]) * size[1]))};
  }
  [[nodiscard]] std::int64_t squared(std::int64_t a, std::int64_t b) const {
    const auto p = place(a);
    const auto q = place(b);
    std::int64_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += static_cast<std::int64_t>(p[axis] - q[axis]) * (p[axis] - q[axis]);
    return sum;
  }
};

Field padded(const model::Volume& part) {
  const model::Grid& grid = part.grid;
  Field field{{grid.nx + 2, grid.ny + 2, grid.nz + 2}, {}, {}};
  const auto all = static_cast<std::size_t>(field.index(0, 0, field.size[2]));
  field.solid.assign(all, 0);
  field.nearest.assign(all, -1);
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      const float* row = part.slice(k) + static_cast<std::ptrdiff_t>(j) * grid.nx;
      for (int i = 0; i < grid.nx; ++i)
        field.solid[static_cast<std::size_t>(field.index(i + 1, j + 1, k + 1))] = model::half_covered(row[i]) ? 1 : 0;
    }
  }
  for (std::size_t at = 0; at < all; ++at)
    if (field.solid[at] == 0) field.nearest[at] = static_cast<std::int32_t>(at);
  return field;
}

/// One line along an axis: of all nearest voids of the line, by the lower envelope of their parabolas.
void sweep(Field& field, std::int64_t first, std::int64_t stride, int count) {
  std::vector<int> hull;      // places whose parabolas make the envelope
  std::vector<double> begin;  // where each begins
  std::vector<std::int32_t> found(static_cast<std::size_t>(count));
  const auto at = [&](int n) { return static_cast<std::size_t>(first + n * stride); };
  for (int n = 0; n < count; ++n) found[static_cast<std::size_t>(n)] = field.nearest[at(n)];
  const auto height = [&](int n) {
    return static_cast<double>(field.squared(static_cast<std::int64_t>(at(n)), found[static_cast<std::size_t>(n)]));
  };
  for (int n = 0; n < count; ++n) {
    if (found[static_cast<std::size_t>(n)] < 0) continue;
    double from = -static_cast<double>(far_away);
    while (!hull.empty()) {
      const int m = hull.back();
      from = (height(n) + double(n) * n - height(m) - double(m) * m) / (2.0 * (n - m));
      if (from > begin.back()) break;
      hull.pop_back();
      begin.pop_back();
      from = -static_cast<double>(far_away);
    }
    hull.push_back(n);
    begin.push_back(from);
  }
  std::size_t piece = 0;
  for (int n = 0; n < count && !hull.empty(); ++n) {
    while (piece + 1 < hull.size() && begin[piece + 1] < n) ++piece;
    field.nearest[at(n)] = found[static_cast<std::size_t>(hull[piece])];
  }
}

void find_nearest(Field& field) {
  const auto [nx, ny, nz] = field.size;
  parallel_for(nz, [&, nx = nx, ny = ny](int k) {
    for (int j = 0; j < ny; ++j) sweep(field, field.index(0, j, k), 1, nx);
    for (int i = 0; i < nx; ++i) sweep(field, field.index(i, 0, k), nx, ny);
  });
  parallel_for(ny, [&, nx = nx, ny = ny, nz = nz](int j) {
    for (int i = 0; i < nx; ++i) sweep(field, field.index(i, j, 0), static_cast<std::int64_t>(nx) * ny, nz);
  });
}

/// No voxel around is farther from the void.
bool is_middle(const Field& field, int i, int j, int k) {
  const std::int64_t here = field.index(i, j, k);
  const std::int64_t own = field.squared(here, field.nearest[static_cast<std::size_t>(here)]);
  for (int n = 0; n < 27; ++n) {
    const std::int64_t there = field.index(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1);
    if (field.squared(there, field.nearest[static_cast<std::size_t>(there)]) > own) return false;
  }
  return true;
}

/// Through this voxel, from the nearest void straight on to the other side.
double thickness(const Field& field, std::int64_t here) {
  const auto p = field.place(here);
  const auto v = field.place(field.nearest[static_cast<std::size_t>(here)]);
  const double distance =
      std::sqrt(static_cast<double>(field.squared(here, field.nearest[static_cast<std::size_t>(here)])));
  constexpr double step = 0.25;
  for (double way = step;; way += step) {
    std::array<int, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<int>(std::lround(p[axis] + way * (p[axis] - v[axis]) / distance));
    if (field.solid[static_cast<std::size_t>(field.index(at[0], at[1], at[2]))] == 0) {
      return distance - 0.5 + way - 0.5 * step;  // faces are half a voxel from the middles of voxels
    }
  }
}

}  // namespace

std::optional<double> thinnest_wall_voxels(const model::Volume& part) {
  Field field = padded(part);
  find_nearest(field);
  std::vector<double> walls;
  std::mutex mutex;
  parallel_for(field.size[2] - 2, [&](int slice) {
    std::vector<double> own;
    for (int j = 1; j + 1 < field.size[1]; ++j) {
      for (int i = 1; i + 1 < field.size[0]; ++i) {
        const std::int64_t here = field.index(i, j, slice + 1);
        if (field.solid[static_cast<std::size_t>(here)] != 0 && is_middle(field, i, j, slice + 1))
          own.push_back(thickness(field, here));
      }
    }
    const std::lock_guard lock(mutex);
    walls.insert(walls.end(), own.begin(), own.end());
  });
  if (walls.empty()) return std::nullopt;
  const auto at = walls.begin() + static_cast<std::ptrdiff_t>(thin_share * static_cast<double>(walls.size()));
  std::nth_element(walls.begin(), at, walls.end());
  return *at;
}

}  // namespace vam::solid
