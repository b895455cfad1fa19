// SPDX-License-Identifier: GPL-3.0-or-later
// A ray of a lens through the bath's window and the vial, for simulated cameras, beams and prints: unit vectors, and
// Snell's law in vector form at each surface. It shares nothing with lib/optics and lib/light, which tests judge by
// this bench.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/vector3.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"

namespace vam::sim {

struct SimShell {
  double radius_mm;
  double index;  // inside
};
struct SimShells {
  double outside = 1;            // air, or the bath behind its window
  double window_mm = 0;          // from the axis; counts only with a bath
  std::vector<SimShell> shells;  // from outside to inside; the last is the resin
};

[[nodiscard]] inline SimShells outer_shells(const model::Printer& printer, double resin_index) {
  SimShells all{printer.bath.index, printer.bath.index == 1 ? 0 : printer.bath.window_mm, {}};
  if (printer.vial.wall_mm > 0) all.shells.push_back({printer.vial.radius_mm, printer.vial.index_glass});
  all.shells.push_back({model::resin_radius_mm(printer.vial), resin_index});
  return all;
}

/// Where a ray enters the resin, and its unit direction there. The lens looks along +y, the vial's axis is z.
struct ClimbingRay {
  bool enters = false;
  Vector3 at{};
  Vector3 along{};
  double transmittance = 1;
  double length_mm = 0;  // of its way through the resin
};

/// Distances of a lens from the axis as columns and rows see it; none where their chief rays are parallel.
struct SimLens {
  std::optional<double> columns_mm;
  std::optional<double> rows_mm;
};

namespace detail {

inline void go(ClimbingRay& ray, double far) { ray.at = ray.at + far * ray.along; }

// Into index n2 from n1 through a surface whose unit normal points against the light; unpolarised. False: total
// reflection.
[[nodiscard]] inline bool enter(ClimbingRay& ray, double n1, double n2, const Vector3& normal) {
  const double cosine1 = -dot(ray.along, normal);
  const double eta = n1 / n2;
  const double square = 1 - eta * eta * (1 - cosine1 * cosine1);
  if (square <= 0) return false;
  const double cosine2 = std::sqrt(square);
  ray.along = eta * ray.along + (eta * cosine1 - cosine2) * normal;
  const double reflected_s = (n1 * cosine1 - n2 * cosine2) / (n1 * cosine1 + n2 * cosine2);
  const double reflected_p = (n1 * cosine2 - n2 * cosine1) / (n1 * cosine2 + n2 * cosine1);
  ray.transmittance *= 1 - 0.5 * (reflected_s * reflected_s + reflected_p * reflected_p);
  return true;
}

}  // namespace detail

/// The ray that would cross the plane of the axis at (x_mm, z_mm) if all were air.
[[nodiscard]] inline ClimbingRay climbing_ray(double x_mm, double z_mm, const SimLens& lens, const SimShells& through) {
  const Vector3 aim{lens.columns_mm ? x_mm / *lens.columns_mm : 0, 1, lens.rows_mm ? z_mm / *lens.rows_mm : 0};
  ClimbingRay ray{false, {x_mm, 0, z_mm}, (1 / length(aim)) * aim};
  detail::go(ray, -through.window_mm / ray.along[1]);
  if (!detail::enter(ray, 1, through.outside, {0, -1, 0})) return ray;
  double index = through.outside;
  for (const SimShell& shell : through.shells) {
    const double flat = ray.along[0] * ray.along[0] + ray.along[1] * ray.along[1];
    const double nearest = (ray.at[0] * ray.along[0] + ray.at[1] * ray.along[1]) / flat;
    const double beyond = (ray.at[0] * ray.at[0] + ray.at[1] * ray.at[1] - shell.radius_mm * shell.radius_mm) / flat;
    const double square = nearest * nearest - beyond;
    if (square <= 0) return ray;
    detail::go(ray, -nearest - std::sqrt(square));
    const Vector3 normal{ray.at[0] / shell.radius_mm, ray.at[1] / shell.radius_mm, 0};
    if (!detail::enter(ray, index, shell.index, normal)) return ray;
    index = shell.index;
  }
  const double flat = ray.along[0] * ray.along[0] + ray.along[1] * ray.along[1];
  ray.length_mm = -2 * (ray.at[0] * ray.along[0] + ray.at[1] * ray.along[1]) / flat;
  ray.enters = true;
  return ray;
}

/// The same ray in a frame that is turned by -turn_rad against that of the lens: as the part sees it.
[[nodiscard]] inline ClimbingRay turned(const ClimbingRay& ray, double cosine, double sine) {
  ClimbingRay other = ray;
  other.at = {ray.at[0] * cosine - ray.at[1] * sine, ray.at[0] * sine + ray.at[1] * cosine, ray.at[2]};
  other.along = {ray.along[0] * cosine - ray.along[1] * sine, ray.along[0] * sine + ray.along[1] * cosine,
                 ray.along[2]};
  return other;
}

/// A ray in units of voxels, the lower corner of voxel 0 at 0, and from where to where (mm) it is between the voxels
/// `low` and `high` (one behind the last) of a grid, on its way through the resin. Empty: to <= from.
struct RaySegment {
  std::array<float, 3> at{};
  std::array<float, 3> along{};
  double from_mm = 0;
  double to_mm = 0;
};

[[nodiscard]] inline RaySegment passage(const ClimbingRay& ray, const model::Grid& grid, const int (&low)[3],
                                        const int (&high)[3]) {
  RaySegment way;
  way.to_mm = ray.length_mm;
  for (std::size_t a = 0; a < 3; ++a) {
    const double start = (ray.at[a] - grid.origin_mm[a]) / grid.voxel_mm + 0.5;
    const double pace = ray.along[a] / grid.voxel_mm;
    way.at[a] = static_cast<float>(start);
    way.along[a] = static_cast<float>(pace);
    constexpr double level = 1e-9;  // voxels per mm: too few for a vial to have a face on the way
    if (std::abs(pace) < level) {
      if (start < low[a] || start >= high[a]) way.to_mm = 0;
      continue;
    }
    const double one = (low[a] - start) / pace;
    const double other = (high[a] - start) / pace;
    way.from_mm = std::max(way.from_mm, std::min(one, other));
    way.to_mm = std::min(way.to_mm, std::max(one, other));
  }
  return way;
}

/// A level ray in the plane across the axis.
/// Inside the resin the ray is { offset (cos turn, sin turn) + u (-sin turn, cos turn) }, u along the light.
struct SimRay {
  bool enters = false;  // false: it passes beside the resin; offset_mm then only has a sign
  double offset_mm = 0;
  double turn_rad = 0;
  double transmittance = 0;  // of all interfaces, unpolarised
};

/// The one that would cross the plane of the axis at x_mm if all were air; distance_mm to the lens, none when
/// telecentric.
[[nodiscard]] inline SimRay sim_ray(double x_mm, std::optional<double> distance_mm, const SimShells& through) {
  const ClimbingRay ray = climbing_ray(x_mm, 0, {distance_mm, {}}, through);
  if (!ray.enters) return {false, x_mm, 0, 0};
  return {true, ray.at[0] * ray.along[1] - ray.at[1] * ray.along[0], std::atan2(-ray.along[0], ray.along[1]),
          ray.transmittance};
}

}  // namespace vam::sim
