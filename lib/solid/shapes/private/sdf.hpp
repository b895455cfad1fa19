// SPDX-License-Identifier: GPL-3.0-or-later
// Signed distances of simple solids, mm, negative inside. Each is the exact distance, or (corners of intersections) a
// lower bound of it that vanishes at the surface. Formulas: Quilez, "3D distance functions".
#pragma once

#include <algorithm>
#include <cmath>

#include "solid/mesh/geometry.hpp"

namespace vam::solid::sdf {

/// Distance from a point (r, z) of a half plane to the rectangle |r| <= half_r, |z| <= half_z.
[[nodiscard]] inline double rectangle(double r, double z, double half_r, double half_z) {
  const double dr = std::abs(r) - half_r;
  const double dz = std::abs(z) - half_z;
  return std::min(std::max(dr, dz), 0.0) + std::hypot(std::max(dr, 0.0), std::max(dz, 0.0));
}

[[nodiscard]] inline double ball(const Point& p, double radius) { return length(p) - radius; }

/// Upright cylinder about the z axis, |z| <= half_height.
[[nodiscard]] inline double cylinder(const Point& p, double radius, double half_height) {
  return rectangle(std::hypot(p[0], p[1]), p[2], radius, half_height);
}

/// Upright tube, inner <= r <= outer.
[[nodiscard]] inline double tube(const Point& p, double inner, double outer, double half_height) {
  return rectangle(std::hypot(p[0], p[1]) - 0.5 * (inner + outer), p[2], 0.5 * (outer - inner), half_height);
}

[[nodiscard]] inline double box(const Point& p, const Point& half) {
  Point outside{};
  double inside = -1e300;
  for (std::size_t a = 0; a < 3; ++a) {
    const double d = std::abs(p[a]) - half[a];
    outside[a] = std::max(d, 0.0);
    inside = std::max(inside, d);
  }
  return std::min(inside, 0.0) + length(outside);
}

/// Ring about the z axis.
[[nodiscard]] inline double torus(const Point& p, double ring_radius, double tube_radius) {
  return std::hypot(std::hypot(p[0], p[1]) - ring_radius, p[2]) - tube_radius;
}

/// Frustum about the z axis, radius `bottom` at z = -half_height and `top` at +half_height.
[[nodiscard]] inline double frustum(const Point& p, double bottom, double top, double half_height) {
  const double r = std::hypot(p[0], p[1]);
  const double z = p[2];
  const double cap_r = r - std::min(r, z < 0 ? bottom : top);
  const double cap_z = std::abs(z) - half_height;
  const double slope_r = top - bottom;
  const double slope_z = 2 * half_height;
  const double t = std::clamp(
      ((top - r) * slope_r + (half_height - z) * slope_z) / (slope_r * slope_r + slope_z * slope_z), 0.0, 1.0);
  const double side_r = r - top + slope_r * t;
  const double side_z = z - half_height + slope_z * t;
  const bool inside = side_r < 0 && cap_z < 0;
  return (inside ? -1 : 1) * std::sqrt(std::min(cap_r * cap_r + cap_z * cap_z, side_r * side_r + side_z * side_z));
}

/// Convex hull of a ball of radius `low` at z = 0 and one of radius `high` at z = height: an egg. |low - high| <
/// height.
[[nodiscard]] inline double egg(const Point& p, double low, double high, double height) {
  const double r = std::hypot(p[0], p[1]);
  const double b = (low - high) / height;
  const double a = std::sqrt(1 - b * b);
  const double k = a * p[2] - b * r;
  if (k < 0) return std::hypot(r, p[2]) - low;
  if (k > a * height) return std::hypot(r, p[2] - height) - high;
  return r * a + p[2] * b - low;
}

}  // namespace vam::solid::sdf
