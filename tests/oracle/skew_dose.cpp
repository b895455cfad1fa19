// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/skew_dose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace vam::oracle {

namespace {

struct Way {
  double p[3], d[3];
  double transmittance;
  double length;  // to the other side of the resin
};

std::optional<Way> way_of(const Bench& bench, double x, double z) {
  const auto ray = trace(bench, x, z);
  if (!ray) return std::nullopt;
  Way way{};
  for (std::size_t i = 0; i < 3; ++i) {
    way.p[i] = static_cast<double>(ray->point[i]);
    way.d[i] = static_cast<double>(ray->direction[i]);
  }
  way.transmittance = static_cast<double>(ray->transmittance);
  const double px = way.p[0] - static_cast<double>(bench.axis_x);
  const double py = way.p[1] - static_cast<double>(bench.axis_y);
  way.length = -2 * (px * way.d[0] + py * way.d[1]) / (way.d[0] * way.d[0] + way.d[1] * way.d[1]);
  return way;
}

/// Leaves the light of a ray in the voxels, up to an opaque one; the part stands turned and displaced.
void deposit(const SkewDose& setup, const Way& way, double light, double angle, const SkewPose& pose,
             std::vector<double>& dose) {
  const double step = 0.2 * setup.voxel;
  const double half = 0.5 * setup.size * setup.voxel;
  const double middle = 0.5 * way.length;
  // Steps within the box around the voxels only.
  const double level = std::hypot(way.d[0], way.d[1]);
  const double off = pose.vial ? 0 : std::hypot(pose.x, pose.y);
  const double reach = std::min(middle, (std::hypot(half, half) + off) / level);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (double s = middle - reach + 0.5 * step; s < middle + reach; s += step) {
    const double x = way.p[0] + s * way.d[0] - pose.x;
    const double y = way.p[1] + s * way.d[1] - pose.y;
    const double z = way.p[2] + s * way.d[2] - pose.z;
    const int i = static_cast<int>(std::floor((x * cosine - y * sine) / setup.voxel + 0.5 * setup.size));
    const int j = static_cast<int>(std::floor((x * sine + y * cosine) / setup.voxel + 0.5 * setup.size));
    const int slice = static_cast<int>(std::floor((z - setup.first_slice) / setup.height + 0.5));
    if (i < 0 || j < 0 || slice < 0 || i >= setup.size || j >= setup.size || slice >= setup.slices) continue;
    if (setup.opaque && setup.opaque(i, j, slice)) return;
    const auto at = (static_cast<std::size_t>(slice) * setup.size + static_cast<std::size_t>(j)) *
                        static_cast<std::size_t>(setup.size) +
                    static_cast<std::size_t>(i);
    dose[at] += light * step * (setup.absorption > 0 ? std::exp(-setup.absorption * s) : 1.0);
  }
}

}  // namespace

SkewResult skew_dose(const SkewDose& setup, const std::function<double(int, int, int)>& intensity) {
  SkewResult result;
  result.dose.assign(static_cast<std::size_t>(setup.size) * setup.size * static_cast<std::size_t>(setup.slices), 0.0);
  const double turn = 2 * std::numbers::pi * setup.turns / setup.angles;
  const double ray_area = setup.pixel * setup.pixel / (setup.rays * setup.rays);
  const double volume = setup.voxel * setup.voxel * setup.height;
  for (int r = 0; r < setup.rows; ++r) {
    for (int c = 0; c < setup.columns; ++c) {
      for (int k = 0; k < setup.rays * setup.rays; ++k) {
        const double x = (c - 0.5 * (setup.columns - 1) + (k % setup.rays + 0.5) / setup.rays - 0.5) * setup.pixel;
        const double z = setup.first_row + (r + (k / setup.rays + 0.5) / setup.rays - 0.5) * setup.pixel;
        const auto still = way_of(setup.bench, x, z);
        for (int a = 0; a < setup.angles; ++a) {
          const SkewPose pose = setup.poses.empty() ? SkewPose{} : setup.poses[static_cast<std::size_t>(a)];
          auto way = still;
          if (pose.vial) {
            Bench moved = setup.bench;
            moved.axis_x = pose.x;
            moved.axis_y = pose.y;
            way = way_of(moved, x, z);
          }
          if (!way) continue;
          const double light = intensity(c, r, a) * way->transmittance * ray_area;
          if (light == 0) continue;
          result.entered += light;
          result.absorbed += light * (1 - std::exp(-setup.absorption * way->length));
          deposit(setup, *way, light * turn / volume, a * turn, pose, result.dose);
        }
      }
    }
  }
  return result;
}

}  // namespace vam::oracle
