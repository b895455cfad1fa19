// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/insert_shadow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "light/operators/insert.hpp"

namespace vam::light {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A ray along one axis, in voxels: voxel i lies between i and i + 1.
struct WalkAxis {
  double start, rate;

  /// Stretch of u in which the ray is between two faces.
  [[nodiscard]] std::pair<double, double> between(int low, int high) const {
    if (rate == 0) return start > low && start < high ? std::pair{-never, never} : std::pair{never, -never};
    const double a = (low - start) / rate;
    const double b = (high - start) / rate;
    return {std::min(a, b), std::max(a, b)};
  }
  [[nodiscard]] int voxel(double u, int low, int high) const {
    return std::clamp(floor_int(start + u * rate), low, high - 1);
  }
  /// u at which it leaves the voxel.
  [[nodiscard]] double leaves(int voxel) const {
    if (rate == 0) return never;
    return (voxel + (rate > 0 ? 1 : 0) - start) / rate;
  }
  [[nodiscard]] int step() const { return rate > 0 ? 1 : -1; }
};

}  // namespace

/// An insert and the box around it: voxels [low, high) along x, y and z.
struct InsertShadow::Body {
  std::span<const Slab> coverage;
  std::array<int, 3> low{}, high{};

  explicit Body(std::span<const Slab> slabs) : coverage(slabs) {
    const std::array<int, 3> size{slabs[0].width, slabs[0].height, count_of(slabs) * lanes};
    low = size;
    for (int z = 0; z < size[2]; ++z) {
      for (int y = 0; y < size[1]; ++y) {
        for (int x = 0; x < size[0]; ++x) {
          if (!at({x, y, z})) continue;
          const std::array<int, 3> here{x, y, z};
          for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], here[d]);
            high[d] = std::max(high[d], here[d] + 1);
          }
        }
      }
    }
  }
  [[nodiscard]] bool at(const std::array<int, 3>& v) const {
    return opaque(coverage[v[2] / lanes].at(v[0], v[1])[v[2] % lanes]);
  }
};

PixelRay PixelRay::seen_from(double x_mm, double y_mm, double slices) const {
  const double cosine = std::cos(delta_rad);
  const double sine = std::sin(delta_rad);
  const double along = y_mm * cosine - x_mm * sine;
  return {hits, offset_mm - x_mm * cosine - y_mm * sine, delta_rad, slice - slices + climb_per_mm * along,
          climb_per_mm};
}

InsertShadow::InsertShadow(const model::Grid& grid, std::span<const Slab> inserts,
                           std::span<const double> part_angles_rad, int columns, int row_slabs, bool same_at_all_angles,
                           const Rays& ray)
    : grid_(grid), angles_(part_angles_rad.size()) {
  const Body body(inserts);
  const int angles = static_cast<int>(angles_);
  rays_.resize(product(columns, angles_));
  ends_.assign(row_slabs, Slab(columns, angles));
  parallel_for(row_slabs * columns, [&](int item) {
    Slab& slab = ends_[item / columns];
    const int column = item % columns;
    for (int lane = 0; lane < lanes; ++lane) {
      const int row = item / columns * lanes + lane;
      PixelRay way;
      for (int a = 0; a < angles; ++a) {
        if (a == 0 || !same_at_all_angles) way = ray(column, row, a);
        slab.at(column, a)[lane] = follow(body, way, part_angles_rad[a]);
        if (row != row_slabs * lanes / 2) continue;
        const double angle = part_angles_rad[a] + way.delta_rad;
        rays_[at(column, a)] = {std::cos(angle), std::sin(angle)};
      }
    }
  });
  note_hindered(columns);
}

void InsertShadow::note_hindered(int columns) {
  const int angles = static_cast<int>(angles_);
  occludes_.assign(rays_.size(), 0);
  parallel_for(columns, [&](int c) {
    for (int a = 0; a < angles; ++a) {
      for (const Slab& slab : ends_) {
        const float* ends = slab.at(c, a);
        if (std::any_of(ends, ends + lanes, [](float u) { return u < unhindered; })) occludes_[at(c, a)] = 1;
      }
    }
  });
}

/// Voxel by voxel [AW87].
float InsertShadow::follow(const Body& body, const PixelRay& ray, double part_angle_rad) const {
  if (!ray.hits || body.high[0] == 0) return unhindered;
  const double c = std::cos(part_angle_rad + ray.delta_rad);
  const double s = std::sin(part_angle_rad + ray.delta_rad);
  const double voxel = grid_.voxel_mm;  // u in voxels on the way
  const std::array<WalkAxis, 3> axes{WalkAxis{(ray.offset_mm * c - grid_.origin_mm[0]) / voxel + 0.5, -s},
                                     WalkAxis{(ray.offset_mm * s - grid_.origin_mm[1]) / voxel + 0.5, c},
                                     WalkAxis{ray.slice + 0.5, ray.climb_per_mm * voxel}};
  double u = -never;
  double out = never;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto [first, last] = axes[d].between(body.low[d], body.high[d]);
    u = std::max(u, first);
    out = std::min(out, last);
  }
  if (!(u < out)) return unhindered;
  std::array<int, 3> at{};
  for (std::size_t d = 0; d < 3; ++d) at[d] = axes[d].voxel(u, body.low[d], body.high[d]);
  while (true) {
    if (body.at(at)) return static_cast<float>(u * voxel);
    std::size_t next = 0;
    for (const std::size_t d : {1, 2}) {
      if (axes[d].leaves(at[d]) < axes[next].leaves(at[next])) next = d;
    }
    u = axes[next].leaves(at[next]);
    at[next] += axes[next].step();
    if (at[next] < body.low[next] || at[next] >= body.high[next]) return unhindered;
  }
}

}  // namespace vam::light
