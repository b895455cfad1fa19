#include "metrology/ost/surface_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::metrology {

namespace {

/// Trilinear; the border's value beyond it.
double value_at(const model::Volume& volume, const Vector3& point) {
  const model::Grid& grid = volume.grid;
  const std::array<int, 3> counts{grid.nx, grid.ny, grid.nz};
  std::array<int, 3> low{};
  std::array<double, 3> part{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double place = std::clamp((point[a] - grid.origin_mm[a]) / grid.voxel_mm, 0.0, counts[a] - 1.0);
    low[a] = std::min(static_cast<int>(place), std::max(0, counts[a] - 2));
    part[a] = place - low[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int step = corner >> a & 1;
      weight *= step == 1 ? part[a] : 1 - part[a];
      at[a] = std::min(low[a] + step, counts[a] - 1);
    }
    sum += weight * static_cast<double>(volume.slice(at[2])[std::ptrdiff_t{at[1]} * grid.nx + at[0]]);
  }
  return sum;
}

double slope_at(const model::Volume& volume, const Vector3& point) {
  double square = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    Vector3 up = point;
    Vector3 down = point;
    up[a] += 0.5 * volume.grid.voxel_mm;
    down[a] -= 0.5 * volume.grid.voxel_mm;
    square += std::pow((value_at(volume, up) - value_at(volume, down)) / volume.grid.voxel_mm, 2);
  }
  return std::sqrt(square);
}

}  // namespace

std::vector<float> mm_per_value(const model::Volume& volume, std::span<const Vector3> points) {
  const float largest = *std::max_element(volume.values.begin(), volume.values.end());
  const double most = 3 * volume.grid.voxel_mm / (0.1 * std::max(static_cast<double>(largest), 1e-30));
  std::vector<float> out(points.size());
  parallel_for(count_of(points), [&](int i) {
    out[i] = static_cast<float>(std::min(most, 1 / std::max(slope_at(volume, points[i]), 1e-30)));
  });
  return out;
}

std::vector<float> surface_uncertainty_mm(const model::Volume& scatter, const model::Volume& sigma,
                                          std::span<const Vector3> points) {
  std::vector<float> out = mm_per_value(scatter, points);
  parallel_for(count_of(points), [&](int i) { out[i] *= static_cast<float>(value_at(sigma, points[i])); });
  return out;
}

}  // namespace vam::metrology
