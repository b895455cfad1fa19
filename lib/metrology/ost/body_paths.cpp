// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/body_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "base/stats/median.hpp"
#include "tomo/filter.hpp"

namespace vam::metrology {

namespace {

// Beyond the stretch of heights rays are as at its ends.
std::vector<Slab> filtered(const std::vector<Image>& sinograms, int beyond) {
  std::vector<Image> all;
  for (int k = -beyond; k < count_of(sinograms) + beyond; ++k) {
    all.push_back(sinograms[std::clamp(k, 0, count_of(sinograms) - 1)]);
  }
  auto out = packed(all, all.front().width, all.front().height);
  const tomo::Filter filter(all.front().width, {.window = tomo::FilterWindow::cosine});
  for (Slab& slab : out) filter.apply(slab);
  return out;
}

}  // namespace

BodyPaths::BodyPaths(const ClimbingRays& rays, const model::Grid& grid, const std::vector<Image>& sinograms, float dark)
    : rays_(rays), grid_(grid) {
  const int beyond = heights_beyond(rays, grid);
  model::Volume volume{grid, std::vector<float>(grid.size())};
  back_project(rays, filtered(sinograms, beyond), beyond, 0, grid.nz, volume);
  const float density = density_of(volume);
  carve(sinograms, dark, density, volume);
  keep(volume, density);
}

// Median of what is above half of the 99th percentile of all that scatters.
float BodyPaths::density_of(const model::Volume& volume) const {
  std::vector<float> some;
  for (std::size_t i = 0; i < volume.values.size(); i += 61) {
    if (volume.values[i] > 0) some.push_back(volume.values[i]);
  }
  if (some.empty()) return 0;
  const auto high = some.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(some.size()));
  std::nth_element(some.begin(), high, some.end());
  const float half = 0.5F * *high;
  std::erase_if(some, [half](float v) { return v < half; });
  return static_cast<float>(stats::median(some));
}

// Empties cubes of three voxels that are seen through: what bubbles leave beside the print.
void BodyPaths::carve(const std::vector<Image>& sinograms, float dark, float density, model::Volume& volume) const {
  constexpr int edge = 3;
  constexpr int every = 4;      // view
  constexpr int most_dark = 2;  // of these views: edges and noise
  const model::Grid& g = grid_;
  const double zero = -g.origin_mm[2] / g.voxel_mm;
  std::vector<std::array<double, 2>> directions;
  for (int a = 0; a < rays_.angles; a += every) {
    const double theta = 2 * std::numbers::pi * a / rays_.angles;
    directions.push_back({std::cos(theta), std::sin(theta)});
  }
  const auto is_empty = [&](int i, int j, int k) {
    const double x = i - 0.5 * (g.nx - 1);
    const double y = j - 0.5 * (g.ny - 1);
    int count = 0;
    for (int a = 0; a < rays_.angles; a += every) {
      const auto [c, s] = directions[a / every];
      const double u_mm = (y * c - x * s) * g.voxel_mm;
      const int t = static_cast<int>(x * c + y * s + 0.5 * rays_.columns);
      if (t < 0 || t >= rays_.columns) continue;
      const double height = 0.5 + zero + (k - zero) / (1 + rays_.rate_per_mm[t] * u_mm);
      if (sinograms[std::clamp(static_cast<int>(height), 0, g.nz - 1)](t, a) < dark) ++count;
    }
    return count > most_dark;
  };
  parallel_for((g.nz + edge - 1) / edge, [&](int cube) {
    const int k0 = cube * edge;
    const int k1 = std::min(k0 + edge, g.nz);
    for (int j = 0; j + edge <= g.ny; j += edge) {
      for (int i = 0; i + edge <= g.nx; i += edge) {
        const auto rows = [&](const auto& work) {
          for (int k = k0; k < k1; ++k) {
            for (int y = j; y < j + edge; ++y) work(volume.slice(k) + std::ptrdiff_t{y} * g.nx + i);
          }
        };
        float most = 0;
        rows([&](const float* row) { most = std::max(most, *std::max_element(row, row + edge)); });
        if (4 * most < density || !is_empty(i + 1, j + 1, std::min(k0 + 1, g.nz - 1))) continue;
        rows([&](float* row) { std::fill(row, row + edge, 0.0F); });
      }
    }
  });
}

