// SPDX-License-Identifier: GPL-3.0-or-later
// Planes and cylinders through measured points, by least squares, and how far the points depart from them.
#pragma once

#include <span>

#include "base/vector3.hpp"

namespace vam::metrology {

/// { x : normal . (x - point) = 0 }; `point` is the middle of the points.
struct PlaneFit {
  Vector3 point{};
  Vector3 normal{};              // unit length
  double peak_to_valley_mm = 0;  // extreme departures: FLTt of ISO 12781-1
};
/// The normal lies on the side of `near`. At least 3 points that are not on a line.
[[nodiscard]] PlaneFit fit_plane(std::span<const Vector3> points, const Vector3& near);

struct CylinderFit {
  Vector3 point{};  // on the axis, at the middle of the points
  Vector3 axis{};   // unit length
  double radius_mm = 0;
  double peak_to_valley_mm = 0;  // of the radius: CYLt of ISO 12180-1
};
/// From the direction of an axis that is nearly right, by Gauss-Newton. At least 5 points, half around the axis or so.
[[nodiscard]] CylinderFit fit_cylinder(std::span<const Vector3> points, const Vector3& near);

/// The direction to which most of these normals are perpendicular, within 10 degrees: the axis of what is round.
[[nodiscard]] Vector3 axis_of(std::span<const Vector3> normals);

/// Unit vectors that make a right-handed frame with `axis`, which is one.
struct AcrossAxis {
  Vector3 u{};
  Vector3 v{};
};
[[nodiscard]] AcrossAxis across(const Vector3& axis);

}  // namespace vam::metrology
