// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/body_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::metrology {

BodyPaths::BodyPaths(const ClimbingRays& rays, const model::Volume& bodies) : rays_(rays), grid_(bodies.grid) {
  const model::Grid& g = grid_;
  values_.resize(g.size());
  const auto column = [&](int i, int j) { return values_.data() + flat_index(j, g.nx, i) * g.nz; };
  std::vector<char> body(product(g.nx, g.ny));
  parallel_for(g.ny, [&](int j) {
    for (int k = 0; k < g.nz; ++k) {
      const float* from = bodies.slice(k) + std::ptrdiff_t{j} * g.nx;
      for (int i = 0; i < g.nx; ++i) {
        column(i, j)[k] = from[i];
        if (from[i] > 0) body[flat_index(j, g.nx, i)] = 1;
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
