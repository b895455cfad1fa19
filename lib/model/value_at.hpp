// SPDX-License-Identifier: GPL-3.0-or-later
// A volume between its voxels.
#pragma once

#include <cmath>

#include "model/grid.hpp"

namespace vam::model {

/// The value at a point in mm, trilinear between voxel centres; 0 outside.
[[nodiscard]] inline float value_at(const Volume& volume, double x_mm, double y_mm, double z_mm) {
  const Grid& g = volume.grid;
  const double at[3] = {(x_mm - g.origin_mm[0]) / g.voxel_mm, (y_mm - g.origin_mm[1]) / g.voxel_mm,
                        (z_mm - g.origin_mm[2]) / g.voxel_mm};
  const int size[3] = {g.nx, g.ny, g.nz};
  int low[3];
  float high_part[3];
  for (int d = 0; d < 3; ++d) {
    const double whole = std::floor(at[d]);
    if (!(whole >= -1) || !(whole < size[d])) return 0;
    low[d] = static_cast<int>(whole);
    high_part[d] = static_cast<float>(at[d] - whole);
  }
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1;
    int index[3];
    bool inside = true;
    for (int d = 0; d < 3; ++d) {
      const int up = corner >> d & 1;
      index[d] = low[d] + up;
      weight *= up != 0 ? high_part[d] : 1 - high_part[d];
      inside = inside && index[d] >= 0 && index[d] < size[d];
    }
    if (inside) sum += weight * volume.slice(index[2])[index[1] * g.nx + index[0]];
  }
  return sum;
}

/// A target or dose of a part that was stretched along z, which the light prints at its own height.
struct StretchedVolume {
  Volume volume;
  double stretch_z = 1;

  /// At a point of the part, or of its print.
  [[nodiscard]] float at(double x_mm, double y_mm, double z_mm) const {
    return value_at(volume, x_mm, y_mm, z_mm * stretch_z);
  }
};

}  // namespace vam::model