void BodyPaths::keep(const model::Volume& volume, float density) {
  const model::Grid& g = grid_;
  values_.resize(g.size());
  const auto column = [&](int i, int j) { return values_.data() + flat_index(j, g.nx, i) * g.nz; };
  std::vector<char> body(product(g.nx, g.ny));
  parallel_for(g.ny, [&](int j) {
    for (int k = 0; k < g.nz; ++k) {
      const float* from = volume.slice(k) + std::ptrdiff_t{j} * g.nx;
      for (int i = 0; i < g.nx; ++i) {
        const float value = std::clamp(2 * from[i] - 0.5F * density, 0.0F, density);
        column(i, j)[k] = value;
        if (value > 0) body[flat_index(j, g.nx, i)] = 1;
      }
    }
  });
  occupied_.resize(body.size());
  for (int j = 0; j + 1 < g.ny; ++j) {
    for (int i = 0; i + 1 < g.nx; ++i) {
      const char* at = body.data() + flat_index(j, g.nx, i);
      if ((at[0] | at[1] | at[g.nx] | at[g.nx + 1]) == 0) continue;
      occupied_[flat_index(j, g.nx, i)] = 1;
      reach_ = std::max(reach_, 1 + std::hypot(i - 0.5 * (g.nx - 1), j - 0.5 * (g.ny - 1)));
    }
  }
}

// The bodies at (x, y) at the heights start, start + slope, ..., in voxels: linear between voxels.
void BodyPaths::add(double x, double y, double start, double slope, std::span<float> out) const {
  const int i = floor_int(x);
  const int j = floor_int(y);
  if (i < 0 || j < 0 || i + 1 >= grid_.nx || j + 1 >= grid_.ny) return;
  if (occupied_[flat_index(j, grid_.nx, i)] == 0) return;
  const auto u = static_cast<float>(x - i);
  const auto v = static_cast<float>(y - j);
  const int last = grid_.nz - 1;
  const int low = std::clamp(floor_int(start), 0, last);
  const int high = std::clamp(floor_int(start + slope * (count_of(out) - 1)) + 1, low, last);
  const float* here = values_.data() + flat_index(j, grid_.nx, i) * grid_.nz + low;
  const float* above = here + product(grid_.nx, grid_.nz);
  const float weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  thread_local std::vector<float> between;
  between.resize(high - low + 1);
  for (int k = 0; k <= high - low; ++k) {
    between[k] = weights[0] * here[k] + weights[1] * here[k + grid_.nz] + weights[2] * above[k] +
                 weights[3] * above[k + grid_.nz];
  }
  const auto first = static_cast<float>(start - low);
  const auto rise = static_cast<float>(slope);
  const auto top = static_cast<float>(high - low);
  for (int k = 0; k < count_of(out); ++k) {
    const float z = std::clamp(first + rise * static_cast<float>(k), 0.0F, top);
    const int m = static_cast<int>(z);
    const float w = z - static_cast<float>(m);
    out[k] += (1 - w) * between[m] + w * between[std::min(m + 1, high - low)];
  }
}

void BodyPaths::along(int column, int angle, int first, int step, std::span<float> out) const {
  std::fill(out.begin(), out.end(), 0.0F);
  const double t = column - 0.5 * (rays_.columns - 1);
  if (std::abs(t) > reach_) return;
  const double theta = 2 * std::numbers::pi * angle / rays_.angles;
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  const double zero = -grid_.origin_mm[2] / grid_.voxel_mm;  // slice of height 0
  const int steps = ceil_int(std::sqrt(reach_ * reach_ - t * t) / step);
  for (int n = -steps; n <= steps; ++n) {
    const int u = step * n;
    const double slope = 1 + rays_.rate_per_mm[column] * u * grid_.voxel_mm;
    add(0.5 * (grid_.nx - 1) + t * c - u * s, 0.5 * (grid_.ny - 1) + t * s + u * c, zero + (first - zero) * slope,
        slope, out);
  }
  for (float& value : out) value *= static_cast<float>(step * grid_.voxel_mm);
}

}  // namespace vam::metrology
