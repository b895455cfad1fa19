// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/walked_dose.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vam::oracle {

std::vector<double> walked_dose(const WalkedDose& setup) {
  const double step = 0.1 * setup.voxel;
  const double turn = 2 * std::numbers::pi / static_cast<double>(setup.angles.size());
  std::vector<double> dose(setup.insert.size(), 0.0);
  for (const double theta : setup.angles) {
    for (const WalkedRay& ray : setup.rays) {
      const double c = std::cos(theta + ray.a);
      const double s = std::sin(theta + ray.a);
      const double entry = std::sqrt(setup.edge * setup.edge - ray.t * ray.t);
      const double corner = 0.71 * setup.size * setup.voxel;  // beyond it there are no voxels
      for (double u = -std::min(entry, corner) + 0.5 * step; u < std::min(entry, corner); u += step) {
        const int i = static_cast<int>(std::floor((ray.t * c - u * s) / setup.voxel + 0.5 * setup.size));
        const int j = static_cast<int>(std::floor((ray.t * s + u * c) / setup.voxel + 0.5 * setup.size));
        if (i < 0 || j < 0 || i >= setup.size || j >= setup.size) continue;
        const auto voxel = static_cast<std::size_t>(j) * setup.size + static_cast<std::size_t>(i);
        if (setup.insert[voxel] >= 0.5F) break;
        dose[voxel] +=
            ray.light * step * std::exp(-setup.absorption * (entry + u)) * turn / (setup.voxel * setup.voxel);
      }
    }
  }
  return dose;
}

}  // namespace vam::oracle
