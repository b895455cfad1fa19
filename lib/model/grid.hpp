// SPDX-License-Identifier: GPL-3.0-or-later
// Where the voxels of a volume are.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace vam::model {

/// nx x ny x nz cubic voxels of edge voxel_mm. The centre of voxel (i, j, k) is origin_mm + voxel_mm * (i, j, k) in the
/// part's frame: right-handed, mm, z = rotation axis, up, axis at x = y = 0.
struct Grid {
  int nx = 0;
  int ny = 0;
  int nz = 0;
  double voxel_mm = 0;
  std::array<double, 3> origin_mm{};

  [[nodiscard]] double x_mm(double i) const { return origin_mm[0] + voxel_mm * i; }
  [[nodiscard]] double y_mm(double j) const { return origin_mm[1] + voxel_mm * j; }
  [[nodiscard]] double z_mm(double k) const { return origin_mm[2] + voxel_mm * k; }
  [[nodiscard]] std::size_t slice_size() const { return static_cast<std::size_t>(nx) * ny; }
  [[nodiscard]] std::size_t size() const { return slice_size() * static_cast<std::size_t>(nz); }
  bool operator==(const Grid&) const = default;
};

/// A grid centred on the rotation axis in x and y, its lowest voxel centre at z0_mm.
[[nodiscard]] inline Grid centred_grid(int nx, int ny, int nz, double voxel_mm, double z0_mm = 0) {
  return {nx, ny, nz, voxel_mm, {-0.5 * (nx - 1) * voxel_mm, -0.5 * (ny - 1) * voxel_mm, z0_mm}};
}

/// A dense volume, x fastest, then y, then z: value (i, j, k) is values[(k * ny + j) * nx + i].
struct Volume {
  Grid grid;
  std::vector<float> values;

  [[nodiscard]] const float* slice(int k) const {
    return values.data() + static_cast<std::size_t>(k) * grid.slice_size();
  }
  float* slice(int k) { return values.data() + static_cast<std::size_t>(k) * grid.slice_size(); }
};

}  // namespace vam::model
