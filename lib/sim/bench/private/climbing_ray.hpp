// SPDX-License-Identifier: GPL-3.0-or-later
// A ray of a lens through window and vial in three dimensions, for the simulated print: unit vectors, and Snell's law
// in vector form at each surface. It shares nothing with lib/optics and lib/light, which the print judges.
#pragma once

#include <cmath>
#include <optional>

#include "base/vector3.hpp"
#include "sim/bench/private/ray.hpp"

namespace vam::sim {

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

}  // namespace vam::sim
