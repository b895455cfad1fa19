// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/one_density_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"
#include "base/index.hpp"
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

// Median of what is above half of the 99th percentile of all that scatters.
float density_of(const model::Volume& volume) {
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
void carve(const ClimbingRays& rays, const std::vector<Image>& sinograms, float dark, float density,
           model::Volume& volume) {
  constexpr int edge = 3;
  constexpr int every = 4;      // view
  constexpr int most_dark = 2;  // of these views: edges and noise
  const model::Grid& g = volume.grid;
  const double zero = -g.origin_mm[2] / g.voxel_mm;
  std::vector<std::array<double, 2>> directions;
  for (int a = 0; a < rays.angles; a += every) {
    const double theta = 2 * std::numbers::pi * a / rays.angles;
    directions.push_back({std::cos(theta), std::sin(theta)});
  }
  const auto is_empty = [&](int i, int j, int k) {
    const double x = i - 0.5 * (g.nx - 1);
    const double y = j - 0.5 * (g.ny - 1);
    int count = 0;
    for (int a = 0; a < rays.angles; a += every) {
      const auto [c, s] = directions[a / every];
      const double u_mm = (y * c - x * s) * g.voxel_mm;
      const int t = static_cast<int>(x * c + y * s + 0.5 * rays.columns);
      if (t < 0 || t >= rays.columns) continue;
      const double height = 0.5 + zero + (k - zero) / (1 + rays.rate_per_mm[t] * u_mm);
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

}  // namespace

model::Volume one_density_body(const ClimbingRays& rays, const model::Grid& grid, const std::vector<Image>& sinograms,
                               float dark) {
  const int beyond = heights_beyond(rays, grid);
  model::Volume volume{grid, std::vector<float>(grid.size())};
  back_project(rays, filtered(sinograms, beyond), beyond, 0, grid.nz, volume);
  const float density = density_of(volume);
  carve(rays, sinograms, dark, density, volume);
  parallel_for(grid.nz, [&](int k) {
    float* slice = volume.slice(k);
    std::transform(slice, slice + grid.slice_size(), slice,
                   [density](float value) { return std::clamp(2 * value - 0.5F * density, 0.0F, density); });
  });
  return volume;
}

}  // namespace vam::metrology
