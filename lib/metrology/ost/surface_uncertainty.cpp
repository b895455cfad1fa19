// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/surface_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::metrology {

namespace {

/// A voxel around a point: its weight in the trilinear value there, and how that changes along x, y and z.
struct Corner {
  std::size_t at = 0;
  double weight = 1;
  Vector3 slope{1, 1, 1};  // per mm
};

/// Beyond the volume as at its border.
std::array<Corner, 8> corners_at(const model::Grid& grid, const Vector3& point) {
  const std::array<int, 3> counts{grid.nx, grid.ny, grid.nz};
  const std::array<std::size_t, 3> strides{1, static_cast<std::size_t>(grid.nx), grid.slice_size()};
  std::array<Corner, 8> corners{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double place = std::clamp((point[a] - grid.origin_mm[a]) / grid.voxel_mm, 0.0, counts[a] - 1.0);
    const int low = std::min(static_cast<int>(place), std::max(0, counts[a] - 2));
    for (std::size_t n = 0; n < corners.size(); ++n) {
      const int step = static_cast<int>(n >> a & 1U);
      const double weight = step == 1 ? place - low : 1 - (place - low);
      Corner& corner = corners[n];
      corner.at += strides[a] * static_cast<std::size_t>(std::min(low + step, counts[a] - 1));
      corner.weight *= weight;
      for (std::size_t b = 0; b < 3; ++b) corner.slope[b] *= b == a ? (2 * step - 1) / grid.voxel_mm : weight;
    }
  }
  return corners;
}

double slope_at(const model::Volume& volume, const Vector3& point) {
  Vector3 slope{};
  for (const Corner& corner : corners_at(volume.grid, point)) {
    slope = slope + static_cast<double>(volume.values[corner.at]) * corner.slope;
  }
  return length(slope);
}

/// Standard deviation of the trilinear value: along each axis that of (1 - f) a + f b.
double sigma_at(const VoxelUncertainty& voxels, const Vector3& point) {
  const model::Grid& grid = voxels.sigma.grid;
  double sigma = 0;
  for (const Corner& corner : corners_at(grid, point)) {
    sigma += corner.weight * static_cast<double>(voxels.sigma.values[corner.at]);
  }
  double share = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const double place = (point[a] - grid.origin_mm[a]) / grid.voxel_mm;
    const double f = place - std::floor(place);
    share *= 1 - 2 * f * (1 - f) * (1 - (a == 2 ? voxels.correlation_z : voxels.correlation_xy));
  }
  return sigma * std::sqrt(std::max(0.0, share));
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

std::vector<float> surface_uncertainty_mm(const model::Volume& scatter, const VoxelUncertainty& voxels,
                                          std::span<const Vector3> points) {
  std::vector<float> out = mm_per_value(scatter, points);
  parallel_for(count_of(points), [&](int i) { out[i] *= static_cast<float>(sigma_at(voxels, points[i])); });
  return out;
}

}  // namespace vam::metrology
